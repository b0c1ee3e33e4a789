"""A wall of independent components: each analysed alone, the least multiplier, and forces that bear it elsewhere."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from harness.engine.judge import answered
from harness.engine.symmetry import renumbered
from harness.model.assembly import Assembly
from harness.model.build import build
from harness.model.components import analysed_apart, components_of, joined, joints_of
from harness.model.details import MOVING_FORCES
from harness.model.method import Answer, Finding, OutOfTime, Status
from harness.model.method_registry import load_method
from harness.model.wall import Wall
from tests.walls import assembly, beside, stack

METHODS = ("la", "la-associated", "fe")
SHARES = (1e-12, 1e-6, 1e6, 1e12)


def square(name: str, left: float, low: float, width: float, height: float, **more: Any) -> dict[str, Any]:
    right, high = left + width, low + height
    return {"id": name, "polygon": [[left, low], [right, low], [right, high], [left, high]]} | more


def three_columns(*loads: tuple[float, float]) -> Assembly:
    """Three blocks far apart on one fixed base, half as wide as high (.5), as wide (.7: they slide), and twice."""
    blocks = [square("base", -1.0, -1.0, 20.0, 1.0, fixed=True)]
    blocks += [square(f"b{k}", 5.0 * k, 0.0, width, 1.0) for k, width in enumerate((0.5, 1.0, 2.0))]
    live = {"body": [{"blocks": [f"b{k}"], "per_weight": list(load)} for k, load in enumerate(loads)]}
    wall = {"format": "wall/1", "unit_weight": 20.0, "friction": 0.7, "blocks": blocks, "loads": {"live": live}}
    return build(Wall.model_validate(wall)).assembly


def test_blocks_that_share_fixed_blocks_only_are_components_of_their_own():
    wall = three_columns((1.0, 0.0), (1.0, 0.0), (1.0, 0.0))
    parts = components_of(wall)
    assert [[part.assembly.block_ids[i] for i in part.assembly.free] for part in parts] == [["b0"], ["b1"], ["b2"]]
    assert sorted(np.concatenate([part.interfaces for part in parts])) == [0, 1, 2]
    for part in parts:
        assert [wall.block_ids[i] for i in part.blocks] == list(part.assembly.block_ids)
        np.testing.assert_array_equal(wall.dead[part.blocks], part.assembly.dead)


def test_wall_of_one_component_is_left_as_it_is():
    wall = assembly(stack(3))
    assert components_of(wall)[0].assembly is wall


@pytest.mark.parametrize("name", METHODS)
def test_least_component_fails_and_is_named(name: str):
    result, judgement = answered(load_method(name), three_columns((1.0, 0.0), (1.0, 0.0), (1.0, 0.0)))
    assert judgement.accepted
    assert result.multiplier == pytest.approx(0.5, rel=1e-9)
    assert "the one that fails is that of b0" in result.sentence
    assert [part["multiplier"] for part in result.details["components"]] == pytest.approx([0.5, 0.7, 0.7], rel=1e-9)
    assert result.mechanism is not None
    moving = np.abs(np.reshape(result.mechanism, (-1, 3))).max(axis=1) > 0.0
    assert list(moving) == [False, True, False, False]


@pytest.mark.parametrize("name", METHODS)
def test_component_that_bears_any_load_bears_that_of_the_one_that_fails(name: str):
    result, judgement = answered(load_method(name), three_columns((0.0, -1.0), (1.0, 0.0), (0.0, 0.0)))
    assert judgement.accepted
    assert result.multiplier == pytest.approx(0.7, rel=1e-9)
    assert [part["finding"] for part in result.details["components"]] == ["unbounded", "collapses", "stands"]


@pytest.mark.parametrize("name", METHODS)
def test_wall_falls_with_any_component(name: str):
    wall = three_columns((1.0, 0.0), (1.0, 0.0), (0.0, 0.0))
    dead = wall.dead.copy()
    dead[3, 2] = 100.0  # a couple that overturns the widest
    result, judgement = answered(load_method(name), replace(wall, dead=dead))
    assert result.finding is Finding.FALLS
    assert judgement.accepted
    assert "that of b2" in result.sentence


@pytest.mark.parametrize("name", METHODS)
def test_wall_none_of_whose_components_can_collapse_is_unbounded(name: str):
    result, _ = answered(load_method(name), three_columns((0.0, -1.0), (0.0, -1.0), (0.0, 0.0)))
    assert result.finding is Finding.UNBOUNDED
    assert "none of them fails" in result.sentence


@pytest.mark.parametrize("share", SHARES)
@pytest.mark.parametrize("name", METHODS)
def test_independent_block_of_any_weight_changes_no_multiplier(name: str, share: float):
    for wall in (assembly(stack(3)), three_columns((1.0, 0.0), (1.0, 0.1), (1.0, 0.0))):
        alone, _ = answered(load_method(name), wall)
        result, judgement = answered(load_method(name), renumbered(beside(wall, share)))
        assert judgement.accepted
        assert result.multiplier == pytest.approx(alone.multiplier, rel=1e-9)


PARTS = components_of(three_columns((1.0, 0.0), (1.0, 0.0), (1.0, 0.0)))


def said(finding: Finding, multiplier: float | None = None, **more: Any) -> Answer:
    return Answer(Status.OK, finding, "It is so.", multiplier, **more)


def of_wall(*answers: Answer, bear: Any = None) -> Answer:
    """The answer for the three columns from those for each, all of which bear anything unless it is said."""
    wall = three_columns((1.0, 0.0), (1.0, 0.0), (1.0, 0.0))
    own = bear or (lambda part, _answer, at: np.full((part.n_interfaces, 3), at))
    return joined(wall, PARTS, list(answers), own)


def measured(low: float, high: float) -> Answer:
    return said(Finding.COLLAPSES, 0.5 * (low + high), bracket=(low, high), flow="approximate")


@pytest.mark.parametrize(
    ("answers", "deciding", "finding"),
    [
        ((said(Finding.COLLAPSES, 0.5), said(Finding.FALLS), said(Finding.FALLS)), 1, Finding.FALLS),
        ((said(Finding.COLLAPSES, 0.7), said(Finding.COLLAPSES, 0.5), said(Finding.STANDS)), 1, Finding.COLLAPSES),
        ((said(Finding.STANDS), said(Finding.UNBOUNDED), said(Finding.UNBOUNDED)), 1, Finding.UNBOUNDED),
        ((said(Finding.STANDS), said(Finding.STANDS), said(Finding.STANDS)), 0, Finding.STANDS),
        ((said(Finding.COLLAPSES, 0.7), measured(0.6, 0.9), said(Finding.STANDS)), 1, Finding.COLLAPSES),
        ((said(Finding.COLLAPSES, 0.7), measured(0.75, 0.9), said(Finding.STANDS)), 0, Finding.COLLAPSES),
    ],
)
def test_a_wall_fails_as_the_component_that_fails_first(answers: Any, deciding: int, finding: Finding):
    found = of_wall(*answers)
    assert (found.details["deciding_component"], found.finding) == (deciding, finding)


def test_a_component_without_an_answer_leaves_the_wall_without_one_unless_another_falls():
    lost = Answer(Status.NOT_CONVERGED, Finding.NONE, "The path was lost.")
    found = of_wall(said(Finding.COLLAPSES, 0.7), lost, said(Finding.COLLAPSES, 0.5))
    assert (found.status, found.multiplier, found.forces) == (Status.NOT_CONVERGED, None, None)
    assert "this is said of that of b1. That of b2 alone collapses at 0.5." in found.sentence
    alone = of_wall(said(Finding.STANDS), lost, said(Finding.STANDS))
    assert alone.sentence.endswith("this is said of that of b1.")
    assert of_wall(lost, said(Finding.FALLS), said(Finding.STANDS)).finding is Finding.FALLS


def test_a_bracket_of_a_wall_ends_where_the_first_component_must_have_moved():
    found = of_wall(measured(0.5, 0.9), measured(0.6, 0.7), said(Finding.COLLAPSES, 0.8))
    assert (found.bracket, found.multiplier) == ((0.5, 0.7), 0.7)
    wide = of_wall(measured(0.5, 0.6), measured(0.55, 0.9), said(Finding.STANDS))
    assert wide.bracket == (0.5, 0.6)
    assert wide.multiplier == pytest.approx(0.55)
    exact = of_wall(measured(0.5, 0.9), said(Finding.COLLAPSES, 0.6), said(Finding.STANDS))
    assert (exact.bracket, exact.multiplier) == ((0.5, 0.6), 0.6)


def test_forces_of_the_wall_are_those_of_the_component_that_fails_and_of_others_under_its_load():
    own = np.array([[1.0, 2.0, 3.0]])
    same, lower = {"forces": 4.0 * own, "forces_multiplier": 0.5}, {"forces": own, "forces_multiplier": 0.4}
    found = of_wall(
        said(Finding.COLLAPSES, 0.5, **lower), said(Finding.STANDS, forces=2.0 * own), said(Finding.COLLAPSES, 0.7)
    )
    assert found.forces is not None
    assert found.forces.tolist() == [[1.0, 2.0, 3.0], [2.0, 4.0, 6.0], [0.4, 0.4, 0.4]]
    equal = of_wall(
        said(Finding.COLLAPSES, 0.5, forces=own), said(Finding.COLLAPSES, 0.5, **same), said(Finding.STANDS)
    )
    assert equal.forces is not None
    assert equal.forces.tolist() == [[1.0, 2.0, 3.0], [4.0, 8.0, 12.0], [0.5, 0.5, 0.5]]
    assert of_wall(said(Finding.COLLAPSES, 0.5), said(Finding.STANDS), said(Finding.STANDS)).forces is None


def test_a_load_that_another_component_is_not_known_to_bear_is_no_answer():
    def bear(part: Assembly, _answer: Answer, at: float) -> Any:
        return None if "b2" in part.block_ids else np.zeros((part.n_interfaces, 3))

    own = np.array([[1.0, 2.0, 3.0]])
    found = of_wall(said(Finding.COLLAPSES, 0.5, forces=own), said(Finding.STANDS), said(Finding.UNBOUNDED), bear=bear)
    assert (found.status, found.finding, found.multiplier) == (Status.NOT_CONVERGED, Finding.NONE, None)
    assert found.sentence.endswith("with which the component of b2 bears the load at 0.5.")


def test_motion_and_forces_of_a_component_have_its_place_in_the_wall():
    motion = np.array([[0.0, 0.0, 0.0], [1.0, 2.0, 3.0]])
    chosen = said(Finding.COLLAPSES, 0.5, mechanism=motion, details={MOVING_FORCES: [[4.0, 5.0, 6.0]]}, iterations=7)
    found = of_wall(said(Finding.STANDS, iterations=3), said(Finding.COLLAPSES, 0.7), chosen)
    assert found.iterations == 10
    assert found.mechanism is not None
    assert found.mechanism.tolist() == [[0.0] * 3] * 3 + [[1.0, 2.0, 3.0]]
    assert found.details[MOVING_FORCES] == [[0.0] * 3] * 2 + [[4.0, 5.0, 6.0]]
    assert [part["free_blocks"] for part in found.details["components"]] == [1, 1, 1]


def test_joints_of_a_component_are_found_in_the_whole_wall():
    wall = three_columns((1.0, 0.0), (1.0, 0.0), (1.0, 0.0))
    assert joints_of(wall, wall).tolist() == [0, 1, 2]
    for part in components_of(wall):
        assert joints_of(part.assembly, wall).tolist() == part.interfaces.tolist()


@pytest.mark.parametrize("stop", ["by an exception", "by a detail"])
def test_after_a_component_that_was_stopped_there_is_no_time_for_others(stop: str):
    asked: list[str] = []

    def solve(part: Assembly) -> Answer:
        asked.append(part.block_ids[part.free[0]])
        if len(asked) == 2 and stop == "by an exception":
            raise OutOfTime
        more = {"stopped_by_limit": True} if len(asked) == 2 else {}
        return said(Finding.COLLAPSES, 0.5, details=more)

    wall = three_columns((1.0, 0.0), (1.0, 0.0), (1.0, 0.0))
    found = analysed_apart(wall, solve, lambda part, _answer, _at: np.zeros((part.n_interfaces, 3)))
    assert asked == ["b0", "b1"]
    assert found.status is Status.NOT_CONVERGED
    assert f"component of {'b1' if stop == 'by an exception' else 'b2'} had an answer" in found.sentence


def test_a_wall_whose_first_component_is_stopped_has_no_answer():
    def solve(_part: Assembly) -> Answer:
        raise OutOfTime

    with pytest.raises(OutOfTime):
        analysed_apart(three_columns((1.0, 0.0), (1.0, 0.0), (1.0, 0.0)), solve, lambda *_: None)
