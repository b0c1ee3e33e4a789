"""Requirements on `de-closed`: springs close the gaps that are handed over, and bear what distinct elements bear."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from harness.engine.judge import judge
from harness.engine.residuals import displaced_residuals, force_residuals
from harness.model.displaced import DisplacedState
from harness.model.method import Finding, Status
from harness.model.method_registry import load_method
from harness.model.result import result_of
from methods.de.engines.edges import FacingEdges
from methods.de.methods import DE_CLOSED
from methods.de.uneven.settled_contacts import settle_uneven
from methods.de.uneven_walls import ClosedContacts, ClosedSettings
from tests.walls import assembly, running_bond, stack


def closed(wall, **settings):
    return ClosedContacts().solve(wall, ClosedSettings(**settings))


@pytest.mark.parametrize(
    ("size", "seed"),
    [(0.03, 4), pytest.param(0.01, 1, marks=pytest.mark.slow), pytest.param(0.05, 2, marks=pytest.mark.slow)],
)
def test_with_gaps_handed_over_finite_elements_bear_what_distinct_elements_bear(size, seed):
    wall = assembly(running_bond(6, 3), 0.75)
    answer = closed(wall, size=size, seed=seed)
    assert (answer.status, answer.finding) == (Status.OK, Finding.COLLAPSES)
    alone = answer.details["distinct_elements"]
    # Both brackets are 0.005 wide at most, and 0.5 % is the error of this loading in distinct elements.
    assert answer.multiplier == pytest.approx(0.5 * (alone["stood"] + alone["fell"]), rel=0.02)
    # The contacts that are closed under the dead load bear far less, by FE and LA alike.
    one, two = (answer.details["analyses"][name]["multiplier"] for name in ("fe", "la"))
    assert two <= one * (1.0 + 1e-6)
    assert one < 0.3 * answer.multiplier


def test_fe_and_la_agree_on_the_closed_contacts_alone_and_their_state_is_an_equilibrium():
    structure = settle_uneven(assembly(running_bond(6, 3), 0.75), 0.01, seed=1).assembly
    one, two = (method.solve(structure, method.Settings()) for method in map(load_method, ("fe", "la")))
    # Here both find the same collapse state; rounding only is between them.
    assert one.multiplier == pytest.approx(two.multiplier, rel=1e-6)
    assert max(force_residuals(structure, one.forces, one.multiplier).values()) < DE_CLOSED.tolerance


def test_gaps_that_stay_open_make_the_contacts_alone_weaker_than_the_wall():
    answer = closed(assembly(running_bond(4, 2), 0.75), size=0.02, seed=3, alone=("la",))
    loaded = answer.details["distinct_elements"]
    assert answer.details["analyses"]["la"]["multiplier"] < loaded["stood"]
    assert loaded["cpu_seconds"] > 0.0


def test_the_state_at_rest_is_judged_with_the_contacts_where_they_are():
    wall = assembly(running_bond(6, 3), 0.75)
    answer = closed(wall, size=0.03, seed=2, alone=(), compare=False)
    result = result_of(answer, wall, case="wall", method="de-closed", family="de")
    judgement = judge(wall, result, DE_CLOSED.tolerance)
    # In equilibrium where they are; uneven blocks have settled by more than the accuracy of a multiplier.
    assert max(judgement.residuals[name] for name in ("equilibrium", "yield", "multiplier")) <= DE_CLOSED.tolerance
    assert judgement.accepted is None
    state = DisplacedState.of(answer.details)
    elsewhere = replace(state, point=state.point + np.array([0.0, 0.01]))
    assert displaced_residuals(wall, elsewhere, answer.forces_multiplier)["equilibrium"] > 1e-4


def test_even_stack_has_the_exact_multiplier():
    answer = closed(assembly(stack(3, 0.4, 0.2), 0.9), size=0.0, alone=("la",), compare=False)
    # The bracket is 0.005 wide, and the springs give by a thousandth of a block.
    assert answer.bracket[0] - 5e-3 <= 2 / 3 <= answer.bracket[1] + 5e-3
    assert answer.multiplier == pytest.approx(sum(answer.bracket) / 2.0)
    # The settled contacts overlap by up to the slop of the engine and lie back by the radius of its corners.
    assert answer.details["analyses"]["la"]["multiplier"] == pytest.approx(2 / 3, rel=5e-3)


def test_edges_that_face_each_other_are_where_the_blocks_are():
    wall = assembly(stack(2, 0.4, 0.2), 0.9)
    edges = FacingEdges.of(wall, wall.polygons)
    places = np.zeros((wall.n_blocks, 3))
    moved, openings = edges.at(places)
    assert np.allclose(openings, 0.0)
    assert np.allclose(moved.end1, wall.end1)
    assert np.allclose(moved.normal, wall.normal)
    # The upper block up by 0.01, to the right by 0.05, and turned by 0.02 about its centroid.
    places[2] = [0.05, 0.01, 0.02]
    moved, openings = edges.at(places)
    upper = int(np.flatnonzero((wall.block_a == 2) | (wall.block_b == 2))[0])
    assert np.sort(openings[upper]) == pytest.approx([0.01 - 0.2 * 0.02, 0.01 + 0.15 * 0.02], abs=2e-4)
    assert np.allclose(openings[1 - upper], 0.0)
    # Shifted by more than its length it touches nothing.
    places[2] = [0.5, 0.0, 0.0]
    assert edges.at(places)[1][upper].min() > 0.1


def test_what_cannot_be_analysed_gives_no_multiplier():
    refused = closed(assembly(stack(3), 0.7, loads={"live": None}))
    assert (refused.status, refused.multiplier) == (Status.REFUSED, None)
    falls = closed(assembly(stack(3) | {"offsets": [0.0, 0.0, 0.2]}, 0.7))
    assert (falls.status, falls.finding, falls.multiplier) == (Status.NOT_CONVERGED, Finding.NONE, None)
    pressed = assembly(stack(2), 0.7, loads={"live": {"body": [{"per_weight": [0, -1]}]}})
    stands = closed(pressed, size=0.0, alone=("la",), compare=False)
    assert (stands.status, stands.finding, stands.multiplier) == (Status.NOT_CONVERGED, Finding.NONE, None)
    assert "greatest multiplier tested" in stands.sentence
    unbounded = stands.details["analyses"]["la"]
    assert (unbounded["finding"], unbounded["multiplier"]) == (Finding.UNBOUNDED, None)
