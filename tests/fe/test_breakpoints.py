"""The breakpoints that a path of `fe` names: which joint changes its state, and how."""

from __future__ import annotations

import numpy as np
import pytest

from harness.model.assembly import Assembly
from harness.model.breakpoints import CHANGES, Breakpoint, breakpoints
from harness.model.method_registry import load_method
from methods.fe.settings import GapSpringsSettings, NewtonSettings
from tests.known_walls import box, of_blocks
from tests.tied_walls import tied
from tests.walls import assembly, running_bond, stack


def path_of(wall: Assembly, method: str = "fe") -> dict[str, list[float]]:
    """The path of one history without updates."""
    settings = GapSpringsSettings(histories=(0.0,)) if method == "fe" else NewtonSettings()
    return load_method(method).solve(wall, settings).path


def steps_of(wall: Assembly) -> list[Breakpoint]:
    return breakpoints(path_of(wall), wall.n_interfaces)


def test_what_opens_closes_and_slides_is_what_the_numbers_of_open_and_slipping_points_say() -> None:
    wall = assembly(running_bond(4, 2), 0.5)
    path = path_of(wall)
    found = breakpoints(path, wall.n_interfaces)
    assert len(found) == len(path["multiplier"]) > 20
    assert {step.change for step in found} == set(CHANGES)
    opened, slipping = np.diff(path["open_points"]), np.diff(path["slipping_points"])
    on_open = {"opens": 1, "closes": -1, "slides": 0, "sticks": 0}
    for step, more_open, more_slip in zip(found[:-1], opened, slipping, strict=True):
        assert more_open == on_open[step.change]
        if step.change in ("slides", "sticks"):
            assert more_slip == (1 if step.change == "slides" else -1)


def test_column_opens_at_its_foot_last_and_at_no_other_joint() -> None:
    """It overturns as one body about its lowest joint (b/h = 0.3/0.8), long before friction 2 is used up."""
    wall = assembly(stack(4), 2.0)
    foot = int(np.flatnonzero(wall.fixed[wall.block_a] | wall.fixed[wall.block_b])[0])
    opens = [step.joint for step in steps_of(wall) if step.change == "opens"]
    assert opens
    assert opens[-1] == foot


def test_joint_of_a_mirrored_wall_changes_where_its_image_does() -> None:
    wall = assembly(running_bond(3, 2), 0.6)
    image = assembly(running_bond(3, 2), 0.6, loads={"live": {"body": [{"per_weight": [-1, 0]}]}})
    width = float(wall.corners[0][:, 0].max() + wall.corners[0][:, 0].min())
    middle = [0.5 * (each.end1 + each.end2) for each in (wall, image)]
    steps = [steps_of(each) for each in (wall, image)]
    firsts = []
    for each, places, sign in zip(steps, middle, (1.0, -1.0), strict=True):
        seen: dict[tuple[float, float], set[str]] = {}
        for step in each:
            x, y = places[step.joint]
            seen.setdefault((round(x if sign > 0 else width - x, 6), round(y, 6)), set()).add(step.change)
        firsts.append(seen)
    assert firsts[0] == firsts[1]
    assert len(firsts[0]) > 5


@pytest.mark.parametrize("first", [0.1, 1.0])
def test_joints_of_the_component_that_fails_are_those_of_the_wall(first: float) -> None:
    """Two blocks side by side: the slender one overturns, wherever it stands in the file."""
    second = 1.1 - first
    wall = of_blocks([box("one", 0.0, 0.0, first), box("two", 3.0, 0.0, second)], 3.0)
    slender = "one" if first < second else "two"
    joints = {step.joint for step in steps_of(wall)}
    assert joints
    for joint in joints:
        assert slender in (wall.block_ids[wall.block_a[joint]], wall.block_ids[wall.block_b[joint]])


def test_path_without_breakpoints_names_none() -> None:
    path = path_of(assembly(running_bond(3, 2), 0.6), "fe-newton")
    assert len(path["multiplier"]) > 2
    assert breakpoints(path, 100) == []


def test_columns_of_another_wall_name_only_joints_that_there_are() -> None:
    path = {"changing_joint": [0.0, 7.0, -1.0, 2.0], "change": [0.0, 0.0, -1.0, 9.0]}
    assert breakpoints(path, 3) == [Breakpoint(0, 0, "opens")]


def test_spring_of_cohesion_is_named_by_its_joint_and_a_tie_by_none() -> None:
    """Springs of cohesion and bars come after the gap points. Without friction, all that slides is the cohesion."""
    joint = {"default": 0.0, "cohesion": 5.0}
    glued = steps_of(assembly(stack(2), joint))
    assert "slides" in {step.change for step in glued}
    assert {step.joint for step in glued} <= {0, 1}
    wall = tied(2.0, stiffness=10.0)
    foot = int(np.flatnonzero(~wall.is_bar)[0])
    steps = steps_of(wall)
    assert steps
    assert {step.joint for step in steps} == {foot}


def test_path_of_brittle_joints_names_joints_of_the_wall() -> None:
    """Joints that break take their springs of cohesion away, and the path goes on with other numbers of springs."""
    wall = assembly(running_bond(6, 4), {"default": 0.6, "cohesion": 2.0, "tensile_strength": 1.0, "after": "residual"})
    found = load_method("fe").solve(wall, GapSpringsSettings())
    steps = breakpoints(found.path, wall.n_interfaces)
    assert steps
    assert all(0 <= step.joint < wall.n_interfaces for step in steps)
