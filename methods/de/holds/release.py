"""After the bracket: let the wall go a little above its collapse multiplier and follow it a long way."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from harness.model.assembly import Assembly, FloatArray
from harness.model.deadline import Deadline
from methods.de.engines.pymunk_blocks import PymunkBlocks
from methods.de.settings import ReleaseSettings


@dataclass(frozen=True, eq=False)
class _Collapse:
    """A collapse that was followed.

    Attributes:
        time: (k,) times of the frames [sqrt(length scale / gravity)].
        places: (k, n, 3) displacements (x, y) [length] and rotations of the blocks.
        live_displacement: (k,) work of the live load so far over its sum of magnitudes [length].
        reached: whether a block moved as far as asked.
        separated: indices of the interfaces that had come apart at both ends at the end.
    """

    time: FloatArray
    places: FloatArray
    live_displacement: FloatArray
    reached: bool
    separated: list[int]


def release(assembly: Assembly, multiplier: float, settings: ReleaseSettings) -> _Collapse:
    """Release the wall from rest at this multiplier and follow it.

    Args:
        assembly: the wall.
        multiplier: load it is released under.
        settings: see `ReleaseSettings`.

    Raises:
        OutOfTime: the time of the run is over.
    """
    space = PymunkBlocks(assembly)
    space.load(multiplier)
    times, places = [0.0], [space.places()]
    stride, made = 20, 0
    deadline = Deadline.of_run()
    while made < settings.release_steps:
        deadline.ask()
        space.advance(stride)
        made += stride
        times.append(made * space.options.time_step)
        places.append(space.places())
        if np.abs(places[-1][:, :2]).max() >= settings.reach * assembly.length_scale:
            break
    keep = min(settings.frames, max(8, 20_000 // (3 * assembly.n_blocks)), len(times))
    chosen = even_frames(np.array([np.abs(p[:, :2]).max() for p in places]), keep)
    history = np.array(places)
    size = float(np.linalg.norm(assembly.live[:, :2], axis=1).sum()) or 1.0
    work = np.einsum("kni,ni->k", history, assembly.live) / size
    last = history[-1]
    reached = bool(np.abs(last[:, :2]).max() >= settings.reach * assembly.length_scale)
    apart = separated(assembly, last, settings.gap * assembly.length_scale)
    return _Collapse(np.array(times)[chosen], history[chosen], work[chosen], reached, apart)


def even_frames(travel: FloatArray, count: int) -> list[int]:
    """Indices of at most `count` frames, spaced evenly in the distance travelled (k,), first and last among them."""
    far = np.maximum.accumulate(travel)
    wanted = np.linspace(0.0, far[-1], count)
    return sorted({*(int(np.searchsorted(far, w)) for w in wanted), 0, len(travel) - 1})


def separated(assembly: Assembly, places: FloatArray, gap: float) -> list[int]:
    """Interfaces whose two contact points have both come apart by more than `gap` [length], in any direction."""
    moved = []
    for side in (assembly.block_a, assembly.block_b):
        angle = places[side, 2]
        cosine, sine = np.cos(angle), np.sin(angle)
        ends = []
        for end in (assembly.end1, assembly.end2):
            arm = end - assembly.centroid[side]
            turned = np.column_stack([cosine * arm[:, 0] - sine * arm[:, 1], sine * arm[:, 0] + cosine * arm[:, 1]])
            ends.append(assembly.centroid[side] + places[side, :2] + turned)
        moved.append(ends)
    angle = places[assembly.block_a, 2]
    nx, ny = assembly.normal.T
    normal = np.column_stack([np.cos(angle) * nx - np.sin(angle) * ny, np.sin(angle) * nx + np.cos(angle) * ny])
    opening = [np.sum((b - a) * normal, axis=1) for a, b in zip(moved[0], moved[1], strict=True)]
    return [int(p) for p in np.flatnonzero(np.minimum(*opening) > gap)]
