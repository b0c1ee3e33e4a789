"""What a drawing holds once it is read: outlines of stones by layer, the unit, and what was left out and why."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field, replace

import numpy as np
import shapely

from harness.model.assembly import FloatArray
from harness.model.errors import InputError

Ring = Iterable[Sequence[float]]

LINES, CROSSES = "lines that close", "it crosses itself"
"""Words of an account that a reader looks for."""

SPIKE = 0.01
"""An outline that crosses itself is mended if that changes its area by less than this part: rounding folds the tip of a
thin corner over, and no more."""

SAME_OUTLINE = 0.98
"""Two outlines whose common area is at least this part of their union are one outline drawn twice.

A second pass of a CAD program, or a hatch over its border, differs by rounding only; two stones that bear on each other
share none."""


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

    @property
    def shape(self) -> shapely.Polygon:
        """The stone it encloses."""
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
        """Add an outline, or note why it is none (fewer than three vertices, no area, crosses itself)."""
        polygon = _cleaned(points)
        layer = str(more.get("layer", ""))
        where = f' on layer "{layer}"' if layer else ""
        if len(polygon) < 3:
            self.left_out[f"{kind}{where}: fewer than three vertices"] += 1
            return
        shape = shapely.Polygon(polygon)
        if not np.isfinite(polygon).all() or shape.area <= 0.0:
            self.left_out[f"{kind}{where}: it has no area"] += 1
        elif not shape.is_valid:
            whole = max(shapely.get_parts(shapely.make_valid(shape)), key=shapely.area)
            if whole.geom_type != "Polygon" or abs(whole.area - shape.area) > SPIKE * shape.area:
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
        """Holes of a stone; one that is no polygon within it, or touches it or another along a length, is told."""
        kept: list[FloatArray] = []
        for hole in map(_cleaned, holes):
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
        for cut in cuts:
            around = [k for k, outline in enumerate(self.outlines) if outline.shape.covers(cut.shape)]
            if not around:
                x, y = cut.polygon.mean(axis=0)
                self.left_out[f'hole on layer "{cut.layer}" that lies in no stone, near ({x:g}, {y:g})'] += 1
                continue
            least = min(around, key=lambda k: self.outlines[k].shape.area)
            stone = self.outlines[least]
            holes = self._holes_in(shapely.Polygon(stone.polygon), [*stone.holes, cut.polygon], "a stone")
            self.outlines[least] = replace(stone, holes=holes)

    def add_lines(self, lines: Sequence[tuple[FloatArray, str]], kind: str = LINES) -> None:
        """Add the areas that lines (k, 2) of one layer close, and note what ends in the open.

        Lines of a layer are cut where they meet, so a joint drawn once closes the stones on both sides of it.
        """
        for layer in dict.fromkeys(layer for _, layer in lines):
            mine = shapely.MultiLineString([line for line, its in lines if its == layer and len(line) > 1])
            faces, _, dangles, _ = shapely.polygonize_full([shapely.union_all([mine])])
            for face in shapely.get_parts(faces):
                within = [np.asarray(ring.coords)[:-1] for ring in face.interiors]
                self.add(kind, np.asarray(face.exterior.coords)[:-1], within, layer=layer)
            loose = shapely.get_num_geometries(dangles)
            if loose:
                x, y = shapely.get_coordinates(dangles)[0]
                self.left_out[f'line on layer "{layer}": it closes nothing, first near ({x:g}, {y:g})'] += int(loose)

    def once(self) -> None:
        """Keep outlines that are drawn twice once, and note them."""
        if len(self.outlines) < 2:
            return
        shapes = np.array([outline.shape for outline in self.outlines])
        i, j = shapely.STRtree(shapes).query(shapes, predicate="intersects")
        i, j = i[i < j], j[i < j]
        common, area = shapely.area(shapely.intersection(shapes[i], shapes[j])), shapely.area(shapes)
        twice = set(j[common >= SAME_OUTLINE * (area[i] + area[j] - common)].tolist())
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
            told = "; ".join(f"{count} x {what}" for what, count in self.left_out.items())
            raise InputError(
                "no closed outline is in it" + (f" ({told})" if told else ""),
                "Draw each stone as a closed polyline, or as lines that meet",
                source=source,
            )
        return self


def _cleaned(points: Ring) -> FloatArray:
    return without_repeats(np.array([tuple(point)[:2] for point in points], float).reshape(-1, 2))


def nested(rings: Sequence[FloatArray]) -> list[tuple[FloatArray, list[FloatArray]]]:
    """Closed lines (k, 2) of one entity as outlines, each with the lines just within it as its holes.

    What lies within a hole is an outline again, as in the even-odd rule of drawings.
    """
    shapes = np.array([shapely.Polygon(ring).buffer(0) for ring in rings])
    around: list[set[int]] = [set() for _ in rings]
    if len(rings) > 1:
        for inner, outer in shapely.STRtree(shapes).query(shapes, predicate="within").T.tolist():
            around[inner] |= {outer} - {inner}
    return [
        (ring, [rings[k] for k in range(len(rings)) if i in around[k] and len(around[k]) == len(around[i]) + 1])
        for i, ring in enumerate(rings)
        if len(around[i]) % 2 == 0
    ]


def without_repeats(polygon: FloatArray) -> FloatArray:
    """A polygon (k, 2) without vertices that repeat the one before, the last one's repetition of the first included."""
    if len(polygon) == 0:
        return polygon
    keep = (polygon != np.roll(polygon, 1, axis=0)).any(axis=1)
    return np.asarray(polygon[keep])
