"""The distinct-element methods, as the engine finds them."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np

from harness.model.assembly import Assembly, IntArray
from harness.model.deadline import STOPPED, best_so_far
from harness.model.method import Answer, Finding, Solver, Status
from methods.de.answers import solve_by_holds
from methods.de.crushing import held_within_tangents
from methods.de.engines.box2d_joints import Box2dJoints, load_box2d
from methods.de.engines.engine import Engine, motion_units
from methods.de.engines.mass_scaling import MassScaling, courses, insertion_orders, is_chain, lighter_upwards, tunings
from methods.de.engines.mujoco_wall import MujocoTuning, MujocoWall, SolverFailed, load_mujoco
from methods.de.engines.pymunk_joints import PymunkJoints
from methods.de.engines.sequential_impulses import SequentialImpulses
from methods.de.engines.strips import CannotModel
from methods.de.holds.release import release
from methods.de.methods import DE, DE_BOX2D, DE_MUJOCO
from methods.de.settings import Box2dSettings, MujocoSettings, ReleaseSettings, SweepSettings
from methods.numerics.claims import analysed
from methods.numerics.crushing_claims import falls_by_statics
from methods.numerics.residual_strength import by_component
from methods.springs.warm_up import block_on_halves


@cache
def _load_impulses() -> None:
    """Make a time step of a single block, once in a process."""
    block = block_on_halves((0.6, 0.4))
    course = courses(block)
    ((_, blocks, joints),) = insertion_orders(block, course, 1, 0)
    SequentialImpulses(block, blocks, joints, 1, tunings(course, None)[0]).advance(1)


class DampedHolds(Solver):
    """Damped load steps of a wall at frozen geometry, bracketed over sweep orders."""

    def prepare(self) -> None:
        """Load the compiled sweeps."""
        _load_impulses()

    def solve(self, assembly: Assembly, settings: SweepSettings) -> Answer:
        """Bracket of the collapse multiplier over sweep orders; see `methods.de.answers`."""
        return by_component(assembly, lambda part: self._of_component(part, settings))

    def _of_component(self, assembly: Assembly, settings: SweepSettings) -> Answer:
        if assembly.crushes:
            falls = falls_by_statics(assembly)
            return falls or held_within_tangents(assembly, lambda wall: self._of_component(wall, settings))

        def engine(blocks: IntArray, joints: IntArray, tuning: MassScaling) -> Engine:
            make = PymunkJoints if settings.engine == "pymunk" else SequentialImpulses
            return make(assembly, blocks, joints, settings.iterations, tuning)

        try:
            return solve_by_holds(assembly, settings, engine, DE.tolerance)
        except CannotModel as error:
            return Answer(Status.REFUSED, Finding.NONE, str(error))


class MujocoHolds(Solver):
    """The holds, the bracket and the orders of `de` on MuJoCo, so that an answer does not depend on one engine."""

    def solve(self, assembly: Assembly, settings: MujocoSettings) -> Answer:
        """Bracket of the collapse multiplier over sweep orders; see `methods.de.answers`.

        Raises:
            InputError: mujoco is not installed.
        """
        load_mujoco()
        return analysed(assembly, lambda part: self._of_component(part, settings))

    def _of_component(self, assembly: Assembly, settings: MujocoSettings) -> Answer:
        candidates = _mujoco_tunings(assembly, settings)
        soft = dict(candidates)

        def engine(blocks: IntArray, joints: IntArray, tuning: MassScaling) -> MujocoWall:
            ratio = settings.friction_ratio
            return MujocoWall(assembly, blocks, joints, settings.iterations, tuning, soft[tuning], ratio)

        try:
            return solve_by_holds(assembly, settings, engine, DE_MUJOCO.tolerance, [tuning for tuning, _ in candidates])
        except CannotModel as error:
            return Answer(Status.REFUSED, Finding.NONE, str(error))
        except SolverFailed as error:
            return Answer(Status.NOT_CONVERGED, Finding.NONE, str(error))


class Box2dHolds(Solver):
    """The holds, the bracket and the orders of `de` on Box2D, so that an answer does not depend on one engine."""

    def solve(self, assembly: Assembly, settings: Box2dSettings) -> Answer:
        """Bracket of the collapse multiplier over sweep orders; see `methods.de.answers`.

        Raises:
            InputError: pyb2d3 is not installed.
        """
        load_box2d()
        return analysed(assembly, lambda part: self._of_component(part, settings))

    def _of_component(self, assembly: Assembly, settings: Box2dSettings) -> Answer:
        def engine(blocks: IntArray, joints: IntArray, tuning: MassScaling) -> Box2dJoints:
            return Box2dJoints(assembly, blocks, joints, settings.iterations, tuning)

        try:
            return solve_by_holds(assembly, settings, engine, DE_BOX2D.tolerance)
        except CannotModel as error:
            return Answer(Status.REFUSED, Finding.NONE, str(error))


class ReleasedCollapse(Solver):
    """The bracket of `de`, and the collapse followed through large displacements once the wall is released."""

    def prepare(self) -> None:
        """Load the compiled sweeps."""
        _load_impulses()

    def solve(self, assembly: Assembly, settings: ReleaseSettings) -> Answer:
        """Answer of `de` with the history of the collapse: frames in `details`, time and displacement in `path`."""
        answer = DampedHolds().solve(assembly, settings)
        fails = answer.finding.has_multiplier or answer.finding is Finding.FALLS
        if not fails or answer.details.get("stopped_by_limit"):
            return answer
        multiplier = settings.excess * (answer.multiplier or 0.0)
        collapse = best_so_far(lambda: release(assembly, multiplier, settings), lambda: None)
        if collapse is None:
            answer.sentence += f"; what follows a release was {STOPPED}"
            return answer
        pairs = [
            (assembly.block_ids[assembly.block_a[p]], assembly.block_ids[assembly.block_b[p]])
            for p in collapse.separated
        ]
        answer.path = {
            "time": collapse.time.tolist(),
            "live_displacement": collapse.live_displacement.tolist(),
            "multiplier": [multiplier] * len(collapse.time),
        }
        answer.details["release"] = {
            "multiplier": multiplier,
            "reached": collapse.reached,
            "separated": [list(pair) for pair in pairs],
            "frames": (np.round(collapse.places / motion_units(assembly), 6) * motion_units(assembly)).tolist(),
            "time_unit": "sqrt(length scale / gravity)",
        }
        end = "until a block had moved far enough" if collapse.reached else "without such a displacement"
        answer.sentence += f"; released at {multiplier:.6g} and followed {end}: {len(pairs)} interfaces separated"
        return answer


def _mujoco_tunings(assembly: Assembly, settings: MujocoSettings) -> list[tuple[MassScaling, float]]:
    """Tunings with their impedances, in the order in which they are tried: light tops first."""
    options, course = MujocoTuning(), courses(assembly)
    contacts = options.contacts
    tuning = lighter_upwards(course)
    usual = contacts.chain_impedance if is_chain(course) else contacts.wall_impedance
    impedance = settings.impedance or usual
    if settings.mass_decay is not None:
        return [(replace(tuning, mass_decay=settings.mass_decay), impedance)]
    return [(tuning, impedance), (options.uniform, settings.impedance or contacts.wall_impedance)]
