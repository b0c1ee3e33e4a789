"""The display list: what a drawing shows, as polygons, lines, circles, arrows and texts with a role each.

Coordinates and sizes are drawing units: the longer side of a wall has 4000 of them, x points right and y down. A role
says what a part stands for; its colours and widths of lines are in `reports.drawing.looks`. There are two back-ends,
`reports.drawing.svg` and `reports.figures.plot`.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from harness.model.assembly import Assembly, FloatArray
from reports.geometry import shapes

_SIZE = 4000
_MARGIN = 560
BELOW = 240
LETTERS = 150.0
"""Size of letters that are read in a page: 11 px where a drawing takes a third of it."""
Box = tuple[float, float, float, float]
"""Left, top, width and height in drawing units."""


@dataclass(frozen=True)
class Frame:
    """The change from the lengths of a wall to drawing units.

    Attributes:
        extent: rectangle round the wall [length].
        length: size of its blocks [length].
    """

    extent: shapes.Extent
    length: float

    @classmethod
    def of(cls, assembly: Assembly) -> Frame:
        """The frame of a wall."""
        return cls(shapes.extent(assembly), assembly.length_scale)

    @property
    def scale(self) -> float:
        """Drawing units in a length."""
        return _SIZE / self.extent.longest

    @property
    def block(self) -> float:
        """Size of the blocks in drawing units."""
        return self.length * self.scale

    @property
    def thinner(self) -> float:
        """How much thinner than usual lines are drawn, so that small blocks are not buried under them."""
        return round(min(1.0, max(0.3, self.block / 450.0)), 2)

    @property
    def below(self) -> int:
        """Room below the wall: the scales of lengths and forces stand beside each other where it is wide enough."""
        return BELOW if self.extent.width * self.scale >= 0.55 * _SIZE else 2 * BELOW

    @property
    def box(self) -> Box:
        """The part to show: the wall and room round it for loads and motion."""
        width, height = self.extent.width * self.scale, self.extent.height * self.scale
        return -_MARGIN, -_MARGIN, width + 2 * _MARGIN, height + _MARGIN + self.below

    def place(self, points: FloatArray) -> FloatArray:
        """Points (..., 2) [length] in drawing units."""
        return np.asarray((points - [self.extent.left, self.extent.top]) * [self.scale, -self.scale])

    def place_all(self, outlines: Sequence[FloatArray]) -> list[FloatArray]:
        """Outlines (k, 2) [length] in drawing units."""
        if not outlines:
            return []
        return np.split(self.place(np.concatenate(outlines)), np.cumsum([len(outline) for outline in outlines])[:-1])

    def back(self, points: FloatArray) -> FloatArray:
        """Points (..., 2) in drawing units as lengths of the wall."""
        return np.asarray(points / [self.scale, -self.scale] + [self.extent.left, self.extent.top])


@dataclass(frozen=True)
class Polygons:
    """Closed outlines (k, 2), those with holes as of `harness.model.rings`.

    Attributes:
        rest: a line (2, 2) for each outline of four corners that opens as the wall moves, where it is before; empty
            where they do not open.
    """

    role: str
    outlines: tuple[FloatArray, ...]
    rest: tuple[FloatArray, ...] = ()


@dataclass(frozen=True)
class Lines:
    """Open lines (k, 2) of one width.

    Attributes:
        width: that of the role if None.
        dash: length of dashes and gaps; as of the role if None.
    """

    role: str
    points: tuple[FloatArray, ...]
    width: float | None = None
    dash: float | None = None


@dataclass(frozen=True)
class Circles:
    """Circles about points (k, 2)."""

    role: str
    centres: FloatArray
    radius: float


@dataclass(frozen=True)
class Arrows:
    """Straight arrows from tails to tips (k, 2) with heads (k,) of a length."""

    role: str
    tails: FloatArray
    tips: FloatArray
    heads: FloatArray

    def outlines(self) -> tuple[tuple[FloatArray, ...], tuple[FloatArray, ...]]:
        """The shafts (2, 2) and the triangles (3, 2) of the heads."""
        step = self.tips - self.tails
        way = step / np.linalg.norm(step, axis=1)[:, None]
        neck = self.tips - self.heads[:, None] * way
        side = 0.4 * self.heads[:, None] * np.column_stack([-way[:, 1], way[:, 0]])
        shafts = np.stack([self.tails, neck], axis=1)
        return tuple(shafts), tuple(np.stack([self.tips, neck + side, neck - side], axis=1))


@dataclass(frozen=True)
class Text:
    """Letters whose baseline begins ("start"), ends or has its middle at a point; `title` is shown on hovering."""

    role: str
    at: tuple[float, float]
    text: str
    size: float
    anchor: str = "middle"
    title: str = ""


Shape = Polygons | Lines | Circles | Arrows | Text


@dataclass(frozen=True)
class Group:
    """Parts that belong together: they move as one, and have values for who points at them.

    Attributes:
        motion: (turn, x, y): a point (x', y') goes to (x' - turn y' + x, y' + turn x' + y), without large rotations.
        block, joint: index of the block or of the interface that the parts show.
        values: numbers and words of it; None where there is none.
    """

    parts: tuple[Shape, ...]
    motion: tuple[float, float, float] | None = None
    block: int | None = None
    joint: int | None = None
    values: tuple[float | str | None, ...] = ()


@dataclass(frozen=True)
class DisplayList:
    """A display list in the order of drawing.

    Attributes:
        frame: of its wall.
        label: what is shown, for who cannot see it.
        parts: shapes and groups.
    """

    frame: Frame
    label: str
    parts: list[Shape | Group] = field(default_factory=list)

    def flat(self) -> Iterator[Shape]:
        """All shapes where their groups have moved them; neighbours of one look as one shape."""
        held: Shape | None = None
        for shape in self._moved():
            joined = None if held is None else _joined(held, shape)
            if held is not None and joined is None:
                yield held
            held = joined or shape
        if held is not None:
            yield held

    def _moved(self) -> Iterator[Shape]:
        for part in self.parts:
            if isinstance(part, Group):
                yield from (moved(shape, part.motion) for shape in part.parts)
            else:
                yield part


def moved(shape: Shape, motion: tuple[float, float, float] | None) -> Shape:
    """A shape after the motion of its group."""
    if motion is None:
        return shape
    turn, x, y = motion

    def at(points: FloatArray) -> FloatArray:
        return np.column_stack([points[:, 0] - turn * points[:, 1] + x, points[:, 1] + turn * points[:, 0] + y])

    match shape:
        case Polygons():
            return replace(shape, outlines=tuple(at(outline) for outline in shape.outlines))
        case Lines():
            return replace(shape, points=tuple(at(line) for line in shape.points))
        case Circles():
            return replace(shape, centres=at(shape.centres))
        case Arrows():
            return replace(shape, tails=at(shape.tails), tips=at(shape.tips))
        case Text():
            to = at(np.array([shape.at]))[0]
            return replace(shape, at=(float(to[0]), float(to[1])))


def _joined(first: Shape, second: Shape) -> Shape | None:
    """Two shapes as one where they look alike."""
    if first.role != second.role:
        return None
    match first, second:
        case Polygons(), Polygons():
            return replace(first, outlines=first.outlines + second.outlines, rest=first.rest + second.rest)
        case Lines(), Lines() if (first.width, first.dash) == (second.width, second.dash):
            return replace(first, points=first.points + second.points)
        case Circles(), Circles() if first.radius == second.radius:
            return replace(first, centres=np.concatenate([first.centres, second.centres]))
    return None


def chosen(outlines: Sequence[FloatArray], members: np.ndarray) -> tuple[FloatArray, ...]:
    """Those outlines that are members."""
    return tuple(outline for outline, member in zip(outlines, members.tolist(), strict=True) if member)
