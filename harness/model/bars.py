"""Ties and props as arrays: bars with a hinge at each end, between points of two blocks.

A bar bears the tension T (compression negative) in the range prestress + least <= T <= prestress + greatest. Its
prestress is part of the dead load; what is beyond it does work on the elongation. The elongation rate d is that of the
distance of its ends. Where d > 0 the bar is at its greatest force, where d < 0 at its least (plastic, associated):
a tie (least 0) takes work only where it yields, and none where it goes slack. Source: Livesley (1978), bars of plastic
frames with other limits in tension and compression.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from functools import cached_property, partial
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from harness.model.details import BAR_FORCES, DEAD_BAR_FORCES, AnswerDetails

if TYPE_CHECKING:
    from harness.model.assembly import Assembly
    from harness.model.method import Answer
    from harness.model.result import Result

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]


def _no_index() -> IntArray:
    return np.zeros(0, dtype=np.int64)


_none = partial(np.zeros, (0,))
_no_points = partial(np.zeros, (0, 2))


ARRAYS = ("block_a", "block_b", "end1", "end2", "prestress", "least", "greatest", "stiffness")
"""Fields of `Bars` that are arrays, an entry a bar."""


@dataclass(frozen=True, eq=False)
class Bars:
    """k ties and props.

    Attributes:
        names: (k,) for messages and tables.
        kinds: (k,) "tie", "prop" or, of passive fill, "fill".
        block_a, block_b: (k,) indices of the blocks at end 1 and at end 2.
        end1, end2: (k, 2) ends [length].
        prestress: (k,) tension that acts as dead load [force].
        least, greatest: (k,) range of what is borne beyond the prestress, tension positive [force].
        stiffness: (k,) force for a unit of elongation [force/length]; nan where none is given.
    """

    names: tuple[str, ...] = ()
    kinds: tuple[str, ...] = ()
    block_a: IntArray = field(default_factory=_no_index)
    block_b: IntArray = field(default_factory=_no_index)
    end1: FloatArray = field(default_factory=_no_points)
    end2: FloatArray = field(default_factory=_no_points)
    prestress: FloatArray = field(default_factory=_none)
    least: FloatArray = field(default_factory=_none)
    greatest: FloatArray = field(default_factory=_none)
    stiffness: FloatArray = field(default_factory=_none)

    def __post_init__(self) -> None:
        """Without any stiffness none is given."""
        if not len(self.stiffness):
            object.__setattr__(self, "stiffness", np.full(len(self.names), np.nan))

    def __len__(self) -> int:
        """Number of bars k."""
        return len(self.names)

    @cached_property
    def axis(self) -> FloatArray:
        """(k, 2) unit vectors from end 1 to end 2."""
        along = self.end2 - self.end1
        return np.asarray(along / np.hypot(along[:, 0], along[:, 1])[:, None])

    def chosen(self, kept: IntArray, place: IntArray) -> Bars:
        """These bars (j,) alone, on blocks numbered by `place` (n,)."""
        arrays: dict[str, Any] = {name: getattr(self, name)[kept] for name in ARRAYS}
        arrays |= {name: place[arrays[name]] for name in ("block_a", "block_b")}
        return Bars(tuple(self.names[k] for k in kept), tuple(self.kinds[k] for k in kept), **arrays)

    def followed_by(self, others: Bars) -> Bars:
        """These bars and then others."""
        arrays: dict[str, Any] = {name: np.concatenate([getattr(self, name), getattr(others, name)]) for name in ARRAYS}
        return Bars(self.names + others.names, self.kinds + others.kinds, **arrays)

    def copied(self) -> Bars:
        """The same bars in arrays of their own."""
        return self.chosen(np.arange(len(self)), np.arange(1 + max([0, *self.block_a, *self.block_b])))

    def generalised(self, tension: FloatArray, centroid: FloatArray) -> FloatArray:
        """(n, 3) forces and moments about the centroids (n, 2) of the blocks, of tensions (k,) [force]."""
        sums = np.zeros((len(centroid), 3))
        pull = tension[:, None] * self.axis
        for block, point, force in ((self.block_a, self.end1, pull), (self.block_b, self.end2, -pull)):
            arm = point - centroid[block]
            np.add.at(sums, block, np.column_stack([force, arm[:, 0] * force[:, 1] - arm[:, 1] * force[:, 0]]))
        return sums

    def elongations(self, mechanism: FloatArray, centroid: FloatArray) -> FloatArray:
        """(k,) elongation rates under a mechanism (n, 3) of blocks with centroids (n, 2)."""
        ends = []
        for block, point in ((self.block_a, self.end1), (self.block_b, self.end2)):
            arm = point - centroid[block]
            turn = mechanism[block, 2:3] * np.stack([-arm[:, 1], arm[:, 0]], axis=1)
            ends.append(mechanism[block, :2] + turn)
        return np.asarray(((ends[1] - ends[0]) * self.axis).sum(axis=1))


def with_bars_as_joints(assembly: Assembly) -> Assembly:
    """The wall with each bar as a further row of the law of joints, after the joints that it has.

    Such a row has no normal, so that its normal forces do nothing, and its tangent is the axis of the bar: its shear s
    is minus the tension beyond the prestress, its slip the elongation. Friction and dilatancy -1 leave -(n1 + n2) on
    top of the range of s: with n1 = n2 = 0 that is the range of the bar, and of both signs of slip each lifts the ends
    of which nothing is seen; so the domain is bounded, its flow is associated, and both have an interior.
    """
    bars = assembly.bars
    k = len(bars)
    if not k:
        return assembly
    minus, nothing = np.full(k, -1.0), np.zeros((k, 2))
    wall = assembly.with_further_joints(
        bars.names,
        block_a=bars.block_a,
        block_b=bars.block_b,
        end1=bars.end1,
        end2=bars.end2,
        face1=bars.end1,
        face2=bars.end2,
        normal=nothing,
        friction=minus,
        dilatancy=minus,
        constant=np.column_stack([nothing, bars.greatest, 0.0 - bars.least]),
        bar_stiffness=bars.stiffness,
    )
    return replace(wall, bars=Bars())


def tensions(bars: Bars, forces: FloatArray) -> FloatArray:
    """(k,) tensions of the bars [force], from the forces (m + k, 3) of a wall of `with_bars_as_joints`."""
    return np.asarray(bars.prestress - forces[len(forces) - len(bars) :, 2])


def with_bar_forces(answer: Answer, bars: Bars, m: int) -> Answer:
    """The answer for a wall with bars as joints, its forces (m + k, 3) separated: of m joints and of k bars.

    Columns of its path that have the name of a bar are tensions beyond the prestress, and become whole ones.
    """
    details = dict(answer.details)
    found = AnswerDetails(answer.details)
    named = {BAR_FORCES: answer.forces, DEAD_BAR_FORCES: found.dead_forces}
    details |= {name: tensions(bars, np.asarray(all_)).tolist() for name, all_ in named.items() if all_ is not None}
    details |= {name: forces[:m] for name, forces in found.contact_forces.items()}
    whole = {
        path_column(name): [prestress + beyond for beyond in answer.path[path_column(name)]]
        for name, prestress in zip(bars.names, bars.prestress.tolist(), strict=True)
        if path_column(name) in answer.path
    }
    forces = None if answer.forces is None else answer.forces[:m]
    return replace(answer, forces=forces, path=answer.path | whole, details=details)


def path_column(name: str) -> str:
    """The column of a path that holds the tensions of a bar."""
    return f"tension of {name}"


def bar_tensions(assembly: Assembly, result: Result | None) -> FloatArray | None:
    """(k,) tensions that an answer gives of the bars of a wall [force]; None where it gives none of them."""
    listed = None if result is None or result.forces is None else AnswerDetails(result.details).bar_tensions()
    fits = isinstance(listed, list) and len(listed) == len(assembly.bars) > 0
    return np.asarray(listed, dtype=float) if fits else None


def state_of(kind: str, tension: float, least: float, greatest: float) -> str:
    """ "yields" at its yield force, "slack" or "at its prestress" where it bears no more than that, else "bears".

    Args:
        kind: as of `Bars`; tension: of the bar, in its range from `least` to `greatest`, prestress included [force].
    """
    rounding = 1e-9 * (greatest - least)
    yields, slack = (greatest, least) if kind == "tie" else (least, greatest)
    if abs(tension - yields) <= rounding:
        return "yields"
    return ("at its prestress" if slack else "slack") if abs(tension - slack) <= rounding else "bears"
