"""Walls that have moved far: states of rest with contacts of their own, and collapses that were followed."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from harness.model.assembly import Assembly, FloatArray, IntArray
from harness.model.details import AnswerDetails
from harness.model.result import Result

_NAME = "displaced_state"
"""Name under which an answer's details hold it."""


@dataclass(frozen=True, eq=False)
class DisplacedState:
    """Point contacts of a wall that has moved, and the forces in them. k contacts.

    Attributes:
        places: (n, 3) displacements (x, y) [length] and rotations of the blocks.
        interface: (k,) the interface of the assembly that each contact belongs to.
        onto: (k,) the block that the force acts on; the other block of the interface receives the opposite.
        point: (k, 2) where the contacts are [length].
        normal: (k, 2) unit normals, towards `onto`.
        force: (k, 2) forces on `onto` [force].
    """

    places: FloatArray
    interface: IntArray
    onto: IntArray
    point: FloatArray
    normal: FloatArray
    force: FloatArray

    def as_details(self) -> dict[str, Any]:
        """JSON values for an answer's details."""
        return {_NAME: {name: value.tolist() for name, value in vars(self).items()}}

    @classmethod
    def of(cls, details: dict[str, Any]) -> DisplacedState | None:
        """The state that details hold, None where they hold none."""
        data = details.get(_NAME)
        if data is None:
            return None
        whole = ("interface", "onto")
        return cls(**{k: np.array(v, dtype=np.int64 if k in whole else float) for k, v in data.items()})


def released(result: Result, n_blocks: int) -> FloatArray | None:
    """Frames (k, n, 3) of a collapse that was followed: displacements (x, y) [length] and rotations; or None."""
    release = AnswerDetails(result.details).release
    if release is None or release.frames is None:
        return None
    frames = release.frames
    return frames if frames.ndim == 3 and frames.shape[0] > 1 and frames.shape[1:] == (n_blocks, 3) else None


def carried(assembly: Assembly, places: FloatArray) -> list[FloatArray]:
    """Polygons displaced by (n, 3) displacements and finite rotations about the centroids."""
    polygons = []
    for polygon, centroid, (x, y, angle) in zip(assembly.polygons, assembly.centroid, places, strict=True):
        turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
        polygons.append(centroid + np.array([x, y]) + (polygon - centroid) @ turn.T)
    return polygons
