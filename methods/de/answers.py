"""From the brackets of several insertion orders to one answer that claims no more than they show."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np

from harness.model.assembly import Assembly, FloatArray, IntArray
from harness.model.deadline import best_so_far
from harness.model.details import MOVING_FORCES
from harness.model.method import Answer, Finding, Status
from methods.de.engines.engine import Engine
from methods.de.engines.mass_scaling import MassScaling, courses, insertion_orders, tunings
from methods.de.holds.bracket_state import BracketState, stopped_answer
from methods.de.holds.load_step import hold, settle
from methods.de.holds.motion import StaticLimit
from methods.de.holds.order_bracket import LOOSE, BracketSearch, OrderBracket
from methods.de.settings import HoldSettings

_BRACKET_MEANING = (
    "[lowest multiplier held, highest multiplier moving] over the sweep orders: every order was held at or above the "
    "lower end and moved at or below the upper end"
)

EngineMaker = Callable[[IntArray, IntArray, MassScaling], Engine]
"""From free blocks and interfaces in insertion order and a tuning to an engine that holds the wall."""


def solve_by_holds(
    assembly: Assembly,
    settings: HoldSettings,
    make_engine: EngineMaker,
    tolerance: float,
    candidates: list[MassScaling] | None = None,
) -> Answer:
    """Bracket the collapse multiplier in every insertion order and put the findings together.

    Args:
        assembly: the wall.
        settings: settings of the holds.
        make_engine: makes the engine.
        tolerance: residual of contact forces that the judge accepts of the method.
        candidates: tunings to try in turn; None: those of `methods.de.engines.mass_scaling.tunings`.

    Where the time is over what is shown by then is the answer (`methods.de.holds.bracket_state`).
    """
    if assembly.n_free == 0:
        return Answer(Status.OK, Finding.STANDS, "every block is fixed: nothing can move")
    unit = assembly.load_unit
    course = courses(assembly)
    orders = insertion_orders(assembly, course, settings.orders, settings.seed)
    candidates = candidates or tunings(course, settings.mass_decay)
    known, statics = BracketState(len(orders)), StaticLimit(assembly)

    def searches(tuning: MassScaling, first: int, last: int | None = None) -> list[BracketSearch]:
        chosen = orders[first:last]
        return [BracketSearch(make_engine(b, j, tuning), settings, statics, unit, name) for name, b, j in chosen]

    def to_its_end() -> Answer:
        known.search_ahead(searches(candidates[0], 0), assembly.has_live_load)
        tuning, first = _first_bracket(lambda tuning: searches(tuning, 0, 1)[0], assembly, candidates, known)
        known.finished.append(first)
        if tuning is not candidates[0]:
            known.search_ahead(searches(tuning, 1), assembly.has_live_load)
        for search in searches(tuning, 1):
            known.finished.append(known.searched(search, assembly.has_live_load))
        brackets = known.finished
        answer = _conclude(assembly, settings, brackets, unit)
        answer.details = {**describe(assembly, brackets), **_of_tuning(tuning), **answer.details}
        answer.iterations = sum(b.steps for b in brackets)
        best = reporting(brackets)
        if best is None:
            return answer
        _, blocks, joints = next(order for order in orders if order[0] == best.order)
        return _with_state(answer, make_engine(blocks, joints, tuning), settings, statics, best)

    def stopped() -> Answer:
        found = [search.found for search in known.counted()]
        return stopped_answer(assembly, known, tolerance, describe(assembly, found))

    return best_so_far(to_its_end, stopped)


def _of_tuning(tuning: MassScaling) -> dict[str, Any]:
    return {"mass_decay": tuning.mass_decay, "damping": tuning.damping}


def _with_state(
    answer: Answer, engine: Engine, settings: HoldSettings, statics: StaticLimit, best: OrderBracket
) -> Answer:
    """The answer with the contact forces, the motion and the way of the order that is reported."""
    forces, residual = _held_forces(engine, settings, best)
    answer = replace(
        answer,
        forces=forces,
        forces_multiplier=best.held,
        details=answer.details | {"residual_of_forces": residual},
        path=best.path,
    )
    if answer.finding is Finding.COLLAPSES:
        answer.mechanism, forces = _mechanism_at(engine, settings, statics, best)
        answer.flow = "approximate"
        answer.details[MOVING_FORCES] = forces.tolist()
    answer.iterations += engine.steps
    return answer


def _first_bracket(
    search: Callable[[MassScaling], BracketSearch],
    assembly: Assembly,
    candidates: list[MassScaling],
    known: BracketState,
) -> tuple[MassScaling, OrderBracket]:
    """The first order's bracket, and the tuning that gave it: the first that converges, else the one that got nearest.

    The tunings decide only how fast a wall settles; a bracket of either is a bracket. A wall falls under its dead load
    only where it moves with every tuning: what one of them holds, stands.

    Args:
        search: begins the search of the first order with a tuning.
        assembly: the wall; candidates: tunings to try in turn; known: what the searches found.
    """
    tried: list[tuple[tuple[bool, float, bool, int], MassScaling, OrderBracket]] = []
    for k, tuning in enumerate(candidates):
        found = known.searched(search(tuning), assembly.has_live_load)
        if found.held is not None and found.shows(assembly.has_live_load):
            return tuning, found
        width = 1.0 if found.width is None else found.width
        tried.append(((found.held is None, width, found.moving is None, k), tuning, found))
    _, tuning, found = min(tried, key=lambda item: item[0])
    return tuning, found


def reporting(brackets: list[OrderBracket]) -> OrderBracket | None:
    """The order that is reported: the median of those that have a bracket, else the one held highest, else None."""
    full = sorted((b for b in brackets if b.middle is not None), key=lambda b: (b.middle, b.order))
    if full:
        return full[(len(full) - 1) // 2]
    held = [b for b in brackets if b.held is not None]
    return max(held, key=lambda b: b.held or 0.0) if held else None


def describe(assembly: Assembly, brackets: list[OrderBracket]) -> dict[str, Any]:
    """What every order found, as JSON values."""
    middles = [b.middle for b in brackets if b.middle is not None]
    spread = (max(middles) - min(middles)) / float(np.mean(middles)) if middles and np.mean(middles) > 0 else None
    return {
        "orders": [
            {
                "order": b.order,
                "held": b.held,
                "moving": b.moving,
                "proof": None if b.proof is None else str(b.proof),
                "undecided": b.undecided,
                "holds": b.holds,
                "time_steps": b.steps,
                "work_exhausted": b.exhausted,
            }
            for b in brackets
        ],
        "spread": spread,
        "lowest_moving": min((b.moving for b in brackets if b.moving is not None), default=None),
        "undecided": sum(len(b.undecided) for b in brackets),
        "reporting_order": best.order if (best := reporting(brackets)) else None,
        "contact_updates": sum(b.steps for b in brackets) * assembly.n_interfaces,
    }


def _conclude(assembly: Assembly, settings: HoldSettings, brackets: list[OrderBracket], unit: float) -> Answer:
    """Status, finding and sentence; without forces and mechanism."""
    fallen = [b for b in brackets if b.held is None]
    if fallen:
        return _at_zero(assembly, brackets, fallen)
    if not assembly.has_live_load:
        return Answer(Status.OK, Finding.STANDS, f"the dead load is held in all {len(brackets)} sweep orders")
    if all(b.capped for b in brackets):
        cap = settings.load_cap * unit
        sentence = (
            f"held up to the cap: the live load was raised to multiplier {cap:.6g}, {settings.load_cap:g} times the "
            f"dead load, and held in all {len(brackets)} sweep orders; larger loads were not tried"
        )
        return Answer(Status.OK, Finding.UNBOUNDED, sentence, details={"cap": cap})
    return _collapse(brackets)


def _at_zero(assembly: Assembly, brackets: list[OrderBracket], fallen: list[OrderBracket]) -> Answer:
    """Some order is not held under the dead load alone."""
    moved = [b for b in fallen if b.moving is not None]
    if len(moved) == len(brackets):
        sentence = f"falls under its dead load: it moved in all {len(brackets)} sweep orders at multiplier 0"
        answer = Answer(Status.OK, Finding.FALLS, sentence)
        answer.mechanism, answer.flow = moved[0].velocity, "approximate"
        if moved[0].moving_forces is not None:
            answer.details[MOVING_FORCES] = moved[0].moving_forces.tolist()
        return answer
    sentence = (
        f"whether the dead load is held is not decided: of {len(brackets)} sweep orders {len(brackets) - len(fallen)} "
        f"held it, {len(moved)} moved and {len(fallen) - len(moved)} are undecided"
    )
    return Answer(Status.NOT_CONVERGED, Finding.NONE, sentence)


def _collapse(brackets: list[OrderBracket]) -> Answer:
    """Every order holds the dead load, and not all of them the load cap."""
    best = reporting(brackets)
    complete = [b for b in brackets if b.middle is not None]
    if best is None or best.middle is None or not complete:
        held = min(b.held or 0.0 for b in brackets)
        sentence = f"no sweep order reached a state that moves: held up to multiplier {held:.6g}, then undecided"
        return Answer(Status.NOT_CONVERGED, Finding.NONE, sentence)
    low = min(b.held for b in brackets if b.held is not None)
    high = max(b.moving for b in complete if b.moving is not None)
    undecided = sum(len(b.undecided) for b in brackets)
    sentence = (
        f"collapses between {low:.6g} (held) and {high:.6g} (moving) over {len(brackets)} sweep orders; the multiplier "
        f"{best.middle:.6g} is the middle of the median order's bracket [{best.held:.6g}, {best.moving:.6g}], not an "
        "exact value"
    )
    if best.nothing:
        sentence = (
            f"collapses at 0: it stands without live load and moved at {best.moving:.3g}, which the residuals "
            f"do not distinguish from zero; over {len(brackets)} sweep orders between {low:.6g} and {high:.6g}"
        )
    if undecided:
        sentence += f"; undecided load steps, which are not counted as held: {undecided}"
    status = Status.OK
    # Beside a range that the orders leave open, what one of them leaves open is as small as it is to that range.
    widest = max(0.0 if b.nothing else ((b.moving or 0.0) - (b.held or 0.0)) / high for b in complete)
    if len(complete) < len(brackets) or widest > LOOSE:
        status = Status.NOT_CONVERGED
        sentence += f"; not converged: {len(brackets) - len(complete)} orders without a moving state, widest bracket "
        sentence += f"{100 * widest:.2g} %"
    return Answer(
        status,
        Finding.COLLAPSES,
        sentence,
        multiplier=best.middle,
        bracket=(low, high),
        bracket_meaning=_BRACKET_MEANING,
    )


def _held_forces(engine: Engine, settings: HoldSettings, found: OrderBracket) -> tuple[FloatArray, float]:
    """Contact forces (m, 3) at the highest held state, followed until it no longer settles, and its residual."""
    assert found.held is not None
    assert found.state is not None
    engine.restore(found.state)
    engine.load(found.held)
    engine.advance(2 * max(10, round(engine.relaxation / 3.0)))
    residual = settle(engine, settings)
    return engine.contact_forces(), residual


def _mechanism_at(
    engine: Engine, settings: HoldSettings, statics: StaticLimit, found: OrderBracket, excess: float = 1.02
) -> tuple[FloatArray, FloatArray]:
    """Velocity field (n, 3) from the highest held state and the contact forces (m, 3) that were measured with it.

    It is that at `excess` times the middle of the bracket, or where it moves if nothing is held.
    """
    assert found.middle is not None
    assert found.moving is not None
    assert found.state is not None
    engine.restore(found.state)
    engine.load(found.moving if found.nothing else excess * found.middle)
    velocity = hold(engine, settings, statics).velocity
    return velocity, engine.contact_forces()
