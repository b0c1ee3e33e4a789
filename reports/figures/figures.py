"""Figures for papers: walls, mechanisms, contact forces and thrust lines through matplotlib, as PDF, SVG or PNG.

Widths are those of a journal: one column of 88 mm, two of 180 mm. The same input gives the same bytes.
"""

from __future__ import annotations

import textwrap
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.figure import Figure

from harness.model.assembly import Assembly
from harness.model.build import Built
from harness.model.case import Case
from harness.model.errors import InputError
from harness.model.result import Result
from harness.model.result_texts import strength_in_words
from harness.model.writing import replacing
from reports.drawing.display_list import Box, Frame
from reports.drawing.force_drawing import force_drawing
from reports.drawing.looks import COLOURS
from reports.drawing.mechanism_drawing import mechanism_drawing
from reports.drawing.wall_drawing import plain_wall
from reports.figures.plot import plot
from reports.geometry import shapes, thrust_lines
from reports.labels.wall_summary import friction_text, given_in_words, value_in_words

COLUMN, PAGE = 88 / 25.4, 180 / 25.4
"""Width of one and of two columns [inch]."""
_WINDOW_DPI = 220
KINDS = ("mechanism", "forces", "thrust", "wall", "comparison")
_FORMATS = (".pdf", ".svg", ".png")
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
        raise InputError(
            f'there is no figure "{kind}"', f"Ask for one of {', '.join(each for each in KINDS if each != 'wall')}"
        )
    needed = {"mechanism": ["mechanism"], "comparison": ["mechanism", "forces"]}.get(kind, ["forces"])
    usable = [r for r in results if any(getattr(r, name) is not None for name in needed)]
    if not usable:
        methods = ", ".join(result.method for result in results) or "no method"
        raise InputError(
            f"{methods} gave no {' and no '.join(needed)} to draw",
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
    with style(), mpl.rc_context({"figure.dpi": _WINDOW_DPI}):
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
    page, axes = blank(built.assembly, 1, 1, head=_title(title, built.assembly) if title else "")
    plot(axes[0][0], plain_wall(built.assembly, built.wall.units, title))
    return page


@contextmanager
def style() -> Iterator[None]:
    """Matplotlib's own defaults and ours, whatever the user's configuration says."""
    with mpl.rc_context():
        mpl.rcdefaults()
        mpl.rcParams.update(_STYLE)
        yield


def check_ending(path: Path, formats: Sequence[str] = _FORMATS, kind: str = "figure") -> None:
    """Refuse a file whose ending says no format of its kind.

    Raises:
        InputError: naming those there are.
    """
    if path.suffix.lower() not in formats:
        raise InputError(f'no {kind} format is called "{path.suffix}"', f"Use {', '.join(formats)}", source=str(path))


def save(make: Callable[[], Figure], path: Path) -> None:
    """Make a figure and write it, in the style of figures.

    Raises:
        InputError: an ending that no figure has, or the path of something that is no regular file.
    """
    check_ending(path)
    with replacing(path) as draft, style():
        make().savefig(draft, metadata=_metadata(path))


def _metadata(path: Path) -> dict[str, Any]:
    """File information without dates, so that the bytes depend on the input alone."""
    suffix = path.suffix.lower()
    if suffix == ".pdf":
        return {"CreationDate": None, "ModDate": None, "Creator": "Drystone", "Producer": "matplotlib"}
    return {"Date": None, "Creator": "Drystone"} if suffix == ".svg" else {"Software": "Drystone"}


def blank(assembly: Assembly, rows: int, columns: int, head: str = "", box: Box | None = None) -> tuple[Figure, Any]:
    """A figure of a journal's width with axes in the lengths of a wall, and a line of text above all.

    Args:
        assembly: the wall.
        rows, columns: of axes.
        head: the line of text.
        box: the part that the axes show; that of a drawing of the wall if None.
    """
    frame = Frame.of(assembly)
    left, top, wide, high = box or frame.box
    width = COLUMN if columns == 1 else PAGE
    head = _fitting(head, width)
    above = 0.22 + (0.17 * max(head.count("\n") + 1, 2) if head else 0.0)
    height = min(rows * (width / columns * min(high / wide, 1.6) + 0.28) + above - 0.22, 9.2)
    page = Figure(figsize=(width, height))
    axes = page.subplots(rows, columns, squeeze=False)
    page.subplots_adjust(left=0.01, right=0.99, bottom=0.01, top=1.0 - above / height, wspace=0.03, hspace=0.12)
    if head:
        page.suptitle(head, x=0.01, y=1.0 - 0.05 / height, ha="left", va="top", fontsize=7.5)
    for ax in axes.ravel():
        (x0, y0), (x1, y1) = frame.back(np.array([(left, top + high), (left + wide, top)])).tolist()
        ax.set_xlim(x0, x1)
        ax.set_ylim(y0, y1)
        ax.set_aspect("equal")
        ax.axis("off")
    return page, axes


def _fitting(text: str, width: float) -> str:
    """A text in lines that fit a width [inch] at the size of titles: about 18 letters an inch."""
    return "\n".join(part for line in text.split("\n") for part in textwrap.wrap(line, int(18.0 * width)))


def _title(title: str, assembly: Assembly) -> str:
    return f"{title}\ntan φ = {friction_text(assembly)}"


def _panels(case: Case, results: list[Result], rows: list[str]) -> Figure:
    counted = "".join(dict.fromkeys(map(strength_in_words, results)))
    head = f"{case.file.title}\n{given_in_words(case)}{counted}"
    page, axes = blank(case.assembly, len(rows), len(results), head=head)
    for column, result in enumerate(results):
        for row, what in enumerate(rows):
            if (result.mechanism if what == "mechanism" else result.forces) is None:
                continue
            axes[row][column].set_title(_panel_title(case, result, what), pad=3, color=COLOURS["ink"])
            drawn = mechanism_drawing(case, result) if what == "mechanism" else force_drawing(case, result, (what,))
            plot(axes[row][column], drawn)
    return page


def _panel_title(case: Case, result: Result, what: str) -> str:
    """The method, its value, and what is drawn."""
    if what == "thrust":
        found = shapes.thrusts(case.assembly, np.asarray(result.forces, dtype=float), thrust_lines.SMALLEST)
        what = "line of thrust" if thrust_lines.has_line_of_thrust(case.assembly, found) else "flow of forces"
    return f"{result.method}, {value_in_words(result)}: {what}"
