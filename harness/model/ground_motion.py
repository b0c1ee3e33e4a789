"""The horizontal acceleration of the ground in time, as pulses or as a record out of a CSV file."""

from __future__ import annotations

import csv
import re
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from harness.model.assembly import FloatArray
from harness.model.errors import InputError
from harness.model.json_text import MOST_SHOWN, read_text

_MOST_PIECES = 200_000
"""Pieces of a motion: a record of 1000 s at 200 samples a second."""
_LONGEST_MOTION = 1000.0
"""Duration of a motion [s]."""
STRONGEST = 1000.0
"""Acceleration of the ground [g], beyond which a unit is mistaken."""
GRAVITY = 9.81
"""Acceleration of gravity where none is given [m/s2]."""
_PULSES = "Give them as ACCELERATION:SECONDS, in g and one after the other, as 0.5:0.3,-0.25:0.6"
_HEADS = 'Give a first line as "time [s],acceleration [g]" or "time [s],acceleration [m/s2]"'
_TIME = re.compile(r"\s*(?:t|time)\s*[\[(]\s*s\s*[\])]\s*", re.IGNORECASE)
_ACCELERATION = re.compile(r"\s*(?:a|acc|acceleration)\s*[\[(]\s*(g|m/s2|m/s\^2|m/s²)\s*[\])]\s*", re.IGNORECASE)


@dataclass(frozen=True, eq=False)
class GroundMotion:
    """Horizontal acceleration of the ground, linear in each of k pieces, and zero from then on.

    Attributes:
        time: (k+1,) where pieces begin and end, from zero [s].
        first, last: (k,) acceleration at the beginning and at the end of each piece, to the right [g].
    """

    time: FloatArray
    first: FloatArray
    last: FloatArray

    @property
    def duration(self) -> float:
        """When the ground has come to rest, or moves on at a constant velocity [s]."""
        return float(self.time[-1])

    @property
    def peak(self) -> float:
        """The largest acceleration in either sense [g]."""
        return float(max(abs(self.first).max(), abs(self.last).max()))

    def times(self, multiple: float) -> GroundMotion:
        """The same motion with all accelerations multiplied."""
        return replace(self, first=multiple * self.first, last=multiple * self.last)

    def means(self, at: FloatArray) -> FloatArray:
        """(j,) mean acceleration between ascending times (j+1,) from zero on [g]: steps lose none of its impulse."""
        length = np.diff(self.time)
        before = np.concatenate([[0.0], np.cumsum(0.5 * (self.first + self.last) * length)])
        inside = np.minimum(at, self.duration)
        piece = np.clip(np.searchsorted(self.time, inside, side="right") - 1, 0, len(length) - 1)
        since = inside - self.time[piece]
        slope = (self.last - self.first)[piece] / length[piece]
        velocity = before[piece] + since * (self.first[piece] + 0.5 * slope * since)
        return np.asarray(np.diff(velocity) / np.diff(at))


def pulses_of(text: str) -> GroundMotion:
    """Rectangular pulses, written as ACCELERATION:SECONDS with commas between them, the acceleration in g.

    Raises:
        InputError: naming the pulse and what would be right.
    """
    accelerations, seconds = [], []
    parts = text.split(",")
    if len(parts) > _MOST_PIECES:
        raise InputError(
            f"there are {len(parts):,} pulses, and at most {_MOST_PIECES:,} are taken", "Give fewer", "pulse"
        )
    for number, part in enumerate(parts, 1):
        try:
            acceleration, length = (float(word) for word in part.split(":"))
        except ValueError:
            acceleration = length = np.nan
        if not (np.isfinite(acceleration) and np.isfinite(length) and length > 0.0):
            raise InputError(f'"{part[:MOST_SHOWN]}" is no pulse', _PULSES, f"pulse {number}")
        accelerations.append(acceleration)
        seconds.append(length)
    level = np.array(accelerations)
    return _checked(GroundMotion(np.concatenate([[0.0], np.cumsum(seconds)]), level, level), "pulse", "")


def read_motion(path: Path, gravity: float = GRAVITY) -> GroundMotion:
    """A record, linear between its samples: a CSV file whose first line names its columns and their units.

    Args:
        path: of the file; its times are counted from the first of them.
        gravity: the acceleration g that divides accelerations in m/s2 [m/s2].

    Raises:
        InputError: naming the file, the line and what would be right.
    """
    rows = list(csv.reader(read_text(path).splitlines()))
    try:
        return _record(rows, gravity)
    except InputError as error:
        error.source = str(path)
        raise


def _record(rows: list[list[str]], gravity: float) -> GroundMotion:
    head = rows[0] if rows else []
    unit = _ACCELERATION.fullmatch(head[1]) if len(head) == 2 and _TIME.fullmatch(head[0]) else None
    if unit is None:
        raise InputError("its first line does not name a time in s and an acceleration with its unit", _HEADS, "line 1")
    if len(rows) - 2 > _MOST_PIECES:
        raise InputError(f"it has {len(rows) - 1:,} samples, and at most {_MOST_PIECES + 1:,} are taken", "Give fewer")
    values = np.zeros((len(rows) - 1, 2))
    for line, row in enumerate(rows[1:], 2):
        try:
            time, acceleration = (float(word) for word in row)
        except ValueError:
            time = acceleration = np.nan
        if not (np.isfinite(time) and np.isfinite(acceleration)):
            said = ",".join(row)[:MOST_SHOWN]
            raise InputError(
                f'"{said}" is not a time and an acceleration', "Give two numbers in each line", f"line {line}"
            )
        if line > 2 and not time > values[line - 3, 0]:
            problem = f"the time {time:g} does not follow on {values[line - 3, 0]:g}"
            raise InputError(problem, "Sort the lines by time and give each time once", f"line {line}")
        values[line - 2] = time, acceleration
    if len(values) < 2:
        raise InputError(f"it has {len(values)} samples", "Give two at least")
    times, level = values[:, 0] - values[0, 0], values[:, 1] / (1.0 if unit[1].lower() == "g" else gravity)
    return _checked(
        GroundMotion(times, level[:-1], level[1:]), "motion", " (are they in the unit that the file names?)"
    )


def _checked(motion: GroundMotion, element: str, doubt: str) -> GroundMotion:
    """The motion, if its duration and accelerations are within bounds and it moves at all; raises InputError."""
    if not motion.duration <= _LONGEST_MOTION:
        problem = f"it takes {motion.duration:g} s, and at most {_LONGEST_MOTION:g} s are followed"
        raise InputError(problem, "Give a part of it", element)
    if not motion.peak <= STRONGEST:
        problem = f"it reaches {motion.peak:g} g, and at most {STRONGEST:g} g are taken{doubt}"
        raise InputError(problem, "Give smaller accelerations", element)
    if motion.peak == 0.0:
        raise InputError("all its accelerations are zero", "Give a motion of the ground", element)
    return motion
