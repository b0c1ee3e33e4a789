"""On walls nobody chose, the methods stand to each other as theory says, and every state passes the judge."""

from __future__ import annotations

from collections import Counter
from typing import Any

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from benchmarks.walls import irregular_wall
from harness.engine.judge import answered
from harness.engine.symmetry import VIEWS
from harness.model.assembly import Assembly
from harness.model.method import Finding, Status
from harness.model.method_registry import load_method
from tests.walls import assembly

BOUND = 1e-7
"""Relative: the accuracy of the linear programme's optimum, with a margin."""


@st.composite
def coursed_walls(draw: st.DrawFn) -> Assembly:
    """Three to five courses of three block lengths in all, cut at random places, friction from 0.3 to 1.1."""
    courses: list[list[float]] = []
    for _ in range(draw(st.integers(3, 5))):
        widths: list[float] = []
        while sum(widths) < 3.0:
            width = draw(st.sampled_from([0.5, 0.75, 1.0, 1.25]))
            widths.append(min(width, 3.0 - sum(widths)))
        courses.append(widths)
    height = draw(st.sampled_from([0.15, 0.2, 0.3]))
    friction = draw(st.sampled_from([0.3, 0.45, 0.65, 0.8, 1.1]))
    pattern: dict[str, Any] = {
        "type": "running_bond",
        "block_length": 0.4,
        "block_height": height,
        "courses": courses,
    }
    return assembly(pattern, friction)


@st.composite
def panels(draw: st.DrawFn) -> Assembly:
    """Grids of cells joined at random to blocks of up to four, which need not be convex, pushed sideways or askew."""
    columns, rows = draw(st.integers(3, 6)), draw(st.integers(3, 5))
    letters, size = [""] * (columns * rows), Counter[str]()
    for cell in range(columns * rows):
        beside = letters[cell - 1] if cell % columns else ""
        above = letters[cell - columns] if cell >= columns else ""
        letter = draw(st.sampled_from([beside, above, ""]))
        letters[cell] = letter if letter and size[letter] < 4 else chr(ord("A") + cell)
        size[letters[cell]] += 1
    layout = ["".join(letters[k : k + columns]) for k in range(0, columns * rows, columns)] + ["_" * columns]
    pattern = {"type": "panel", "cell_length": 0.5, "cell_height": 0.3, "layout": layout, "fixed": "_"}
    friction = {"default": draw(st.sampled_from([0.3, 0.5, 0.65, 0.9]))}
    rule = {"joint": "head", "value": draw(st.sampled_from([0.2, 0.6, 1.0]))}
    live = {"live": {"body": [{"per_weight": draw(st.sampled_from([[1, 0], [-1, 0.4], [0.7, -0.3]]))}]}}
    return assembly(pattern, friction | {"rules": [rule]}, loads=live)


@pytest.mark.slow
@settings(max_examples=10, deadline=None, derandomize=True, suppress_health_check=list(HealthCheck))
@given(panels())
def test_methods_agree_on_panels_of_blocks_of_any_shape(wall: Assembly):
    found = {name: answered(load_method(name), wall) for name in ("la", "fe", "la-associated", "de")}
    for name, (_, judgement) in found.items():
        assert judgement.accepted is not False, (name, judgement.sentence)
    if found["la-associated"][0].finding is Finding.FALLS:
        assert {result.finding for result, _ in found.values()} == {Finding.FALLS}
        return
    value = {name: result.multiplier for name, (result, _) in found.items() if result.multiplier is not None}
    bracket = found["de"][0].bracket
    if bracket is not None:
        value["de"] = bracket[0]
    greatest = value.get("la-associated", float("inf"))
    for name in value:
        assert value[name] <= greatest + BOUND * max(1.0, greatest), name
    if "fe" in value and "la" in value:
        assert value["la"] <= value["fe"] + BOUND * max(1.0, value["fe"])


@settings(max_examples=6, deadline=None, derandomize=True, suppress_health_check=list(HealthCheck))
@given(coursed_walls())
def test_least_known_plateau_and_associated_maximum_are_ordered(wall: Assembly):
    found = {name: answered(load_method(name), wall) for name in ("la", "fe", "la-associated")}
    values = {}
    for name, (result, judgement) in found.items():
        if result.status is not Status.OK:
            assert name == "fe", result.sentence  # only a traced path may end without a plateau
            continue
        assert judgement.accepted, (name, judgement.sentence)
        assert result.finding is Finding.COLLAPSES
        assert result.multiplier is not None
        values[name] = result.multiplier
    slack = BOUND * max(1.0, values["la-associated"])
    assert values["la"] <= values["la-associated"] + slack
    if "fe" in values:
        assert values["fe"] <= values["la-associated"] + slack
        assert values["la"] <= values["fe"] + slack


@pytest.mark.parametrize(("seed", "columns", "courses"), [(27, 4, 4), (7, 5, 4), (4, 5, 3), (17, 5, 3)])
def test_least_known_is_no_higher_than_the_plateau_of_irregular_blocks(seed: int, columns: int, courses: int):
    # Central paths alone ended up to 3 times as high as the plateau on these walls.
    wall = irregular_wall(seed, columns, courses, 0.8)
    (least, judgement), (plateau, _) = (answered(load_method(name), wall) for name in ("la", "fe"))
    assert judgement.accepted
    assert least.multiplier is not None
    assert plateau.multiplier is not None
    assert least.multiplier <= plateau.multiplier * (1.0 + BOUND)


def test_wall_that_falls_alone_past_its_peak_has_no_plateau_and_no_negative_multiplier():
    wall = irregular_wall(2, 5, 3, 0.8)
    path, _ = answered(load_method("fe"), wall)
    assert path.multiplier is None
    assert path.details["path_status"] == "peak_only"
    assert "falls under its dead load alone" in path.sentence
    least, judgement = answered(load_method("la"), wall)
    assert judgement.accepted
    assert least.multiplier is not None
    assert least.multiplier > 0.0


@settings(max_examples=4, deadline=None, derandomize=True, suppress_health_check=list(HealthCheck))
@given(coursed_walls())
@pytest.mark.parametrize("view", ["mirrored", "scaled", "rotated"])
def test_associated_maximum_is_the_same_in_every_view(view: str, wall: Assembly):
    method = load_method("la-associated")
    plain, _ = answered(method, wall)
    seen, judgement = answered(method, VIEWS[view](wall))
    assert judgement.accepted
    assert seen.multiplier == pytest.approx(plain.multiplier, rel=1e-9)
