"""Joints that crush in distinct elements: brackets about the values of statics, and motions that the judge checks."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

from harness.engine.crushing import block_forces
from harness.engine.judge import judge
from harness.engine.measured_motion import motion_faults
from harness.model.assembly import Assembly
from harness.model.details import MOVING_FORCES
from harness.model.method import Finding
from harness.model.result import Result, residual_of
from methods.numerics.pressed_state import nearest_motion
from methods.numerics.stress_blocks import pressed_shares
from tests.bonded_walls import BOND
from tests.pressed_walls import SEMICIRCLES, arch, column_off_its_axis, found, set_in
from tests.walls import assembly, stack

ACCURACY = 5e-3


@cache
def of_weak_arch() -> tuple[Assembly, Result]:
    wall = arch(0.15, 5.0)
    return wall, found("de", wall)


@pytest.mark.parametrize(("height", "value"), [(2.0, 0.16), (4.0, 0.06), (8.0, 0.01)])
def test_pier_overturns_about_the_edge_of_its_pressed_strip(height: float, value: float):
    result = found("de", assembly(stack(1, 0.4, height), 1.0, compressive_strength=200.0))
    assert result.multiplier == pytest.approx(value, rel=ACCURACY)
    assert result.bracket is not None
    assert result.bracket[0] <= value * (1.0 + 1e-9)


def test_pier_that_its_weight_crushes_falls_though_the_live_load_would_lift_it():
    """The weight presses its base by 80, more than 60; three tenths of it lifted, the pier would stand."""
    lift = {"live": {"body": [{"per_weight": [-0.02, 1.0]}]}}
    wall = assembly(stack(1, 0.4, 4.0), 1.0, compressive_strength=60.0, loads=lift)
    assert found("de", wall).finding is Finding.FALLS


def test_tension_widens_the_pressed_strip():
    wall = assembly(stack(1, 0.4, 2.0), 1.0, cohesion=8.0, tensile_strength=4.0, compressive_strength=200.0)
    result = found("de", wall)
    assert result.multiplier == pytest.approx(0.1725490, rel=ACCURACY)
    residual = residual_of(result)
    assert residual is not None
    assert residual.multiplier == pytest.approx(0.16, rel=ACCURACY)


@pytest.mark.parametrize(("thickness", "strength", "value"), SEMICIRCLES)
def test_semicircle(thickness: float, strength: float | None, value: float):
    weak = (thickness, strength) == (0.15, 5.0)
    result = of_weak_arch()[1] if weak else found("de", arch(thickness, strength))
    assert result.multiplier == pytest.approx(value, rel=ACCURACY)


def test_semicircle_falls_below_the_least_strength_and_stands_above():
    for thickness, least in ((0.15, 4.1981), (0.2, 2.6466)):
        for live in ({"loads": {}}, {}):
            assert found("de", arch(thickness, 0.977 * least, **live)).finding is Finding.FALLS
        assert found("de", arch(thickness, 1.05 * least, loads={})).finding is Finding.STANDS


def test_wall_of_bricks_slides_and_crushes_where_fe_has_its_plateau():
    result = found("de", assembly(BOND, 0.65, unit_weight=1.0, compressive_strength=100.0))
    assert result.bracket is not None
    assert result.bracket[0] <= 0.5515217391 <= result.bracket[1]
    assert result.multiplier == pytest.approx(0.5515217391, rel=ACCURACY)


def test_full_dilatancy_leads_to_the_associated_maximum():
    law = {"default": 0.65, "dilatancy": 0.65, "compressive_strength": 100.0}
    assert found("de", assembly(BOND, law, unit_weight=1.0)).multiplier == pytest.approx(0.571732, rel=ACCURACY)


def test_wall_that_presses_more_than_half_of_a_joint_where_fe_has_its_plateau():
    result = found("de", assembly(BOND, 0.65, unit_weight=1.0, compressive_strength=20.0))
    assert result.bracket is not None
    assert result.bracket[0] <= 0.4973896 <= result.bracket[1]


@pytest.mark.parametrize("eccentricity", [0.0, 0.3])
def test_a_column_crushes_at_its_base_under_a_load_off_its_axis(eccentricity: float):
    """N = W + lambda, N (1 - N / (f_c b)) = 2 e lambda / b: the stress block about the force at the base."""
    top = {"live": {"points": [{"block": "3", "at": [0.5 + 0.5 * eccentricity, 1.5], "force": [0, -1]}]}}
    wall = assembly(stack(3, 1.0, 0.5), 0.6, compressive_strength=100.0, loads=top)
    value = column_off_its_axis(30.0, 100.0, eccentricity)
    result = found("de", wall)
    assert result.multiplier == pytest.approx(value, rel=ACCURACY)
    assert result.bracket is not None
    assert result.bracket[0] <= value


@pytest.mark.parametrize("change", ["higher", "middles", "ends", "no forces", "weaker"])
def test_wrong_answers_are_rejected(change: str):
    wall, result = of_weak_arch()
    forces = np.asarray(result.details[MOVING_FORCES])
    assert result.bracket is not None
    if change == "higher":
        changed = result.model_copy(update={"bracket": (result.bracket[1], 1.01 * result.bracket[1])})
    elif change == "weaker":
        wall = arch(0.15, 4.98)
        changed = result
    elif change == "no forces":  # ends close, with nothing that shows what they press
        details = {name: value for name, value in result.details.items() if name != MOVING_FORCES}
        mechanism = np.asarray(result.mechanism)
        with_forces, without = (
            motion_faults(wall, mechanism, result.bracket[1], given)[0]["motion_interpenetration"]
            for given in (result.details, details)
        )
        assert with_forces == 0.0
        assert without > 0.02
        return
    else:
        share = pressed_shares(wall, forces)
        other = set_in(wall, share) if change == "middles" else wall
        mechanism = np.asarray(result.mechanism)
        rates = wall.law.rates((wall.kinematic_matrix @ mechanism[wall.free].ravel()).reshape(-1, 3))
        turned = nearest_motion(other, np.zeros_like(share), rates)
        assert turned is not None
        changed = result.model_copy(update={"mechanism": turned.tolist()})
    assert judge(wall, changed, 1e-6).accepted is False


def test_forces_of_the_stress_block_by_hand():
    """F0 = 8: one end closes by 1, the other opens by 3, so that a quarter bears 2, an eighth from its end."""
    wall = assembly(stack(1, 1.0, 0.2), 0.5, compressive_strength=8.0)
    assert block_forces(wall, np.array([[-1.0, 3.0]])) == pytest.approx(np.array([[1.75, 0.25]]))
    assert block_forces(wall, np.array([[3.0, -1.0]])) == pytest.approx(np.array([[0.25, 1.75]]))
    assert block_forces(wall, np.array([[-1.0, -2.0]])) == pytest.approx(np.array([[4.0, 4.0]]))
    assert block_forces(wall, np.array([[1.0, 2.0]])) == pytest.approx(np.zeros((1, 2)))


def test_motion_is_found_beside_a_joint_that_a_rounded_force_presses():
    """The left stone turns about a tenth of its base; the head joint, level with that, would have to close below."""
    panel = {"type": "panel", "cell_length": 1.0, "cell_height": 1.0, "layout": ["LR", "##"], "fixed": "#"}
    wall = assembly(panel, 0.5, compressive_strength=100.0)
    ids = [(wall.block_ids[a], wall.block_ids[b]) for a, b in zip(wall.block_a, wall.block_b, strict=True)]
    base, head = ids.index(("#", "L")), ids.index(("L", "R"))
    turned = wall.block_ids.index("L")
    motion = np.zeros((wall.n_blocks, 3))
    away = wall.end1[base] + wall.end2[base] - wall.centroid[turned] * 2.0
    motion[turned] = [0.5 * away[1], 0.4, 1.0]
    strains = (wall.kinematic_matrix @ motion[wall.free].ravel()).reshape(-1, 3)
    rates = np.maximum(wall.law.rates(strains), 0.0)
    opening = strains[base, :2]
    rates[base] = [*np.where(opening > 0.0, np.ptp(opening), 0.0), 0.0, 0.0]
    share = np.zeros(wall.n_interfaces)
    share[base], share[head] = 0.1, 1e-7
    found = nearest_motion(wall, share, rates)
    assert found is not None
    assert found == pytest.approx(motion / rates.max(), abs=1e-6)
