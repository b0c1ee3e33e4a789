"""What a command also writes to a file: a table or a figure, as the ending says."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

from harness.model.writing import replacing

if TYPE_CHECKING:
    from matplotlib.figure import Figure

TABLE = ".csv"


def check_output(path: Path | None) -> None:
    """Refuse an ending that neither a table nor a figure has; asked before the work begins.

    Raises:
        InputError: naming the endings of figures.
    """
    if path is not None and path.suffix.lower() != TABLE:
        from reports.drawing.figures import check_ending

        check_ending(path)


def write_output(path: Path | None, table: Callable[[], str], figure: Callable[[], Figure]) -> None:
    """Write the table, as CSV, or draw the figure; nothing without a path.

    Raises:
        InputError: as `check_output`, or the path of something that is no regular file.
    """
    if path is None:
        return
    if path.suffix.lower() == TABLE:
        with replacing(path) as draft:
            draft.write_text(table(), encoding="utf-8")
        return
    from reports.drawing.figures import save

    save(figure, path)
