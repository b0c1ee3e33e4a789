"""Which load case governs: the lowest multiplier, if all are answered and accepted."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

import drystone
from harness.model.case import Case
from harness.model.comparison import CaseResults
from harness.model.envelope import Envelope, envelope, envelopes, ranked_text
from harness.model.live_load import both_signs
from harness.model.method import Status
from harness.model.result import Result
from reports.page.governing import governing

B1, B2, H = 1.0, 1.2, 2.0
"""Width of the base and of the top of a block that leans to the left, and its height."""


def leaning() -> list[Case]:
    blocks = [
        {"id": "g", "fixed": True, "polygon": [[-1, -1], [3, -1], [3, 0], [-1, 0]]},
        {"id": "a", "polygon": [[0, 0], [B1, 0], [1.0, H], [-0.2, H]]},
    ]
    loads = {"live": {"body": [{"per_weight": [1, 0]}]}}
    wall = drystone.build_wall(
        {"format": "wall/1", "unit_weight": 20, "friction": 0.9, "blocks": blocks, "loads": loads}, "leaning"
    )
    return both_signs(wall.case)


def answers(**settings: Any) -> tuple[list[Case], list[Result]]:
    cases = leaning()
    return cases, [drystone.analyse(drystone.Wall(case), "la-associated", **settings) for case in cases]


def test_the_side_to_which_a_block_leans_governs_with_its_closed_form():
    """It topples at the distance from the edge to the centroid over the height of the centroid."""
    cases, results = answers()
    x, y = cases[0].assembly.centroid[1].tolist()
    found = envelope(cases, results)
    assert [result.multiplier for result in results] == pytest.approx([(B1 - x) / y, x / y], rel=1e-9)
    assert found.governing == ("to the left",)
    assert found.verdict == 'la-associated: load case "to the left" governs, 0.4352941 (upper bound).'
    assert '0.5352941 (upper bound), "to the left" 0.4352941 (upper bound).' in found.sentence
    assert found.as_json()["governing"] == ["to the left"]


def test_equal_load_cases_govern_alike():
    cases, results = answers()
    found = envelope(cases, [results[0], results[0]])
    assert found.verdict == 'la-associated: load cases "to the right", "to the left" govern, 0.5352941 (upper bound).'


def test_of_many_load_cases_the_first_few_are_named():
    _, results = answers()
    names = tuple(f"gust-{k}" for k in range(20))
    found = Envelope("leaning", "la-associated", names, (results[0],) * 20, ("",) * 20)
    assert '"gust-4", "gust-5" and 14 more govern' in found.verdict
    assert found.governing == names
    failed = results[0].model_copy(update={"status": Status.REFUSED})
    unknown = replace(found, results=(failed,) * 20)
    first = ", ".join(f'"{name}"' for name in names[:6])
    assert unknown.verdict.endswith(f"there is no accepted answer to {first} and 14 more.")


def test_no_load_case_governs_while_another_has_no_answer():
    cases, results = answers()
    failed = results[0].model_copy(update={"status": Status.TIMEOUT})
    rejected = results[0].model_copy(update={"judge": results[0].judge.model_copy(update={"accepted": False})})
    for missing in (failed, rejected):
        found = envelope(cases, [missing, results[1]])
        assert found.governing == ()
        assert 'not known, because there is no accepted answer to "to the right"' in found.verdict


def test_envelopes_are_by_wall_and_method_and_walls_of_one_load_case_have_none():
    cases, results = answers()
    alone = drystone.library_wall("single-block").case
    rows = [CaseResults(case, [result]) for case, result in zip([*cases, alone], [*results, results[0]], strict=True)]
    sides = ("to the right", "to the left")
    assert envelopes(rows) == [Envelope("leaning", "la-associated", sides, tuple(results), ("", ""))]


FRICTION, COHESION, WEIGHT, ADDED, PUSHED = 0.5, 5.0, 1.0, 1.0, 1.5
"""Of a bonded block, the dead load that its second load case adds, and the live load of that."""


def bonded() -> drystone.Wall:
    """A block that its cohesion holds best in one load case, and its friction in the other."""
    blocks = [
        {"id": "g", "fixed": True, "polygon": [[0, -1], [1, -1], [1, 0], [0, 0]]},
        {"id": "a", "polygon": [[0, 0], [1, 0], [1, 0.2], [0, 0.2]]},
    ]
    added = {"points": [{"block": "a", "at": [0.5, 0.2], "force": [0, -ADDED]}]}
    cases = {
        "light": {"live": {"body": [{"per_weight": [1, 0]}]}},
        "heavy": {"dead": added, "live": {"body": [{"per_weight": [PUSHED, 0]}]}},
    }
    joints = {"friction": FRICTION, "cohesion": COHESION, "tensile_strength": 8.0}
    return drystone.build_wall(
        {"format": "wall/1", "unit_weight": 5.0, "blocks": blocks, "load_cases": cases, **joints}, "bonded"
    )


def test_the_residual_multiplier_decides_where_joints_have_strength():
    """Sliding: (friction N + cohesion A) / H with the strength, friction N / H without it."""
    compared = drystone.compare(bonded(), ["la"], isolated=False)
    plastic = [FRICTION * WEIGHT + COHESION, (FRICTION * (WEIGHT + ADDED) + COHESION) / PUSHED]
    residual = [FRICTION * WEIGHT, FRICTION * (WEIGHT + ADDED) / PUSHED]
    assert plastic[1] < plastic[0], "by its strength alone the heavy case would govern"
    assert residual[0] < residual[1]
    (found,) = envelopes(compared.run.cases)
    assert [result.multiplier for result in found.results] == pytest.approx(plastic, rel=1e-9)
    assert found.governing == ("light",)
    assert found.verdict == (
        'la: load case "light" governs, 0.5000000 residual (5.5000000 with the strength of its joints).'
    )
    data = found.as_json()
    assert data["ranked_by"] == "residual_multiplier"
    assert [case["residual_multiplier"] for case in data["load_cases"]] == pytest.approx(residual, rel=1e-9)
    lost = found.results[0].model_copy(
        update={"details": {"without_strength": {"status": "timeout", "finding": "none"}}}
    )
    unknown = replace(found, results=(lost, found.results[1]))
    assert unknown.governing == ()
    assert 'no accepted residual answer to "light"' in unknown.verdict
    assert envelope(*answers()).as_json()["ranked_by"] == "multiplier"


def test_first_screen_ranks_by_the_residual_multiplier_and_says_so(tmp_path: Path):
    page = drystone.compare(bonded(), ["la"], isolated=False).report(tmp_path / "report.html").read_text("utf-8")
    assert "The load case with the lowest multiplier governs, residual ones included" in page
    rows = re.findall(r'<tr><th scope="row">(light|heavy)</th>((?:<td>[^<]*</td>){4})</tr>', page)
    assert rows == [
        ("light", "<td>0.50000 (la)</td><td>5.5000 (la)</td><td>least, to rounding</td><td>yes</td>"),
        ("heavy", "<td>0.66667 (la)</td><td>4.0000 (la)</td><td>least, to rounding</td><td></td>"),
    ]
    assert "For safety use 0.50000 (la) in load case light, the residual multiplier" in page


@pytest.mark.parametrize(
    ("more", "value", "words"),
    [({}, 0.45, "Rely on the lower one, with strength"), ({"after": "residual"}, 0.5, "which is no safe estimate")],
)
def test_the_multiplier_with_strength_decides_where_it_is_the_lower_one(
    more: dict[str, str], value: float, words: str, tmp_path: Path
):
    """Of two blocks on friction mu one slides off while its glued side lifts it: mu (1 - c A / W), below mu."""
    head = {"joint": "head", "value": 0.5, "cohesion": 2.0} | more
    panel = {"type": "panel", "cell_length": 1.0, "cell_height": 0.5, "layout": ["ab", "##"], "fixed": "#"}
    pair = {"format": "wall/1", "unit_weight": 20.0, "pattern": panel, "friction": {"default": 0.5, "rules": [head]}}
    wall = drystone.build_wall(pair | {"loads": {"live": {"body": [{"per_weight": [-1, 0]}]}}}, "pair")
    compared = drystone.compare(wall, ["la"], isolated=False)
    (result,) = compared.run.cases[0].results
    assert result.multiplier == pytest.approx(value, rel=1e-9)
    assert words in result.sentence
    assert ranked_text(result) == "0.4500000 with the strength of its joints (0.5000000 residual)"
    assert envelope([wall.case], [result]).as_json()["ranked_by"] == "lower_multiplier"
    page = compared.report(tmp_path / "report.html").read_text("utf-8")
    assert "For safety use 0.45000 (la), below the residual multiplier" in page
    (way,) = governing(compared.run.cases).ways
    assert (way.residual, way.governs) == ("0.50000 (la)", True)


@pytest.mark.parametrize(("strength", "told"), [({}, False), ({"compressive_strength": 60.0}, True)])
def test_a_page_explains_the_columns_that_it_has_of_the_one_joint_of_a_pier(
    strength: dict[str, float], told: bool, tmp_path: Path
):
    data: dict[str, Any] = {"format": "wall/1", "unit_weight": 20.0, "friction": 0.9}
    data["pattern"] = {"type": "stack", "width": 0.4, "height": 1.0, "count": 1}
    data["loads"] = {"live": {"body": [{"per_weight": [1, 0]}]}}
    wall = drystone.build_wall(data | strength, "pier")
    page = drystone.compare(wall, ["la"], isolated=False).report(tmp_path / "report.html").read_text("utf-8")
    assert "by la: the joint.</p>" in page
    assert ("Crushing is the edge stress over the compressive strength." in page) == told
