"""Studies and grids of walls that differ in friction or proportion."""

from __future__ import annotations

import re

import numpy as np
import pytest

from harness.model.comparison import CaseResults, ComparisonRun
from reports.charts import families, grid, studies
from reports.geometry import thrust_lines
from reports.page import paper
from tests.reports import samples


def test_walls_that_differ_in_friction_make_a_study():
    cases = [samples.bond(f"wall-{k}", friction=friction) for k, friction in enumerate((0.75, 0.4, 0.65))]
    run = ComparisonRun(
        "",
        "",
        "",
        [CaseResults(case, [samples.solved(case, "la", 0.5, turn=0.1 * (k == 1))]) for k, case in enumerate(cases)],
    )
    (study,) = families.families(run)
    assert "3 values of friction" in study.sentence
    assert [caption for caption, _ in study.charts] == [""], "a chart alone is named by its head"
    assert "0.4 and 0.65" in study.sentence, "the mechanism of the one with friction 0.4 is another"


def test_walls_that_differ_in_proportion_make_a_study():
    cases = [samples.bond(f"wall-{k}", length=length) for k, length in enumerate((0.2, 0.4, 0.6))]
    run = ComparisonRun("", "", "", [CaseResults(case, [samples.solved(case, "la", 0.5)]) for case in cases])
    (study,) = families.families(run)
    assert "3 values of proportion" in study.sentence
    other = samples.bond("other", length=0.8, friction=0.3)
    run.cases[2] = CaseResults(other, [samples.solved(other, "la", 0.5)])
    assert families.families(run) == [], "another friction is another family"


def test_given_study_is_drawn():
    line = {
        "name": "de",
        "x": [0.0, 0.03, 0.08],
        "y": [0.56, 0.49, 0.4],
        "low": [0.55, 0.45, 0.3],
        "high": [0.57, 0.5, 0.5],
    }
    given = {"title": "Imperfections", "sentence": "It falls.", "read": "Down.", "x_label": "eps", "series": [line]}
    (study,) = studies.studies(ComparisonRun("", "", "", [], {"studies": [given]}))
    assert study.title == "Imperfections"
    assert str(study.charts[0][1]).count('class="bar') == 3


def test_ratios_need_no_method_that_is_missing():
    case = samples.bond()
    found = paper.paper_comparison(ComparisonRun("", "", "", [CaseResults(case, [samples.solved(case, "la", 0.5)])]))
    assert found is not None
    assert found.ratio_ours == ""
    assert paper.paper_comparison(ComparisonRun("", "", "", [])) is None


MAINS = ("fe", "la", "de")


def grid_of(values: dict[tuple[float, float], tuple[float, float, float]]) -> families.StudyCurves:
    """The grid study of walls (length of a brick, friction) with multipliers of FE, LA and DE."""
    items = []
    for (length, friction), found in values.items():
        case = samples.bond(f"wall-{len(items)}", length=length, friction=friction)
        items.append(
            CaseResults(case, [samples.solved(case, name, value) for name, value in zip(MAINS, found, strict=True)])
        )
    (study,) = grid.grids(ComparisonRun("", "", "", items))
    return study


def test_grid_names_who_stands_apart_and_how_far():
    study = grid_of(
        {
            (0.4, 0.5): (0.5, 0.5, 0.501),
            (0.4, 0.8): (0.56, 0.53, 0.5601),
            (0.6, 0.5): (0.5, 0.5, 0.5),
            (0.6, 0.8): (0.8, 0.8, 0.88),
        }
    )
    assert "agree within 1 % on 2 of 4 walls" in study.sentence
    assert "LA low 5 %" in study.table
    assert "DE high 10 %" in study.table
    assert "On 1 of the 2 walls where they differ, LA is lowest, by 5 % from the middle one" in study.sentence


def test_grid_says_where_the_least_known_falls_as_friction_grows():
    values = {(length, mu): (0.6, 0.6, 0.6) for length in (0.4, 0.6) for mu in (0.6, 0.8)}
    values[0.4, 0.8] = (0.6, 0.55, 0.6)
    found = grid_of(values)
    assert "it falls at 2:1 from 0.60000 at 0.6 to 0.55000 at 0.8." in found.sentence
    assert found.table is not None
    assert re.findall(r'<td class="([^"]+)"', found.table) == ["agree", "differ-2", "agree", "agree"]
    thirds = {(length, mu): (0.6, 0.6, 0.6) for length in (0.4, 0.4472) for mu in (0.6, 0.8)}
    thirds[0.4472, 0.8] = (0.6, 0.55, 0.6)
    assert "falls at 2.24:1 from" in grid_of(thirds).sentence
    values[0.4, 0.8] = (0.6, 0.65, 0.6)
    assert "falls at" not in grid_of(values).sentence


def test_walls_of_one_proportion_make_no_grid():
    cases = [samples.bond(f"wall-{k}", friction=friction) for k, friction in enumerate((0.4, 0.6, 0.8))]
    items = [CaseResults(case, [samples.solved(case, name, 0.5) for name in MAINS]) for case in cases]
    assert grid.grids(ComparisonRun("", "", "", items)) == []


@pytest.mark.parametrize("methods", [("la-associated",), ("la", "la-associated"), ("fe-qp", "la-associated")])
def test_a_grid_of_fewer_than_two_main_methods_says_nothing_of_agreement(methods: tuple[str, ...]):
    kinds = [(length, friction) for length in (0.4, 0.6) for friction in (0.5, 0.8)]
    cases = [samples.bond(f"wall-{k}", length=length, friction=mu) for k, (length, mu) in enumerate(kinds)]
    items = [CaseResults(case, [samples.solved(case, name, 0.5) for name in methods]) for case in cases]
    assert grid.grids(ComparisonRun("", "", "", items)) == []


def test_paper_section_tells_what_uneven_blocks_cost():
    case = samples.bond("wall-21")
    item = CaseResults(case, [samples.solved(case, "la", 0.5)])
    study = {
        "name": "imperfections",
        "title": "Multiplier against unevenness of the blocks",
        "sentence": "It falls by 15 %.",
    }
    told = paper.paper_comparison(ComparisonRun("", "", "", [item], {"studies": [study]}))
    untold = paper.paper_comparison(ComparisonRun("", "", "", [item]))
    assert told is not None
    assert untold is not None
    assert (told.imperfection, untold.imperfection) == ("It falls by 15 %.", "")


def bracketed_grid(low: float, high: float) -> families.StudyCurves:
    """A grid of four walls, on which DE brackets one, and the others agree."""
    items = []
    for number, (length, friction) in enumerate(((0.4, 0.5), (0.4, 0.8), (0.6, 0.5), (0.6, 0.8))):
        case = samples.bond(f"wall-{number}", length=length, friction=friction)
        ends = (low, high) if number == 3 else (0.4999, 0.5001)
        de = samples.solved(case, "de", 0.5 * sum(ends), flow="approximate", bracket=ends)
        items.append(CaseResults(case, [samples.solved(case, name, 0.5) for name in ("fe", "la")] + [de]))
    (study,) = grid.grids(ComparisonRun("", "", "", items))
    return study


def test_a_bracket_in_a_grid_agrees_differs_or_does_not_decide():
    assert "agree within 1 % on all 4 walls" in bracketed_grid(0.499, 0.502).sentence
    open_ = bracketed_grid(0.45, 0.6)
    assert "on 3 of 4 walls; on 1 a measured bracket does not decide." in open_.sentence
    assert "DE open" in open_.table
    apart = bracketed_grid(0.55, 0.7)
    assert "The least friction at which they differ is, by proportion, 3:1 at 0.8." in apart.sentence
    assert "DE is highest, by 10 % from the middle one" in apart.sentence, "its nearest end"
    assert "DE high 10 %" in apart.table


def test_what_head_joints_carry_is_said_from_the_forces_of_the_walls_that_differ():
    def said(share: float) -> str:
        items = []
        for number, (length, friction) in enumerate(((0.4, 0.5), (0.4, 0.8), (0.6, 0.5), (0.6, 0.8))):
            case = samples.bond(f"wall-{number}", length=length, friction=friction)
            assembly = case.assembly
            heads = np.flatnonzero(abs(assembly.normal[:, 0]) > thrust_lines.HEAD_JOINT)
            weight = float(assembly.weight[assembly.free].sum())
            rows = []
            for name, value in (("fe", 0.6), ("la", 0.5)):
                forces = np.array(samples.solved(case, name, value).forces)
                forces[heads, :2] = 0.0
                forces[heads[0], 0] = weight * (share if name == "la" else 0.125)
                update = {"forces": [tuple(row) for row in forces.tolist()]}
                rows.append(samples.solved(case, name, value).model_copy(update=update))
            items.append(CaseResults(case, rows))
        (study,) = grid.grids(ComparisonRun("", "", "", items))
        return study.sentence

    assert "its head joints carry 0.5 of the wall's weight there in the median, with 0.12 in FE" in said(0.5)
    assert "its head joints carry 0.25 of the wall's weight" in said(0.25)
