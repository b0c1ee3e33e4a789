"""What is found of walls that are followed as they move, kept in the details of an answer."""

from __future__ import annotations

import math
from dataclasses import dataclass, fields
from typing import Any, ClassVar, Self

import numpy as np

from harness.model.assembly import Assembly, BoolArray, FloatArray, IntArray
from harness.model.method import Answer, Finding, Status

COUNTABLE = 1e100
"""Largest number of an answer: sums of products of such numbers are finite, so that no residual is lost in them."""
_KINDS = {"FloatArray": "iuf", "IntArray": "iu", "BoolArray": "b"}
"""Kinds of NumPy's types that an array may have, by its annotation."""
_PLAIN: dict[str, tuple[type, ...]] = {"float": (int, float), "bool": (bool,), "str": (str,)}
"""Types that another value may have, by its annotation."""


@dataclass(frozen=True, eq=False)
class InDetails:
    """What details of an answer hold under its name: arrays, numbers, texts, and None for what there is not.

    The first of its arrays ascends.
    """

    NAME: ClassVar[str]
    SHAPES: ClassVar[dict[str, str]]
    """Axes of each array, a letter each: k states, of which the first array has as many as there are, n blocks, m
    joints, b ties and props, or so many."""
    END: ClassVar[tuple[str, ...]] = ()
    """Fields that are there together where the end was reached; where it was not, `reason` says why."""

    def as_details(self) -> dict[str, Any]:
        """JSON values for an answer's details."""
        found = vars(self).items()
        return {self.NAME: {name: value.tolist() if isinstance(value, np.ndarray) else value for name, value in found}}

    @classmethod
    def of(cls, details: dict[str, Any], assembly: Assembly) -> Self | None:
        """What details hold, None where they hold none.

        Raises:
            ValueError: what they hold is not of this wall, or no such thing; the words begin with its name.
        """
        data = details.get(cls.NAME)
        if data is None:
            return None
        listed = fields(cls)
        if not isinstance(data, dict) or set(data) != {each.name for each in listed}:
            raise ValueError(f"{cls.NAME} does not have the fields {', '.join(each.name for each in listed)}")
        sizes = {"n": assembly.n_blocks, "m": assembly.n_interfaces, "b": len(assembly.bars), "2": 2, "3": 3}
        found: dict[str, Any] = {}
        for each in listed:
            kind, _, none = str(each.type).partition(" | ")
            given, place, shape = data[each.name], f"{cls.NAME}.{each.name}", cls.SHAPES.get(each.name)
            if given is None and none:
                found[each.name] = None
            else:
                found[each.name] = (
                    _plain(given, kind, place) if shape is None else _array(given, kind, place, shape, sizes)
                )
        first = next((each for each in found.values() if isinstance(each, np.ndarray)), np.zeros(1))
        if first.ndim == 1 and not (len(first) and np.all(np.diff(first) > 0.0)):
            raise ValueError(f"{cls.NAME} has no states in ascending order")
        reached = {found[name] is not None for name in cls.END}
        if cls.END and reached != {not found["reason"]}:
            raise ValueError(f"{cls.NAME} has to give {', '.join(cls.END)}, or else a reason")
        return cls(**found)


def _plain(given: Any, kind: str, place: str) -> Any:
    """A number, truth or text of an annotation. Raises ValueError."""
    if type(given) not in _PLAIN[kind] or (kind == "float" and not abs(given) <= COUNTABLE):
        raise ValueError(f"{place} is no {kind}")
    return float(given) if kind == "float" else given


def _array(given: Any, kind: str, place: str, shape: str, sizes: dict[str, int]) -> Any:
    """An array of an annotation and a shape, the first of which says how many states there are. Raises ValueError."""
    try:
        array = np.array(given)
    except ValueError:
        raise ValueError(f"{place} has rows of different lengths") from None
    for letter, size in zip(shape, array.shape, strict=False):
        sizes.setdefault(letter, size)
    wanted = tuple(sizes.get(letter, 0) for letter in shape)
    if array.size == 0 == math.prod(wanted):
        array = np.zeros(wanted, dtype=bool if kind == "BoolArray" else int if kind == "IntArray" else float)
    if array.shape != wanted:
        raise ValueError(f"{place} is of shape {array.shape}, not {wanted}")
    if array.dtype.kind not in _KINDS[kind] or not (abs(array) <= COUNTABLE).all():
        raise ValueError(f"{place} has other entries than numbers up to {COUNTABLE:g}, or truths, as {kind} says")
    return array.astype(float) if kind == "FloatArray" else array


@dataclass(frozen=True, eq=False)
class DrivenWall(InDetails):
    """A wall with n blocks, m joints and b bars at an extreme reaction of supports that move.

    Attributes:
        reaction: work of the wall on the prescribed motion of the supports.
        forces: (m, 3) contact forces [force]; tensions: (b,) of ties and props, prestress included [force].
        mechanism: (n, 3) motion of all blocks that belongs to them, the supports as prescribed or backwards.
    """

    NAME = "driven"
    SHAPES: ClassVar = {"forces": "m3", "tensions": "b", "mechanism": "n3"}
    reaction: float
    forces: FloatArray
    tensions: FloatArray
    mechanism: FloatArray


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
    SHAPES: ClassVar = {
        "displacement": "k",
        "value": "k",
        "places": "kn3",
        "forces": "km3",
        "mechanisms": "kn3",
        "closed": "m2",
        "fallen": "n3",
        "falling": "n3",
    }
    END = ("falls", "fallen", "falling")
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
    SHAPES: ClassVar = {
        "displacement": "k",
        "reaction": "k",
        "slipping": "k",
        "opened": "k",
        "forces": "m3",
        "mechanism": "n3",
    }
    END = ("mechanism", "constant_from")
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
        fallen: (n,) blocks that have fallen in the end.
        at_rest: whether all motion has died.
        engine: its name and version; impact: e, that it was measured to have at the impact of a rocking block.
    """

    NAME = "shaken"
    SHAPES: ClassVar = {"time": "k", "places": "kn3", "fallen": "n"}
    time: FloatArray
    places: FloatArray
    energy: float | None
    fallen: BoolArray
    at_rest: bool
    engine: str
    impact: float


def check_followed(details: dict[str, Any], assembly: Assembly) -> None:
    """Refuse details that do not hold what they say of a wall whose supports move, that is shaken or that moves on.

    Raises:
        ValueError: as of `InDetails.of`.
    """
    for kind in (DrivenWall, FollowedWall, SupportPath, ShakenWall):
        kind.of(details, assembly)
