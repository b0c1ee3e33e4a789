"""What a drawing holds once it is read: outlines of stones by layer, the unit, and what was left out and why."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np
import shapely

from harness.model.assembly import FloatArray
from harness.model.errors import InputError
from harness.model.units import METRES

Ring = Iterable[Sequence[float]]

LINES, CROSSES = "lines that close", "it crosses itself"
"""Words of an account that a reader looks for."""

_SPIKE = 0.01
"""An outline that crosses itself is mended if that changes its area by less than this part: rounding folds the tip of a
thin corner over, and no more."""

_LARGEST = 1e100
"""Greatest coordinate: products of three of them are numbers still."""
_MOST_PAIRS = 300_000
"""Pairs of parts of an outline, of lines or of outlines that may cross, at most: finding where they do takes a second
or two then, and grows with their square. Parts of a drawing of stones meet a few others each."""
_A_PART = 50
"""Pairs for each part that are looked into whatever their number: stones have a dozen neighbours."""
_MOST_CLOSED = 10_000
"""Areas that lines close at most: a facade has a few thousand stones, crossing lines of a grid close millions."""
_ASK_FOR_POLYLINES = "Draw each stone as a closed polyline, or as lines that meet"

MOST_COPIES = 20_000
"""Entities that blocks and clones of a drawing stand for at most, written out: copies of copies grow without bound."""
PLANES = {"xz": (0, 2, 1), "yz": (1, 2, 0), "xy": (0, 1, 2)}
"""Axes of a plane and the axis across it."""

_SAME_OUTLINE = 0.98
"""Two outlines whose common area is at least this part of their union are one outline drawn twice.

A second pass of a CAD program, or a hatch over its border, differs by rounding only; two stones in contact
share none."""


@dataclass(frozen=True)
class Asked:
    """What a reader is asked for besides the file.

    Attributes:
        accuracy: greatest distance of a curve from the chords that stand for it [m].
        unit: of the drawing, whatever it declares; empty if it is not said.
        scale: lengths of the wall in lengths of the drawing.
        plane: of a drawing in space; None leaves it to the format.
        at: where the plane cuts solids on the third axis [length of the drawing]; the middle if None.
    """

    accuracy: float = 0.001
    unit: str = ""
    scale: float = 1.0
    plane: str | None = None
    at: float | None = None

    def chord(self, declared: str) -> float:
        """The accuracy of curves in a drawing that declares a unit, or none [length of the drawing]."""
        return self.accuracy / (METRES[self.unit or declared or "m"] * self.scale)


@dataclass(frozen=True, eq=False)
class Outline:
    """A closed outline.

    Attributes:
        polygon: (k, 2) vertices, the first not repeated [length of the drawing].
        layer: of the drawing; empty if there is none.
        name: given by the drawing; empty if there is none.
        material: given by the drawing; empty if there is none.
        fixed: whether the drawing says that it is a support.
        holes: (j, 2) vertices of each hole within it, the first not repeated [length of the drawing].
    """

    polygon: FloatArray
    layer: str = ""
    name: str = ""
    material: str = ""
    fixed: bool = False
    holes: tuple[FloatArray, ...] = ()

    @cached_property
    def shape(self) -> shapely.Polygon:
        """The stone it encloses; made once, as most of the time of a large drawing would be that of making it again."""
        return shapely.Polygon(self.polygon, self.holes)


@dataclass
class Drawing:
    """Outlines of a file, with an account of what was read.

    Attributes:
        outlines: in the order of the file.
        unit: of length, as the wall format names it; empty if the file declares none.
        read: how many of each kind of entity gave outlines.
        left_out: what gave none, with the reason, and how often.
        notes: further sentences about the file.
    """

    outlines: list[Outline] = field(default_factory=list)
    unit: str = ""
    read: Counter[str] = field(default_factory=Counter)
    left_out: Counter[str] = field(default_factory=Counter)
    notes: list[str] = field(default_factory=list)

    def add(self, kind: str, points: Ring, holes: Iterable[Ring] = (), **more: object) -> None:
        """Add an outline, or note why it is none (fewer than three vertices, no area, crosses itself).

        Raises:
            InputError: a coordinate is no number or too large, or it crosses itself more often than is looked into.
        """
        layer = str(more.get("layer", ""))
        where = f' on layer "{layer}"' if layer else ""
        polygon = _cleaned(points, f"{kind}{where}" + (f' "{more["name"]}"' if more.get("name") else ""))
        if len(polygon) < 3:
            self.left_out[f"{kind}{where}: fewer than three vertices"] += 1
            return
        shape = shapely.Polygon(polygon)
        if shape.area <= 0.0:
            self.left_out[f"{kind}{where}: it has no area"] += 1
            return
        _check_edges(polygon, f"{kind}{where}: its edges")
        if not shape.is_valid:
            whole = max(shapely.get_parts(shapely.make_valid(shape)), key=shapely.area)
            if whole.geom_type != "Polygon" or abs(whole.area - shape.area) > _SPIKE * shape.area:
                self.left_out[f"{kind}{where}: {CROSSES} near {shapely.is_valid_reason(shape)}"] += 1
                return
            self.notes.append(f"{kind}{where} mended: {CROSSES} by a spike near {shapely.is_valid_reason(shape)}")
            more["holes"] = self._holes_in(whole, holes, kind + where)
            self.outlines.append(Outline(np.asarray(whole.exterior.coords)[:-1], **more))  # type: ignore[arg-type]
            self.read[f"{kind}{where}"] += 1
        else:
            more["holes"] = self._holes_in(shape, holes, kind + where)
            self.outlines.append(Outline(polygon, **more))  # type: ignore[arg-type]
            self.read[f"{kind}{where}"] += 1

    def _holes_in(self, stone: shapely.Polygon, holes: Iterable[Ring], what: str) -> tuple[FloatArray, ...]:
        """Holes of a stone; one that is no polygon within it, or touches it or another along a length, is reported."""
        kept: list[FloatArray] = []
        for ring in holes:
            hole = _cleaned(ring, f"a hole of {what}")
            inside = len(hole) > 2 and stone.covers(shapely.Polygon(hole).buffer(0))
            if inside and shapely.Polygon(stone.exterior, [*kept, hole]).is_valid:
                kept.append(hole)
            else:
                self.left_out[f"hole of {what}: it is no polygon within the outline, and is filled"] += 1
        return tuple(kept)

    def cut_out(self, layers: Iterable[str]) -> None:
        """Take the outlines on layers of holes as holes of the stones that they lie in; note those that lie in none."""
        wanted = set(layers)
        cuts = [outline for outline in self.outlines if outline.layer in wanted]
        self.outlines = [outline for outline in self.outlines if outline.layer not in wanted]
        shapes = np.array([outline.shape for outline in self.outlines], dtype=object)
        tree = shapely.STRtree(shapes)
        for cut in cuts:
            around = tree.query(cut.shape, predicate="covered_by")
            if not len(around):
                x, y = cut.polygon.mean(axis=0)
                self.left_out[f'hole on layer "{cut.layer}" that lies in no stone, near ({x:g}, {y:g})'] += 1
                continue
            least = int(around[np.argmin(shapely.area(shapes[around]))])
            stone = self.outlines[least]
            holes = self._holes_in(shapely.Polygon(stone.polygon), [*stone.holes, cut.polygon], "a stone")
            self.outlines[least] = replace(stone, holes=holes)

    def add_lines(self, lines: Sequence[tuple[FloatArray, str]]) -> None:
        """Add the areas that lines (k, 2) of one layer close, and note what ends in the open.

        Lines of a layer are cut where they meet, so a joint drawn once closes the stones on both sides of it.

        Raises:
            InputError: a coordinate is no number or too large, or they cross or close more than is looked into.
        """
        of_layers: dict[str, list[FloatArray]] = {}
        for line, layer in lines:
            if len(line) > 1:
                of_layers.setdefault(layer, []).append(finite(line, f'a line on layer "{layer}"'))
        for layer, mine in of_layers.items():
            _check_pairs(np.concatenate([_segments(line, closed=False) for line in mine]), f'lines on layer "{layer}"')
            faces, _, dangles, _ = shapely.polygonize_full([shapely.union_all([shapely.MultiLineString(mine)])])
            closed = shapely.get_num_geometries(faces)
            if closed > _MOST_CLOSED:
                raise InputError(
                    f"its lines close {closed:,} areas, and at most {_MOST_CLOSED:,} are taken for stones",
                    f"{_ASK_FOR_POLYLINES}, without grids and hatching",
                    f'layer "{layer}"',
                )
            for face in shapely.get_parts(faces):
                within = [np.asarray(ring.coords)[:-1] for ring in face.interiors]
                self.add(LINES, np.asarray(face.exterior.coords)[:-1], within, layer=layer)
            loose = shapely.get_num_geometries(dangles)
            if loose:
                x, y = shapely.get_coordinates(dangles)[0]
                self.left_out[f'line on layer "{layer}": it closes nothing, first near ({x:g}, {y:g})'] += int(loose)

    def once(self) -> None:
        """Keep outlines that are drawn twice once, and note them."""
        if len(self.outlines) < 2:
            return
        shapes = np.array([outline.shape for outline in self.outlines])
        _check_pairs(shapes, "its outlines")
        i, j = shapely.STRtree(shapes).query(shapes, predicate="intersects")
        i, j = i[i < j], j[i < j]
        common, area = shapely.area(shapely.intersection(shapes[i], shapes[j])), shapely.area(shapes)
        twice = set(j[common >= _SAME_OUTLINE * (area[i] + area[j] - common)].tolist())
        if twice:
            x, y = self.outlines[min(twice)].polygon.mean(axis=0)
            self.left_out[f"outline drawn twice, first near ({x:g}, {y:g})"] += len(twice)
            self.outlines = [outline for number, outline in enumerate(self.outlines) if number not in twice]

    def require(self, source: str) -> Drawing:
        """This drawing.

        Raises:
            InputError: it holds no outline, with what was left out.
        """
        if not self.outlines:
            skipped = "; ".join(f"{count} x {what}" for what, count in self.left_out.items())
            raise InputError(
                "no closed outline is in it" + (f" ({skipped})" if skipped else ""),
                _ASK_FOR_POLYLINES,
                source=source,
            )
        return self

    def scaled(self, scale: float) -> Drawing:
        """The drawing with every length times `scale`."""
        if scale == 1.0:
            return self
        outlines = [
            replace(item, polygon=scale * item.polygon, holes=tuple(scale * hole for hole in item.holes))
            for item in self.outlines
        ]
        return replace(self, outlines=outlines)


def _cleaned(points: Ring, what: str) -> FloatArray:
    return _without_repeats(finite(np.array([tuple(point)[:2] for point in points], float).reshape(-1, 2), what))


def finite(points: FloatArray, what: str) -> FloatArray:
    """The points (k, 2).

    Raises:
        InputError: one of them is no number or too large to compute with.
    """
    wrong = ~(np.abs(points) <= _LARGEST)
    if wrong.any():
        raise InputError(
            f"it has the coordinate {points[wrong][0]:g}", f"Give finite numbers of at most {_LARGEST:g}", element=what
        )
    return points


def _segments(points: FloatArray, *, closed: bool = True) -> np.ndarray:
    """The straight parts of a line (k, 2) as geometries."""
    onward = np.roll(points, -1, axis=0)
    pairs = np.stack([points, onward], axis=1)
    return np.asarray(shapely.linestrings(pairs if closed else pairs[:-1]))


def _check_edges(ring: FloatArray, what: str) -> None:
    """`_check_pairs` of the edges of a closed line (k, 2)."""
    if len(ring) ** 2 > _MOST_PAIRS:
        _check_pairs(_segments(ring), what)


def _check_pairs(parts: np.ndarray, what: str) -> None:
    """Refuse geometries (n,) of which so many lie over each other that to find where they meet would not end.

    Raises:
        InputError: there are more pairs whose boxes meet than is looked into.
    """
    most = max(_MOST_PAIRS, _A_PART * len(parts))
    if len(parts) ** 2 <= most:
        return
    tree, found = shapely.STRtree(parts), 0
    step = max(1, most // len(parts))
    for start in range(0, len(parts), step):
        found += tree.query(parts[start : start + step]).shape[1]
        if found > most:
            raise InputError(
                f"{what} lie over each other in more than {most:,} pairs, the limit",
                "Leave out hatching, and what is drawn many times over",
            )


def nested(rings: Sequence[FloatArray]) -> list[tuple[FloatArray, list[FloatArray]]]:
    """Closed lines (k, 2) of one entity as outlines, each with the lines just within it as its holes.

    What lies within a hole is an outline again, as in the even-odd rule of drawings.
    """
    if len(rings) < 2:
        return [(ring, []) for ring in rings]
    for ring in rings:
        _check_edges(finite(ring, "an outline in parts"), "edges of an outline in parts")
    shapes = np.array([shapely.Polygon(ring).buffer(0) for ring in rings])
    _check_pairs(shapes, "the parts of an outline")
    inner, outer = shapely.STRtree(shapes).query(shapes, predicate="within")
    inner, outer = inner[inner != outer], outer[inner != outer]
    depth = np.bincount(inner, minlength=len(rings))
    around: dict[int, set[int]] = {}
    for k, i in zip(inner.tolist(), outer.tolist(), strict=True):
        if depth[k] == depth[i] + 1:
            around.setdefault(i, set()).add(k)
    return [(ring, [rings[k] for k in sorted(around.get(i, ()))]) for i, ring in enumerate(rings) if depth[i] % 2 == 0]


def without_comments(text: str) -> str:
    """Text without comments from /* to */, the last of which may have no end."""
    kept, begin = [], 0
    while (start := text.find("/*", begin)) >= 0:
        kept.append(text[begin:start])
        end = text.find("*/", start + 2)
        begin = len(text) if end < 0 else end + 2
    return " ".join([*kept, text[begin:]])


def _without_repeats(polygon: FloatArray) -> FloatArray:
    """A polygon (k, 2) without vertices that repeat the one before, the last one's repetition of the first included."""
    if len(polygon) == 0:
        return polygon
    keep = ((polygon - np.roll(polygon, 1, axis=0)) ** 2).sum(axis=1) > 0.0
    return np.asarray(polygon[keep])
