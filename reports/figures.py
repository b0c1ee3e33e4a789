"""Figures for papers: walls, mechanisms, contact forces and thrust lines through matplotlib, as PDF, SVG or PNG.

Widths are those of a journal: one column of 88 mm, two of 180 mm. The same input gives the same bytes.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.figure import Figure

from harness.model.assembly import Assembly, FloatArray
from harness.model.build import Built
from harness.model.case import Case
from harness.model.errors import InputError
from harness.model.result import Result
from reports import joints, numbers, shapes, words
from reports.drawing import LABELLED_BLOCKS, block_labels

COLUMN, PAGE = 88 / 25.4, 180 / 25.4
"""Width of one and of two columns [inch]."""
WINDOW_DPI = 220
KINDS = ("mechanism", "forces", "thrust", "wall", "comparison")
FORMATS = (".pdf", ".svg", ".png")
INK, GREY, BLUE, RUST, PLUM = "#14202b", "#8a96a1", "#17508c", "#a63c06", "#6d2077"
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
        show_wall(case.built, path)
        return
    target = checked(path)
    with style():
        results_figure(case, results, kind).savefig(target, metadata=metadata(path))


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


def show_wall(built: Built, path: Path) -> None:
    """Draw a wall before anything is run: blocks with numbers, joints, contact points, supports and loads.

    Args:
        built: the wall.
        path: the file; its ending .pdf, .svg or .png says the format.

    Raises:
        InputError: another ending.
    """
    target = checked(path)
    with style():
        _wall(built.assembly).savefig(target, metadata=metadata(path))


def wall_figure(built: Built) -> Figure:
    """A wall before anything is run: blocks with numbers, joints, contact points, supports and loads."""
    with style():
        return _wall(built.assembly)


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


def _wall(assembly: Assembly) -> Figure:
    page, axes = blank(assembly, 1, 1)
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


def checked(path: Path) -> Path:
    """The path of a figure, with its folder made.

    Raises:
        InputError: an ending that no figure has.
    """
    if path.suffix.lower() not in FORMATS:
        raise InputError(f'no figure is written as "{path.suffix}"', f"Use {', '.join(FORMATS)}", source=str(path))
    path.parent.mkdir(parents=True, exist_ok=True)
    return path


def metadata(path: Path) -> dict[str, Any]:
    """File information without dates, so that the bytes depend on the input alone."""
    suffix = path.suffix.lower()
    if suffix == ".pdf":
        return {"CreationDate": None, "ModDate": None, "Creator": "Drystone", "Producer": "matplotlib"}
    return {"Date": None, "Creator": "Drystone"} if suffix == ".svg" else {"Software": "Drystone"}


def blank(assembly: Assembly, rows: int, columns: int) -> tuple[Figure, Any]:
    """A figure of a journal's width whose axes have the shape of the wall."""
    extent = shapes.extent(assembly)
    margin = 0.14 * extent.longest
    width = COLUMN if columns == 1 else PAGE
    aspect = (extent.height + 2 * margin) / (extent.width + 2 * margin)
    each = width / columns
    height = min(rows * (each * min(aspect, 1.6) + 0.28), 9.2)
    page = Figure(figsize=(width, height))
    axes = page.subplots(rows, columns, squeeze=False)
    page.subplots_adjust(left=0.01, right=0.99, bottom=0.01, top=1.0 - 0.22 / height, wspace=0.03, hspace=0.12)
    for ax in axes.ravel():
        ax.set_xlim(extent.left - margin, extent.right + margin)
        ax.set_ylim(extent.bottom - margin, extent.top + margin)
        ax.set_aspect("equal")
        ax.axis("off")
    return page, axes


def _panels(case: Case, results: list[Result], rows: list[str]) -> Figure:
    assembly = case.assembly
    page, axes = blank(assembly, len(rows), len(results))
    for column, result in enumerate(results):
        value = words.FINDING[result.finding] if result.multiplier is None else numbers.multiplier(result.multiplier)
        axes[0][column].set_title(f"{result.method}: {value}", pad=3, color=INK)
        for row, what in enumerate(rows):
            ax = axes[row][column]
            if what == "mechanism" and result.mechanism is not None:
                states = joints.joint_states(assembly, result)
                draw_mechanism(ax, assembly, np.asarray(result.mechanism, dtype=float), states)
            elif what != "mechanism" and result.forces is not None:
                draw_forces(ax, assembly, np.asarray(result.forces, dtype=float), thrust=what == "thrust")
    return page


def draw_blocks(ax: Axes, assembly: Assembly, polygons: list[FloatArray], moving: np.ndarray | None = None) -> None:
    """Blocks at given places: fixed ones hatched, moving ones shaded."""
    fixed = [polygon for polygon, still in zip(polygons, assembly.fixed, strict=True) if still]
    ax.add_collection(PolyCollection(fixed, facecolor="white", edgecolor=INK, linewidth=0.5, hatch="/////"))
    moves = np.zeros(assembly.n_blocks, dtype=bool) if moving is None else moving
    free = [(polygon, bool(moves[k])) for k, polygon in enumerate(polygons) if not assembly.fixed[k]]
    colours = ["#dfe8f1" if move else "white" for _, move in free]
    ax.add_collection(PolyCollection([p for p, _ in free], facecolor=colours, edgecolor=INK, linewidth=0.5))


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
        PolyCollection(list(assembly.polygons), facecolor="none", edgecolor=GREY, linewidth=0.3, linestyle=(0, (3, 3)))
    )
    draw_blocks(ax, assembly, shapes.displaced(assembly, mechanism, scale), shapes.moving(assembly, mechanism))
    if states is None:
        return
    names = np.array(states)
    for state, (colour, width, line) in MARKS.items():
        chosen = np.flatnonzero(names == state)
        if not len(chosen):
            continue
        ends = shapes.moved_ends(assembly, mechanism, scale, chosen)
        ax.add_collection(LineCollection(list(ends), colors=colour, linewidths=width, linestyles=line))
        if state == joints.DILATANT:
            ax.add_collection(LineCollection(list(ends), colors="white", linewidths=0.4 * width))
        if state in (joints.ROCK, joints.BOTH):
            hinges = shapes.hinges(assembly, mechanism, ends, chosen)
            ax.plot(hinges[:, 0], hinges[:, 1], "o", color=BLUE, markersize=2.8)


def draw_forces(ax: Axes, assembly: Assembly, forces: FloatArray, *, thrust: bool) -> None:
    """Contact forces (m, 3): resultants at their centres of pressure, or thrust lines through the blocks.

    The width of a line is proportional to the force; a force at the limit of friction is circled.
    """
    for still, hatch in ((False, None), (True, "/////")):
        polygons = [p for p, fixed in zip(assembly.polygons, assembly.fixed, strict=True) if bool(fixed) is still]
        ax.add_collection(PolyCollection(polygons, facecolor="none", edgecolor=GREY, linewidth=0.4, hatch=hatch))
    found = shapes.thrusts(assembly, forces, smallest=2e-3)
    if not len(found.size):
        return
    half = 0.36 * assembly.length_scale * found.force / found.size[:, None]
    widths = 0.3 + 3.2 * found.size / found.size.max()
    shear = abs(forces[found.interface, 2])
    limit = assembly.friction[found.interface] * forces[found.interface, :2].sum(axis=1)
    full = (limit > 0.0) & (shear >= 0.999 * limit)
    if thrust:
        lines = []
        places = shapes.junctions(assembly, found)
        for k, p in enumerate(found.interface):
            a, b = assembly.block_a[p], assembly.block_b[p]
            start = found.point[k] - half[k] if assembly.fixed[a] else places[a]
            end = found.point[k] + half[k] if assembly.fixed[b] else places[b]
            lines.append(np.array([start, found.point[k], end]))
        ax.add_collection(LineCollection(lines, colors=BLUE, linewidths=widths, capstyle="round", joinstyle="round"))
        return
    bars = np.stack([found.point - half, found.point + half], axis=1)
    colours = [RUST if at_limit else BLUE for at_limit in full]
    ax.add_collection(LineCollection(list(bars), colors=colours, linewidths=widths))
    ax.plot(found.point[full, 0], found.point[full, 1], "o", mfc="none", mec=RUST, mew=0.6, markersize=4.0)


def _labels(ax: Axes, assembly: Assembly) -> None:
    if assembly.n_blocks > LABELLED_BLOCKS:
        return
    for label, centroid in zip(block_labels(assembly), assembly.centroid, strict=True):
        ax.annotate(label, centroid, xytext=(0, 2.2), textcoords="offset points", ha="center", color=INK, fontsize=5.5)


def draw_loads(ax: Axes, assembly: Assembly, load: FloatArray, colour: str, kind: str) -> None:
    """A load (n, 3) as arrows at its blocks, dashed where it is dead."""
    arrows = shapes.load_arrows(assembly, load)
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
