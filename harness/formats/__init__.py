"""Drawings in and answers out; `registry` has a row a format.

Knows the wall description and nothing of methods or the engine. The model asks it for a wall through
`harness.model.reading.DRAWINGS`, which `register` fills.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any


def register() -> None:
    """Let every command that takes a wall file take a drawing too."""
    from harness.formats.registry import drawings
    from harness.model import reading

    reading.DRAWINGS.update(dict.fromkeys(drawings(), _document))


def _document(path: Path) -> dict[str, Any]:
    from harness.formats.importing import import_drawing

    return import_drawing(path).wall.document()
