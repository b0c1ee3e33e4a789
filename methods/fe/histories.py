"""One path from gravity to collapse under one friction history, and the spread over several.

Real joints remember in which order they slipped. A history commits the shears (T0, s0) every so often along the path;
none, 1 % and 0.2 % of the multiplier are the three that the answer is reported for. What they differ by is scatter
from data nobody can know.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from harness.model.assembly import FloatArray
from methods.fe.continuation import Tracer
from methods.fe.factor import Factor
from methods.fe.newton import Equilibrium, equilibrium, newton
from methods.fe.path_record import PathEnd, PathRecord
from methods.fe.plateau import CollapseState, finish
from methods.fe.wall_model import WallModel

START = 1e-3
"""First Newton step off the kinks on which gravity leaves many gap points, as a multiplier."""


@dataclass(frozen=True)
class HistoryResult:
    """One history traced to its end.

    Attributes:
        step: commit interval as a share of the multiplier scale; 0 for none.
        end: why the path ended; sentence: what a reader should know about it.
        record: the path; state: the collapse state when a plateau was reached and passed its check, else None.
    """

    step: float
    end: PathEnd
    sentence: str
    record: PathRecord
    state: CollapseState | None
    commits: int
    residual: float


def trace_history(
    model: WallModel, factor: Factor, gravity: Equilibrium, step: float, scale: float, max_events: int
) -> HistoryResult:
    """Trace one history from the gravity state.

    Args:
        model: the wall; factor: its tangent; gravity: equilibrium under the dead load.
        step: commit interval as a share of `scale`, 0 for no history; scale: a multiplier of the order of collapse.
        max_events: changes of state after which the history is given up.
    """
    record = PathRecord()
    history, u, multiplier = model.history, gravity.u, 0.0
    interval = step * scale if step > 0.0 else np.inf
    commits = 0
    tracer: Tracer | None = None
    end = PathEnd.BREAKDOWN
    start = START * min(1.0, scale)
    while True:
        if tracer is None:
            first = equilibrium(model, factor, u, start, history)
            if not first.found:
                return HistoryResult(step, end, "no equilibrium a small step off the dead load", record, None, 0, 0.0)
            tracer = Tracer(model, factor, first.u, start, history, first.state)
        target = tracer.multiplier + interval
        end = tracer.run(record, max_events, target=target)
        if end != PathEnd.TARGET:
            break
        u, multiplier = tracer.u, tracer.multiplier
        fresh = tracer.commit()
        for ahead in (1.0, 0.1, 0.01):
            if not record.peak <= multiplier:
                break
            answer = newton(model, factor, u, multiplier + ahead * interval, fresh, 15)
            if answer.found:
                commits += 1
                tracer = Tracer(model, factor, answer.u, multiplier + ahead * interval, fresh, answer.state)
                record.peak = max(record.peak, tracer.multiplier)
                break
        else:
            tracer = Tracer(model, factor, u, multiplier, tracer.history, tracer.state)
    state = finish(tracer) if end == PathEnd.PLATEAU else None
    sentence = f"the path ended: {end.value}"
    if state is not None and state.worst > CERTIFICATE:
        sentence = f"the last state is no exact collapse state (worst residual {state.worst:.1e})"
        state = None
    return HistoryResult(step, end, sentence, record, state, commits, tracer.worst_residual)


def gravity_state(model: WallModel, factor: Factor) -> Equilibrium:
    """Equilibrium under the dead load from the virgin state."""
    return equilibrium(model, factor, np.zeros(model.n_unknowns), 0.0, model.history)


def moving_blocks(model: WallModel, mechanism: FloatArray) -> list[str]:
    """Names of the blocks that move in a mechanism (n, 3): faster than a millionth of the fastest."""
    speed = np.abs(mechanism * np.array([1.0, 1.0, model.length])).max(axis=1)
    return [model.assembly.block_ids[i] for i in np.flatnonzero(speed > 1e-6 * speed.max(initial=0.0))]
