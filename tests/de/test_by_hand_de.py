"""Contacts of one block by hand: springs in its gaps, a corner that it stands on, and what a search cut short says."""

from __future__ import annotations

import numpy as np
import pytest

from harness.model.method import Status
from methods.de.damped_holds import DampedHolds
from methods.de.engines.pymunk_blocks import PymunkBlocks
from methods.de.settings import SweepSettings
from methods.de.uneven.gapped import GAPPED, GappedWall
from methods.de.uneven.settled_contacts import SETTLING, with_contacts
from tests.walls import assembly, stack


def test_contacts_with_gaps_bear_the_loads_of_a_block_at_rest():
    """A block .4 x .2 under its weight W and a push W / 4, which its joint bears by friction .5."""
    wall = assembly(stack(1, 0.4, 0.2), 0.5)
    block = int(wall.free[0])
    gapped = GappedWall(wall, wall.polygons, np.zeros((wall.n_blocks, 3)), 0.5)
    assert gapped.rests(0.25)
    state = gapped.state()
    assert state.interface.tolist() == [0, 0]
    sign = np.where(state.onto == block, 1.0, -1.0)
    borne = (sign[:, None] * state.force).sum(axis=0)
    assert borne == pytest.approx(-(wall.dead + 0.25 * wall.live)[block, :2], rel=1e-6)
    # Half the weight on each of two springs of 1e4 W a length scale.
    sinks = 0.5 / GAPPED.stiffness * wall.length_scale
    assert gapped.rest.places[block] == pytest.approx(np.zeros(3), abs=1e-3 * wall.length_scale)
    assert -gapped.rest.moved[block, 1] == pytest.approx(sinks, rel=1e-6)
    assert gapped.drift > 0.0


def test_a_block_on_its_corner_has_a_short_contact_about_that_corner():
    """Turned by a hundredth about its lower left corner; methods need two contact points, so the joint is short."""
    wall = assembly(stack(1, 0.4, 0.2), 0.5)
    block, turn = int(wall.free[0]), 0.01
    corner = wall.polygons[block].min(axis=0)
    arm = wall.centroid[block] - corner
    turned = np.array([np.cos(turn) * arm[0] - np.sin(turn) * arm[1], np.sin(turn) * arm[0] + np.cos(turn) * arm[1]])
    places = np.zeros((wall.n_blocks, 3))
    places[block] = [*(turned - arm), turn]
    space = PymunkBlocks(wall)
    space.put(places)
    space.advance(1)
    structure, single = with_contacts(wall, space, space.places())
    assert (single, structure.n_interfaces) == (1, 1)
    assert structure.length == pytest.approx([SETTLING.point * wall.length_scale])
    middle = 0.5 * (structure.end1[0] + structure.end2[0])
    assert middle == pytest.approx(corner, abs=0.01 * wall.length_scale)
    along = structure.end2[0] - structure.end1[0]
    assert along @ structure.normal[0] == pytest.approx(0.0, abs=1e-12)


def test_a_search_that_runs_out_of_work_says_how_wide_its_brackets_are():
    """The widest of the brackets, beside the highest multiplier at which the wall moved: held at .4, moved at .8."""
    wall = assembly(stack(1, 0.4, 0.2), 0.5)
    coarse = SweepSettings(orders=1, load_step=0.4, load_growth=0.5, work=100)
    answer = DampedHolds().solve(wall, coarse)
    (row,) = answer.details["orders"]
    assert (row["held"], row["moving"]) == pytest.approx((0.4, 0.8))
    assert answer.status is Status.NOT_CONVERGED
    assert answer.sentence.endswith("0 orders without a moving state, widest bracket 50 %")
    more = DampedHolds().solve(wall, coarse.model_copy(update={"work": 10_000}))
    assert more.status is Status.OK
    assert "not converged" not in more.sentence
