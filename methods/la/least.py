"""The run of `la`: starting-point strategies in order, one budget and one record, and the answer.

The least multiplier under zero dilatancy is a mathematical programme with equilibrium constraints:

    min lambda   s.t.  C' r + f0 + lambda fL = 0,   C u = E g,   fL.u = 1,   0 <= y = S r + s0,   g >= 0,   y.g = 0

Source: Baggio and Trovalusci (1995), equations 1 to 11; Ferris and Tin-Loi (2001). It is not convex: the search returns
the least state that it finds, and `methods.la.certify` and `methods.proof` prove bounds.
"""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import suppress
from dataclasses import replace
from typing import Any

from harness.model.deadline import STOPPED, OutOfTime, best_so_far
from harness.model.errors import first_few
from harness.model.method import Answer, Status, none_above
from methods.la.answers import (
    LOCAL_RESIDUAL,
    NO_MOTION,
    NO_STATE,
    collapse_answer,
    not_converged,
    unbounded_answer,
)
from methods.la.certify.proof import TreeProof, prove
from methods.la.certify.rational import confirm
from methods.la.core.exact import exact_mechanism
from methods.la.core.newton_matrix import NewtonMatrix
from methods.la.core.problem import Problem
from methods.la.core.state import CollapseState, local_residuals, polished, residuals
from methods.la.core.vertex_programmes import ForceProgramme, RowScaling, row_scaling
from methods.la.settings import SearchSettings
from methods.la.sources import SOURCES, Source, explore
from methods.la.sources.budget import Budget, rounds_of
from methods.la.sources.search import Choices, Search
from methods.numerics.failures import NumericalFailure

_NOT_EXACT = "No state is in equilibrium at the lightest blocks too: weights differ too much within the wall"
SAME_MULTIPLIER = 1e-9
"""Relative difference of two multipliers below which the state with the smaller residuals is the better one."""


def least_known(
    problem: Problem,
    newton: NewtonMatrix,
    settings: SearchSettings,
    tolerance: float,
    sources: Sequence[Source] = SOURCES,
    choices: Choices = Choices(),
) -> Answer:
    """The answer with the least collapse state that the search finds, in the time there is.

    Args:
        problem: the scaled wall, which stands under its dead load and has a live load.
        newton: its Newton matrix.
        settings: effort and seed.
        tolerance: largest residual of a state that is returned.
        sources: of states, in the order in which they are tried.
        choices: how the search solves its programmes.
    """
    rounds = rounds_of(settings, problem)
    search = Search(problem, newton, settings.seed, Budget(rounds[0]), choices=choices)

    def to_its_end() -> Answer:
        for limits in rounds:
            search.begin_round(limits)
            explore(search, sources)
        return _found(search, settings, tolerance)

    def known() -> Answer:
        if search.record.known:
            return _stopped(search, tolerance)
        if search.associated.state is None:
            raise OutOfTime
        return _stopped_before_the_first(search, search.associated.state, tolerance)

    return best_so_far(to_its_end, known)


def _found(search: Search, settings: SearchSettings, tolerance: float) -> Answer:
    """The answer of the whole search."""
    problem = search.problem
    asked = problem.n_interfaces <= search.choices.gravity_up_to and problem.law.is_cone  # springs bear no tension
    falling = search.gravity.falling if asked else []
    if not search.record.known:
        return _with_falling_blocks(_nothing_found(search), falling)
    chosen = chosen_state(search)
    if chosen is None:
        return not_converged(f"{_NOT_EXACT}.", search.budget.spent.newton_steps)
    best, proof = chosen
    details = _details(search, best, proof)
    exact = not problem.dilates and problem.law.is_cone  # the equations in fractions are of dry joints
    if problem.n_interfaces <= settings.rational_interfaces and exact:
        details["rational_confirmation"] = confirm(problem, best)
    answer = collapse_answer(
        problem, best, _sentence(search, best, proof), tolerance, search.budget.spent.newton_steps, details
    )
    return _with_falling_blocks(replace(answer, path=search.record.path(problem.unit_multiplier)), falling)


def chosen_state(search: Search) -> tuple[CollapseState, TreeProof] | None:
    """The least state, exact, and what a tree proves of it; None where none holds beside the lightest blocks."""
    problem, newton, states = search.problem, search.newton, search.record.states
    badly_scaled = row_scaling(problem)
    if badly_scaled is not None:
        states = confirmed(problem, newton, badly_scaled, states)
        if not states:
            return None
    best = least_of(problem, states)
    proof = prove(search, best, search.budget.limits.nodes)
    if badly_scaled is not None:
        return of_uneven(problem, newton, badly_scaled, [*states, best], proof)
    if proof.state is not best:
        best = search.descend(proof.state)
        proof = replace(proof, state=best)
    best = polished(problem, newton, best)
    if max(part.max(initial=0.0) for part in local_residuals(problem, best)) > LOCAL_RESIDUAL:
        exact = confirmed(problem, newton, None, [best])
        best = least_of(problem, exact) if exact else best
    return best, proof


def _stopped(search: Search, tolerance: float) -> Answer:
    """The answer with the least of the states that were known when the time was over and are exact."""
    problem = search.problem
    details = _details(search, None, None) | {"stopped_by_limit": True}
    for found in reversed(search.record.improvements):
        exact = max(residuals(problem, found.state).values()) <= tolerance
        best = found.state if exact else polished(problem, search.newton, found.state)
        sentence = (
            f"The least collapse multiplier known so far is {problem.to_multiplier(best.multiplier):.7g}: the search "
            f"was {STOPPED} at {search.record.source}, with more left to try."
        )
        answer = collapse_answer(problem, best, sentence, tolerance, search.budget.spent.newton_steps, details)
        if answer.status is Status.OK:
            break
    return replace(answer, path=search.record.path(problem.unit_multiplier))


def _stopped_before_the_first(search: Search, associated: CollapseState, tolerance: float) -> Answer:
    """The answer with the associated collapse state, where the time was over before any other was known."""
    problem = search.problem
    greatest = problem.to_multiplier(associated.multiplier)
    sentence = (
        f"No collapse state without dilatancy is known yet: the search was {STOPPED}; {none_above(greatest)}, by "
        "associated flow."
    )
    details = _details(search, None, None) | {"stopped_by_limit": True}
    return collapse_answer(
        problem, associated, sentence, tolerance, 0, details, (0.0, greatest), "only the upper bound is known"
    )


def _nothing_found(search: Search) -> Answer:
    if not search.finds_motion():
        return unbounded_answer(NO_MOTION)
    if search.associated.outcome == "unbounded":
        return unbounded_answer(NO_STATE)
    details = _details(search, None, None)
    bound = f"; {none_above(details['associated'])}" if "associated" in details else ""
    return not_converged(
        "No contact forces fit the mechanisms that were tried, and no path of the wall with springs in its joints came "
        f"to a mechanism on which the live load does work, so no collapse state is known{bound}.",
        search.budget.spent.newton_steps,
        details,
    )


def least_of(problem: Problem, states: list[CollapseState]) -> CollapseState:
    """The most exact of the states with the least multiplier, but for rounding."""
    least = min(state.multiplier for state in states)
    same = (state for state in states if state.multiplier <= least + SAME_MULTIPLIER * abs(least))
    return min(same, key=lambda state: max(residuals(problem, state).values()))


def confirmed(
    problem: Problem, newton: NewtonMatrix, units: RowScaling | None, states: list[CollapseState]
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


def of_uneven(
    problem: Problem, newton: NewtonMatrix, units: RowScaling, states: list[CollapseState], proof: TreeProof
) -> tuple[CollapseState, TreeProof]:
    """The least state that is confirmed, and what the tree proves of it: nothing where its own is not confirmed."""
    best = least_of(problem, confirmed(problem, newton, units, [*states, proof.state]) or states)
    holds = best.multiplier <= proof.state.multiplier + SAME_MULTIPLIER * abs(proof.state.multiplier)
    return best, replace(proof, state=best) if holds else TreeProof(best, 0.0, proof.nodes)


def _with_falling_blocks(answer: Answer, falling: list[str]) -> Answer:
    """The answer with the blocks that fall under the dead load where the joints carry no self-stress, if any."""
    if not falling:
        return answer
    sentence = (
        f"{answer.sentence} The wall stands by self-stress in its joints: without any, "
        f"{first_few(falling, 8)} would fall under the dead load."
    )
    return replace(answer, sentence=sentence, details={**answer.details, "falls_without_self_stress": falling})


def _details(search: Search, best: CollapseState | None, proof: TreeProof | None) -> dict[str, Any]:
    """What the search found and spent, and what is proved."""
    problem, spent = search.problem, search.budget.spent
    values = [problem.to_multiplier(state.multiplier) for states in search.record.ends for state in states]
    details: dict[str, Any] = {
        "starts": len(values),
        "start_values": values,
        **search.record.details(problem.unit_multiplier),
        "newton_steps": spent.newton_steps,
        "programmes": spent.programmes,
        "breakpoints": spent.breakpoints,
        "unknowns": 7 * problem.n_interfaces + problem.n_velocities + 1,
        "lower_bound": 0.0 if proof is None else problem.to_multiplier(proof.lower_bound),
        "proved_least": proof is not None and proof.complete,
        "proof_nodes": 0 if proof is None else proof.nodes,
    }
    if best is not None:
        agreeing = sum(value <= problem.to_multiplier(best.multiplier) * (1.0 + 1e-7) + 1e-12 for value in values)
        details |= {"starts_at_least_known": agreeing, "starts_agree": agreeing == len(values)}
    if search.associated.state is not None:
        details["associated"] = problem.to_multiplier(search.associated.state.multiplier)
    return details


def _sentence(search: Search, best: CollapseState, proof: TreeProof) -> str:
    least = search.problem.to_multiplier(best.multiplier)
    if proof.complete:
        nodes = f"{proof.nodes} node{'s' if proof.nodes != 1 else ''}"
        lower = f"branch and bound ({nodes}) excludes lower ones to rounding"
        return f"The least collapse multiplier is {least:.7g}: {lower}."
    source = search.record.improvements[-1].source
    descent = "" if search.budget.limits.descents else ", without descent because of the size of the wall"
    return f"The least collapse multiplier known is {least:.7g}{descent}; found from: {source}."
