"""The engineer's appendix: what it holds, that supports take the loads, and that it prints."""

from __future__ import annotations

import json
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import drystone as package
from drystone.cli import printing
from harness.model.comparison import CaseResults
from harness.model.live_load import reversed_live
from harness.model.method import Finding, Status
from harness.model.result import Result
from harness.model.support_reactions import out_of_balance, support_reactions
from reports.appendix import render, write_appendix
from reports.labels.wall_summary import value_in_words
from tests.commands import drystone
from tests.reports import samples
from tests.walls import assembly, stack


def one_wall():
    run = samples.typical()
    return replace(run, cases=[next(item for item in run.cases if item.results and item.results[0].forces)])


def test_reaction_of_a_column_is_its_weight_and_push_where_statics_puts_it():
    wall = assembly(stack(3), 0.65)  # blocks of .3 by .2 m, 1.2 kN each, on a fixed one
    push = 0.25
    forces = []
    for height in (3, 2, 1):  # from the foot up: the blocks above, their centre half-way up
        weight = 1.2 * height
        eccentric = push * 0.1 * height
        share = 0.5 + eccentric / 0.3
        forces.append((weight * (1.0 - share), weight * share, push * weight))
    along = float(wall.tangent[0, 0])
    if along < 0.0:
        forces = [(second, first, -shear) for first, second, shear in forces]
    sign = float(wall.normal[0, 1])
    forces = [(first, second, sign * shear) for first, second, shear in forces]
    (reaction,) = support_reactions(wall, np.array(forces))
    assert abs(reaction.fx) == pytest.approx(push * 3.6)
    assert reaction.fy == pytest.approx(3.6)
    centre = float(wall.centroid[wall.free, 0].mean())
    assert abs((reaction.x or 0.0) - centre) == pytest.approx(push * 0.3)
    assert out_of_balance(wall, [reaction], -np.sign(reaction.fx) * push) < 1e-12
    assert out_of_balance(wall, [reaction], 0.3) > 0.01


def test_appendix_holds_what_an_engineer_signs_for():
    run = one_wall()
    (item,) = run.cases
    text = render(run)
    for heading in ("Result", "Given", "Assumptions", "Drawing", "Mechanism and forces", "Blocks", "Limits"):
        assert re.search(rf"<h2>\d {heading}", text), heading
    for free in item.case.assembly.free:
        name = item.case.assembly.block_ids[free]
        assert f'<th scope="row">{name}</th>' in text
    for word in ("Supports", "Friction", "Units", "Reactions of the supports", "Computed by", "Repeat it"):
        assert word in text
    joints = item.case.assembly.n_interfaces
    assert f"<b>Most critical joints</b> ({min(joints, 8)} of {joints}) in this state" in text
    assert text.count("<svg") == 3
    assert not re.search(r'(src|href)="http', text)


def test_a_machine_without_a_browser_is_told_what_to_do(tmp_path: Path):
    with pytest.raises(printing.PrintError, match="install chromium, or open"):
        printing.print_pdf(tmp_path / "a.html", tmp_path / "a.pdf", printing.Browsers(names=("no-such-browser",)))
    assert not list(tmp_path.iterdir())


@pytest.mark.browser
def test_appendix_prints_on_two_to_four_sheets(tmp_path: Path):
    page = tmp_path / "wall-appendix.html"
    write_appendix(one_wall(), page)
    try:
        printing.print_pdf(page, page.with_suffix(".pdf"))
    except printing.PrintError as error:
        pytest.skip(str(error))
    sheets = len(re.findall(rb"/Type /Page\b", page.with_suffix(".pdf").read_bytes()))
    assert 2 <= sheets <= 4


def both_ways(right: float, left: float) -> str:
    case = samples.bond("mine")
    turned = reversed_live(case)
    items = [
        CaseResults(case, [samples.solved(case, "la", right)]),
        CaseResults(turned, [samples.solved(turned, "la", left)]),
    ]
    return re.sub(r"\s+", " ", render(replace(samples.typical(), cases=items)))


def test_the_lower_of_two_directions_governs_the_appendix():
    text = both_ways(0.38236, 0.29947)
    assert "mine collapses at 0.29947 under the live load to the left" in text
    assert "For safety use 0.29947" in text
    assert '<th scope="row">to the right</th><td>0.38236 (la)</td><td>least known</td><td></td>' in text
    assert '<th scope="row">to the left</th><td>0.29947 (la)</td><td>least known</td><td>yes</td>' in text
    assert "For safety use 0.29947" in both_ways(0.29947, 0.38236)
    assert "under the live load to the right" in both_ways(0.29947, 0.38236)


def test_no_load_case_governs_the_appendix_while_one_has_no_answer():
    """It said that the lowest multiplier governs, beside the sentence that which one governs is not known."""
    push = {"live": {"body": [{"per_weight": [1, 0]}]}}
    stone = {"id": "a", "polygon": [[0, 0], [1, 0], [1, 1], [0, 1]]}
    ground = {"id": "g", "fixed": True, "polygon": [[-1, -1], [2, -1], [2, 0], [-1, 0]]}
    wall = {"format": "wall/1", "unit_weight": 20, "friction": 0.5, "blocks": [ground, stone]}
    cases = package.build_wall(wall | {"load_cases": {"known": push, "open": push}}).load_cases
    known, unknown = (each.case for each in cases.values())
    lost = samples.failed(unknown, "la", Status.NOT_CONVERGED, "It gave up.")
    items = [CaseResults(known, [samples.solved(known, "la", 0.5)]), CaseResults(unknown, [lost])]
    text = re.sub(r"\s+", " ", render(replace(samples.typical(), cases=items)))
    assert "2 load cases were analysed; which one governs is not known, and all further results are for that of" in text
    assert "Which load case governs is not known: there is no accepted answer to open." in text
    assert "the lowest multiplier governs" not in text


def test_one_direction_alone_is_named():
    case = samples.bond("mine")
    text = render(replace(samples.typical(), cases=[CaseResults(case, [samples.solved(case, "la", 0.5)])]))
    assert "Live load: to the right. No other direction was analysed." in text


def appendix(wall: str, folder: Path) -> str:
    done = drystone("report", "--appendix", f"{wall}.json", cwd=folder)
    assert done.returncode == 0, done.stderr
    return (folder / "out" / f"{wall}-appendix.html").read_text()


def test_the_command_analyses_a_horizontal_load_both_ways(tmp_path: Path):
    stones = {"g": [-1, -0.2, 2, 0], "a": [0, 0, 0.5, 0.5], "b": [0.2, 0.5, 0.6, 1.0]}
    blocks = [
        {"id": name, "fixed": name == "g", "polygon": [[x0, y0], [x1, y0], [x1, y1], [x0, y1]]}
        for name, (x0, y0, x1, y1) in stones.items()
    ]
    left, right = ({"live": {"body": [{"per_weight": [sign, 0]}]}} for sign in (-1, 1))
    wall = {"format": "wall/1", "unit_weight": 20, "friction": 0.9, "blocks": blocks}
    (tmp_path / "lean.json").write_text(json.dumps(wall | {"loads": left}))
    (tmp_path / "named.json").write_text(json.dumps(wall | {"load_cases": {"wind": left, "quake": right}}))
    text, named = appendix("lean", tmp_path), appendix("named", tmp_path)
    # About the right toe at (.5, 0): (5 kN * .25 m + 4 kN * .1 m) over (5 kN * .25 m + 4 kN * .75 m); about the left
    # one: (5 * .25 + 4 * .4) over the same.
    assert "collapses at 0.38824 under the live load to the right" in text
    assert "<td>0.67059 (la)</td>" in text
    assert "2 load cases were analysed; the lowest multiplier governs" in named
    assert "all further results are for the load case quake" in named
    assert "<h1>named</h1>" in named
    assert "named.json, load case &#34;quake&#34;" in named
    assert "wind&#34;" not in named, "the wall that governs heads the sheet, not the first load case"
    for name, value, governs in (("wind", "0.67059", ""), ("quake", "0.38824", "yes")):
        assert re.search(rf'"row">{name}</th><td>{value} \(la\)</td><td>[a-z ,]+</td><td>{governs}</td>', named)


@pytest.mark.parametrize("without", ["forces", "mechanism"])
def test_the_appendix_draws_the_least_state_that_has_forces_and_a_motion(without: str):
    case = samples.bond("mine")
    least, other = samples.solved(case, "la", 0.4), samples.solved(case, "fe", 0.5)
    bare = least.model_copy(update={without: None})

    def drawn(*results: Result) -> tuple[str, ...]:
        text = render(replace(samples.typical(), cases=[CaseResults(case, list(results))]))
        assert text.count("<svg") == (3 if "Velocities" in text else 1), "the wall alone where nothing else is known"
        found = re.search(r"By (\S+) at ([\d.]+)\. Velocities drawn", text)
        return () if found is None else found.groups()

    assert drawn(least, other) == ("la", "0.40000")
    assert drawn(bare, other) == ("fe", "0.50000")
    assert drawn(bare) == ()


@pytest.mark.parametrize("finding", list(Finding))
def test_a_value_is_a_number_only_where_the_wall_collapses(finding: Finding):
    result = samples.solved(samples.bond("mine"), "la", 0.4).model_copy(update={"finding": finding})
    assert ("0.4" in value_in_words(result)) is (finding is Finding.COLLAPSES)


def test_loads_and_blocks_of_the_appendix_are_those_of_the_file():
    case = samples.bond("mine", courses=1, bricks=1)  # two halves of .2 by .2 m, 20 kN/m3, one metre thick
    text = render(replace(samples.typical(), cases=[CaseResults(case, [samples.solved(case, "la", 0.4)])]))
    rows = [re.findall(r"<t[hd][^>]*>(.*?)</t[hd]>", row) for row in re.findall(r"<tr>(.*?)</tr>", text)]
    told = {
        row[0]: [part for cell in row[1:] for part in cell.replace("\u2212", "-").split(", ")] for row in rows if row
    }
    assert [float(x) for x in told["Dead load, with the weights"]] == pytest.approx([0.0, -1.6], abs=5e-4)
    assert [float(x) for x in told["Live load at multiplier 1"]] == pytest.approx([1.6, 0.0], abs=5e-4)
    free = int(case.assembly.free[0])
    x, y = case.assembly.polygons[free].mean(axis=0)
    values = [float(value) for value in told[case.assembly.block_ids[free]]]
    assert values == pytest.approx([x, y, 0.8, 0.0, -0.8, 0.8, 0.0], abs=5e-4)
