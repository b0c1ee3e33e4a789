"""`la` where joints crush: the search within tangents of the stress blocks, and states exact in all of them."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from harness.model.assembly import Assembly
from harness.model.method import Finding, Status
from methods.la.search import LimitAnalysis
from methods.la.settings import SearchSettings
from methods.la.tangent_search import TangentTolerances
from tests.bonded_walls import BOND
from tests.pressed_walls import found
from tests.walls import assembly, running_bond, stack


def body(x: float, y: float) -> dict[str, Any]:
    return {"live": {"body": [{"per_weight": [x, y]}]}}


def weak_wall(seed: int) -> Assembly:
    """A wall of a few courses of masonry so weak that joints press far in, under a load of any direction."""
    generator = np.random.default_rng(seed)
    law = {"default": float(generator.uniform(0.3, 0.9))}
    law["compressive_strength"] = float(10.0 ** generator.uniform(1.0, 3.0))
    if generator.random() < 0.5:
        law["cohesion"] = float(generator.uniform(0.0, 5.0))
    bond = running_bond(*generator.integers(2, 5, 2).tolist())
    angle = generator.uniform(0.0, 2.0 * np.pi)
    return assembly(bond, law, loads=body(float(np.cos(angle)), float(np.sin(angle))))


@pytest.mark.parametrize("height", [0.5, 2.0])
def test_a_pier_crushes_evenly_under_a_load_that_presses_it(height: float):
    """f_c b = (1 + lambda) gamma b h: no joint has any length left."""
    wall = assembly(stack(1, 0.4, height), 0.6, compressive_strength=60.0, loads=body(0.0, -1.0))
    assert found("la", wall).multiplier == pytest.approx(60.0 / (20.0 * height) - 1.0, rel=1e-9)


@pytest.mark.parametrize("height", [8.0, 9.9])
def test_a_pier_that_presses_most_of_its_joint_overturns_about_the_edge_of_what_it_presses(height: float):
    """b / H - gamma b / f_c, with .8 and .99 of the joint pressed."""
    wall = assembly(stack(1, 0.4, height), 1.0, compressive_strength=200.0)
    assert found("la", wall).multiplier == pytest.approx(0.4 / height - 0.04, abs=1e-12)


def test_weak_walls_have_states_of_their_stress_blocks_below_the_associated_maximum():
    """Of seeds 1000 to 1039 with the normal effort all but 1032 have an answer; with walls set in, nine had none."""
    below = 0
    for seed in (1017, 1025, 1030, 1033):
        wall = weak_wall(seed)
        greatest, least = (found(name, wall).multiplier for name in ("la-associated", "la"))
        assert greatest is not None
        assert least is not None
        assert least <= greatest * (1.0 + 1e-9)
        below += least < 0.999 * greatest
    assert below == 4


def test_wall_of_bricks_that_presses_more_than_half_of_a_joint():
    wall = assembly(BOND, 0.65, unit_weight=1.0, compressive_strength=20.0)
    result = found("la", wall, effort="quick")
    assert result.flow == "non-associated"
    assert result.multiplier is not None
    assert result.multiplier <= 0.49739 < 0.51801


def test_a_wall_of_which_one_search_knows_no_exact_state_has_no_answer_rather_than_a_wrong_one():
    wall = weak_wall(1030)
    once = LimitAnalysis(tangents=TangentTolerances(rounds=1)).solve(wall, SearchSettings())
    assert once.status is Status.NOT_CONVERGED
    assert once.multiplier is None
    assert "1 rounds of a search within tangents" in once.sentence


def test_a_load_that_joints_that_do_not_crush_bear_without_end_is_without_end():
    """It presses the lower of two blocks on its base; the joint above it crushes, and bears the upper block."""
    wall = assembly(stack(2), 0.6, compressive_strength=60.0, loads=body(0.0, -1.0))
    wall = replace(wall, live=np.array([[0.0] * 3, [0.0, -1.0, 0.0], [0.0] * 3]), crushing=np.array([np.inf, 18.0]))
    assert found("la", wall).finding is Finding.UNBOUNDED
