"""Requirements on `de-closed`: FE and LA agree on the closed contacts, their state can be judged, and gaps matter."""

from __future__ import annotations

import numpy as np
import pytest

from harness.engine.judge import equilibrium_residual, yield_violation
from harness.model.method import Finding, Status
from methods.de.closed import ClosedContacts, ClosedSettings
from methods.de.uneven import settle_uneven
from tests.walls import assembly, running_bond, stack


def closed(wall, **settings):
    return ClosedContacts().solve(wall, ClosedSettings(**settings))


def test_fe_and_la_agree_on_the_closed_contacts_and_their_state_is_an_equilibrium():
    wall = assembly(running_bond(6, 3), 0.75)
    answer = closed(wall, size=0.01, seed=1, compare=False)
    assert (answer.status, answer.finding) == (Status.OK, Finding.COLLAPSES)
    one, two = (answer.details["analyses"][name]["multiplier"] for name in ("fe", "la"))
    # Here both find the same collapse state; rounding only is between them.
    assert one == pytest.approx(two, rel=1e-6)
    structure = settle_uneven(wall, 0.01, seed=1).assembly
    state = answer.details["state"]
    assert state["block_a"] == structure.block_a.tolist()
    forces = np.array(state["forces"])
    assert equilibrium_residual(structure, forces, state["multiplier"]) < ClosedContacts.tolerance
    assert yield_violation(structure, forces) < ClosedContacts.tolerance


def test_gaps_that_would_close_stay_open_so_distinct_elements_alone_carry_more():
    answer = closed(assembly(running_bond(4, 2), 0.75), size=0.02, seed=3, main="la", others=())
    alone = answer.details["distinct_elements"]
    assert answer.multiplier < alone["stood"]
    assert alone["cpu_seconds"] > 0.0


def test_even_stack_has_the_exact_multiplier():
    answer = closed(assembly(stack(3, 0.4, 0.2), 0.9), size=0.0, main="la", others=(), compare=False)
    # The settled contacts overlap by up to the slop of the engine and lie back by the radius of its corners.
    assert answer.multiplier == pytest.approx(2 / 3, rel=5e-3)


def test_what_cannot_be_analysed_gives_no_multiplier():
    refused = closed(assembly(stack(3), 0.7, loads={"live": None}))
    assert (refused.status, refused.multiplier) == (Status.REFUSED, None)
    falls = closed(assembly(stack(3) | {"offsets": [0.0, 0.0, 0.2]}, 0.7))
    assert (falls.status, falls.finding, falls.multiplier) == (Status.NOT_CONVERGED, Finding.NONE, None)
    pressed = assembly(stack(2), 0.7, loads={"live": {"body": [{"per_weight": [0, -1]}]}})
    unbounded = closed(pressed, size=0.0, main="la", others=(), compare=False)
    assert (unbounded.finding, unbounded.multiplier) == (Finding.UNBOUNDED, None)
