"""Right answers of random small walls, spoiled: none is accepted with a multiplier that no state can have.

What is possible is told by an enumeration of all contact states (least) and a linear programme in fractions (greatest),
neither of which knows the judge. `DRYSTONE_MUTANTS=20000` is the recorded run of docs/reliability.md.
"""

from __future__ import annotations

import os
from dataclasses import dataclass, replace
from functools import cache
from typing import Any

import numpy as np
from hypothesis import given, target
from hypothesis import settings as tried
from hypothesis import strategies as st

import drystone
from harness.engine.judge import judge
from harness.model.assembly import Assembly
from harness.model.method import Answer, Finding, Method, Settings, Status
from harness.model.method_registry import load_method
from harness.model.result import Judgement, result_of
from tests.enumeration import least_by_enumeration
from tests.exact_programme import greatest_multiplier

MUTANTS = int(os.environ.get("DRYSTONE_MUTANTS", "120"))
"""States that are spoiled."""
WALLS = 40 if MUTANTS > 1000 else 6
"""Walls they belong to; those of three interfaces take seconds each to enumerate."""
METHODS = ("la", "la-associated", "fe")
TOLERANCE = 1e-9
ROUNDING = 1e-7
"""Relative; the judge's tolerance times what a residual of it may shift a multiplier, and scipy's feasibility."""
FAR = 9.0
"""Residual from which on it makes no difference how far a state is from being accepted."""
NUMBERS = st.floats(-2.0, 2.0, allow_nan=False)
KINDS = (
    *("multiplier", "both", "forces", "all forces", "live forces", "scale", "block", "ground", "translation"),
    *("other state", "bracket", "finding", "no mechanism", "size"),
)


@dataclass(frozen=True, eq=False)
class Known:
    """A wall with what is possible on it, and states that methods found."""

    wall: drystone.Wall
    least: float
    greatest: float
    states: tuple[Answer, ...]

    @property
    def assembly(self) -> Assembly:
        return self.wall.assembly


def document(seed: int) -> dict[str, Any]:
    """A wall of one or two blocks and at most three interfaces, pushed somewhere."""
    random = np.random.default_rng(seed)
    size = random.uniform(0.3, 1.2, (2, 2)).round(3)
    shift = round(float(random.uniform(-0.2, 0.2) * size[0, 0]), 3)
    (w, h), (v, g) = size.tolist()
    ground = [[-3.0, -0.5], [3.0, -0.5], [3.0, 0.0], [-3.0, 0.0]]
    first = [[0.0, 0.0], [w, 0.0], [w + shift, h], [shift, h]]
    second = {
        0: None,
        1: [[shift, h], [shift + v, h], [shift + v, h + g], [shift, h + g]],
        2: [[w, 0.0], [w + v, 0.0], [w + v + shift, h], [w + shift, h]],
    }[seed % 3 if WALLS > 6 else seed % 2]
    angle = random.choice([0.0, np.pi, random.uniform(-0.5, 0.5)])
    blocks = [
        {"id": "ground", "polygon": ground, "fixed": True},
        {"id": "a", "polygon": first, "weight": float(10.0 ** random.uniform(-3.0, 3.0))},
    ]
    if second is not None:
        blocks.append({"id": "b", "polygon": second, "weight": float(10.0 ** random.uniform(-3.0, 3.0))})
    return {
        "format": "wall/1",
        "friction": round(float(random.uniform(0.1, 1.2)), 3),
        "blocks": blocks,
        "loads": {"live": {"body": [{"per_weight": [float(np.cos(angle)), float(np.sin(angle))]}]}},
    }


@cache
def known() -> tuple[Known, ...]:
    """Walls that stand and have a least and a greatest multiplier."""
    found: list[Known] = []
    for seed in range(10 * WALLS):
        wall = drystone.build_wall(document(seed), f"mutants-{seed}")
        greatest = greatest_multiplier(wall.assembly)
        if greatest is None or not np.isfinite(float(greatest)):
            continue
        least = least_by_enumeration(wall.assembly)
        answers = [solve(load_method(name), wall.assembly) for name in METHODS]
        states = tuple(item for item in answers if item.finding is Finding.COLLAPSES and item.mechanism is not None)
        if states and np.isfinite(least):
            found.append(Known(wall, least, float(greatest), states))
        if len(found) == WALLS:
            break
    return tuple(found)


def solve(method: Method, wall: Assembly) -> Answer:
    return method.solve(wall, method.Settings())


def said(wall: Assembly, answer: Answer) -> Judgement:
    return judge(wall, result_of(answer, wall, case="x", method="hand", family="hand"), TOLERANCE)


def spoiled(data: st.DataObject, item: Known) -> Answer:
    """A state of the wall with up to four things wrong about it."""
    wall = item.assembly
    answer = data.draw(st.sampled_from(item.states))
    assert answer.forces is not None
    assert answer.mechanism is not None
    forces, mechanism = np.array(answer.forces), np.array(answer.mechanism)
    multiplier = answer.multiplier or 0.0
    at, details = answer.forces_multiplier, dict(answer.details)
    more: dict[str, Any] = {"flow": data.draw(st.sampled_from(["non-associated", "associated"]))}
    for kind in data.draw(st.lists(st.sampled_from(KINDS), min_size=1, max_size=4)):
        row = data.draw(st.integers(0, wall.n_interfaces - 1))
        block = data.draw(st.integers(0, wall.n_blocks - 1))
        match kind:
            case "multiplier":
                multiplier *= 1.0 + data.draw(st.sampled_from([1e-7, 1e-3, -1e-3, 1.0]))
            case "both":
                at = multiplier = data.draw(NUMBERS)
            case "forces":
                forces[row] *= 1.0 + data.draw(NUMBERS)
            case "all forces":
                forces *= data.draw(NUMBERS)
            case "live forces":
                details["live_forces"] = (forces * data.draw(NUMBERS)).tolist()
            case "scale":
                mechanism *= 10.0 ** data.draw(st.integers(-200, 200))
            case "size":
                forces[row] *= 10.0 ** data.draw(st.integers(-200, 200))
            case "block":
                mechanism[block] += np.array([data.draw(NUMBERS) for _ in range(3)])
            case "ground":
                mechanism[wall.fixed] = data.draw(NUMBERS)
            case "translation":
                mechanism[:, :2] += np.array([data.draw(NUMBERS), data.draw(NUMBERS)])
            case "other state":
                other = data.draw(st.sampled_from(item.states))
                assert other.mechanism is not None
                mechanism = np.array(other.mechanism)
            case "bracket":
                low = multiplier + data.draw(st.sampled_from([0.0, -1e-3, 1e-3, 1.0]))
                more |= {"flow": "approximate", "bracket": (low, low + 1e-3), "bracket_meaning": "hold and motion"}
            case "finding":
                more["finding"] = data.draw(st.sampled_from(list(Finding)))
            case "no mechanism":
                mechanism = np.zeros_like(mechanism)
    if data.draw(st.booleans()):
        details["dilatant_mechanism"] = mechanism.tolist()
    return replace(
        answer,
        status=Status.OK,
        multiplier=multiplier,
        forces=forces,
        mechanism=mechanism,
        forces_multiplier=at,
        details=details,
        **more,
    )


def assert_possible(item: Known, answer: Answer) -> None:
    """What an accepted answer says is true of the wall, which stands, and not under every multiplier."""
    slack = ROUNDING * max(1.0, item.greatest)
    assert answer.finding is Finding.COLLAPSES, answer.finding
    assert answer.multiplier is not None
    if answer.flow == "approximate":
        assert answer.bracket is not None
        assert answer.bracket[0] <= item.greatest + slack
        return
    assert item.least - slack <= answer.multiplier <= item.greatest + slack
    if answer.flow == "associated":
        assert answer.multiplier >= item.greatest - slack


@tried(max_examples=MUTANTS, deadline=None, derandomize=True)
@given(st.data())
def test_no_spoiled_state_is_accepted_at_an_impossible_multiplier(data: st.DataObject):
    item = data.draw(st.sampled_from(known()))
    answer = spoiled(data, item)
    judgement = said(item.assembly, answer)
    worst = max((abs(value) for name, value in judgement.residuals.items() if name != "live_work"), default=FAR)
    target(-min(worst, FAR) if np.isfinite(worst) else -FAR)
    if judgement.accepted:
        assert_possible(item, answer)


def test_right_states_are_accepted():
    for item in known():
        for answer in item.states:
            assert said(item.assembly, answer).accepted
            assert_possible(item, answer)


@tried(max_examples=max(20, MUTANTS // 20), deadline=None, derandomize=True)
@given(st.data())
def test_the_engine_rejects_from_a_method_what_the_judge_rejects(data: st.DataObject):
    item = data.draw(st.sampled_from(known()))
    answer = spoiled(data, item)

    class Spoiling(Method):
        name, family, title, tolerance = "spoiling", "hand", "Spoiling", TOLERANCE
        Settings = Settings

        def solve(self, assembly: Assembly, settings: Settings) -> Answer:
            return answer

    result = drystone.analyse(item.wall, Spoiling())
    assert result.judge.outcome == said(item.assembly, answer).outcome
