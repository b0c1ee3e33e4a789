"""The judge against states worked out by hand, and against states spoiled on purpose."""

from __future__ import annotations

import numpy as np
import pytest

from harness.engine.judge import answered, judge
from harness.engine.residuals import block_sums, collapse_residuals
from harness.engine.symmetry import VIEWS
from harness.model.assembly import Assembly
from harness.model.method import Answer, Finding, Status
from harness.model.method_registry import load_method
from harness.model.result import contact_states, result_of
from tests.known_walls import box, of_blocks
from tests.walls import assembly, stack

WEIGHT = 20.0 * 0.3 * 0.2


def one_block(friction: float) -> Assembly:
    """A block 0.3 wide, 0.2 high on a fixed base: slides at mu, topples at 1.5."""
    return assembly(stack(1), friction)


def by_hand(wall: Assembly, multiplier: float) -> np.ndarray:
    """Contact forces of the single block at a multiplier: moments about the two ends of the bed."""
    left = WEIGHT * (0.5 - multiplier * 0.1 / 0.3)
    right = WEIGHT - left
    first, second = (left, right) if wall.end1[0, 0] < wall.end2[0, 0] else (right, left)
    shear = -multiplier * WEIGHT * wall.tangent[0, 0]
    if wall.block_a[0] == 1:
        shear = -shear
    return np.array([[first, second, shear]])


def sliding(wall: Assembly) -> np.ndarray:
    mechanism = np.zeros((2, 3))
    mechanism[1, 0] = 1.0
    return mechanism


def toppling(wall: Assembly) -> np.ndarray:
    mechanism = np.zeros((2, 3))
    mechanism[1] = [0.1, 0.15, -1.0]
    return mechanism


def judged(wall: Assembly, forces: np.ndarray, multiplier: float, mechanism: np.ndarray, tolerance: float = 1e-12):
    answer = Answer(Status.OK, Finding.COLLAPSES, "", multiplier, forces=forces, mechanism=mechanism)
    return judge(wall, result_of(answer, wall, case="x", method="hand", family="hand"), tolerance)


def test_sliding_block_by_hand_is_accepted():
    wall = one_block(0.5)
    said = judged(wall, by_hand(wall, 0.5), 0.5, sliding(wall))
    assert said.accepted, said
    assert contact_states(wall, sliding(wall)) == ["slip"]


def test_toppling_block_by_hand_is_accepted():
    wall = one_block(2.0)
    said = judged(wall, by_hand(wall, 1.5), 1.5, toppling(wall))
    assert said.accepted, said
    assert contact_states(wall, toppling(wall)) == ["rock"]


@pytest.mark.parametrize("view", list(VIEWS))
def test_judge_sees_the_same_in_every_view(view: str):
    wall = one_block(0.5)
    seen = VIEWS[view](wall)
    # The state is rebuilt for the view: the live load direction and the numbering may have changed.
    moving = int(np.flatnonzero(~seen.fixed)[0])
    mechanism = np.zeros((2, 3))
    mechanism[moving, :2] = seen.live[moving, :2] / np.linalg.norm(seen.live[moving, :2])
    weight = np.linalg.norm(seen.dead[moving])
    up = seen.normal[0] if seen.block_b[0] == moving else -seen.normal[0]
    np.testing.assert_allclose(up, -seen.dead[moving, :2] / weight, atol=1e-12)
    shear = -0.5 * weight * np.dot(seen.tangent[0], mechanism[moving, :2])
    shear = shear if seen.block_b[0] == moving else -shear
    toe = np.dot(seen.end1[0] - seen.centroid[moving], mechanism[moving, :2]) > 0
    near, far = weight * (0.5 + 0.5 / 3), weight * (0.5 - 0.5 / 3)
    forces = np.array([[near, far, shear] if toe else [far, near, shear]])
    said = judged(seen, forces, 0.5, mechanism)
    assert said.accepted, said


@pytest.mark.parametrize(
    ("spoil", "name"),
    [
        ("force", "equilibrium"),
        ("tension", "yield"),
        ("friction", "yield"),
        ("through", "interpenetration"),
        ("lifted", "dilatancy"),
        ("unyielded", "sliding"),
        ("backwards", "live_work"),
        ("multiplier", "virtual_work"),
    ],
)
def test_each_fault_is_named(spoil: str, name: str):
    wall = one_block(0.5)
    forces, multiplier, mechanism = by_hand(wall, 0.5), 0.5, sliding(wall)
    match spoil:
        case "force":
            forces[0, 0] += 1e-6
        case "tension":
            forces = by_hand(wall, 2.0)
            multiplier = 2.0
        case "friction":
            forces = by_hand(wall, 0.6)
            multiplier = 0.6
        case "through":
            mechanism[1, 1] = -1e-3
        case "lifted":
            mechanism[1, 1] = 1e-3
        case "unyielded":
            forces, multiplier = by_hand(wall, 0.4), 0.4
        case "backwards":
            mechanism = -mechanism
        case "multiplier":
            multiplier = 0.5 + 1e-6
    said = judged(wall, forces, multiplier, mechanism)
    assert said.accepted is False
    residuals = collapse_residuals(wall, forces, multiplier, mechanism, "non-associated")
    if name == "live_work":
        assert residuals[name] < 0.0
    else:
        assert residuals[name] > 1e-9, residuals
        assert name in said.sentence


def test_associated_flow_asks_for_dilatancy():
    wall = one_block(0.5)
    mechanism = sliding(wall)
    mechanism[1, 1] = 0.5
    flat = collapse_residuals(wall, by_hand(wall, 0.5), 0.5, sliding(wall), "associated")
    dilating = collapse_residuals(wall, by_hand(wall, 0.5), 0.5, mechanism, "associated")
    assert flat["interpenetration"] > 0.1
    assert max(value for name, value in dilating.items() if name != "live_work") < 1e-12


def test_block_sums_put_action_and_reaction_on_the_two_blocks():
    wall = assembly(stack(2), 0.5)
    rng = np.random.default_rng(0)
    sums = block_sums(wall, rng.normal(size=(wall.n_interfaces, 3)))
    np.testing.assert_allclose(sums[:, :2].sum(axis=0), 0.0, atol=1e-14)
    about_origin = sums[:, 2] + wall.centroid[:, 0] * sums[:, 1] - wall.centroid[:, 1] * sums[:, 0]
    assert about_origin.sum() == pytest.approx(0.0, abs=1e-14)


def test_kinematic_matrix_of_the_methods_agrees_with_the_judge_by_virtual_work():
    wall = assembly({"type": "ring", "inner_radius": 1.0, "outer_radius": 1.2, "count": 7}, 0.5)
    rng = np.random.default_rng(1)
    forces, velocities = rng.normal(size=(wall.n_interfaces, 3)), rng.normal(size=(wall.n_free, 3))
    by_matrix = forces.ravel() @ (wall.kinematic_matrix @ velocities.ravel())
    by_blocks = (block_sums(wall, forces)[wall.free] * velocities).sum()
    assert by_matrix == pytest.approx(by_blocks, rel=1e-12)


def test_a_multiplier_without_forces_or_mechanism_is_not_judged_and_wrong_forces_are_rejected():
    wall = one_block(0.5)

    def accepted(forces: np.ndarray | None) -> bool | None:
        answer = Answer(Status.OK, Finding.COLLAPSES, "", 0.5, forces=forces)
        return judge(wall, result_of(answer, wall, case="x", method="hand", family="hand"), 1e-9).accepted

    assert accepted(None) is None
    assert accepted(by_hand(wall, 0.5)) is None
    assert accepted(by_hand(wall, 0.6)) is False


def test_failures_are_not_judged():
    wall = one_block(0.5)
    failed = result_of(Answer(Status.NOT_CONVERGED, Finding.NONE, ""), wall, case="x", method="hand", family="hand")
    assert judge(wall, failed, 1e-9).accepted is None


def test_fall_is_proved_by_a_mechanism_that_gains_dead_work():
    wall = assembly(stack(2) | {"offsets": [0.0, 0.2]}, 0.5)
    mechanism = np.zeros((3, 3))
    top = wall.centroid[2]
    edge = np.array([0.3, 0.2])
    arm = top - edge
    mechanism[2] = [arm[1], -arm[0], -1.0]
    answer = Answer(Status.OK, Finding.FALLS, "", mechanism=mechanism)
    said = judge(wall, result_of(answer, wall, case="x", method="hand", family="hand"), 1e-9)
    assert said.accepted
    assert "proves" in said.sentence
    answer.mechanism = -mechanism
    assert judge(wall, result_of(answer, wall, case="x", method="hand", family="hand"), 1e-9).accepted is False


def test_weightless_block_that_is_pushed_alone_collapses_at_zero():
    """No dead load moves, so that nothing dead measures what is small of a multiplier: the live load alone does."""
    at_foot = {"live": {"points": [{"block": "light", "at": [0.5, 0.0], "force": [1.0, 0.0]}]}}
    wall = of_blocks([box("light", 0.0, 0.0, weight=0.0), box("other", 5.0, 0.0)], 0.5, at_foot)
    light, other = (int(np.flatnonzero(wall.block_b == wall.block_ids.index(name))[0]) for name in ("light", "other"))
    mechanism = np.zeros((3, 3))
    mechanism[wall.block_ids.index("light"), 0] = 1.0
    forces = np.zeros((2, 3))
    forces[other, :2] = 10.0
    assert judged(wall, forces, 0.0, mechanism).accepted
    assert judged(wall, forces, 1e-6, mechanism).accepted is False
    forces[light, 2] = 1e-6 * (1.0 if wall.tangent[light, 0] * (wall.block_a[light] == 0) > 0.0 else -1.0)
    assert judged(wall, forces, 1e-6, mechanism).accepted is False  # friction without a force that presses
    for name in ("la", "la-associated", "fe"):
        result, said = answered(load_method(name), wall)
        assert said.accepted, said.sentence
        assert result.multiplier == pytest.approx(0.0, abs=1e-12)
