"""What is found of walls that are followed as they move, kept in the details of an answer."""

from __future__ import annotations

import math
from dataclasses import dataclass, fields
from typing import Annotated, Any, ClassVar, Self

import numpy as np
from pydantic import (
    ConfigDict,
    Field,
    PlainValidator,
    StrictBool,
    StrictStr,
    TypeAdapter,
    ValidationError,
    ValidationInfo,
)

from harness.model.assembly import Assembly, BoolArray, FloatArray, IntArray
from harness.model.method import Answer, Finding, Status

COUNTABLE = 1e100
"""Largest number of an answer: sums of products of such numbers are finite, so that no residual is lost in them."""
Number = Annotated[float, Field(strict=True, ge=-COUNTABLE, le=COUNTABLE)]


def _floats(axes: str) -> PlainValidator:
    """Reads numbers, in an array that has these axes, as `InDetails` names them."""
    return _array(axes, "iuf", float)


def _integers(axes: str) -> PlainValidator:
    """Reads whole numbers, likewise."""
    return _array(axes, "iu", int)


def _truths(axes: str) -> PlainValidator:
    """Reads truths, likewise."""
    return _array(axes, "b", bool)


def _array(axes: str, kinds: str, kind: type) -> PlainValidator:
    def read(given: Any, info: ValidationInfo) -> Any:
        try:
            array = np.array(given)
        except ValueError:
            raise ValueError("rows of different lengths") from None
        sizes: dict[str, int] = info.context or {}
        for letter, size in zip(axes, array.shape, strict=False):
            sizes.setdefault(letter, size)  # the first array says how many states there are
        wanted = tuple(sizes.get(letter, 0) for letter in axes)
        if array.size == 0 == math.prod(wanted):
            array = np.zeros(wanted, kind)
        if array.shape != wanted:
            raise ValueError(f"of shape {array.shape}, not {wanted}")
        if array.dtype.kind not in kinds or not (abs(array) <= COUNTABLE).all():
            raise ValueError(f"other entries than each a {kind.__name__}, of size {COUNTABLE:g} at most")
        return array.astype(kind)

    return PlainValidator(read)


@dataclass(frozen=True, eq=False)
class InDetails:
    """What details of an answer hold under its name: arrays, numbers, texts, and None for what there is not.

    The axes of an array are a letter each: k states, n blocks, m joints, b ties and props, or so many as a digit says.
    The first of its arrays ascends.
    """

    NAME: ClassVar[str]
    END: ClassVar[tuple[str, ...]] = ()
    """Fields that are there together where the end was reached; where it was not, `reason` says why."""
    __pydantic_config__ = ConfigDict(arbitrary_types_allowed=True, extra="forbid")

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
        listed = [each.name for each in fields(cls)]
        if not isinstance(data, dict) or set(data) != set(listed):
            raise ValueError(f"{cls.NAME} does not have the fields {', '.join(listed)}")
        sizes = {"n": assembly.n_blocks, "m": assembly.n_interfaces, "b": len(assembly.bars), "2": 2, "3": 3}
        try:
            found: Self = TypeAdapter(cls).validate_python(data, context=sizes)
        except ValidationError as error:
            fault = error.errors()[0]
            place = ".".join(map(str, (cls.NAME, *fault["loc"])))
            raise ValueError(f"{place}: {fault['msg'].removeprefix('Value error, ')}") from None
        has = vars(found)
        first = next((each for each in has.values() if isinstance(each, np.ndarray)), np.zeros(1))
        if first.ndim == 1 and not (len(first) and np.all(np.diff(first) > 0.0)):
            raise ValueError(f"{cls.NAME} has no states in ascending order")
        if cls.END and {has[name] is not None for name in cls.END} != {not has["reason"]}:
            raise ValueError(f"{cls.NAME} has to give {', '.join(cls.END)}, or else a reason")
        return found


@dataclass(frozen=True, eq=False)
class DrivenWall(InDetails):
    """A wall with n blocks, m joints and b bars at an extreme reaction of supports that move.

    Attributes:
        reaction: work of the wall on the prescribed motion of the supports.
        forces: (m, 3) contact forces [force]; tensions: (b,) of ties and props, prestress included [force].
        mechanism: (n, 3) motion of all blocks that belongs to them, the supports as prescribed or backwards.
    """

    NAME = "driven"
    reaction: Number
    forces: Annotated[FloatArray, _floats("m3")]
    tensions: Annotated[FloatArray, _floats("b")]
    mechanism: Annotated[FloatArray, _floats("n3")]


@dataclass(frozen=True, eq=False)
class FollowedWall(InDetails):
    """States of a wall with n blocks and m joints on updated geometry. k states, the last the furthest that stands.

    Attributes:
        displacement: (k,) of the supports in the direction of their motion, or length of the way of the fastest vertex
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
    END = ("falls", "fallen", "falling")
    displacement: Annotated[FloatArray, _floats("k")]
    value: Annotated[FloatArray, _floats("k")]
    places: Annotated[FloatArray, _floats("kn3")]
    forces: Annotated[FloatArray, _floats("km3")]
    mechanisms: Annotated[FloatArray, _floats("kn3")]
    closed: Annotated[BoolArray, _truths("m2")]
    falls: Number | None
    fallen: Annotated[FloatArray, _floats("n3")] | None
    falling: Annotated[FloatArray, _floats("n3")] | None
    reason: StrictStr


@dataclass(frozen=True, eq=False)
class SupportPath(InDetails):
    """The reaction against the displacement of supports of a wall with n blocks, and its state at the end. k points.

    Attributes:
        displacement: (k,) of the fastest vertex of the supports [length]; it scales with the compliance of the springs.
        reaction: (k,) work on the direction of the prescribed motion [force; moment of rotations alone].
        slipping, opened: (k,) numbers of gap points.
        forces: (m, 3) contact forces at the last point [force].
        mechanism: (n, 3) motion of all blocks on the plateau, with the supports as prescribed; None without a plateau.
        constant_from: displacement from which the reaction is constant [length]; None without a plateau.
        reason: why there is no plateau; empty where there is one.
    """

    NAME = "support_path"
    END = ("mechanism", "constant_from")
    displacement: Annotated[FloatArray, _floats("k")]
    reaction: Annotated[FloatArray, _floats("k")]
    slipping: Annotated[IntArray, _integers("k")]
    opened: Annotated[IntArray, _integers("k")]
    forces: Annotated[FloatArray, _floats("m3")]
    mechanism: Annotated[FloatArray, _floats("n3")] | None
    constant_from: Number | None
    reason: StrictStr


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
    time: Annotated[FloatArray, _floats("k")]
    places: Annotated[FloatArray, _floats("kn3")]
    energy: Number | None
    fallen: Annotated[BoolArray, _truths("n")]
    at_rest: StrictBool
    engine: StrictStr
    impact: Number


def check_followed(details: dict[str, Any], assembly: Assembly) -> None:
    """Refuse details that do not hold what they say of a wall whose supports move, that is shaken or that moves on.

    Raises:
        ValueError: as of `InDetails.of`.
    """
    for kind in (DrivenWall, FollowedWall, SupportPath, ShakenWall):
        kind.of(details, assembly)
