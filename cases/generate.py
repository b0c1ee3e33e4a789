"""Writes the cases that follow a rule, and the table of sources: `python -m cases.generate`.

The text depends on the rules only, so that writing again changes nothing; `--check` says what would change.
"""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from pathlib import Path

from cases import (
    balanced,
    brittle,
    closed_forms,
    families,
    joint_strength,
    matera,
    passive,
    sources,
    surface_loads,
    tied,
    useful,
)
from cases.writing import case_files, write_files

ROOT = Path(__file__).parent


def generated_files() -> dict[str, str]:
    """Text of every generated file by its path below `cases/`, without the table of sources."""
    files: dict[str, str] = {}
    for module in (
        closed_forms,
        joint_strength,
        families,
        matera,
        useful,
        tied,
        passive,
        brittle,
        balanced,
        surface_loads,
    ):
        for recipe in module.recipes():
            files |= case_files(recipe.file, recipe.wall)
    return files


def stale_files(root: Path = ROOT) -> list[str]:
    """Paths of generated files that are missing or differ from what the rules give."""
    files = generated_files() | {sources.FILE: sources.sources_text(root)}
    return [
        name
        for name, text in files.items()
        if not (root / name).is_file() or (root / name).read_text(encoding="utf-8") != text
    ]


def main(arguments: Sequence[str] | None = None) -> int:
    """Write the generated cases, then the table of sources from all of them."""
    parser = argparse.ArgumentParser(prog="python -m cases.generate", description=__doc__)
    parser.add_argument("--check", action="store_true", help="write nothing; exit code 1 if a file is out of date")
    if parser.parse_args(arguments).check:
        stale = stale_files()
        print("\n".join(f"out of date: {name}" for name in stale) or "Every generated file is up to date.")
        return 1 if stale else 0
    changed = write_files(generated_files(), ROOT)
    changed += write_files({sources.FILE: sources.sources_text(ROOT)}, ROOT)
    print("\n".join(f"wrote {name}" for name in changed) or "Nothing changed.")
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
