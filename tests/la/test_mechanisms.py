"""States sought from mechanisms: the motions of a block among others, and walls where one block slides out alone."""

from __future__ import annotations

import numpy as np
import pytest

from benchmarks.walls import drawn
from harness.model.assembly import Assembly, FloatArray
from harness.model.build import build
from harness.model.wall import Wall
from methods.la.core.problem import make_problem
from methods.la.search import LimitAnalysis
from methods.la.settings import SearchSettings
from methods.la.sources.mechanisms import extreme_motions, least_of_block
from tests.la.bodies import column

RIGHT, LEFT = np.array([1.0, 0.0, 0.0]), np.array([-1.0, 0.0, 0.0])


def bed(width: float, height: float) -> FloatArray:
    """(1, 3, 3) strains of the bed under a block of this size, from the motion of its centre."""
    return np.array([[[0.0, 1.0, -0.5 * width], [0.0, 1.0, 0.5 * width], [1.0, 0.0, 0.5 * height]]])


def test_a_block_on_a_bed_slides_or_turns_over_its_toe() -> None:
    motions = extreme_motions(bed(0.6, 1.0), RIGHT)
    toe = np.array([0.5, 0.3, -1.0])
    assert len(motions) == 2
    assert {tuple(motion.round(9)) for motion in motions} == {
        (1.0, 0.0, 0.0),
        tuple((toe / np.linalg.norm(toe)).round(9)),
    }


def test_a_wall_on_its_side_keeps_a_block_from_sliding_there() -> None:
    beside = np.array([[[-1.0, 0.0, -0.5], [-1.0, 0.0, 0.5], [0.0, 1.0, 0.3]]])
    strains = np.concatenate([bed(0.6, 1.0), beside])
    rates = np.einsum("kij,rj->rki", strains, extreme_motions(strains, RIGHT))
    assert rates.size == 0
    assert extreme_motions(strains, LEFT).size > 0


def test_a_sliding_block_balances_its_own_loads_at_the_friction_of_its_bed() -> None:
    problem = make_problem(column([1.0], [0.2], 0.3))
    strains = problem.kinematic.toarray().reshape(-1, 3, 3)
    sliding = np.array([np.sign(problem.live[0]), 0.0, 0.0])
    least = least_of_block(problem, 0, np.array([0]), strains, sliding)
    assert least * problem.unit_multiplier == pytest.approx(0.3, rel=1e-9)


def six_blocks() -> Assembly:
    """Three courses of two blocks and a load near the edge, pushed to the left and down."""
    pattern = {"type": "panel", "cell_length": 0.5, "cell_height": 0.5, "layout": ["AAB", "CDD", "EEF", "___"]}
    loads = {
        "dead": {
            "points": [{"block": "A", "at": [0.5, 1.75], "force": [1.42, -27.89]}],
        },
        "live": {"body": [{"per_weight": [-1.0, -0.28]}]},
    }
    wall = {"format": "wall/1", "unit_weight": 20.0, "friction": 0.379, "pattern": pattern | {"fixed": "_"}}
    return build(Wall.model_validate(wall | {"loads": loads}), "six blocks").assembly


@pytest.mark.parametrize(
    ("wall", "least"),
    [
        pytest.param(six_blocks(), 0.4257766, id="six blocks"),
        pytest.param(drawn(27), 0.0541262, id="15 irregular blocks"),
        pytest.param(drawn(91), 0.0500811, id="18 irregular blocks"),
    ],
)
def test_la_finds_the_block_that_slides_out_alone(wall: Assembly, least: float) -> None:
    """All paths from forces, and descents from their ends, led to .722, .0947 and .1825 at least."""
    multiplier = LimitAnalysis().solve(wall, SearchSettings()).multiplier
    assert multiplier is not None
    assert multiplier <= least * (1.0 + 1e-6)  # six digits of the value are written here
