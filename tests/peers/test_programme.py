"""The programme that peers solve: its rows hold at collapse states, its extreme values bound them; refusals."""

from __future__ import annotations

import sys

import numpy as np
import pytest

import drystone
from harness.model.assembly import Assembly
from harness.model.build import build
from harness.model.errors import InputError
from harness.model.method import Finding, Status
from harness.model.method_registry import check_takes, listed_methods, load_method
from harness.model.wall import Wall
from methods.peers.programme import collapse_programme
from tests.la.test_strength_and_settlement import with_strength
from tests.walls import assembly, running_bond, stack, wedge

PEERS = {"scip": "pyscipopt", "discopt": "discopt", "pounce": "pounce"}


@pytest.mark.parametrize(
    "name",
    [
        "single-block",
        "running-bond-overturns",
        "wall-21",
        "lact3-arch",
        pytest.param("irregular-wall", marks=pytest.mark.slow),
    ],
)
def test_a_collapse_state_satisfies_every_row(name: str):
    wall = drystone.library_wall(name).assembly
    answer = load_method("la").solve(wall, load_method("la").Settings())
    assert answer.forces is not None
    assert answer.mechanism is not None
    assert answer.multiplier is not None
    programme = collapse_programme(wall)
    velocities = (answer.mechanism[wall.free] * [1.0, 1.0, wall.length_scale]).ravel()
    velocities *= wall.n_free / (programme.live @ velocities)
    rates = np.maximum(wall.law.rates((programme.kinematic @ velocities).reshape(-1, 3)), 0.0).ravel()
    forces, multiplier = answer.forces.ravel() / programme.unit_force, answer.multiplier / wall.load_unit
    slacks = programme.yield_rows @ forces
    assert programme.statics @ np.append(forces, multiplier) == pytest.approx(-programme.dead, abs=1e-8)
    assert programme.kinematic @ velocities == pytest.approx(programme.flow @ rates, abs=1e-8 * (1.0 + rates.max()))
    assert abs(slacks * rates).max() < 1e-8 * (1.0 + rates.max())
    assert multiplier <= programme.greatest * (1.0 + 1e-9)
    assert (slacks <= programme.greatest_slack).all()
    assert (forces.reshape(-1, 3)[:, :2].sum(axis=1) >= programme.least_normal - 1e-9).all()
    own, dead, friction = programme.virtual_work
    assert own * multiplier + dead @ velocities + friction @ rates >= -1e-8 * (1.0 + rates.max())


@pytest.mark.parametrize("name", PEERS)
def test_a_peer_refuses_strength_and_dilatancy(name: str):
    method, wall = load_method(name), assembly(stack(2))
    check_takes(method, wall)
    with pytest.raises(InputError, match=f"{name} takes dry joints only"):
        check_takes(method, with_strength(wall, 1.0))
    with pytest.raises(InputError, match=f"{name} takes no dilatancy"):
        check_takes(method, assembly(stack(2), {"default": 0.6, "dilatancy": 0.1}))


@pytest.mark.parametrize("name", PEERS)
def test_a_peer_without_its_package_is_refused_and_stands_in_no_list(name: str, monkeypatch: pytest.MonkeyPatch):
    assert name not in listed_methods()
    monkeypatch.setitem(sys.modules, PEERS[name], None)
    method = load_method(name)
    with pytest.raises(InputError, match=rf"needs the package {PEERS[name]} .*drystone\[{name}\]"):
        method.solve(assembly(stack(2)), method.Settings())


def test_discopt_refuses_a_wall_whose_slacks_have_no_end():
    pytest.importorskip("discopt", reason="the extra discopt is missing")
    wall = build(Wall.model_validate(wedge())).assembly
    answer = load_method("discopt").solve(wall, load_method("discopt").Settings())
    assert answer.status is Status.REFUSED
    assert "Take la or scip" in answer.sentence


def falls() -> Assembly:
    return assembly(stack(3) | {"offsets": [0.0, 0.0, 0.2]}, 0.7)


@pytest.mark.parametrize("name", PEERS)
@pytest.mark.parametrize(
    ("wall", "finding"),
    [(falls(), Finding.FALLS), (assembly(running_bond(3, 2), loads={"live": None}), Finding.STANDS)],
    ids=["falls", "stands"],
)
def test_the_dead_load_alone_is_answered_first(name: str, wall: Assembly, finding: Finding):
    pytest.importorskip(PEERS[name], reason=f"the extra {name} is missing")
    assert load_method(name).solve(wall, load_method(name).Settings()).finding is finding
