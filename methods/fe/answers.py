"""What the gap-spring methods say, put into the words of the harness."""

from __future__ import annotations

from typing import Any

import numpy as np

from harness.model.assembly import FloatArray, IntArray
from harness.model.bars import path_column
from harness.model.breakpoints import CHANGE, CHANGES, JOINT, NO_JOINT
from harness.model.errors import first_few
from harness.model.load_steps import STATES, LoadSteps
from harness.model.method import Answer, Finding, Status
from methods.fe.histories import HistoryResult
from methods.springs.model.gap_law import OPEN, SLIP_MINUS, SLIP_PLUS, STICK, gap_forces
from methods.springs.model.wall_model import WallModel
from methods.springs.path.path_record import PathEnd, PathRecord, PathStep
from methods.springs.path.plateau import PlateauState
from methods.springs.rest.newton import Equilibrium

_PATH_POINTS = 300
"""Points of a path that an answer keeps, at most."""

SPREAD = 0.025
"""Spread of the histories, as a share of the multiplier, above which the sentence of an answer reports it."""


def gravity_failure(model: WallModel, gravity: Equilibrium) -> Answer:
    """The answer for a wall that falls under its dead load, or for a gravity step that did not end."""
    if not np.any(gravity.rate):
        return Answer(
            Status.NOT_CONVERGED,
            Finding.NONE,
            "the equilibrium under the dead load was not found",
            details={"path_status": "not_converged"},
        )
    return falling(model, gravity.rate, "the gap springs find no equilibrium", gravity.iterations)


def falling(model: WallModel, rate: FloatArray, why: str, iterations: int) -> Answer:
    """The answer for a wall that falls under its dead load along displacements (N,), which are approximate.

    `methods.numerics.claims.with_proof` adds the dilatant mechanism that proves the fall.
    """
    motion = model.block_displacements(rate)
    blocks = model.moving_blocks(motion, model.options.newton.falling)
    return Answer(
        Status.OK,
        Finding.FALLS,
        f"the wall falls under its dead load: {why} for {first_few(blocks, 8)}",
        mechanism=motion / np.abs(motion).max(),
        flow="approximate",
        iterations=iterations,
        details={"path_status": "gravity_failure", "moving_blocks": blocks},
    )


def stands(model: WallModel, gravity: Equilibrium) -> Answer:
    """The answer for a wall without live load that is in equilibrium under its dead load, with its gap forces."""
    normal, shear = model.forces(gravity.u, gravity.history, gravity.state)
    return standing_answer(
        model.end_forces(normal, shear), gravity.iterations, {"path_status": "stands", "residual": gravity.residual}
    )


def standing_answer(forces: FloatArray, iterations: int, details: dict[str, Any]) -> Answer:
    """The answer for a wall that stands by the contact forces (m, 3) under its dead load."""
    return Answer(
        Status.OK,
        Finding.STANDS,
        "the wall is in equilibrium under its dead load; no live load is given",
        forces=forces,
        forces_multiplier=0.0,
        iterations=iterations,
        details=details,
    )


def collapse_answer(model: WallModel, results: list[HistoryResult], factorisations: int, most_steps: int = 0) -> Answer:
    """The answer from the histories: the plateau of the first that reached one, with the spread.

    Args:
        most_steps: load steps of its path in the details, 0 for none.
    """
    reached = [r for r in results if r.state is not None]
    details: dict[str, Any] = {
        "histories": [
            {
                "step": r.plan.step,
                "end": r.end.value,
                "sentence": r.sentence,
                "plateau": r.state.multiplier if r.state else None,
                "peak": r.record.peak if np.isfinite(r.record.peak) else None,
                "first_limit": r.record.first_limit,
                "events": r.record.events,
                "commits": r.commits,
                "path_residual": r.residual,
                "committed_up_to": r.plan.committed_up_to if np.isfinite(r.plan.committed_up_to) else None,
                "disturbance": r.plan.disturbance,
                "raised_to": r.raised.multiplier if r.raised else None,
                "residuals": r.state.residuals if r.state else None,
            }
            for r in results
        ],
        "gap_points": model.n_points,
        "factorisations": factorisations,
        "events": sum(r.record.events for r in results),
    }
    iterations = int(details["events"])
    if most_steps and results:
        shown = (reached or results)[0].record.steps
        details |= _load_steps(model, shown, most_steps).as_details() if shown else {}
    if not reached:
        if results and results[0].end == PathEnd.UNBOUNDED:
            details["path_status"] = "unbounded"
            return Answer(
                Status.OK,
                Finding.UNBOUNDED,
                "the live load cannot make the wall collapse: the path continues to any multiplier",
                iterations=iterations,
                details=details,
            )
        peaked = [r for r in results if r.end in (PathEnd.RUNS_DOWN, PathEnd.TURNED_DOWN)]
        details["path_status"] = "peak_only" if peaked else "not_converged"
        if any(r.end is PathEnd.TIME for r in results):
            details["stopped_by_limit"] = True
        reason = results[0].sentence if results else "no history is selected"
        return Answer(
            Status.NOT_CONVERGED,
            Finding.NONE,
            f"no plateau was reached: {reason}",
            iterations=iterations,
            path=compact(model, results[0].record) if results else {},
            details=details,
        )
    best = reached[0]
    assert best.state is not None
    plateaus = [r.state.multiplier for r in reached if r.state is not None]
    spread = (max(plateaus) - min(plateaus)) / max(abs(min(plateaus)), 1e-12)
    details |= {
        "path_status": "plateau",
        "first_limit": best.record.first_limit if best.record.first_limit is not None else best.record.peak,
        "peak": best.record.peak,
        "plateau": best.state.multiplier,
        "spread": spread if len(reached) > 1 else None,
        "moving_blocks": model.moving_blocks(best.state.mechanism),
        "residuals": best.state.residuals,
        "work_multiplier": best.state.work_multiplier,
    }
    sentence = (
        f"the wall collapses at {best.state.multiplier:.6g} times the live load (plateau; peak {best.record.peak:.6g})"
    )
    if best.raised is not None:
        sentence += f"; up to {best.raised.multiplier:.4g} the load was raised in finite steps between states of rest"
    if spread > SPREAD:
        sentence += (
            f"; the friction history is unknown; histories differ by {100.0 * spread:.1f} %, "
            f"from {min(plateaus):.6g} to {max(plateaus):.6g}"
        )
    if len(results) == 1:
        sentence += "; one friction history, so the spread over histories is unknown"
    lost = len(results) - len(reached)
    if lost:
        sentence += f"; {lost} of {len(results)} histories reached no plateau"
    return Answer(
        Status.OK,
        Finding.COLLAPSES,
        sentence,
        multiplier=best.state.multiplier,
        forces=best.state.forces,
        mechanism=best.state.mechanism,
        iterations=iterations,
        path=compact(model, best.record),
        details=details,
    )


def compact(model: WallModel, record: PathRecord) -> dict[str, list[float]]:
    """Some of the points of a path, evenly picked, the last one kept, with what changes there where that is known."""
    count = len(record.multiplier)
    pick = np.unique(np.linspace(0, count - 1, min(count, _PATH_POINTS)).astype(int)) if count else np.array([], int)
    bars = [model.assembly.joint[p] for p in np.flatnonzero(model.assembly.is_bar)]
    scale = model.displacement / (float(np.abs(model.live.reshape(-1, 3)[:, :2]).sum()) or 1.0)
    changes = [record.change[i] for i in pick]
    columns = {
        "multiplier": [record.multiplier[i] for i in pick],
        "live_displacement": [record.displacement[i] * scale for i in pick],
        "slipping_points": [float(record.slipping[i]) for i in pick],
        "open_points": [float(record.open[i]) for i in pick],
    } | {path_column(name): [record.bars[i][k] for i in pick] for k, name in enumerate(bars)}
    return columns | (_breakpoints(model, changes) if any(changes) else {})


def _breakpoints(model: WallModel, changes: list[tuple[int, int, int] | None]) -> dict[str, list[float]]:
    """Columns of a path that say which joint changes, and how (`harness.model.breakpoints`); a bar is no joint."""
    found = [(NO_JOINT, NO_JOINT)] * len(changes)
    for k, change in enumerate(changes):
        if change is not None and not model.assembly.is_bar[change[0]]:
            joint, old, new = change
            what = "opens" if new == OPEN else "closes" if old == OPEN else "sticks" if new == STICK else "slides"
            found[k] = joint, CHANGES.index(what)
    return {JOINT: [float(joint) for joint, _ in found], CHANGE: [float(what) for _, what in found]}


def single_state_answer(
    model: WallModel, state: PlateauState, sentence: str, record: PathRecord, details: dict[str, Any], iterations: int
) -> Answer:
    """The answer of a method that ended in one checked collapse state."""
    return Answer(
        Status.OK,
        Finding.COLLAPSES,
        f"the wall collapses at {state.multiplier:.6g} times the live load: {sentence}",
        multiplier=state.multiplier,
        forces=state.forces,
        mechanism=state.mechanism,
        iterations=iterations,
        path=compact(model, record),
        details=details
        | {
            "path_status": "plateau",
            "residuals": state.residuals,
            "moving_blocks": model.moving_blocks(state.mechanism),
        },
    )


def _load_steps(model: WallModel, steps: list[PathStep], most: int) -> LoadSteps:
    """At most so many of the steps of a path (one at least), evenly picked, the first and the last among them."""
    pick = np.unique(np.linspace(0, len(steps) - 1, min(len(steps), most)).astype(int))
    kept = [steps[-1]] if most == 1 else [steps[k] for k in pick]
    normal, shear = np.empty(model.n_points), np.empty(model.n_points)
    joints = ~model.assembly.is_bar
    forces = []
    for step in kept:
        gap_forces(step.opening, step.trial, model.kn, model.mu, model.lift, step.state, normal, shear)
        forces.append(model.end_forces(normal, shear)[joints])
    return LoadSteps(
        model.assembly.block_ids,
        np.array([step.multiplier for step in kept]),
        np.array([model.block_displacements(step.u) for step in kept]),
        np.array(forces),
        np.array([joint_states(model, step.state)[joints] for step in kept]),
    )


def joint_states(model: WallModel, state: IntArray) -> IntArray:
    """(m,) places in `STATES` of the interfaces whose gap points are in the given states (P,)."""
    m, contacts = model.assembly.n_interfaces, model.n_contacts
    interface, position = model.interface[:contacts], model.position[:contacts]

    def every(holds: np.ndarray) -> np.ndarray:
        return np.asarray(np.bincount(interface, ~holds[:contacts], m) == 0)

    open_ = state == OPEN
    slides = (state == SLIP_PLUS) | (state == SLIP_MINUS)
    end = (position == 0.0) | (position == 1.0)
    slips = every(slides | open_)
    slips[model.cohesive] &= slides[contacts:]
    names = np.where(slips, STATES.index("slip"), STATES.index("stick"))
    names[~every(~(open_[:contacts] & end))] = STATES.index("rock")
    names[every(open_)] = STATES.index("open")
    return np.asarray(names, dtype=np.int64)
