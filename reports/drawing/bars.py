"""Ties and props as lines of a display list, in a wall, in its mechanism and with their forces."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from harness.model.assembly import Assembly, FloatArray
from harness.model.bar_forces import BarForce
from harness.model.result import vertex_velocities
from reports.drawing.display_list import Frame, Lines, Shape, Text
from reports.labels import numbers


def bar_lines(frame: Frame, assembly: Assembly, shift: FloatArray | None = None) -> list[Shape]:
    """A line a bar between its ends, props wider; moved along displacements (n, 3) of the blocks, if any."""
    bars, ends = assembly.bars, []
    for block, point in ((assembly.bars.block_a, bars.end1), (assembly.bars.block_b, bars.end2)):
        moved = 0.0 if shift is None else vertex_velocities(point, assembly.centroid[block], shift[block])
        ends.append(point + moved)
    placed = frame.place(np.stack(ends, axis=1))
    return [Lines(kind, (line,)) for kind, line in zip(bars.kinds, placed, strict=True)]


def bar_forces(frame: Frame, assembly: Assembly, forces: Sequence[BarForce]) -> list[Shape]:
    """The bars with their tensions beside them, dashed where they bear nothing; compression is negative."""
    placed = frame.place(np.stack([assembly.bars.end1, assembly.bars.end2], axis=1))
    drawn: list[Shape] = []
    for bar, line in zip(forces, placed, strict=True):
        if bar.state == "slack":
            drawn.append(Lines("idle", (line,)))
            continue
        drawn.append(Lines(bar.kind, (line,)))
        x, y = line.mean(axis=0).tolist()
        across, along = abs(np.ptp(line, axis=0)).tolist()
        beside, above, anchor = (0.09, 0.0, "start") if along > across else (0.0, 0.05, "middle")
        at, size = (x + beside * frame.block, y - above * frame.block), min(110.0, 0.17 * frame.block)
        drawn.append(Text("said", at, numbers.given(bar.tension, 3), size, anchor))
    return drawn
