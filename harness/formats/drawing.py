"""What a drawing holds once it is read: outlines of stones by layer, the unit, and what was left out and why."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field

import numpy as np
import shapely

from harness.model.assembly import FloatArray
from harness.model.errors import InputError

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
    """

    polygon: FloatArray
    layer: str = ""
    name: str = ""
    material: str = ""
    fixed: bool = False


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

    def add(self, kind: str, points: Iterable[Sequence[float]], **more: object) -> None:
        """Add an outline, or note why it is none (fewer than three vertices, no area, crosses itself)."""
        polygon = without_repeats(np.array([tuple(point)[:2] for point in points], float).reshape(-1, 2))
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
            self.outlines.append(Outline(np.asarray(whole.exterior.coords)[:-1], **more))  # type: ignore[arg-type]
            self.read[f"{kind}{where}"] += 1
        else:
            self.outlines.append(Outline(polygon, **more))  # type: ignore[arg-type]
            self.read[f"{kind}{where}"] += 1

    def add_lines(self, lines: Sequence[tuple[FloatArray, str]], kind: str = LINES) -> None:
        """Add the areas that lines (k, 2) of one layer close, and note what ends in the open.

        Lines of a layer are cut where they meet, so a joint drawn once closes the stones on both sides of it.
        """
        for layer in dict.fromkeys(layer for _, layer in lines):
            mine = shapely.MultiLineString([line for line, its in lines if its == layer and len(line) > 1])
            faces, _, dangles, _ = shapely.polygonize_full([shapely.union_all([mine])])
            for face in shapely.get_parts(faces):
                self.add(kind, np.asarray(face.exterior.coords)[:-1], layer=layer)
            loose = shapely.get_num_geometries(dangles)
            if loose:
                x, y = shapely.get_coordinates(dangles)[0]
                self.left_out[f'line on layer "{layer}": it closes nothing, first near ({x:g}, {y:g})'] += int(loose)

    def once(self) -> None:
        """Keep outlines that are drawn twice once, and note them."""
        if len(self.outlines) < 2:
            return
        shapes = np.array([shapely.Polygon(outline.polygon) for outline in self.outlines])
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


def without_repeats(polygon: FloatArray) -> FloatArray:
    """A polygon (k, 2) without vertices that repeat the one before, the last one's repetition of the first included."""
    if len(polygon) == 0:
        return polygon
    keep = (polygon != np.roll(polygon, 1, axis=0)).any(axis=1)
    return np.asarray(polygon[keep])
