"""A wall as it was read, drawn to be checked: sound or not, with its faults marked under the numbers of their list.

Blocks carry the ids that messages use, the axes the coordinates of the file; a bar shows the scale. On request the
wall and every block carry their sizes.
"""

from __future__ import annotations

import textwrap
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import shapely
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from harness.model.assembly import FloatArray
from harness.model.inspection import FaultMark, Inspection
from harness.model.load_cases import named_loads
from harness.model.rings import rings_of
from harness.model.units import DIMENSIONLESS
from reports.drawing.display_list import Arrows, DisplayList, Frame, Polygons
from reports.drawing.looks import COLOURS, LOOKS
from reports.drawing.wall_drawing import joint_lines, load_arrows
from reports.figures.figures import PAGE, save, style
from reports.figures.plot import plot
from reports.geometry import shapes
from reports.geometry.thrust_lines import round_number
from reports.labels.numbers import count


@dataclass(frozen=True)
class Sheet:
    """The look of the sheet.

    Attributes:
        margin: round the wall, in its longer side: room for dimensions and for the numbers of marks.
        text, least: greatest and least size of letters [pt]; ids are made to fit their blocks, and below the least they
            cannot be read even when a drawing fills a screen.
        wide: width of a letter in its size, of the fonts of figures on the average.
        tallest: height of the drawing in its width at most, so that a tower stays on a page.
        listed: marks explained below the drawing; `drystone validate` lists all.
        line: letters of a line of such words.
    """

    margin: float = 0.09
    text: float = 6.0
    least: float = 0.8
    wide: float = 0.62
    tallest: float = 1.4
    listed: int = 14
    line: int = 150


def draw_inspected(looked: Inspection, path: Path, *, axes: bool = True, dimensions: bool = False) -> None:
    """Draw a wall, sound or not, to a file.

    Args:
        looked: the wall looked over.
        path: the file; its ending .pdf, .svg or .png says the format.
        axes: whether coordinates and a scale are drawn.
        dimensions: whether sizes of the wall and of its blocks are.

    Raises:
        InputError: another ending.
    """
    save(lambda: inspected_figure(looked, axes=axes, dimensions=dimensions), path)


def inspected_figure(
    looked: Inspection, *, axes: bool = True, dimensions: bool = False, sheet: Sheet | None = None
) -> Figure:
    """The figure of `draw_inspected`."""
    sheet = sheet or Sheet()
    with style():
        extent = shapes.extent_of(looked.outlines)
        margin = sheet.margin * extent.longest
        width, height = extent.width + 2 * margin, extent.height + 2 * margin
        legend = [*_loads(looked), *_legend(looked.marks, sheet)]
        tall = PAGE * min(height / width, sheet.tallest)
        foot = (0.35 if axes else 0.0) + 1.35 * sheet.text / 72 * len(legend)
        page = Figure(figsize=(PAGE, tall + foot))
        ax = page.add_axes((0.08, foot / (tall + foot), 0.9, tall / (tall + foot)))
        ax.set_xlim(extent.left - margin, extent.right + margin)
        ax.set_ylim(extent.bottom - margin, extent.top + margin)
        ax.set_aspect("equal")
        plot(ax, _drawing(looked, extent, margin, dimensions=dimensions), least=0.0)
        point = width / (72 * min(0.9 * PAGE, tall * width / height))  # length that one point of the page shows
        _ids(ax, looked, point, sheet, dimensions=dimensions)
        if dimensions:
            _overall(ax, extent, margin, sheet)
        unit = looked.wall.units.length
        if axes:
            _axes(ax, extent, margin, "" if unit == DIMENSIONLESS else unit, sheet)
        else:
            ax.axis("off")
        _marks(ax, looked.marks, sheet)
        words = "\n".join(legend)
        page.text(
            0.02, 0.1 * sheet.text / 72 / (tall + foot), words, fontsize=sheet.text, color=COLOURS["ink"], va="bottom"
        )
    return page


def _drawing(looked: Inspection, extent: shapes.Extent, margin: float, *, dimensions: bool) -> DisplayList:
    """Outlines as drawn, also those that are no polygons, those of blocks with a mark tinted; joints, loads, sizes."""
    assembly = None if looked.built is None else looked.built.assembly
    drawn = DisplayList(Frame(extent, 0.1 * extent.longest if assembly is None else assembly.length_scale), "")
    concerned = {name: mark.kind for mark in reversed(looked.marks) for name in mark.blocks}
    for k in sorted(range(len(looked.names)), key=lambda k: not looked.fixed[k]):
        role = concerned.get(looked.names[k], "sound") + ("-held" if looked.fixed[k] else "")
        drawn.parts.append(Polygons(role, (drawn.frame.place(looked.outlines[k]),)))
    if assembly is not None:
        drawn.parts.extend(joint_lines(drawn.frame, assembly))
        drawn.parts.extend(load_arrows(drawn.frame, assembly, head=40.0))
    if dimensions:
        right, top = extent.right + 0.6 * margin, extent.top + 0.6 * margin
        width = np.array([(extent.left, top), (extent.right, top)])
        height = np.array([(right, extent.bottom), (right, extent.top)])
        ends = drawn.frame.place(np.stack([width, width[::-1], height, height[::-1]]))
        drawn.parts.append(Arrows("size", ends[:, 0], ends[:, 1], np.full(4, 35.0)))
    return drawn


def _ids(ax: Axes, looked: Inspection, point: float, sheet: Sheet, *, dimensions: bool) -> None:
    """Ids, and sizes where they are wanted, as large as their blocks allow; `point` [length] is one of the page."""
    for name, outline in zip(looked.names, looked.outlines, strict=True):
        lines = [name, _size(outline)] if dimensions else [name]
        across, up = np.ptp(outline, axis=0) / point
        letters = max(len(line) for line in lines)
        high = 0.8 / (2 * 1.7) if dimensions else 0.5 / 1.3  # of the block: two lines far apart, or one
        size = min(sheet.text, 0.9 * across / (sheet.wide * letters), high * up)
        if size < sheet.least:
            continue
        x, y = _inside(outline)
        above = "center" if dimensions else "bottom"  # the arrow of a load goes between the lines, or below one
        ax.text(x, y, "\n".join(lines), ha="center", va=above, color=COLOURS["ink"], fontsize=size, linespacing=1.9)


def _inside(outline: FloatArray) -> tuple[float, float]:
    """A point for the letters of a block: the middle of its extent, or another one where that is outside."""
    outer, *holes = rings_of(outline)
    shape = shapely.Polygon(outer, holes).buffer(0)
    x, y = (outline.min(axis=0) + 0.5 * np.ptp(outline, axis=0)).tolist()
    if shape.is_empty or shape.contains(shapely.Point(x, y)):
        return x, y
    inside = shape.representative_point()
    return inside.x, inside.y


def _size(outline: FloatArray) -> str:
    """Length and height of a block: the sides of the least rectangle about it."""
    corners = shapely.get_coordinates(shapely.oriented_envelope(shapely.MultiPoint(outline)))
    if len(corners) < 4:
        return ""
    sides = np.diff(corners, axis=0)[:2]
    flat, steep = sorted(sides, key=lambda side: abs(side[1]) / (abs(side[0]) + abs(side[1])))
    return f"{np.hypot(*flat):.4g} x {np.hypot(*steep):.4g}"


def _overall(ax: Axes, extent: shapes.Extent, margin: float, sheet: Sheet) -> None:
    """Width and height of the wall in numbers at its lines of dimension above and on the right."""
    right, top = extent.right + 0.6 * margin, extent.top + 0.6 * margin
    middle = (0.5 * (extent.left + extent.right), 0.5 * (extent.bottom + extent.top))
    ax.text(middle[0], top, f"{extent.width:.6g}", ha="center", va="bottom", fontsize=sheet.text, color=COLOURS["ink"])
    ax.text(
        right,
        middle[1],
        f"{extent.height:.6g}",
        rotation=90,
        ha="right",
        va="center",
        fontsize=sheet.text,
        color=COLOURS["ink"],
    )


def _axes(ax: Axes, extent: shapes.Extent, margin: float, unit: str, sheet: Sheet) -> None:
    """Coordinates of the file along two sides, and a bar of a round length."""
    ax.tick_params(labelsize=sheet.text, color=COLOURS["grey"])
    for side, line in ax.spines.items():
        line.set_visible(side in ("left", "bottom"))
        line.set_color(COLOURS["grey"])
    ax.ticklabel_format(useOffset=False)
    for axis, name in ((ax.xaxis, "x"), (ax.yaxis, "y")):
        axis.set_label_text(f"{name} [{unit}]" if unit else name, fontsize=sheet.text)
    length = round_number(0.25 * extent.width)
    left, low = extent.left, extent.bottom - 0.6 * margin
    ax.plot([left, left + length], [low, low], color=COLOURS["ink"], linewidth=2.0, solid_capstyle="butt")
    ax.text(left + length, low, f"  {length:g} {unit}", va="center", fontsize=sheet.text, color=COLOURS["ink"])


def _marks(ax: Axes, marks: Sequence[FaultMark], sheet: Sheet) -> None:
    """The numbers of marks at their places, those at one place beside each other."""
    there: dict[tuple[float, float], list[int]] = {}
    for number, mark in enumerate(marks, start=1):
        if mark.at is not None:
            there.setdefault(mark.at, []).append(number)
    for at, numbers in there.items():
        tint = COLOURS[LOOKS[marks[numbers[0] - 1].kind].stroke]
        ax.plot(*at, "x", color=tint, markersize=0.6 * sheet.text)
        ax.annotate(
            ", ".join(str(number) for number in numbers),
            at,
            xytext=(5, 5),
            textcoords="offset points",
            fontsize=sheet.text,
            fontweight="bold",
            color="white",
            bbox={"boxstyle": "round,pad=0.2", "facecolor": tint, "edgecolor": "none"},
            arrowprops={"arrowstyle": "-", "color": tint},
        )


def _loads(looked: Inspection) -> list[str]:
    """Which of several load cases is drawn, in words."""
    if not looked.load_case:
        return []
    return [f'Loads: load case "{looked.load_case}", of {count(len(named_loads(looked.wall)), "load case")}']


def _legend(marks: Sequence[FaultMark], sheet: Sheet) -> list[str]:
    """The first marks in words."""
    lines: list[str] = []
    for number, mark in enumerate(marks[: sheet.listed], start=1):
        lines += textwrap.wrap(f"{number}. {mark.kind}: {mark}", sheet.line, subsequent_indent="     ")
    more = len(marks) - sheet.listed
    return [*lines, f"and {more} more: drystone validate lists all of them"] if more > 0 else lines
