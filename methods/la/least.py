"""The run of `la`: starts, descents, restarts and continuation in order, and the answer they lead to."""

from __future__ import annotations

import time
from contextlib import suppress
from dataclasses import dataclass, replace
from itertools import chain
from typing import Any

import numpy as np

from harness.model.errors import first_few
from harness.model.method import Answer, OutOfTime, Status
from methods.la.answers import LOCALLY, NO_MOTION, NO_STATE, collapse_answer, not_converged, unbounded_answer
from methods.la.associated import AssociatedResult
from methods.la.continuation import POOL, climb, descend_from, smooth_joints
from methods.la.exact import exact_mechanism
from methods.la.extremes import ForceProgramme, Units, units_of
from methods.la.large import MOST_INTERFACES, LargeSearch, central_search, lagged_state, large_search
from methods.la.mechanisms import mechanism_states
from methods.la.newton_matrix import NewtonMatrix
from methods.la.prestressed import LIGHT_UP_TO, first_state, gravity_of, last_states, light_states
from methods.la.problem import Problem
from methods.la.proof import Proof, prove
from methods.la.rational import confirm
from methods.la.search import Effort, Search
from methods.la.settings import SearchSettings
from methods.la.state import CollapseState, local_residuals, polished, residuals
from methods.numerics.failures import NumericalFailure


@dataclass(frozen=True)
class Plan:
    """How much is tried.

    Attributes:
        starts: random starts; failures: draws that end a descent; ladder: friction factors; descents: on each rung.
        kinks: on all paths of springs from forces of little self-stress.
        mechanisms: drawn without regard to forces.
        nodes: of the tree that may prove the least state.
    """

    starts: int
    failures: int
    ladder: tuple[float, ...]
    descents: int
    kinks: int
    mechanisms: int
    nodes: int


NOT_EXACT = "No state was found that holds beside the lightest blocks too: weights differ too much within the wall"
SIMPLEX_SEARCH = 1000
"""Interfaces above which the search by simplex programmes is too slow and the interior point does all."""
FEW_INTERFACES = 400
"""Interfaces up to which the associated solution is one more start; on larger walls it led to high states only."""
LARGE_KINKS = 60000
"""Kinks on the paths of springs from forces of little self-stress on walls above `SIMPLEX_SEARCH`."""
PROVABLE, PROVABLE_RING = 16, 30
"""Interfaces up to which a proof is tried, and those of walls with hardly more interfaces than blocks.

With more, hardly any tree of 1,500 nodes comes to an end.
"""
SAME = 1e-9
"""Relative difference of two multipliers below which the state with the smaller residuals is the better one."""
LADDER = (0.55, 0.65, 0.75, 0.85, 0.925)
SMOOTH = (0.5, 0.3, 0.0)
"""Factors on the friction of the joints that the dead load leaves unloaded, each one more start."""
FINE_LADDER = (1.3, 1.15, 1.0, 0.9, 0.8, 0.7, 0.6, 0.5, 0.55, 0.6, 0.65, 0.7, 0.75, 0.8, 0.85, 0.9, 0.95)


def plan_of(settings: SearchSettings, problem: Problem) -> Plan:
    """The plan for a wall; normal effort shrinks with size so that the time grows slowly."""
    n_free = problem.assembly.n_free
    most = PROVABLE_RING if problem.n_interfaces <= n_free + 2 else PROVABLE
    nodes = 1500 if problem.n_interfaces <= most else 0
    deep_nodes = 20000 if problem.n_interfaces <= 2 * most else 0
    plan = {
        "quick": Plan(0, 8, (), 1, 300, 0, min(nodes, 100)),
        "normal": Plan(3, 12, LADDER, 3, 6000, 60, nodes)
        if n_free <= 30
        else Plan(1, 12, LADDER[::2], 1, 6000, 20, nodes),
        "deep": Plan(20, 40, FINE_LADDER, 8, 100000, 1000 if n_free <= 60 else 50, deep_nodes),
    }[settings.effort]
    if settings.effort == "normal" and n_free > 60:
        plan = Plan(1 if n_free <= 150 else 0, 40, (), 1, 20000, 0, 0)
    return replace(
        plan,
        starts=plan.starts if settings.starts is None else settings.starts,
        failures=plan.failures if settings.failures is None else settings.failures,
        ladder=plan.ladder if settings.ladder is None else settings.ladder,
    )


def least_known(problem: Problem, newton: NewtonMatrix, settings: SearchSettings, tolerance: float) -> Answer:
    """The answer with the least collapse state that the search finds, in the time there is.

    Args:
        problem: the scaled wall, which stands under its dead load and has a live load.
        newton: its Newton matrix.
        settings: effort and seed.
        tolerance: largest residual of a state that is returned.
    """
    search, found = Search(problem, newton, settings.seed), LargeSearch()
    try:
        if problem.n_interfaces > SIMPLEX_SEARCH:
            return _large(search, found, settings, tolerance)
        return _searched(search, settings, tolerance)
    except OutOfTime:
        states = search.lower + found.states
        if not states and search.associated.state is not None:
            return _stopped_before_the_first(problem, search.associated.state, tolerance)
        if not states:
            raise
        return _stopped(problem, newton, states, search.tally.newton_steps + found.steps, tolerance)


def _stopped(
    problem: Problem, newton: NewtonMatrix, states: list[CollapseState], steps: int, tolerance: float
) -> Answer:
    """The answer with the least of the states that were known when the time was over and are exact."""
    details = {
        "stopped_by_limit": True,
        "starts": len(states),
        "start_values": [problem.to_multiplier(state.multiplier) for state in states],
        "newton_steps": steps,
        "lower_bound": 0.0,
        "proved_least": False,
    }
    for state in sorted(states, key=lambda state: state.multiplier):
        exact = max(residuals(problem, state).values()) <= tolerance
        best = state if exact else polished(problem, newton, state)
        sentence = (
            f"The least collapse multiplier known so far is {problem.to_multiplier(best.multiplier):.7g}: the search "
            "was stopped by the time limit, with starts, descents and paths left to try. It is not proved to be the "
            "least."
        )
        answer = collapse_answer(problem, best, sentence, tolerance, steps, details)
        if answer.status is Status.OK:
            break
    return answer


def _stopped_before_the_first(problem: Problem, associated: CollapseState, tolerance: float) -> Answer:
    """The answer with the associated collapse state, where the time was over before any other was known."""
    greatest = problem.to_multiplier(associated.multiplier)
    sentence = (
        f"No collapse state without dilatancy is known yet: the search was stopped by the time limit. None lies above "
        f"{greatest:.7g}, at which the wall collapses under associated flow."
    )
    details = {"stopped_by_limit": True, "associated": greatest, "lower_bound": 0.0, "proved_least": False}
    return collapse_answer(
        problem, associated, sentence, tolerance, 0, details, (0.0, greatest), "nothing is known but the upper bound"
    )


def _searched(search: Search, settings: SearchSettings, tolerance: float) -> Answer:
    """The answer of the whole search on walls of up to `SIMPLEX_SEARCH` interfaces."""
    problem, newton = search.problem, search.newton
    began = time.process_time()
    plan = plan_of(settings, problem)
    effort = Effort(failures=plan.failures)
    first = search.interior()
    rungs = (smooth_joints(search, factor) for factor in SMOOTH)
    carried = [state for rung in rungs if rung is not None for state in search.adopt(rung, POOL)]
    climbed = descend_from(carried, search, effort, plan.descents)
    associated = search.solve_associated()
    found = [search.descend(state, effort) for state in _starting_states(search, first, associated, plan.starts)]
    below = climb(search, plan.ladder, effort, plan.descents)
    if below is not None:
        climbed += descend_from(search.adopt(below, POOL), search, effort, plan.descents)
    gravity = gravity_of(problem)
    light: list[CollapseState] = []
    if not problem.dilates:  # Springs slide without lifting, and so do the blocks whose motions are drawn.
        light = list(light_states(search, gravity, plan.kinks, associated.greatest))
        climbed += descend_from(light, search, effort, plan.descents)
        climbed += descend_from(list(mechanism_states(search, plan.mechanisms)), search, effort, plan.descents)
    found += light
    if not found and not climbed:
        return _with_falling_blocks(_nothing_found(search, associated), gravity.falling)
    uneven = units_of(problem)
    if uneven is not None:
        climbed = confirmed(problem, newton, uneven, found + climbed)
        found = []
        if not climbed:
            return not_converged(f"{NOT_EXACT}.", search.tally.newton_steps)
    best = least_of(problem, found + climbed)
    joined = search.as_one_block(best)
    if joined is not None and joined.multiplier < best.multiplier:
        best = search.descend(joined, effort)
    proof = prove(search, best, plan.nodes)
    if uneven is not None:
        best, proof = _of_uneven(problem, newton, uneven, [*climbed, best], proof)
    elif proof.state is not best:
        best = search.descend(proof.state, effort)
        proof = replace(proof, state=best)
    if uneven is None:
        best = polished(problem, newton, best)
        if max(part.max(initial=0.0) for part in local_residuals(problem, best)) > LOCALLY:
            exact = confirmed(problem, newton, None, [best])
            best = least_of(problem, exact) if exact else best
    answer = _answer(
        problem, search, best, (found, climbed), (associated, proof), tolerance, settings.rational_interfaces
    )
    return _with_falling_blocks(replace(answer, path=_path(search, began)), gravity.falling)


def least_of(problem: Problem, states: list[CollapseState]) -> CollapseState:
    """The most exact of the states with the least multiplier, but for rounding."""
    least = min(state.multiplier for state in states)
    same = (state for state in states if state.multiplier <= least + SAME * abs(least))
    return min(same, key=lambda state: max(residuals(problem, state).values()))


def confirmed(
    problem: Problem, newton: NewtonMatrix, units: Units | None, states: list[CollapseState]
) -> list[CollapseState]:
    """The states whose forces, solved for in units of their own blocks and interfaces, exist; lowest first, some left.

    Programmes in one unit overlook what a block of 1e-9 times the mean weight needs, and give states that are none.
    """
    programme = ForceProgramme(problem, units)
    kept: list[CollapseState] = []
    for state in sorted(states, key=lambda state: state.multiplier):
        if kept and state.multiplier > min(other.multiplier for other in kept):
            break
        found = programme.extreme(greatest=False, tight=state.moving)
        if isinstance(found, str):
            continue
        statics = found.statics
        exact = replace(state, forces=statics.forces, multiplier=statics.multiplier)
        with suppress(NumericalFailure):
            exact = replace(exact, velocities=exact_mechanism(problem, newton, state.velocities, state.moving, False))
        kept.append(exact)
    return kept


def _of_uneven(
    problem: Problem, newton: NewtonMatrix, units: Units, states: list[CollapseState], proof: Proof
) -> tuple[CollapseState, Proof]:
    """The least state that is confirmed, and what the tree proves of it: nothing where its own is not confirmed."""
    best = least_of(problem, confirmed(problem, newton, units, [*states, proof.state]) or states)
    holds = best.multiplier <= proof.state.multiplier + SAME * abs(proof.state.multiplier)
    return best, replace(proof, state=best) if holds else Proof(best, 0.0, proof.nodes)


def _with_falling_blocks(answer: Answer, falling: list[str]) -> Answer:
    """The answer with the blocks that fall under the dead load where the joints carry no self-stress, if any."""
    if not falling:
        return answer
    sentence = (
        f"{answer.sentence} The wall stands by self-stress in its joints: without any, "
        f"{first_few(falling, 8)} would fall under the dead load."
    )
    return replace(answer, sentence=sentence, details={**answer.details, "falls_without_self_stress": falling})


def _path(search: Search, began: float) -> dict[str, list[float]]:
    """When which multiplier was the least known; CPU time since the search began."""
    seconds, multipliers = np.array(search.history).T
    multipliers = multipliers * search.problem.unit_multiplier
    return {"cpu_seconds": (seconds - began).tolist(), "multiplier": multipliers.tolist()}


def _large(search: Search, found: LargeSearch, settings: SearchSettings, tolerance: float) -> Answer:
    """The answer of the search on larger walls, which descends from nothing."""
    problem, newton = search.problem, search.newton
    began = time.process_time()
    associated = search.solve_associated()
    velocities = None if associated.state is None else associated.state.velocities
    unbounded = associated.outcome == "unbounded"
    central_search(found, problem, newton, settings.seed)
    springs = not (unbounded or problem.dilates)
    soon = problem.n_interfaces <= MOST_INTERFACES and springs
    if soon and not found.states:
        found.add(first_state(search, LARGE_KINKS), 0, found.gap)
    large_search(found, problem, newton, settings.seed, velocities)
    details: dict[str, Any] = {"unknowns": 7 * problem.n_interfaces + problem.n_velocities + 1}
    falling: list[str] = []
    for state in found.states:
        search.record(state)
    if problem.n_interfaces <= LIGHT_UP_TO:
        gravity = gravity_of(problem)
        falling = gravity.falling
        light = light_states(search, gravity, 1 if unbounded else LARGE_KINKS, associated.greatest)
        for state in () if problem.dilates else chain(light, mechanism_states(search, 0)):
            found.add(state, 0, found.gap)
    if springs and not (found.states or soon):
        found.add(first_state(search, LARGE_KINKS), 0, found.gap)
    if springs and not found.states:
        for state in last_states(search, associated.greatest, LARGE_KINKS):
            found.add(state, 0, found.gap)
    found.steps += search.tally.newton_steps
    details["kinks"] = search.tally.kinks
    details |= {"starts": len(found.states), "newton_steps": found.steps, "path_gap": found.gap}
    if associated.state is not None:
        details["associated"] = problem.to_multiplier(associated.state.multiplier)
    if not found.states and unbounded:
        return _with_falling_blocks(unbounded_answer(NO_STATE), falling)
    if not found.states:
        answer = not_converged(
            "No contact forces fit the mechanisms at the ends of the central paths, and no path of the wall with "
            "springs in its joints came to a mechanism, so no collapse state is known.",
            found.steps,
            details,
        )
        return _with_falling_blocks(answer, falling)
    values = [problem.to_multiplier(state.multiplier) for state in found.states]
    details["start_values"] = values
    best = polished(problem, newton, least_of(problem, found.states))
    sentence = (
        f"The least collapse multiplier known is {problem.to_multiplier(best.multiplier):.7g}, without descent "
        "because of the size of the wall. It is not proved to be the least."
    )
    answer = collapse_answer(problem, best, sentence, tolerance, found.steps, details)
    path = {
        "cpu_seconds": [second - began for second in found.seconds],
        "multiplier": np.minimum.accumulate(values).tolist(),
    }
    return _with_falling_blocks(replace(answer, path=path), falling)


def _starting_states(
    search: Search, first: CollapseState | None, associated: AssociatedResult, starts: int
) -> list[CollapseState]:
    states = [first]
    few = search.problem.n_interfaces <= FEW_INTERFACES
    if associated.state is not None and (few or states[0] is None):
        states.append(search.nearest_mechanism(associated.state.forces))
    if not search.problem.dilates and (not few or not any(states)):
        state, steps, _ = lagged_state(search.problem, search.newton, ((100, 0.6),))
        search.tally.newton_steps += steps
        if state is not None:
            search.record(state)
        states.append(state)
    states += [search.interior(spread=2.0) for _ in range(starts)]
    return [state for state in states if state is not None]


def _nothing_found(search: Search, associated: AssociatedResult) -> Answer:
    if not search.finds_motion():
        return unbounded_answer(NO_MOTION)
    if associated.outcome == "unbounded":
        return unbounded_answer(NO_STATE)
    return not_converged("The search found no collapse state.", search.tally.newton_steps)


def _answer(
    problem: Problem,
    search: Search,
    best: CollapseState,
    states: tuple[list[CollapseState], list[CollapseState]],
    bounds: tuple[AssociatedResult, Proof],
    tolerance: float,
    rational_interfaces: int,
) -> Answer:
    associated, proof = bounds
    least = problem.to_multiplier(best.multiplier)
    values, climbed = ([problem.to_multiplier(state.multiplier) for state in group] for group in states)
    agreeing = sum(value <= least * (1.0 + 1e-7) + 1e-12 for value in values)
    details: dict[str, Any] = {
        "starts": len(values),
        "starts_agree": agreeing == len(values),
        "starts_at_least_known": agreeing,
        "start_values": values,
        "continuation_values": climbed,
        "newton_steps": search.tally.newton_steps,
        "programmes": search.tally.programmes,
        "unknowns": 7 * problem.n_interfaces + problem.n_velocities + 1,
        "lower_bound": problem.to_multiplier(proof.lower_bound),
        "proved_least": proof.complete,
        "proof_nodes": proof.nodes,
    }
    if problem.n_interfaces <= rational_interfaces and not problem.dilates:
        details["rational_confirmation"] = confirm(problem, best)
    if associated.state is not None:
        details["associated"] = problem.to_multiplier(associated.state.multiplier)
    if proof.complete:
        nodes = f"{proof.nodes} node{'s' if proof.nodes != 1 else ''}"
        sentence = f"The least collapse multiplier is {least:.7g}, proved by branch and bound ({nodes}), to rounding."
    else:
        sentence = (
            f"The least collapse multiplier known is {least:.7g}; {agreeing} of {len(values)} starts "
            "lead to it. It is not proved to be the least."
        )
    return collapse_answer(
        problem,
        best,
        sentence,
        tolerance,
        search.tally.newton_steps,
        details,
    )
