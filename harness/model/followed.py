"""What is found of walls that are followed as they move, kept in the details of an answer."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar, Self

import numpy as np

from harness.model.assembly import BoolArray, FloatArray, IntArray
from harness.model.method import Answer, Finding, Status


class InDetails:
    """What details of an answer hold under its name: arrays, numbers, texts, and None for what there is not."""

    NAME: ClassVar[str]

    def as_details(self) -> dict[str, Any]:
        """JSON values for an answer's details."""
        found = vars(self).items()
        return {self.NAME: {name: value.tolist() if isinstance(value, np.ndarray) else value for name, value in found}}

    @classmethod
    def of(cls, details: dict[str, Any]) -> Self | None:
        """What details hold, None where they hold none."""
        data = details.get(cls.NAME)
        if data is None:
            return None
        return cls(**{name: np.array(value) if isinstance(value, list) else value for name, value in data.items()})


@dataclass(frozen=True, eq=False)
class FollowedWall(InDetails):
    """States of a wall with n blocks and m joints on updated geometry. k states, the last the furthest that stands.

    Attributes:
        displacement: (k,) multiple of the prescribed motion of the supports, or length of the way of the fastest vertex
            where they rest [length].
        value: (k,) the least reaction of moving supports there, or the greatest multiplier where they rest.
        places: (k, n, 3) displacements [length] and rotations [rad] of the blocks.
        forces: (k, m, 3) contact forces, along the joints as they have turned [force].
        mechanisms: (k, n, 3) motions of all blocks, by which the wall goes on.
        closed: (m, 2) ends of joints that meet in the last state.
        falls: displacement a hair further, at which it falls, or None.
        fallen: (n, 3) places there; falling: (n, 3) dilatant mechanism that proves the fall; or None.
        reason: why it was followed no further; empty where it falls.
    """

    NAME = "followed"
    displacement: FloatArray
    value: FloatArray
    places: FloatArray
    forces: FloatArray
    mechanisms: FloatArray
    closed: BoolArray
    falls: float | None
    fallen: FloatArray | None
    falling: FloatArray | None
    reason: str


@dataclass(frozen=True, eq=False)
class SupportPath(InDetails):
    """The reaction against the displacement of supports of a wall with n blocks, and its state at the end. k points.

    Attributes:
        displacement: (k,) of the fastest vertex of the supports [length]; it scales with the compliance of the springs.
        reaction: (k,) work on the prescribed motion [force where that is a translation by one].
        slipping, opened: (k,) numbers of gap points.
        forces: (m, 3) contact forces at the last point [force].
        mechanism: (n, 3) motion of all blocks on the plateau, with the supports as prescribed; None without a plateau.
        constant_from: displacement from which the reaction is constant [length]; None without a plateau.
        reason: why there is no plateau; empty where there is one.
    """

    NAME = "support_path"
    displacement: FloatArray
    reaction: FloatArray
    slipping: IntArray
    opened: IntArray
    forces: FloatArray
    mechanism: FloatArray | None
    constant_from: float | None
    reason: str


def path_answer(found: SupportPath | str) -> Answer:
    """The answer that has a path in its details and the forces at its end; or why there is no path."""
    if isinstance(found, str):
        return Answer(Status.NOT_CONVERGED, Finding.NONE, found)
    return Answer(
        Status.NOT_CONVERGED if found.reason else Status.OK,
        Finding.STANDS,
        found.reason or f"The reaction is constant at {found.reaction[-1]:.7g}.",
        forces=found.forces,
        forces_multiplier=0.0,
        path={"displacement": found.displacement.tolist(), "reaction": found.reaction.tolist()},
        details=found.as_details(),
    )


@dataclass(frozen=True, eq=False)
class ShakenWall(InDetails):
    """The motion of a wall with n blocks in time. k states.

    Attributes:
        time: (k,) of the states [s].
        places: (k, n, 3) displacements of the centroids from where they were drawn [length] and rotations [rad].
        energy: kinetic and potential in the end, zero for the wall at rest as drawn [force x length]; None: no number.
        fallen: (f,) indices of the blocks that have fallen in the end.
        at_rest: whether all motion has died.
        engine: its name and version; impact: e, that it was measured to have at the impact of a rocking block.
    """

    NAME = "shaken"
    time: FloatArray
    places: FloatArray
    energy: float | None
    fallen: IntArray
    at_rest: bool
    engine: str
    impact: float
