"""The path of a wall whose supports move, by distinct elements with deformable joints.

The supports are carried a step along their motion and stop, the damped motion of the blocks dies, and the reaction is
read: the wall at rest at one displacement after another (`methods.de.engines.soft_wall`). The steps grow until the wall
has become a mechanism that the supports drive, and the reaction stays as it is. Places are updated and slips are not
undone, so the states have the history of a support that moved; displacements scale with the give of the joints.
Source: P. A. Cundall, Distinct element models of rock and soil structure, 1987, for joints and damping.
"""

from __future__ import annotations

import numpy as np

from harness.model.assembly import Assembly, FloatArray
from harness.model.deadline import Deadline
from harness.model.followed import SupportPath, path_answer
from harness.model.method import Answer, Solver
from harness.model.result import fastest_vertex
from methods.de.engines.soft_wall import SoftWall
from methods.de.settings import LOOK, SoftPathSettings, SoftSettings
from methods.de.soft import ROUNDING, STIFFNESS

_FIRST = 0.05
"""Step, in displacements of a joint of one length scale under the mean weight of a block: nothing has opened or slipped
then."""
_LONGER = 1.3
"""Factor on the next step."""
_SPEED = 0.003
"""Of the supports, in those displacements a time step. The slower, the fewer bricks slide by their own impetus: against
the path of `fe` they end 0.6 % away at 0.01 and 0.05 % at 0.001."""
_STEADY = 3.0
"""Multiple of the displacement over which the reaction has to stay the same."""
_SAME = 1e-3
"""Stiffness of a mechanism, as a share of that of the wall at rest, beside what moves with the arms of its loads: the
dead load over the length scale. A wall that is about to become a mechanism has 1e-2 of it."""
_LEVEL = 5e-3
"""Change of a constant reaction at most, as a share of it or of the dead load, whichever is more: what the judge leaves
open. Over many elastic displacements the stiffness of a mechanism allows more."""

NO_REST = "The wall with deformable joints does not come to rest under its dead load."


def support_path(assembly: Assembly, gives_way: bool, settings: SoftSettings, most: int = 50) -> SupportPath | str:
    """Carry the supports from rest under the dead load until the reaction is constant.

    Without a stiffness of their own joints are the stiffest that places resolve, because the displacements at which a
    wall becomes a mechanism change its reaction as they change its geometry.

    Args:
        assembly: dry, with `support_motion`.
        gives_way: whether the supports move as prescribed; else backwards.
        settings: of joints, corners and rests.
        most: steps of the supports: a ring of 100 voussoirs needs 47 to become a mechanism, a wall of bricks 33.

    Returns:
        The path, or why there is none.

    Raises:
        OutOfTime: the time of the run is over.
    """
    size = assembly.length_scale
    mean = assembly.force_scale / max(assembly.n_free, 1)
    stiffness = settings.stiffness or settings.stiffest * STIFFNESS * mean / size**2
    wall = SoftWall(assembly, stiffness, settings.shear_ratio, settings.rounding or ROUNDING / settings.stiffest * size)
    path = _Path(wall, settings, gives_way)
    if not path.rests(0.0):
        return NO_REST
    give = mean / (stiffness * size)
    step, reason = _FIRST * give, f"The reaction still changes after {most} steps."
    for _ in range(most):
        path.carry(step, step / (_SPEED * give))
        if not path.rests(step):
            reason = f"The wall does not come to rest at the displacement {path.displacement[-1] + step:.6g}."
            break
        begins = path.constant_from()
        if begins is not None:
            return path.ended(begins, "")
        step *= _LONGER
    return path.ended(None, reason)


class _Path:
    """The rests of a wall whose supports are carried on."""

    def __init__(self, wall: SoftWall, settings: SoftSettings, gives_way: bool) -> None:
        assembly = wall.assembly
        self.displacement: list[float] = []
        self._wall, self._settings = wall, settings
        self._fastest = fastest_vertex(assembly, assembly.support_motion)
        self._motion = (1.0 if gives_way else -1.0) * assembly.support_motion / self._fastest
        self._reaction: list[float] = []
        self._counts: list[tuple[int, int]] = []
        self._places: list[FloatArray] = []

    def carry(self, step: float, time_steps: float) -> None:
        """Carry the supports on by a step [length]."""
        self._wall.carry(step * self._motion, max(LOOK, int(time_steps)))

    def rests(self, step: float) -> bool:
        """Whether the wall comes to rest after a step [length]; if it does, that is a point of the path."""
        wall, deadline = self._wall, Deadline.of_run()
        for _ in range(self._settings.relaxations * self._settings.hold_steps // LOOK):
            deadline.ask()
            if wall.advance(LOOK) < self._settings.held_residual:
                break
        else:
            return False
        forces = wall.contact_forces()
        self.displacement.append((self.displacement[-1] if self.displacement else 0.0) + step)
        self._reaction.append(float((wall.assembly.support_strains * forces).sum()))
        self._counts.append(wall.slipping_and_open())
        self._places.append(wall.places.copy())
        return True

    def constant_from(self) -> float | None:
        """Displacement from which the reaction has been constant for long enough; None where it is not."""
        far = np.array(self.displacement)
        change = abs(np.array(self._reaction) - self._reaction[-1])
        before = np.flatnonzero(far[1:] * _STEADY <= far[-1]) + 1
        if not len(before):
            return None
        begins = int(before[-1])
        at_rest = abs(self._reaction[1] - self._reaction[0]) / far[1]
        assembly = self._wall.assembly
        work = assembly.force_scale * self._fastest
        of_mechanism = (_SAME * at_rest + work / assembly.length_scale) * (far[-1] - far[begins])
        allowed = min(of_mechanism, _LEVEL * max(work, abs(self._reaction[-1])))
        return float(far[begins]) if change[begins:].max() <= allowed else None

    def ended(self, constant_from: float | None, reason: str) -> SupportPath:
        """The path up to here."""
        slipping, opened = zip(*self._counts, strict=True)
        mechanism = None
        if constant_from is not None:
            last = self.displacement[-1] - self.displacement[-2]
            mechanism = (self._places[-1] - self._places[-2]) * self._fastest / last
        return SupportPath(
            np.array(self.displacement),
            np.array(self._reaction),
            np.array(slipping),
            np.array(opened),
            self._wall.contact_forces(),
            mechanism,
            constant_from,
            reason,
        )


class CarriedSupports(Solver):
    """The reaction of supports against the displacement that is imposed on them (`de-reaction`)."""

    def solve(self, assembly: Assembly, settings: SoftPathSettings) -> Answer:
        """The path, as details; the forces are those at its end."""
        return path_answer(support_path(assembly, settings.gives_way, settings))
