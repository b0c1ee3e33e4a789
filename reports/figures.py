"""Figures for papers: walls, mechanisms, contact forces and thrust lines through matplotlib, as PDF, SVG or PNG.

Widths are those of a journal: one column of 88 mm, two of 180 mm. The same input gives the same bytes.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure

from harness.model.assembly import Assembly, FloatArray
from harness.model.build import Built
from harness.model.case import Case
from harness.model.errors import InputError
from harness.model.result import Result
from harness.model.writing import replacing
from reports import flow, joints, shapes
from reports.drawing import LABELLED_BLOCKS, block_labels, stroke_factor
from reports.facts import friction_text, value_in_words
from reports.force_figure import BLUE, GREY, INK, PLUM, RUST, draw_forces, length_scale, stones

COLUMN, PAGE = 88 / 25.4, 180 / 25.4
"""Width of one and of two columns [inch]."""
WINDOW_DPI = 220
KINDS = ("mechanism", "forces", "thrust", "wall", "comparison")
FORMATS = (".pdf", ".svg", ".png")
MARKS = {
    joints.SLIDE: (RUST, 1.8, "-"),
    joints.DILATANT: (RUST, 2.1, "-"),
    joints.ROCK: (BLUE, 1.1, "-"),
    joints.BOTH: (RUST, 1.8, "-"),
    joints.OPEN: (PLUM, 1.0, "--"),
}
"""Colour, width [pt] and line of what a joint does."""
_STYLE: dict[Any, Any] = {
    "font.family": "DejaVu Sans",
    "font.size": 7.0,
    "axes.titlesize": 7.5,
    "pdf.fonttype": 42,
    "svg.fonttype": "path",
    "svg.hashsalt": "drystone",
    "hatch.linewidth": 0.4,
    "path.simplify": False,
    "text.parse_math": False,
    "savefig.dpi": 300,
    "figure.dpi": 100,
}


def figure(case: Case, results: list[Result], kind: str, path: Path) -> None:
    """Draw results of one case.

    Args:
        case: the case.
        results: one result for a single drawing; several stand side by side.
        kind: "mechanism", "forces", "thrust", "wall" or "comparison" (mechanism above forces for every result).
        path: the file; its ending .pdf, .svg or .png says the format.

    Raises:
        InputError: an unknown kind or ending, or results without the field to draw.
    """
    if kind not in KINDS:
        raise InputError(f'there is no figure "{kind}"', f"Ask for one of {', '.join(KINDS)}")
    if kind == "wall":
        show_wall(case.built, path, title=case.file.title)
        return
    save(lambda: results_figure(case, results, kind), path)


def results_figure(case: Case, results: list[Result], kind: str) -> Figure:
    """Results of one case side by side: "mechanism", "forces", "thrust" or "comparison".

    Raises:
        InputError: an unknown kind, or results without the field to draw.
    """
    if kind not in KINDS or kind == "wall":
        raise InputError(f'there is no figure "{kind}"', f"Ask for one of {', '.join(set(KINDS) - {'wall'})}")
    needed = {"mechanism": ["mechanism"], "comparison": ["mechanism", "forces"]}.get(kind, ["forces"])
    usable = [r for r in results if any(getattr(r, name) is not None for name in needed)]
    if not usable:
        methods = ", ".join(result.method for result in results) or "no method"
        raise InputError(
            f"{methods} left no {' and no '.join(needed)} to draw",
            "Choose a method that ended with a collapse state",
            source=case.id,
        )
    rows = ["mechanism", "forces"] if kind == "comparison" else [kind]
    with style():
        return _panels(case, usable, rows)


def show_wall(built: Built, path: Path, *, title: str = "") -> None:
    """Draw a wall before anything is run: blocks with numbers, joints, contact points, supports and loads.

    Args:
        built: the wall.
        path: the file; its ending .pdf, .svg or .png says the format.
        title: above the drawing.

    Raises:
        InputError: another ending.
    """
    save(lambda: _wall(built, title), path)


def wall_figure(built: Built, title: str = "") -> Figure:
    """A wall before anything is run: blocks with numbers, joints, contact points, supports and loads."""
    with style():
        return _wall(built, title)


def show_window(page: Figure, title: str) -> None:
    """Show a figure in a window, where it can be zoomed, and wait until the user closes it.

    Raises:
        InputError: no window can be opened here.
    """
    with style(), mpl.rc_context({"figure.dpi": WINDOW_DPI}):
        try:
            from tkinter import TclError

            from matplotlib.backends.backend_tkagg import FigureCanvasTkAgg
        except ImportError as error:
            raise _no_window(error) from error
        try:
            manager: Any = FigureCanvasTkAgg.new_manager(page, 1)
        except TclError as error:
            raise _no_window(error) from error
        manager.set_window_title(title)
        manager.show()
        manager.window.mainloop()


def _no_window(error: Exception) -> InputError:
    return InputError(
        f"no window can be opened here ({error})", "Draw to a file instead: -o wall.svg", source="--window"
    )


def _wall(built: Built, title: str = "") -> Figure:
    assembly = built.assembly
    page, axes = blank(assembly, 1, 1, head=_title(title, assembly) if title else "")
    length_scale(axes[0][0], assembly, built.wall.units)
    draw_blocks(axes[0][0], assembly, list(assembly.polygons))
    draw_joints(axes[0][0], assembly)
    _labels(axes[0][0], assembly)
    draw_loads(axes[0][0], assembly, shapes.extra_dead_load(assembly), RUST, "dead")
    draw_loads(axes[0][0], assembly, assembly.live, BLUE, "live")
    return page


@contextmanager
def style() -> Iterator[None]:
    """Matplotlib's own defaults and ours, whatever the user's configuration says."""
    with mpl.rc_context():
        mpl.rcdefaults()
        mpl.rcParams.update(_STYLE)
        yield


def save(make: Callable[[], Figure], path: Path) -> None:
    """Make a figure and write it, in the style of figures.

    Raises:
        InputError: an ending that no figure has, or the path of something that is no regular file.
    """
    if path.suffix.lower() not in FORMATS:
        raise InputError(f'no figure is written as "{path.suffix}"', f"Use {', '.join(FORMATS)}", source=str(path))
    with replacing(path) as draft, style():
        make().savefig(draft, metadata=metadata(path))


def metadata(path: Path) -> dict[str, Any]:
    """File information without dates, so that the bytes depend on the input alone."""
    suffix = path.suffix.lower()
    if suffix == ".pdf":
        return {"CreationDate": None, "ModDate": None, "Creator": "Drystone", "Producer": "matplotlib"}
    return {"Date": None, "Creator": "Drystone"} if suffix == ".svg" else {"Software": "Drystone"}


def blank(assembly: Assembly, rows: int, columns: int, head: str = "") -> tuple[Figure, Any]:
    """A figure of a journal's width whose axes have the shape of the wall, with a line of text above all."""
    extent = shapes.extent(assembly)
    margin = 0.14 * extent.longest
    width = COLUMN if columns == 1 else PAGE
    aspect = (extent.height + 2 * margin) / (extent.width + 2 * margin)
    each = width / columns
    above = 0.22 + (0.34 if head else 0.0)
    height = min(rows * (each * min(aspect, 1.6) + 0.28) + above - 0.22, 9.2)
    page = Figure(figsize=(width, height))
    axes = page.subplots(rows, columns, squeeze=False)
    page.subplots_adjust(left=0.01, right=0.99, bottom=0.01, top=1.0 - above / height, wspace=0.03, hspace=0.12)
    if head:
        page.suptitle(_fitting(head, width), x=0.01, y=1.0 - 0.05 / height, ha="left", va="top", fontsize=7.5)
    for ax in axes.ravel():
        ax.set_xlim(extent.left - margin, extent.right + margin)
        ax.set_ylim(extent.bottom - margin, extent.top + margin)
        ax.set_aspect("equal")
        ax.axis("off")
    return page, axes


def _fitting(text: str, width: float) -> str:
    """As much of each line of a text as fits a width [inch] at the size of titles: about 18 letters an inch."""
    most = int(18.0 * width)
    return "\n".join(line if len(line) <= most else f"{line[: most - 1]}…" for line in text.split("\n"))


def _title(title: str, assembly: Assembly) -> str:
    return f"{title}\ntan φ = {friction_text(assembly)}"


def _panels(case: Case, results: list[Result], rows: list[str]) -> Figure:
    assembly, units = case.assembly, case.wall.units
    page, axes = blank(assembly, len(rows), len(results), head=_title(case.file.title, assembly))
    for column, result in enumerate(results):
        for row, what in enumerate(rows):
            ax = axes[row][column]
            field = result.mechanism if what == "mechanism" else result.forces
            if field is None:
                continue
            ax.set_title(_panel_title(case, result, what), pad=3, color=INK)
            length_scale(ax, assembly, units)
            if what == "mechanism":
                draw_mechanism(ax, assembly, np.asarray(field, dtype=float), joints.joint_states(assembly, result))
            else:
                draw_forces(ax, assembly, np.asarray(field, dtype=float), thrust=what == "thrust", units=units)
    return page


def _panel_title(case: Case, result: Result, what: str) -> str:
    """The method, its value, and what is drawn."""
    if what == "thrust":
        found = shapes.thrusts(case.assembly, np.asarray(result.forces, dtype=float), flow.STYLE.smallest)
        what = "line of thrust" if flow.has_line_of_thrust(case.assembly, found) else "flow of forces"
    return f"{result.method}, {value_in_words(result)}: {what}"


def draw_blocks(ax: Axes, assembly: Assembly, polygons: list[FloatArray], moving: np.ndarray | None = None) -> None:
    """Blocks at given places: fixed ones hatched, moving ones shaded."""
    fixed = [polygon for polygon, still in zip(polygons, assembly.fixed, strict=True) if still]
    ax.add_collection(stones(fixed, facecolor="white", edgecolor=INK, linewidth=0.5, hatch="/////"))
    moves = np.zeros(assembly.n_blocks, dtype=bool) if moving is None else moving
    free = [(polygon, bool(moves[k])) for k, polygon in enumerate(polygons) if not assembly.fixed[k]]
    colours = ["#dfe8f1" if move else "white" for _, move in free]
    ax.add_collection(stones([p for p, _ in free], facecolor=colours, edgecolor=INK, linewidth=0.5))


def draw_joints(ax: Axes, assembly: Assembly) -> None:
    """Interfaces as heavier lines, with dots at their contact points."""
    segments = np.stack([assembly.end1, assembly.end2], axis=1)
    ax.add_collection(LineCollection(list(segments), colors=INK, linewidths=0.9))
    if assembly.n_interfaces <= 240:
        points = segments.reshape(-1, 2)
        ax.plot(points[:, 0], points[:, 1], ".", color=INK, markersize=2.2)


def draw_mechanism(
    ax: Axes, assembly: Assembly, mechanism: FloatArray, states: list[str] | None, scale: float | None = None
) -> None:
    """A mechanism (n, 3) as displaced blocks; what slides bold, a dot at a hinge, open dashed, dilatant double.

    Args:
        ax: where.
        assembly: the wall.
        mechanism: normalised block velocities.
        states: of the interfaces, as of `joints.joint_states`; or None.
        scale: displacement of the fastest vertex [length]; one that shows well by default.
    """
    scale = shapes.amplitude(assembly, mechanism) if scale is None else scale
    ax.add_collection(
        stones(list(assembly.polygons), facecolor="none", edgecolor=GREY, linewidth=0.3, linestyle=(0, (3, 3)))
    )
    draw_blocks(ax, assembly, shapes.displaced(assembly, mechanism, scale), shapes.moving(assembly, mechanism))
    if states is None:
        return
    names, thinner = np.array(states), stroke_factor(assembly)
    for state, (colour, width, line) in MARKS.items():
        chosen = np.flatnonzero(names == state)
        if not len(chosen):
            continue
        ends = shapes.moved_ends(assembly, mechanism, scale, chosen)
        ax.add_collection(LineCollection(list(ends), colors=colour, linewidths=thinner * width, linestyles=line))
        if state == joints.DILATANT:
            ax.add_collection(LineCollection(list(ends), colors="white", linewidths=0.4 * thinner * width))
        if state in (joints.ROCK, joints.BOTH):
            hinges = shapes.hinges(assembly, mechanism, ends, chosen)
            ax.plot(hinges[:, 0], hinges[:, 1], "o", color=BLUE, markersize=2.8 * thinner)


def _labels(ax: Axes, assembly: Assembly) -> None:
    if assembly.n_blocks > LABELLED_BLOCKS:
        return
    for label, centroid in zip(block_labels(assembly), assembly.centroid, strict=True):
        ax.annotate(label, centroid, xytext=(0, 2.2), textcoords="offset points", ha="center", color=INK, fontsize=5.5)


def draw_loads(ax: Axes, assembly: Assembly, load: FloatArray, colour: str, kind: str) -> None:
    """A load (n, 3) as arrows at its blocks, dashed where it is dead."""
    arrows = shapes.load_arrows(assembly, load)
    arrows = arrows[:: shapes.drawn_every(len(arrows))]
    if not arrows:
        return
    largest = max(float(np.linalg.norm(arrow.force)) for arrow in arrows)
    wall = shapes.extent(assembly).longest
    longest = min(0.11 * wall, max(0.04 * wall, 0.8 * assembly.length_scale))
    for arrow in arrows:
        size = float(np.linalg.norm(arrow.force))
        step = arrow.force / size * longest * (0.35 + 0.65 * np.sqrt(size / largest))
        ax.annotate(
            "",
            arrow.point + step,
            xytext=tuple(arrow.point),
            arrowprops={
                "arrowstyle": "-|>",
                "edgecolor": colour,
                "linewidth": 0.7,
                "linestyle": "-" if kind == "live" else (0, (2, 1.2)),
                "shrinkA": 0,
                "shrinkB": 0,
                "mutation_scale": 5,
                "facecolor": colour if kind == "live" else "white",
            },
        )
