"""A state of rest at large displacements: contacts where they are then, which those of the assembly no longer are."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from harness.model.assembly import FloatArray, IntArray

NAME = "displaced_state"
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
        return {NAME: {name: value.tolist() for name, value in vars(self).items()}}

    @classmethod
    def of(cls, details: dict[str, Any]) -> DisplacedState | None:
        """The state that details hold, None where they hold none."""
        data = details.get(NAME)
        if data is None:
            return None
        whole = ("interface", "onto")
        return cls(**{k: np.array(v, dtype=np.int64 if k in whole else float) for k, v in data.items()})
