"""The gallery of the documentation: walls made and drawn by the commands that it shows, under docs/generated/."""

from __future__ import annotations

import shlex
from pathlib import Path

from click.testing import CliRunner

SHOWN = {
    "running-bond": "--length 2 --height 0.8",
    "ashlar": "",
    "flemish": "--length 1.5 --height 0.6",
    "english": "--length 1.5 --height 0.6",
    "irregular": "--length 2 --courses 5",
    "arch": "",
    "bridge": "",
    "portal": "",
    "facade": "--storeys 1 --openings 2 --brick-length 0.5 --brick-height 0.15",
    "buttress": "",
    "two-leaf": "",
    "stack": "--count 4",
    "matera": "",
}
"""Every kind of `drystone new`, with the numbers it is shown with."""
METHOD = "fe"
"""Method of the mechanisms: the path of the springs ends in one on every kind of wall."""


class GalleryError(Exception):
    """A command of the gallery did not do what the page says."""


def gallery_page(folder: Path) -> None:
    """A page with every kind of wall, the commands that make it and draw it and its mechanism, and both drawings.

    Raises:
        GalleryError: a command fails, or a kind of wall is not shown.
    """
    from cases.start import STARTS

    if set(SHOWN) != set(STARTS):
        raise GalleryError(f"kinds of `drystone new` and of the gallery differ: {set(SHOWN) ^ set(STARTS)}")
    pictures = folder / "gallery"
    pictures.mkdir(exist_ok=True)
    first = "Parametric walls and how they collapse, each made and drawn by the commands above it."
    parts = ["# Gallery", "", first, ""]
    for kind, numbers in SHOWN.items():
        make = f"drystone new {kind} {numbers}".strip() + f" -o {kind}.json"
        draw = f"drystone show {kind}.json -o {kind}.svg --dimensions"
        move = f"drystone figure {kind}.json --methods {METHOD} --kind mechanism -o {kind}-mechanism.svg"
        for command in (make, draw, move):
            _run(command, pictures)
        parts += [f"## {kind}", "", "```", make, draw, move, "```", ""]
        parts += [f"![The wall {kind}](gallery/{kind}.svg)", ""]
        parts += [f"![How the wall {kind} collapses, by {METHOD}](gallery/{kind}-mechanism.svg)", ""]
    (folder / "gallery.md").write_text("\n".join(parts), encoding="utf-8")


def _run(command: str, folder: Path) -> None:
    """Run a command of the page with its files in a folder."""
    from drystone.cli.main import main

    words = [str(folder / word) if Path(word).suffix in (".json", ".svg") else word for word in shlex.split(command)]
    done = CliRunner().invoke(main, words[1:])
    if done.exit_code:
        raise GalleryError(f"{command}: exit code {done.exit_code}\n{done.output}")
