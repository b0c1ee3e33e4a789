"""What must hold on every wall: order of the values, invariance, determinism, honest findings."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from harness.engine.symmetry import VIEWS
from harness.model.assembly import Assembly
from harness.model.joint_law import JointLaw
from harness.model.method import Finding, Status
from harness.model.method_registry import load_method
from methods.la.associated import AssociatedLimitAnalysis
from methods.la.core.flexibility import Compliance
from methods.la.search import LimitAnalysis
from methods.la.settings import AssociatedSettings, SearchSettings
from tests.la.bodies import column, running_bond

QUICK = SearchSettings(effort="quick")


def greatest(wall: Assembly) -> float | None:
    return AssociatedLimitAnalysis().solve(wall, AssociatedSettings()).multiplier


@pytest.mark.parametrize("view", sorted(VIEWS))
def test_multipliers_do_not_depend_on_how_the_wall_is_looked_at(view: str) -> None:
    wall = running_bond(4, 2, 0.2, 0.6)
    seen = VIEWS[view](wall)
    normal = SearchSettings()
    assert greatest(seen) == pytest.approx(greatest(wall), rel=1e-9)
    expected = LimitAnalysis().solve(wall, normal).multiplier
    assert LimitAnalysis().solve(seen, normal).multiplier == pytest.approx(expected, rel=1e-9)


def test_same_seed_gives_the_same_answer() -> None:
    wall = running_bond(6, 3, 0.2, 0.85)
    first, second = (LimitAnalysis().solve(wall, QUICK) for _ in range(2))
    assert first.multiplier == second.multiplier
    assert first.forces is not None
    assert second.forces is not None
    np.testing.assert_array_equal(first.forces, second.forces)


@settings(max_examples=15, deadline=None, derandomize=True)
@given(
    st.lists(st.tuples(st.floats(0.2, 2.0), st.floats(0.1, 1.0)), min_size=1, max_size=4),
    st.floats(0.0, 2.0),
    st.integers(1, 3),
)
def test_least_is_never_above_greatest_on_random_columns(
    sizes: list[tuple[float, float]], friction: float, halves: int
) -> None:
    wall = column([width for width, _ in sizes], [height for _, height in sizes], friction, halves)
    answer = LimitAnalysis().solve(wall, QUICK)
    upper = greatest(wall)
    assert answer.status is Status.OK
    assert answer.multiplier is not None
    assert upper is not None
    assert answer.multiplier <= upper + 1e-9
    assert max(answer.details["residuals"].values()) <= 1e-10


def test_wall_that_overhangs_too_far_falls_by_a_mechanism_that_gains_dead_work() -> None:
    wall = column([0.3], [0.2], 0.7)
    wall = replace(wall, dead=wall.dead + np.array([[0, 0, 0], [0, 0, 1.0]]))
    for method in (load_method("la"), load_method("la-associated")):
        answer = method.solve(wall, method.Settings())
        assert answer.finding is Finding.FALLS
        assert answer.multiplier is None
        assert answer.mechanism is not None
        assert float((wall.dead * answer.mechanism).sum()) > 0.0


def test_wall_without_live_load_stands() -> None:
    wall = column([0.3], [0.2], 0.7)
    answer = LimitAnalysis().solve(replace(wall, live=np.zeros_like(wall.live)), SearchSettings())
    assert answer.finding is Finding.STANDS
    assert answer.forces_multiplier == 0.0


def test_load_that_presses_down_cannot_make_a_wall_collapse() -> None:
    wall = column([0.3, 0.3], [0.2, 0.2], 0.7)
    wall = replace(wall, live=wall.dead.copy())
    for method in (load_method("la"), load_method("la-associated")):
        answer = method.solve(wall, method.Settings())
        assert answer.finding is Finding.UNBOUNDED
        assert answer.multiplier is None


@pytest.mark.parametrize("dilatancy", [0.0, 0.3, 1.0])
def test_compliance_inverts_the_interface_matrix(dilatancy: float) -> None:
    generator = np.random.default_rng(1)
    weight, friction = generator.uniform(0.01, 5.0, (6, 4)), generator.uniform(0.0, 2.0, 6)
    compliance = Compliance(JointLaw(friction, dilatancy * friction), weight, dilatancy * friction)
    strain = generator.normal(size=(6, 3))
    for p, mu in enumerate(friction):
        slack_of_force = np.array([[1, 0, 0], [0, 1, 0], [mu, mu, 1], [mu, mu, -1]])
        d = dilatancy * mu
        strain_of_rate = np.array([[1, 0, d, d], [0, 1, d, d], [0, 0, 1, -1]])
        matrix = strain_of_rate @ np.diag(weight[p]) @ slack_of_force
        np.testing.assert_allclose(compliance.matrices[p] @ matrix, np.eye(3), atol=1e-10)
        np.testing.assert_allclose(matrix @ compliance.forces(strain)[p], strain[p], atol=1e-10)
        np.testing.assert_allclose(
            compliance.response(strain)[1][p], slack_of_force @ compliance.forces(strain)[p], atol=1e-9
        )
