"""The gap-spring methods `fe`, `fe-newton` and `fe-qp`."""

from __future__ import annotations

import math
from dataclasses import replace
from importlib import import_module
from typing import Any

import numpy as np

from harness.model.assembly import Assembly
from harness.model.load_steps import NAME
from harness.model.method import Answer, Finding, Solver, Status
from methods.fe.answers import (
    collapse_answer,
    compact,
    falling,
    gravity_failure,
    single_state_answer,
    standing_answer,
    stands,
)
from methods.fe.brittle import brittle_answer
from methods.fe.convex_steps import bracket_answer, bracket_collapse
from methods.fe.histories import HistoryPlan, HistoryResult, HistoryTuning, trace_history
from methods.fe.incremental import IncrementalResult, march
from methods.fe.settings import GapSpringsSettings, NewtonSettings
from methods.numerics.crushing_claims import falls_by_statics
from methods.numerics.residual_strength import by_component
from methods.numerics.statics import admissible_forces
from methods.numerics.tangent_search import by_tangents
from methods.springs.model.factor import Factor, make_factor
from methods.springs.model.wall_model import WallModel, build_model
from methods.springs.path.path_record import PathEnd
from methods.springs.rest.equilibrium import equilibrium, gravity_state
from methods.springs.rest.newton import Equilibrium
from methods.springs.warm_up import load_kernels

_FEWEST = 2000
"""Events up to which every history is traced."""
_FIRST = 30
"""Events more for every gap point on the first history. Walls in courses come to a plateau after 1 to 8 events a point,
two walls of 400 irregular blocks after 20 and 26."""
_FURTHER = 5
"""The same on histories after the first."""
_FEWEST_BESIDE = 500
"""Events above which, once a history reached its plateau, the next are given up."""
_MULTIPLE = 4
"""Multiple of the events of that history above which they are given up."""
_INTERVALS = (0.0, 0.01, 0.002)
"""Of commits, as shares of the multiplier, by default."""
_THREE = 1200
"""Blocks above which only the first of these intervals has a history."""
_AGREEING = 1e-3
"""Relative difference of the first two plateaus up to which no third history is traced by default: published values of
gap springs agree within as much."""

load_kernels()


class GapSprings(Solver):
    """Gap-spring finite elements with the path traced exactly, breakpoint by breakpoint (`fe`)."""

    def solve(self, assembly: Assembly, settings: Any) -> Answer:
        """Gravity first, then the live load to the plateau under every history asked for."""
        if assembly.breaks:
            events = _FEWEST + _FIRST * settings.points * assembly.n_interfaces
            most = settings.max_events or events
            return brittle_answer(assembly, settings, _unit(assembly), most)
        return by_component(assembly, lambda part: self._of_component(part, settings))

    def _of_component(self, assembly: Assembly, settings: Any) -> Answer:
        if assembly.crushes:
            return falls_by_statics(assembly) or by_tangents(assembly, lambda wall: self._of_component(wall, settings))
        answer = self._solve(build_model(assembly, settings, settings.friction_cap), settings)
        if answer.finding != Finding.COLLAPSES and float(assembly.friction.max(initial=0.0)) > settings.friction_cap:
            answer = self._solve(build_model(assembly, settings), settings)
        return answer

    def _solve(self, model: WallModel, settings: GapSpringsSettings) -> Answer:
        if model.dilates and any(settings.histories or ()):
            return _refused(
                "the plastic slip is not updated where joints dilate, because its lift would have to be too: leave "
                "`histories` out, or give 0 alone"
            )
        factor = make_factor(model)
        gravity = gravity_state(model, factor)
        if not gravity.found:
            return gravity_failure(model, gravity)
        if not model.assembly.has_live_load:
            return stands(model, gravity)
        if settings.initial_shear > 0.0:
            model = _with_initial_shear(model, gravity, settings.initial_shear, settings.seed)
            gravity = equilibrium(model, factor, gravity.u, 0.0, model.history)
            if not gravity.found:
                return gravity_failure(model, gravity)
        results, start = list[HistoryResult](), gravity
        scale = _unit(model.assembly)
        tuning = HistoryTuning()
        limit, further = (settings.max_events or _FEWEST + count * model.n_points for count in (_FIRST, _FURTHER))
        for step in _chosen_histories(model, settings):
            if settings.histories is None and _agree(results, _AGREEING):
                break
            plan = HistoryPlan(step, scale, limit, load_steps=settings.load_steps, options=tuning)
            result = trace_history(model, factor, start, plan)
            results.append(result)
            start = result.raised or start
            if result.end in (PathEnd.UNBOUNDED, PathEnd.TIME):
                break
            limit = min(limit, further)
            if result.state is None and 0.0 < result.record.peak < np.inf:
                scale = result.record.peak
            elif result.state is not None:
                scale = abs(result.state.multiplier) or 1.0
                limit = min(limit, _FEWEST_BESIDE + _MULTIPLE * result.record.events)
        answer = collapse_answer(model, results, factor.factorisations, settings.load_steps)
        lost = results and all(r.state is None and r.end is PathEnd.BREAKDOWN for r in results)
        if lost and model.assembly.n_free <= tuning.large:
            return _by_displacement_control(model, factor, gravity, answer)
        return answer


def _by_displacement_control(model: WallModel, factor: Factor, gravity: Equilibrium, lost: Answer) -> Answer:
    """The plateau that ordinary Newton reaches where every exact path was lost, or else the answer that says so.

    Among them are walls at their limit under the dead load, which move at any live load: no path leads off them; and
    walls that fall under it by less than is seen beside what their ties and props could bear, which have no plateau.
    """
    if admissible_forces(model.assembly, model.assembly.dead) is None:
        return lost
    newton = NewtonSettings()
    model = replace(model, history=gravity.history)
    first_step = newton.first_step * _unit(model.assembly)
    result = march(model, factor, gravity, first_step, newton.cuts, newton.displacement_steps)
    if result.unbounded:
        return _incremental_answer(model, result, f"{result.sentence}; the exact path was lost", lost.details)
    if result.state is None:
        return lost
    sentence = f"{result.sentence}; the exact path was lost ({lost.sentence})"
    details = {k: v for k, v in lost.details.items() if k != NAME} | {"displacement_control": True}
    return single_state_answer(model, result.state, sentence, result.record, details, result.iterations)


def _chosen_histories(model: WallModel, settings: GapSpringsSettings) -> tuple[float, ...]:
    """The commit intervals to run: as set, or by the size of the wall; none where joints dilate."""
    if settings.histories is not None:
        return settings.histories
    updates = model.assembly.n_free <= _THREE and not model.dilates
    return _INTERVALS if updates else _INTERVALS[:1]


def _agree(results: list[HistoryResult], within: float) -> bool:
    """Whether histories without and with updates of the plastic slip came to one plateau, within a relative width."""
    plateaus = [result.state.multiplier for result in results if result.state is not None]
    if len(plateaus) < 2 or len(plateaus) < len(results):
        return False
    return max(plateaus) - min(plateaus) <= within * abs(min(plateaus))


def _unit(assembly: Assembly) -> float:
    """The load unit rounded to a power of two: a live load that is given so many times larger is marched up alike."""
    return 2.0 ** round(math.log2(assembly.load_unit))


def _incremental_answer(model: WallModel, result: IncrementalResult, sentence: str, details: dict[str, Any]) -> Answer:
    """The answer of ordinary Newton that came to no collapse state: unbounded, or without an end."""
    return Answer(
        Status.OK if result.unbounded else Status.NOT_CONVERGED,
        Finding.UNBOUNDED if result.unbounded else Finding.NONE,
        sentence,
        iterations=result.iterations,
        path=compact(model, result.record),
        details=details | {"path_status": "unbounded" if result.unbounded else "not_converged"},
    )


class IncrementalNewton(Solver):
    """Ordinary incremental Newton: load control, then displacement control (`fe-newton`)."""

    def solve(self, assembly: Assembly, settings: Any) -> Answer:
        """March as a general code does; a value only where a mechanism was reached and checked."""
        return by_component(assembly, lambda part: self._of_component(part, settings))

    def _of_component(self, assembly: Assembly, settings: Any) -> Answer:
        model = build_model(assembly, settings)
        factor = make_factor(model)
        gravity = gravity_state(model, factor)
        if not gravity.found:
            return gravity_failure(model, gravity)
        if not assembly.has_live_load:
            return stands(model, gravity)
        first_step = settings.first_step * _unit(assembly)
        model = replace(model, history=gravity.history)
        result = march(model, factor, gravity, first_step, settings.cuts, settings.displacement_steps)
        details = {"load_control_limit": result.load_control, "gap_points": model.n_points}
        if result.state is not None:
            return single_state_answer(model, result.state, result.sentence, result.record, details, result.iterations)
        return _incremental_answer(model, result, result.sentence, details)


class ConvexSteps(Solver):
    """Each step as convex quadratic programmes with frozen friction limits (`fe-qp`)."""

    def prepare(self) -> None:
        """Import the solver of the programmes."""
        import_module("osqp")

    def solve(self, assembly: Assembly, settings: Any) -> Answer:
        """Bracket the multiplier at which the steps lose their equilibrium; refused above the set number of blocks."""
        return by_component(assembly, lambda part: self._of_component(part, settings))

    def _of_component(self, assembly: Assembly, settings: Any) -> Answer:
        if assembly.n_free > settings.max_blocks:
            return _refused(
                f"{assembly.n_free} blocks: the convex steps are a cross-check for up to {settings.max_blocks} blocks, "
                "above which their fixed-point iteration is too slow; use fe"
            )
        model = build_model(assembly, settings, settings.friction_cap)
        first_step = settings.first_step * _unit(assembly)
        result = bracket_collapse(model, first_step, settings.resolution, settings.fixed_points)
        details = {"programmes": result.programmes, "gap_points": model.n_points}
        if result.fall is not None:
            return falling(model, result.fall, "the energy has no minimum under the dead load", result.programmes)
        if not result.gravity:
            return Answer(
                Status.NOT_CONVERGED,
                Finding.NONE,
                "no equilibrium was found under the dead load alone; fe decides whether the wall falls",
                iterations=result.programmes,
                details=details | {"path_status": "not_converged"},
            )
        assert result.forces is not None
        forces = model.end_forces(*result.forces)
        if not assembly.has_live_load:
            return standing_answer(forces, result.programmes, details | {"path_status": "stands"})
        return bracket_answer(result, forces, details)


def _refused(why: str) -> Answer:
    """The answer of a method that does not take a wall, or not with these settings."""
    return Answer(Status.REFUSED, Finding.NONE, why, details={"path_status": "refused"})


def _with_initial_shear(model: WallModel, gravity: Equilibrium, share: float, seed: int) -> WallModel:
    """The model with shears frozen in before the live load: a random share of what friction holds under gravity."""
    normal, _ = model.forces(gravity.u, gravity.history, gravity.state)
    noise = np.random.default_rng(seed).uniform(-share, share, model.n_points)
    frozen = model.law.part_by_friction(noise, normal)
    return replace(model, history=model.updated(frozen, model.history))
