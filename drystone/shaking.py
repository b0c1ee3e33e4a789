"""A wall on ground that accelerates: whether it stands or falls.

The blocks are followed in time by distinct elements (`methods.de.time`), until one has fallen or all motion has died.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from drystone.settling import check_simple
from drystone.walls import Wall, checked_wall
from harness.engine.judge import judge
from harness.engine.motion_judge import judge_time_history
from harness.engine.pipeline import Runs
from harness.model.assembly import Assembly, FloatArray
from harness.model.errors import InputError, in_file
from harness.model.followed import ShakenWall
from harness.model.ground_motion import GRAVITY, GroundMotion, pulses_of, read_motion
from harness.model.method import Finding
from harness.model.result import Judgement, Result
from harness.model.units import DIMENSIONLESS

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from methods.de.settings import TimeSteps

MOST_STEPS = 5_000_000
"""Time steps of one motion, beyond which it would take hours."""


@dataclass(frozen=True, eq=False)
class Shaking:
    """A wall that was shaken. k states.

    Attributes:
        wall: the wall.
        motion: of the ground; gravity: acceleration g [m/s2].
        finding: stands, falls, or none where neither was shown.
        time: (k,) of the states [s].
        places: (k, n, 3) displacements of the centroids, relative to the ground [length], and rotations [rad].
        fallen: names of the blocks that have fallen in the end.
        at_rest: whether all motion has died.
        energy: kinetic and potential in the end, zero for the wall at rest as drawn [force x length].
        judge: what the places show of the finding.
        engine: its name and version; impact: e, that it was measured to have at the impact of a rocking block.
        reason: why it was not followed at all, as by a limit of its run; empty where it was.
    """

    wall: Wall
    motion: GroundMotion
    gravity: float
    finding: Finding
    time: FloatArray
    places: FloatArray
    fallen: tuple[str, ...]
    at_rest: bool
    energy: float
    judge: Judgement
    engine: str
    impact: float
    reason: str = ""

    @property
    def accepted(self) -> bool:
        """Whether the wall stands or falls, and the judge accepts that."""
        return self.judge.accepted is True

    @property
    def furthest(self) -> tuple[str, float]:
        """The block whose centroid moved furthest while the wall was followed, and how far [length]."""
        travel = np.hypot(self.places[:, :, 0], self.places[:, :, 1]).max(axis=0)
        return self.wall.assembly.block_ids[int(np.argmax(travel))], float(travel.max())

    @property
    def sentence(self) -> str:
        """What was found, and how it is shown."""
        return " ".join(self._sentences())

    def _sentences(self) -> Iterator[str]:
        if self.reason:
            yield f"Whether the wall stands is undecided. {self.reason}"
            return
        unit = self.wall.units["length"]
        name, travel = self.furthest
        at = f"{self.time[-1]:.4g} s"
        if self.finding is Finding.STANDS:
            left = float(np.hypot(*self.places[-1, :, :2].T).max())
            yield f"The wall stands: at {at} all motion has died."
            yield f"Block {name} moved furthest, by {travel:.4g} {unit}; the displacement left is {left:.3g} {unit}."
        elif self.finding is Finding.FALLS:
            yield f"The wall falls: at {at} {_several(self.fallen)}, and {self._no_return()}."
        else:
            yield f"Whether the wall stands is undecided: at {at} its blocks still move, and it is followed no further."
            yield f"Block {name} moved furthest, by {travel:.4g} {unit}."
        if self.judge.accepted is False:
            yield f"The judge rejects this: {self.judge.sentence}"

    def _no_return(self) -> str:
        if self.at_rest:
            return "all motion has died"
        if self.energy < 0.0:
            return "the energy left is less than that of the wall as drawn"
        return "one lies below all supports, where nothing stops it"

    def as_json(self) -> dict[str, Any]:
        """JSON values; the motion itself is in the table."""
        name, travel = self.furthest
        return {
            "case": self.wall.name,
            "finding": self.finding.value if self.finding is not Finding.NONE else "undecided",
            "sentence": self.sentence,
            "time": float(self.time[-1]),
            "fallen": list(self.fallen),
            "at_rest": self.at_rest,
            "energy": self.energy if np.isfinite(self.energy) else None,
            "furthest": {"block": name, "displacement": travel},
            "places": self.places[-1].tolist(),
            "motion": {"peak": self.motion.peak, "seconds": self.motion.duration, "gravity": self.gravity},
            "engine": None if self.reason else {"name": self.engine, "impact": self.impact},
            "judge": self.judge.model_dump(mode="json"),
        }

    def as_csv(self) -> str:
        """One row a state: time [s], then ux, uy [length] and rotation [rad] of every free block; heads have units."""
        import pandas as pd

        from reports.labels.numbers import labelled

        wall, unit = self.wall.assembly, self.wall.units["length"]
        columns: dict[str, FloatArray] = {"time [s]": self.time}
        for i in wall.free:
            for k, what in enumerate((labelled("ux", unit), labelled("uy", unit), "rotation [rad]")):
                columns[f"{wall.block_ids[i]} {what}"] = self.places[:, i, k]
        return str(pd.DataFrame(columns).to_csv(index=False))

    def plot(self) -> Figure:
        """The displacement of the block that moved furthest against time, and the wall in the end."""
        from reports.figures.settling import settled_figure

        name, _ = self.furthest
        wall = self.wall.assembly
        labels = ("time [s]", f"horizontal displacement of block {name} [{self.wall.units['length']}]")
        moved = self.places[:, wall.block_ids.index(name), 0]
        return settled_figure(wall, self.places[-1], (self.time, moved), labels)


def _several(names: tuple[str, ...]) -> str:
    first = ", ".join(names[:5]) + (f" and {len(names) - 5} more" if len(names) > 5 else "")
    return f"block {first} has fallen" if len(names) == 1 else f"blocks {first} have fallen"


def shake(
    wall: Wall,
    motion: GroundMotion | str | Path,
    multiple: float = 1.0,
    *,
    gravity: float = GRAVITY,
    steps: TimeSteps | None = None,
    runs: Runs = Runs(),
) -> Shaking:
    """Shake a wall and follow its blocks until one has fallen or all motion has died.

    >>> wall = drystone.new_wall("stack", count=1, width=0.4, height=2, friction=0.9)  # doctest: +SKIP
    >>> shake(wall, "0.8:0.1").finding  # 0.8 g for 0.1 s  # doctest: +SKIP
    <Finding.STANDS: 'stands'>

    Args:
        wall: of dry joints, in a unit of length, under the weights of its blocks; its live load does not act. Forces
            need no unit: masses are to each other as weights are.
        motion: of the ground: pulses as "0.5:0.3,-0.25:0.6", accelerations in g and durations in s, to the right where
            positive; or the path of a CSV file (`harness.model.ground_motion.read_motion`).
        multiple: of the motion.
        gravity: acceleration g [m/s2].
        steps: how it is followed; None: `TimeSteps()`.
        runs: how they are made.

    Raises:
        InputError: a motion or a wall that cannot be followed, or an engine that does not lose e^2 at an impact.
    """
    return Shaker(checked_wall(wall), motion, gravity, steps, runs).shaken(multiple)


class Shaker:
    """Shakes one wall by multiples of one motion; arguments and errors as of `shake`."""

    def __init__(
        self, wall: Wall, motion: GroundMotion | str | Path, gravity: float, steps: TimeSteps | None, runs: Runs
    ) -> None:
        from methods.de.settings import TimeSteps

        if not 0.0 < gravity <= 1e6:
            raise InputError(f"the gravity {gravity:g} is out of range", "Give it in m/s2, as 9.81", "gravity")
        self.wall, self.gravity, self._runs = wall, gravity, runs
        self.steps = TimeSteps() if steps is None else steps
        if isinstance(motion, str):
            motion = pulses_of(motion)
        self.motion = read_motion(motion, gravity) if isinstance(motion, Path) else motion
        with in_file(wall.case.origin):
            _check(wall)
        self._in_lengths = gravity * wall.case.wall.units.metre
        self._check_steps()

    def _check_steps(self) -> None:
        from methods.de.time.history import count_steps

        count = count_steps(self.wall.assembly, self.motion, self._in_lengths, self.steps)
        if count.moving + count.after > MOST_STEPS:
            raise InputError(
                f"the motion takes {count.moving + count.after:,} time steps of {count.step:.3g} s, and at most "
                f"{MOST_STEPS:,} are made",
                "Give a shorter one, or larger blocks",
                "motion",
            )

    def shaken(self, multiple: float) -> Shaking:
        """The wall shaken by a multiple of the motion."""
        if not 0.0 < abs(multiple) <= 1e6:
            raise InputError(f"the multiple {multiple:g} is out of range", "Give one that is not zero", "multiple")
        motion = self.motion.times(multiple)
        moves = {"time": motion.time.tolist(), "first": motion.first.tolist(), "last": motion.last.tolist()}
        settings = self.steps.model_dump(mode="json") | moves | {"gravity": self._in_lengths}
        result = self._runs.result(self.wall.case, "de-time", settings, partial(_word, moves_until=motion.duration))
        found = ShakenWall.of(result.details, self.wall.assembly)
        if found is None:
            still = np.zeros((1, self.wall.assembly.n_blocks, 3))
            return Shaking(
                self.wall, motion, self.gravity, Finding.NONE, np.zeros(1), still, (), False,
                math.nan, result.judge, "", math.nan, result.sentence,
            )  # fmt: skip
        fallen = tuple(self.wall.assembly.block_ids[i] for i in np.flatnonzero(found.fallen))
        return Shaking(
            self.wall, motion, self.gravity, result.finding, found.time, found.places, fallen, found.at_rest,
            math.nan if found.energy is None else found.energy, result.judge, found.engine, found.impact,
        )  # fmt: skip


def _word(assembly: Assembly, result: Result, tolerance: float, *, moves_until: float) -> Judgement:
    """The word of the judge on the motion, where there is one."""
    found = ShakenWall.of(result.details, assembly)
    if found is None:
        return judge(assembly, result, tolerance)
    return judge_time_history(assembly, result.finding, found.time, found.places, found.at_rest, moves_until, tolerance)


def _check(wall: Wall) -> None:
    """Refuse what is not followed in time. Raises InputError."""
    assembly: Assembly = wall.assembly
    if wall.case.wall.units.length == DIMENSIONLESS:
        problem = "the wall has no unit of length, so that its motion has no time"
        raise InputError(problem, 'Give one, as "units": {"length": "m"}', "units")
    if np.any(assembly.support_motion):
        raise InputError("the wall has settlements", "Leave them out", "settlements")
    if assembly.dilates:
        raise InputError(
            "the wall has joints with dilatancy, which are not followed in time", "Leave it out", "friction"
        )
    weightless = assembly.free[assembly.weight[assembly.free] <= 0.0]
    if len(weightless):
        name = assembly.block_ids[int(weightless[0])]
        problem = f"the free block {name} has no weight, so that its mass is not known"
        raise InputError(problem, 'Give "unit_weight" of the wall or "weight" of the block', name)
    own = np.zeros_like(assembly.dead)
    own[assembly.free, 1] = -assembly.weight[assembly.free]
    if not np.abs(assembly.dead - own).max() <= 1e-9 * assembly.force_scale * max(1.0, assembly.length_scale):
        problem = "the dead load is not the weight of the blocks alone, and the mass of what else acts is not known"
        raise InputError(problem, "Leave other dead loads out and do not turn gravity", "loads.dead")
    check_simple(assembly, "ask `drystone run` for the multiplier of a horizontal load")
