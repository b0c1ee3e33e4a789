"""Load steps: what the blocks and joints of a wall did on the way to its collapse, as an answer's details hold them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from harness.model.assembly import Assembly, FloatArray, IntArray
from harness.model.components import components_of

NAME = "load_steps"
"""Name under which an answer's details hold them, and of the setting that asks a method for so many."""
STATES = ("stick", "slip", "rock", "open")
"""States of joints: held, sliding at every end that is closed, open at one end, open."""
UNKNOWN = -1
"""State of a joint that no method followed."""


@dataclass(frozen=True, eq=False)
class LoadSteps:
    """k steps of a wall of n blocks and m interfaces, in the order in which they were met.

    Attributes:
        blocks: names of the n blocks that were followed, those of one independent component.
        multiplier: (k,) of the live load.
        displacements: (k, n, 3) of the blocks since no load acted (ux, uy, rotation) [length, length, radian].
        forces: (k, m, 3) contact forces n1, n2, s [force], in equilibrium with dead + multiplier x live.
        states: (k, m) places in `STATES`, or `UNKNOWN`.
    """

    blocks: tuple[str, ...]
    multiplier: FloatArray
    displacements: FloatArray
    forces: FloatArray
    states: IntArray

    def as_details(self) -> dict[str, Any]:
        """JSON values for an answer's details."""
        arrays = {k: v.tolist() for k, v in vars(self).items() if k != "blocks"}
        return {NAME: {"blocks": list(self.blocks)} | arrays}

    @classmethod
    def of(cls, details: dict[str, Any], assembly: Assembly) -> LoadSteps | None:
        """The steps that details hold, on the whole of the wall; None where they hold none that fit it.

        Blocks of other components do not move, their joints carry nothing and are in no known state.
        """
        data = details.get(NAME)
        if not isinstance(data, dict):
            return None
        own = cls(
            tuple(data["blocks"]),
            np.array(data["multiplier"], dtype=float),
            np.array(data["displacements"], dtype=float),
            np.array(data["forces"], dtype=float),
            np.array(data["states"], dtype=np.int64),
        )
        part = next((each for each in components_of(assembly) if each.assembly.block_ids == own.blocks), None)
        if part is None or not own._fits(len(part.blocks), len(part.interfaces)):
            return None
        k = len(own.multiplier)
        displacements = np.zeros((k, assembly.n_blocks, 3))
        forces = np.zeros((k, assembly.n_interfaces, 3))
        states = np.full((k, assembly.n_interfaces), UNKNOWN)
        displacements[:, part.blocks] = own.displacements
        forces[:, part.interfaces] = own.forces
        states[:, part.interfaces] = own.states
        return cls(assembly.block_ids, own.multiplier, displacements, forces, states)

    def _fits(self, n: int, m: int) -> bool:
        """Whether these are steps of n blocks and m interfaces."""
        k = len(self.multiplier)
        shapes = self.displacements.shape, self.forces.shape, self.states.shape
        return k > 0 and shapes == ((k, n, 3), (k, m, 3), (k, m))


def without_series(details: dict[str, Any], n: int, joint: IntArray) -> dict[str, Any]:
    """Details in which steps of a wall with k more blocks and joints, in series with these (k,), are of its n blocks.

    A joint of which one in series slips, rocks or opens does so.
    """
    data = details.get(NAME)
    if not isinstance(data, dict):
        return details
    states = np.array(data["states"], dtype=np.int64)
    m = states.shape[1] - len(joint)
    own = states[:, :m].copy()
    for i, p in enumerate(joint):
        own[:, p] = np.maximum(own[:, p], states[:, m + i])
    of_wall = LoadSteps(
        tuple(data["blocks"][:n]),
        np.array(data["multiplier"], dtype=float),
        np.array(data["displacements"], dtype=float)[:, :n],
        np.array(data["forces"], dtype=float)[:, :m],
        own,
    )
    return details | of_wall.as_details()
