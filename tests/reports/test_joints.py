"""What joints are drawn as: motion and force of states that the methods themselves found."""

from __future__ import annotations

import numpy as np
import pytest

from harness.model.case import Case, read_case, shipped_cases
from harness.model.method_registry import load_method
from harness.model.result import Result, result_of
from reports.drawing.mechanism_drawing import mechanism_drawing
from reports.drawing.svg import inline
from reports.findings import joints
from reports.page import sections
from tests.reports import samples

WALL = read_case(shipped_cases() / "wall-21")


def solved(case: Case, name: str) -> Result:
    method = load_method(name)
    answer = method.solve(case.assembly, method.Settings())
    return result_of(answer, case.assembly, case=case.id, method=name, family=method.family)


def test_block_on_halves_widens_under_force_on_both_in_associated_flow():
    # 0.6/1.1 by sliding on both halves, each of which carries force at the end that is least lifted.
    result = solved(samples.block(), "la-associated")
    assert sorted(joints.joint_states(samples.block().assembly, result) or []) == ["dilatant slip", "dilatant slip"]
    assert joints.open_with_force(samples.block().assembly, result) == 0


def test_most_compressed_joint_of_the_associated_maximum_is_drawn_as_dilatant():
    result = solved(WALL, "la-associated")
    states = joints.joint_states(WALL.assembly, result)
    assert states is not None
    moving = [p for p, state in enumerate(states) if state != "stick"]
    compression = np.asarray(result.forces)[:, :2].sum(axis=1)
    assert states[max(moving, key=lambda p: compression[p])] == "dilatant slip"
    assert joints.open_with_force(WALL.assembly, result) == 0
    assert 'class="dilatant"' in inline(mechanism_drawing(WALL, result))


def test_joint_that_rocks_and_slides_is_told_from_one_that_only_rocks():
    # The block turns about its left corner while that corner slides, and the other half is left at both ends.
    case = samples.block()
    for slip, state in ((0.0, "rock"), (0.1, "rock and slide")):
        turned = [[0.0, 0.0, 0.0], [0.0, 0.0, 0.0], [-0.25 + slip, 0.5, 1.0]]
        result = samples.solved(case, "la", 0.4).model_copy(update={"mechanism": turned})
        states = joints.joint_states(case.assembly, result)
        assert states is not None
        assert set(states) == {state, "open"}
        drawn = inline(mechanism_drawing(case, result))
        assert drawn.count(f'data-values="{state}|') == drawn.count('data-values="open|') == 1
        assert drawn.count('class="hinge"') == 1


@pytest.mark.parametrize("flow", ["approximate", "non-associated"])
def test_open_joint_that_carries_force_is_told_beside_the_drawing(flow: str):
    case = samples.block()
    lifted = [[0.0, 0.0, 0.0], [0.0, 0.0, 0.0], [0.0, 1.0, 0.0]]
    result = samples.solved(case, "de", 0.4, flow=flow).model_copy(update={"mechanism": lifted})
    assert joints.open_with_force(case.assembly, result) == 2
    told = sections._forces_beside(case, result)
    assert told.startswith("2 joints drawn as open carry force below")
    assert ("the forces belong to the held state" in told) == (flow == "approximate")
