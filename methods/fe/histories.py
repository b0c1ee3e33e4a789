"""One path from gravity to collapse under one friction history, and the spread over several.

Real joints remember in which order they slipped. A history commits the shears (T0, s0) every so often along the path:
never, and at every 1 % of the multiplier; where these two end apart, at every 0.2 % too. What they differ by is scatter
from unknown data.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from harness.model.deadline import STOPPED, best_so_far
from harness.model.errors import first_few
from methods.springs.model.factor import Factor, SingularTangent
from methods.springs.model.gap_law import OPEN, SLIP_PLUS
from methods.springs.model.wall_model import WallModel
from methods.springs.path.continuation import PathFollower
from methods.springs.path.load_path import follow
from methods.springs.path.path_record import PathEnd, PathRecord, PathSnapshot, PathStep
from methods.springs.path.plateau import PlateauState, does_no_work, finish
from methods.springs.rest.equilibrium import doubled, equilibrium, first_step
from methods.springs.rest.newton import Equilibrium
from methods.springs.rest.pseudo_transient import PseudoTransient


@dataclass(frozen=True)
class HistoryTuning:
    """What is tried where a history is lost, and when.

    Attributes:
        disturbances: random initial shears, in weights of a block, tried in turn where exact ties lead a path astray.
        committed_up_to: shares of the multiplier scale up to which a history is committed, in turn while it is lost.
        astray: multiple of the first history's plateau at which a committed history counts as lost.
        large: blocks above which a path of too many breakpoints is not traced again with disturbed shears.
        doubled: blocks above which a path without commits starts where doubled Newton steps end, to save the early
            events.
        seed: of the disturbances.
    """

    disturbances: tuple[float, ...] = (1e-9, 1e-7, 1e-5)
    committed_up_to: tuple[float, ...] = (np.inf, 0.97, 0.9, 0.8)
    astray: float = 3.0
    large: int = 500
    doubled: int = 100
    seed: int = 1995


SENTENCES = {
    PathEnd.PLATEAU: "the path ends on a plateau",
    PathEnd.UNBOUNDED: "the path continues to any multiplier",
    PathEnd.RUNS_DOWN: "the path has a peak but runs down without a plateau",
    PathEnd.EVENTS: "the path was stopped at the largest number of events",
    PathEnd.BREAKDOWN: "the path was lost",
    PathEnd.TARGET: "the path reached its target",
    PathEnd.TURNED_DOWN: "the path turned down",
    PathEnd.BROKEN: "a brittle joint has reached its strength",
    PathEnd.TIME: f"the path was {STOPPED}",
}
_BELOW_ZERO = "the path has a peak but runs down below zero: past its peak the wall falls under its dead load alone"


@dataclass(frozen=True)
class HistoryPlan:
    """How a history is to be traced.

    Attributes:
        step: commit interval as a share of `scale`, 0 for no history; scale: a multiplier of the order of collapse.
        max_events: changes of state after which the history is given up.
        committed_up_to: multiplier above which it is no longer committed.
        disturbance: random initial shear that the start has, in weights of a block.
        load_steps: points of the path that are kept whole.
        options: what is tried where it is lost.
    """

    step: float
    scale: float
    max_events: int
    committed_up_to: float = np.inf
    disturbance: float = 0.0
    load_steps: int = 0
    options: HistoryTuning = HistoryTuning()


@dataclass(frozen=True)
class HistoryResult:
    """One history traced to its end.

    Attributes:
        plan: how it was traced.
        end: why the path ended; sentence: what a reader should know about it.
        record: the path; state: the collapse state when a plateau was reached and passed its check, else None.
        raised: the rest up to which the load was raised in finite steps, None if the path is exact from the start.
    """

    plan: HistoryPlan
    end: PathEnd
    sentence: str
    record: PathRecord
    state: PlateauState | None
    commits: int
    residual: float
    raised: Equilibrium | None = None


def trace_history(model: WallModel, factor: Factor, start: Equilibrium, plan: HistoryPlan) -> HistoryResult:
    """Trace one history from the gravity state, or from the rest that another raised the load to.

    A lost history with commits is traced again with commits up to 97, then 90, then 80 % of the multiplier scale only:
    at a commit many breakpoints meet, and near the peak the path from there may run in a closed loop. Where exact ties
    lead a path without commits astray it is traced again with the initial shears disturbed by 1e-9, 1e-7 and 1e-5 of a
    block's weight: data nobody knows, and the end is an exact collapse state all the same. Where a path without
    commits has not ended after so many events, the load is raised in finite steps instead
    (`methods.springs.rest.pseudo_transient`), and the path goes on from there.

    Args:
        model: the wall; factor: its tangent; start: equilibrium under the dead load, or at the rest.
    """
    if plan.step > 0.0:
        return _committed(model, factor, start, plan)
    result = _trace(model, factor, start, plan)
    if result.raised is not None:
        return result
    large = model.assembly.n_free > plan.options.large
    for disturbance in plan.options.disturbances:
        if not _lost(result) or (large and result.end == PathEnd.EVENTS):
            break
        noise = np.random.default_rng(plan.options.seed).uniform(-disturbance, disturbance, model.n_points)
        disturbed = equilibrium(model, factor, start.u, 0.0, start.history + noise)
        if disturbed.found:
            result = _trace(model, factor, disturbed, replace(plan, disturbance=disturbance))
    if result.end == PathEnd.EVENTS and result.state is None:
        raised = _as_far_as_possible(partial(_raised, model, factor, start, plan), plan)
        return raised if raised.state is not None or raised.end == PathEnd.TIME else result
    return result


def _committed(model: WallModel, factor: Factor, start: Equilibrium, plan: HistoryPlan) -> HistoryResult:
    """A history with commits, up to the end or as far as it is not lost."""
    for share in plan.options.committed_up_to:
        result = _trace(model, factor, start, replace(plan, committed_up_to=share * plan.scale))
        if not _lost(result):
            break
    return result


def _raised(
    model: WallModel, factor: Factor, gravity: Equilibrium, plan: HistoryPlan, record: PathRecord
) -> HistoryResult:
    """Trace a path into the record from the multiplier that the load can be raised to in finite steps.

    Raises:
        OutOfTime: the time given is over.
        SingularTangent: the path cannot be taken up where the wall is at rest.
    """
    rest = gravity
    record.keep(partial(_load_step, model, gravity))
    for rest in PseudoTransient(model, factor, gravity, True).raise_load(plan.scale):
        _note(record, model, rest)
        record.peak = rest.multiplier
    return _resumed(model, factor, rest, plan, record)


def _resumed(
    model: WallModel, factor: Factor, rest: Equilibrium, plan: HistoryPlan, record: PathRecord
) -> HistoryResult:
    """Trace a path into the record from the rest that the load was raised to. Raises as `_raised` does."""
    result = _followed(PathFollower.from_rest(model, factor, rest), plan, record)
    sentence = f"{result.sentence}; up to {rest.multiplier:.4g} the load was raised in finite steps"
    return replace(result, sentence=sentence, raised=rest)


def _lost(result: HistoryResult) -> bool:
    return result.state is None and result.end not in (PathEnd.UNBOUNDED, PathEnd.TIME)


def _trace(model: WallModel, factor: Factor, start: Equilibrium, plan: HistoryPlan) -> HistoryResult:
    """Trace one history from an equilibrium, as far as the time allows."""
    return _as_far_as_possible(partial(_trace_in_time, model, factor, start, plan), plan)


def _as_far_as_possible(trace: Callable[[PathRecord], HistoryResult], plan: HistoryPlan) -> HistoryResult:
    """What a trace into a record leads to, or how far the record came where the time is over or the path is lost."""
    record = PathRecord(most=plan.load_steps)
    try:
        return best_so_far(partial(trace, record), partial(_stopped, plan, record))
    except SingularTangent:
        return HistoryResult(plan, PathEnd.BREAKDOWN, SENTENCES[PathEnd.BREAKDOWN], record, None, 0, 0.0)


def _stopped(plan: HistoryPlan, record: PathRecord) -> HistoryResult:
    """How far a record came in the time there was."""
    sentence = SENTENCES[PathEnd.TIME]
    if record.multiplier:
        sentence += f", at {record.multiplier[-1]:.4g} times the live load (greatest so far {record.peak:.4g})"
    return HistoryResult(plan, PathEnd.TIME, sentence, record, None, 0, 0.0)


def _trace_in_time(
    model: WallModel, factor: Factor, start: Equilibrium, plan: HistoryPlan, record: PathRecord
) -> HistoryResult:
    """Trace one history into the record.

    Raises:
        OutOfTime: the time given is over.
        SingularTangent: the path cannot be begun, or taken up again, where it stands.
    """
    if start.multiplier > 0.0:
        _note(record, model, start)
        record.peak = start.multiplier
        return _resumed(model, factor, start, plan, record)
    record.keep(partial(_load_step, model, start))
    first = first_step(model, factor, start, plan.scale)
    if not first.found:
        least = f"{first.multiplier:.2g} times the live load, the least step tried"
        sentence = f"the dead load is in equilibrium, but {least}, is not"
        return HistoryResult(plan, PathEnd.BREAKDOWN, sentence, record, None, 0, 0.0)
    if plan.step == 0.0 and model.assembly.n_free > plan.options.doubled:
        for further in doubled(model, factor, first):
            first = further
            _note(record, model, first)
    return _followed(PathFollower.from_rest(model, factor, first), plan, record)


def _followed(follower: PathFollower, plan: HistoryPlan, record: PathRecord) -> HistoryResult:
    """What following a path from where the follower stands leads to. Raises OutOfTime and SingularTangent as above."""
    model, scale = follower.model, plan.scale
    interval = plan.step * scale or np.inf
    way = follow(
        follower, record, plan.max_events, interval, plan.options.astray * scale, committed_up_to=plan.committed_up_to
    )
    follower, end = way.follower, way.end
    record.keep(follower.load_step, always=True)
    state = (
        finish(model, follower.present(), follower.kept)
        if end in (PathEnd.PLATEAU, PathEnd.BREAKDOWN, PathEnd.EVENTS)
        else None
    )
    sentence = SENTENCES[end]
    if state is not None and state.multiplier < 0.0:
        state, end, sentence = None, PathEnd.RUNS_DOWN, _BELOW_ZERO
    elif state is None and end == PathEnd.PLATEAU:
        sentence = _not_collapse(model, follower.present())
    if plan.committed_up_to < np.inf:
        sentence += f"; plastic slip updated up to {plan.committed_up_to:.4g} only: later updates lost the path"
    return HistoryResult(plan, end, sentence, record, state, way.commits, way.residual)


def _not_collapse(model: WallModel, last: PathSnapshot) -> str:
    """Why a last piece that moves is no collapse state."""
    moving = model.moving_blocks(model.block_displacements(last.velocity))
    if model.idle_blocks.issuperset(moving):
        return (
            f"blocks without weight or load move freely ({first_few(moving, 8)}), in an undetermined direction: "
            "give every block a weight, however small"
        )
    if does_no_work(model.live, last.velocity):
        return (
            f"at {last.multiplier:.7g} times the live load the wall moves by a mechanism on which that does no work, "
            "as where it takes pressure off a joint that slides: it is no collapse state"
        )
    return "the last piece is a mechanism, but its forces do not pass the check of an exact collapse state"


def _note(record: PathRecord, model: WallModel, rest: Equilibrium) -> None:
    """Add an equilibrium to the record."""
    slipping = int(np.count_nonzero(rest.state >= SLIP_PLUS))
    step = _load_step(model, rest)
    opened, bars = int(np.count_nonzero(rest.state == OPEN)), model.bar_tensions(step.trial)
    record.add(rest.multiplier, float(model.live @ rest.u), slipping, opened, bars)
    record.keep(lambda: step)


def _load_step(model: WallModel, rest: Equilibrium) -> PathStep:
    """An equilibrium, kept whole."""
    opening, slip = model.strains(rest.u)
    return PathStep(rest.multiplier, rest.u, opening, model.kt * slip + rest.history, rest.state)
