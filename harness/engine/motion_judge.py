"""The judge of motions in time: what the places of the blocks show of a wall that is said to stand or to have fallen.

It has the places alone, and puts the wall together from them with other means than the engine (`shapely`). That the
motion obeys its equation is not judged here. Residuals are relative to the size of a block.

start              displacement of the first state, which is the wall as drawn
supports           displacement of a support, in the frame of the ground
interpenetration   common area of two blocks over the shorter outline where a wall stands in the end
overlap            the same in fifty states, until a block has fallen
unsettled          motion of a standing wall in the last twentieth of its time
early              time for which the ground moves on, over that for which it moves; none where a block lies below
fallen             1 if a block of a standing wall has tipped over or dropped off, or if none has of a fallen one
lifted             1 if a fallen wall that still moves has more potential energy than as drawn, and no block lies below
                   all supports
"""

from __future__ import annotations

import numpy as np
import shapely

from harness.engine.judge_decision import countable, said_of
from harness.model.assembly import Assembly, FloatArray
from harness.model.displaced import carried
from harness.model.geometry import shapes_of
from harness.model.method import Finding
from harness.model.result import Judgement

_STATES = 50
"""States whose blocks are looked at for overlaps."""
_OVERLAP = 5e-3
"""Overlap while blocks move: in a step of 1e-3 sqrt(size / g) two close by so much at 5 sqrt(size g)."""
_TIPPED = 0.5
"""Cosine of the rotation of a block that has tipped over, 60 degrees."""


def judge_time_history(
    assembly: Assembly,
    finding: Finding,
    time: FloatArray,
    places: FloatArray,
    at_rest: bool,
    moves_until: float,
    tolerance: float = 1e-3,
) -> Judgement:
    """Whether the places of the blocks show what was found.

    Args:
        assembly: the wall as drawn.
        finding: that it stands or falls; of anything else nothing is judged.
        time: (k,) of the states [s].
        places: (k, n, 3) displacements of the centroids [length] and rotations [rad].
        at_rest: whether all motion is said to have died; a wall that stands has to be at rest.
        moves_until: time at which the ground comes to rest [s].
        tolerance: the largest residual that is acceptable; contacts of the engine overlap by 1e-5.
    """
    if finding not in (Finding.STANDS, Finding.FALLS):
        return said_of(tolerance, None, "Nothing was found that could be judged.")
    if not (countable(places) and countable(time)):
        return said_of(tolerance, False, "Its numbers are not finite, or too large.")
    size = assembly.length_scale
    own = np.array([np.sqrt(shapely.Polygon(polygon).area) for polygon in assembly.polygons])
    turned = (np.cos(places[:, :, 2]) < _TIPPED) | (abs(places[:, :, 2]) > np.pi)
    gone = np.any((turned | (places[:, :, 1] < -0.5 * own)) & ~assembly.fixed, axis=1)
    whole = int(np.argmax(gone)) if gone.any() else len(places)
    looked_at = sorted({*np.linspace(0, whole - 1, _STATES).astype(int).tolist()})
    end = places[-1]
    residuals = {
        "start": float(abs(places[0]).max()) / size,
        "supports": float(abs(places[:, assembly.fixed]).max(initial=0.0)) / size,
        "overlap": max(_overlap(carried(assembly, places[k])) for k in looked_at) / size,
        "fallen": float(bool(gone[-1]) != (finding is Finding.FALLS)),
    }
    if finding is Finding.STANDS:
        residuals["interpenetration"] = _overlap(carried(assembly, end)) / size
    outlines = carried(assembly, end)
    ground = min(outlines[i][:, 1].min() for i in np.flatnonzero(assembly.fixed))
    below = any(outlines[i][:, 1].max() < ground for i in assembly.free)
    if not below:
        residuals["early"] = max(0.0, moves_until - float(time[-1])) / moves_until
    if at_rest or finding is Finding.STANDS:
        late = places[time >= 0.95 * time[-1]]
        residuals["unsettled"] = float((abs(late - end) * [1.0, 1.0, size]).max()) / size
    elif finding is Finding.FALLS:
        higher = float(np.sum(assembly.weight[assembly.free] * end[assembly.free, 1])) > 0.0
        residuals["lifted"] = float(higher and not below)
    within = {"overlap": max(_OVERLAP, tolerance)}
    failed = [f"{name} {value:.3g}" for name, value in residuals.items() if not value <= within.get(name, tolerance)]
    holds = f"not within {tolerance:g}: {', '.join(failed)}" if failed else f"they hold within {tolerance:g}"
    sentence = f"The wall was put together again from the places of its blocks; {holds}."
    return Judgement(residuals=residuals, tolerance=tolerance, accepted=not failed, sentence=sentence)


def _overlap(outlines: list[FloatArray]) -> float:
    """Largest common area of two blocks over the shorter outline [length]."""
    shapes = shapes_of(outlines)
    i, j = shapely.STRtree(shapes).query(shapes, predicate="intersects")
    i, j = i[i < j], j[i < j]
    common = shapely.area(shapely.intersection(shapes[i], shapes[j]))
    outline = shapely.length(shapes)
    return float((common / np.minimum(outline[i], outline[j])).max(initial=0.0))
