"""`de-soft`: distinct elements with deformable joints and rounded corners, at large displacements.

The model is that of UDEC (Cundall 1987): joints have a stiffness, leaning blocks add to the load (P-Delta), and corners
roll. `methods.de.engines.soft_wall` has the equations of motion. With stiff joints and small radii the multiplier is
that of the other methods; the reduction by softer joints and larger radii is the result of interest.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from harness.model.assembly import Assembly, FloatArray
from harness.model.deadline import Deadline, best_so_far
from harness.model.method import Answer, Finding, Solver, Status
from methods.de.engines.engine import motion_units
from methods.de.engines.mass_scaling import courses, number_of_courses
from methods.de.engines.soft_wall import SoftWall
from methods.de.holds.bracket_state import SEARCH_STOPPED, undecided, unmoved
from methods.de.holds.load_step import ConvergenceMonitor, LoadStep, State
from methods.de.holds.loading import raise_until_it_falls
from methods.de.holds.motion import MotionProof, StaticLimit, by_travel
from methods.de.holds.order_bracket import LOOSE
from methods.de.settings import LOOK, RISE, SoftSettings
from methods.numerics.claims import at_limit, with_proof

SHARE = 2e-3
"""Of a small multiplier to which its bracket is narrowed, and of an undecided one the first rise above it, which
doubles until the wall falls."""
_LOW = 7
"""Courses up to which a hold is no longer than `hold_steps`; above, with the square of the courses."""
_PATIENCE = 10
"""Multiple of the length of a hold that the dead load has."""
_AWAY = 300.0
"""Multiple of what the blocks had moved at the last rest from which it is asked whether the wall falls."""

_FAR = 0.01
"""Length scales that a block has gone under one load from where on what joints give is little beside its motion, and
the motion changes with the shape of the wall."""

_BRACKET_MEANING = "[highest multiplier at which it came to rest, lowest at which it fell]"

STIFFNESS = 1e6
"""Of joints where none is given, in mean dead loads of a block over the square of the length scale: as good as rigid on
low walls."""

ROUNDING = 2e-4
"""Radius of corners where none is given, in length scales."""


@dataclass(eq=False)
class Holds:
    """The wall held under one multiplier after another, from rest to rest.

    Attributes:
        wall, settings: what is held, and how.
        rest: the last rest.
        motion, proof: (n, 3) displacements of the last fall under one load, and what shows that it is one.
        fell: multiplier of that fall.
        undecided: multipliers at which the wall neither rested nor fell.
        path: multiplier and displacement of the live load at every rest.
    """

    wall: SoftWall
    settings: SoftSettings
    rest: tuple[FloatArray, FloatArray] = field(init=False)
    motion: FloatArray | None = None
    proof: MotionProof | None = None
    fell: float | None = None
    undecided: list[float] = field(default_factory=list)
    path: dict[str, list[float]] = field(default_factory=lambda: {"multiplier": [], "live_displacement": []})

    def __post_init__(self) -> None:
        """The wall as it is."""
        self.rest = self.wall.save()
        self._statics = StaticLimit(self.wall.assembly)
        high = number_of_courses(courses(self.wall.assembly)) / _LOW
        self._looks = int(self.settings.hold_steps * max(1.0, high**2)) // LOOK

    def rests(self, multiplier: float) -> bool:
        """Whether the wall comes to rest at a multiplier; if not it is put back where it rested last."""
        return self.hold(multiplier) is State.HELD

    def hold(self, multiplier: float) -> State:
        """Hold the wall at a multiplier from its last rest, and note what came of it."""
        wall = self.wall
        wall.load(multiplier)
        end = self._settled(self._looks * (1 if multiplier else _PATIENCE))
        state = end.state
        if state is State.HELD:
            self.rest = wall.save()
            self.path["multiplier"].append(multiplier)
            self.path["live_displacement"].append(_live_displacement(wall))
            return state
        if state is State.MOVING:
            self.motion, self.proof, self.fell = end.velocity, end.proof, multiplier
            self.motion = self._followed(end)
        else:
            self.undecided.append(multiplier)
        wall.restore(self.rest)
        return state

    def _settled(self, looks: int) -> LoadStep:
        """What the wall does under its load within so many looks, or within twenty times its own slowest relaxation.

        `methods.de.holds.motion` says whether it moves: asked at each doubling of the looks, where a block has come far
        beyond what any had moved until then, and at the end.
        """
        wall, settings = self.wall, self.settings
        before = self.rest[0]
        load = wall.assembly.dead + wall.multiplier * wall.assembly.live
        away = _AWAY * float(np.abs(before[:, :2]).max()) if np.any(before[:, :2]) else np.inf
        watch = ConvergenceMonitor(settings.held_residual, settings.held_residual, motion_units(wall.assembly))
        places, start = before, wall.steps
        affordable, deadline = settings.relaxations * looks, Deadline.of_run()
        while True:
            deadline.ask()
            residual = wall.advance(LOOK)
            moved, places = wall.places - places, wall.places.copy()
            watch.note(moved, residual)
            if residual < settings.held_residual or not np.all(np.isfinite(places)):
                state = State.HELD if residual < settings.held_residual else State.UNDECIDED
                return LoadStep(state, residual, wall.steps - start, places - before)
            over = watch.over(looks, affordable, settings.relaxations)
            motion = by_travel(wall.assembly, load, places - before, settings.reach)
            far = float(np.abs((places - before)[:, :2]).max(initial=0.0)) > away
            if motion is None and (over or watch.doubled or far):
                motion = watch.motion(wall, self._statics)
                away *= 2.0 if far else 1.0
            if motion is not None:
                return LoadStep(State.MOVING, residual, wall.steps - start, places - before, motion.proof)
            if over:
                return LoadStep(State.UNDECIDED, residual, wall.steps - start, places - before)

    def _followed(self, fall: LoadStep) -> FloatArray:
        """Displacements (n, 3) of a fall for as long again as it took to show, until a block has gone `_FAR`.

        What comes before is in part what joints give while forces pass from one to another: blocks seem to penetrate.
        Where a block had gone as far when the fall was shown, its displacements are those until then.
        """
        wall, shown = self.wall, self.wall.places.copy()
        far, end = _FAR * wall.assembly.length_scale, wall.steps + fall.steps
        while wall.steps < end and float(np.abs((wall.places - self.rest[0])[:, :2]).max()) < far:
            Deadline.of_run().ask()
            wall.advance(LOOK)
        return fall.velocity if np.array_equal(wall.places, shown) else wall.places - shown


class DeformableJoints(Solver):
    """Distinct elements with deformable joints and rounded corners (`de-soft`)."""

    def solve(self, assembly: Assembly, settings: SoftSettings) -> Answer:
        """The bracket [rested, fell] as the live load grows from rest to rest."""
        if assembly.n_free == 0:
            return Answer(Status.OK, Finding.STANDS, "every block is fixed: nothing can move")
        mean = assembly.force_scale / assembly.n_free
        stiffness = settings.stiffness or STIFFNESS * mean / assembly.length_scale**2
        answer = self._with_joints(assembly, settings, stiffness, ROUNDING * assembly.length_scale)
        factor = _too_soft(answer, settings)
        if settings.stiffness is None and factor > 1.0 and not answer.details.get("stopped_by_limit"):
            rounding = ROUNDING / factor * assembly.length_scale
            again = self._with_joints(assembly, settings, factor * stiffness, rounding)
            again.iterations += answer.iterations
            answer = _better(answer, again)
        return with_proof(assembly, at_limit(assembly, saying_soft(answer, settings)))

    def _with_joints(self, assembly: Assembly, settings: SoftSettings, stiffness: float, round_by: float) -> Answer:
        """The answer with joints of one stiffness [force/length^2], corners rounded by so much where nothing is set."""
        rounding = settings.rounding or round_by
        wall = SoftWall(assembly, stiffness, settings.shear_ratio, rounding)
        holds = Holds(wall, settings)
        joints = _described(wall, stiffness, settings.shear_ratio)
        answer = best_so_far(
            lambda: self._at_zero(assembly, holds, joints) or self._loaded(holds, joints, assembly.load_unit),
            lambda: _stopped(holds, joints),
        )
        answer.iterations, answer.path, answer.flow = wall.steps, holds.path, "approximate"
        answer.forces_multiplier = holds.path["multiplier"][-1] if holds.path["multiplier"] else None
        if answer.finding in (Finding.COLLAPSES, Finding.FALLS):
            answer.mechanism = None if holds.motion is None else _velocities_of(holds.motion)
        answer.details |= _details(holds, stiffness)
        return answer

    def _loaded(self, holds: Holds, joints: str, unit: float) -> Answer:
        """The answer for a wall that stands its dead load, in multiples of the multiplier that equals it."""
        settings = holds.settings
        cap = settings.load_cap * unit
        step, accuracy, share = settings.load_step * unit, settings.accuracy * unit, SHARE
        stood, fell = raise_until_it_falls(holds.rests, cap, step, accuracy, settings.load_growth, share)
        if fell is not None:
            stood, fell = _in_small_steps(holds, stood, min(accuracy, share * fell))
        return _concluded(holds, joints, stood, fell, cap)

    def _at_zero(self, assembly: Assembly, holds: Holds, joints: str) -> Answer | None:
        """The answer where the dead load decides; None where the wall stands it and a live load follows."""
        state = holds.hold(0.0)
        if state is State.MOVING:
            return Answer(Status.OK, Finding.FALLS, f"falls under its dead load, with {joints}")
        if state is State.UNDECIDED:
            sentence = "whether the dead load is held is not decided: the wall neither came to rest nor fell"
            return Answer(Status.NOT_CONVERGED, Finding.NONE, sentence)
        if not assembly.has_live_load:
            return Answer(Status.OK, Finding.STANDS, f"comes to rest under its dead load, with {joints}")
        return None


def _in_small_steps(holds: Holds, stood: float, step: float) -> tuple[float, float]:
    """On from the last rest as long as the wall comes to rest: after smaller steps it swings less, and bears more."""
    while holds.rests(stood + step):
        stood += step
    return stood, stood + step


def _concluded(holds: Holds, joints: str, stood: float, fell: float | None, cap: float) -> Answer:
    """The answer for a wall that stands its dead load."""
    if fell is None:
        sentence = (
            f"at rest up to the cap: the live load was raised to {cap:.6g}, with {joints}; larger loads were not tried"
        )
        return Answer(Status.OK, Finding.UNBOUNDED, sentence, details={"cap": cap})
    if fell in holds.undecided:
        fell = fall_above(holds, fell, cap)
    if fell is None:
        sentence = f"came to rest at {stood:.6g} and neither came to rest nor fell above it, with {joints}"
        return Answer(Status.NOT_CONVERGED, Finding.NONE, sentence)
    moved = holds.path["live_displacement"][-1]
    sentence = (
        f"came to rest at {stood:.6g} and fell at {fell:.6g}, with {joints}; the live load had moved by {moved:.3g} "
        "at the last state of rest"
    )
    loose = fell - stood > LOOSE * fell
    if loose:
        sentence += "; not converged: between them it neither came to rest nor fell"
    return Answer(
        Status.NOT_CONVERGED if loose else Status.OK,
        Finding.COLLAPSES,
        sentence,
        multiplier=0.5 * (stood + fell),
        bracket=(stood, fell),
        bracket_meaning=_BRACKET_MEANING,
    )


def _stopped(holds: Holds, joints: str) -> Answer:
    """What is shown when the time is over: the highest rest, and the fall above it if there is one."""
    details = {"stopped_by_limit": True}
    if not holds.path["multiplier"]:
        return replace(undecided(f", with {joints}"), details=details)
    stood, fell = holds.path["multiplier"][-1], holds.fell
    if fell is None or fell <= stood:
        return replace(unmoved(stood, f", with {joints}"), details=details)
    sentence = (
        f"came to rest at {stood:.6g} and fell at {fell:.6g}, with {joints}; {SEARCH_STOPPED}, and the multiplier is "
        "no more than the middle of what is known so far"
    )
    answer = Answer(Status.OK, Finding.COLLAPSES, sentence, 0.5 * (stood + fell), (stood, fell), details=details)
    answer.bracket_meaning = _BRACKET_MEANING
    return answer


def _better(answer: Answer, again: Answer) -> Answer:
    """The answer with stiffer joints, unless it was not found, or not to its end, and that with softer ones was."""
    if again.status is Status.OK and not again.details.get("stopped_by_limit"):
        return again
    if answer.status is not Status.OK:
        return again
    if again.details.get("stopped_by_limit"):
        answer.sentence += f"; the run with stiffer joints is incomplete: {SEARCH_STOPPED}"
        answer.details["stopped_by_limit"] = True
    return answer


def fall_above(holds: Holds, multiplier: float, cap: float) -> float | None:
    """The lowest multiplier tried above an undecided one at which the wall falls; None up to the cap."""
    rise = SHARE * multiplier
    while multiplier + rise <= cap:
        if holds.hold(multiplier + rise) is State.MOVING:
            return multiplier + rise
        rise *= RISE
    return None


def _described(wall: SoftWall, stiffness: float, ratio: float) -> str:
    """The joints and corners in words."""
    least, most = wall.contacts.radius.min(), wall.contacts.radius.max()
    radius = f"{most:.4g}" if most - least < 1e-9 * most else f"{least:.4g} to {most:.4g}"
    return f"joints of stiffness {stiffness:.4g} across and {ratio:g} times that along, corners rounded by {radius}"


def _details(holds: Holds, stiffness: float) -> dict[str, Any]:
    """What the details tell of the last rest."""
    wall = holds.wall
    wall.restore(holds.rest)
    return {
        "stiffness": stiffness,
        "rounding": float(wall.contacts.radius.max()),
        "undecided": len(holds.undecided),
        "undecided_at": holds.undecided,
        "proof": None if holds.proof is None else str(holds.proof),
        "lean": _lean(holds),
        **wall.state().as_details(),
    }


def _velocities_of(displacements: FloatArray) -> FloatArray:
    """Constant velocities (n, 3) that carry blocks through displacements (n, 3) in unit time, each about its pole.

    A displacement (ux, uy, omega) by itself seems to close a contact about which a block turns, by the square of omega:
    u = V v, V = [[sin omega, cos omega - 1], [1 - cos omega, sin omega]] / omega (logarithm of a plane rigid motion).
    """
    x, y, turn = displacements.T
    half = 0.5 * turn
    straight = np.ones_like(half)
    np.divide(half, np.tan(half), out=straight, where=half != 0.0)
    return np.column_stack([straight * x + half * y, straight * y - half * x, turn])


def _lean(holds: Holds) -> float | None:
    """Share of its multiplier that the wall would bear more had its joints not given; None without a fall above zero.

    The contact forces of the last rest, put where the joints were drawn, leave the blocks out of balance; the power of
    that on the motion of the fall, over the power of the live load, is the multiplier that leaning and rolling took.
    """
    wall, at = holds.wall, (holds.path["multiplier"] or [0.0])[-1]
    if holds.motion is None or not at > 0.0:
        return None
    drawn, moved = wall.assembly, holds.motion[wall.assembly.free].ravel()
    load = (drawn.dead + at * drawn.live)[drawn.free].ravel()
    power = float(drawn.live[drawn.free].ravel() @ moved)
    left = float((load + drawn.kinematic_matrix.T @ wall.contact_forces().ravel()) @ moved)
    return -left / (at * power) if power > 0.0 else None


def _too_soft(answer: Answer, settings: SoftSettings) -> float:
    """Factor on the stiffness with which the joints take half of what they may; 1 where they take no more already."""
    if answer.finding is Finding.FALLS:
        return settings.stiffest
    share = abs(answer.details["lean"] or 0.0)
    return min(settings.stiffest, 2.0 * share / settings.lean) if share > settings.lean else 1.0


def saying_soft(answer: Answer, settings: SoftSettings) -> Answer:
    """The answer, saying so where its joints took more of the multiplier than they may."""
    share = answer.details["lean"]
    soft = share is not None and abs(share) > settings.lean
    answer.details["soft_joints"] = soft
    if soft and answer.finding is Finding.COLLAPSES:
        answer.sentence += f"; its joints are soft: rigid ones would bear about {100.0 * share:+.2g} %"
    return answer


def _live_displacement(wall: SoftWall) -> float:
    """Work of the live load so far over the sum of its magnitudes [length]."""
    live = wall.assembly.live
    size = float(np.linalg.norm(live[:, :2], axis=1).sum())
    return float((live * wall.places).sum()) / size if size > 0.0 else 0.0
