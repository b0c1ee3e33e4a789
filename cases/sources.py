"""`cases/SOURCES.md` from the case files: what is verification, what benchmark, what validation, with its sources.

The three are kept apart because a disagreement means something else in each: an error of ours, a difference between
codes, or a difference between the model and a wall.
"""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

from harness.model.case import CaseFile, Reference, ReferenceType, case_folders, read_case

FILE = "SOURCES.md"

HEAD = """# Where the references come from

Written by `python -m cases.generate` from the `case.toml` files; change those, not this.

A disagreement means something else in each table, so they are kept apart: **verification** compares with closed forms
and proved bounds (a disagreement is an error of ours), **benchmark** with values others computed (a difference between
codes, or an error of either), **validation** with experiments (a difference between the model and a wall).
**Regression** holds our own values of this release, so that a change is seen. Checked references make `drystone check`
fail.

Values of kind *finding* say whether the wall stands under its dead load. `at most` stands with values that a better
collapse state may lie below.
"""

_TABLES: tuple[tuple[str, tuple[ReferenceType, ...], str], ...] = (
    ("Verification", (ReferenceType.EXACT, ReferenceType.BOUND), "Closed forms, counts and bounds."),
    ("Benchmark", (ReferenceType.PUBLISHED,), "Values computed by others, as printed."),
    ("Validation", (ReferenceType.MEASURED,), "Values found by experiments."),
    ("Regression", (ReferenceType.REGRESSION,), "Our own values."),
)

_NO_MEASUREMENT = (
    "No experiment whose absolute value could be read is in the library yet. The paper's tilting-table test of its\n"
    "21-brick wall is known only as about 20 % below the computed load, and stands as an erratum of `wall-21`. The\n"
    "arches of Borri and Carozzi were tested with mortar, so their experiments are no references for dry joints.\n"
)


def sources_text(root: Path) -> str:
    """The content of `SOURCES.md` for the cases below `root`."""
    files = [read_case(folder).file for folder in case_folders([root]).values()]
    parts = [HEAD]
    for title, kinds, sentence in _TABLES:
        rows = [_row(file, item) for file in files for item in file.references if item.type in kinds]
        parts.append(f"\n## {title}\n\n{sentence}\n\n")
        if rows:
            parts.append(
                "| case | quantity | value | tolerance | methods | gated | source |\n|---|---|---|---|---|---|---|\n"
            )
            parts += rows
        else:
            parts.append(_NO_MEASUREMENT)
    parts.append("\n## Works cited\n\n" + "".join(_works(files)))
    parts.append(
        "\n## Errata\n\nWhat sources leave open, or state otherwise than we find.\n\n" + "".join(_errata(files))
    )
    return "".join(parts)


def _row(file: CaseFile, item: Reference) -> str:
    cells = (
        f"`{file.id}`",
        item.quantity,
        _value(item),
        f"{item.tolerance:.2g}" if item.tolerance else "",
        ", ".join(item.applies_to),
        "yes" if item.gate else "",
        item.source,
    )
    return "| " + " | ".join(cell.replace("|", "\\|") for cell in cells) + " |\n"


def _value(item: Reference) -> str:
    if isinstance(item.value, str):
        return item.value
    if isinstance(item.value, tuple):
        return f"inside {item.value[0]:.7g} .. {item.value[1]:.7g}"
    word = {"at_most": "at most ", "at_least": "at least ", "contains": "bracket contains "}.get(item.relation, "")
    return f"{word}{item.value:.9g}"


def _works(files: Iterable[CaseFile]) -> list[str]:
    cases_of: dict[str, list[str]] = {}
    for file in files:
        cases_of.setdefault(file.source, []).append(f"`{file.id}`")
    return [f"- {source} — {', '.join(names)}\n" for source, names in sorted(cases_of.items())]


def _errata(files: Iterable[CaseFile]) -> list[str]:
    cases_of: dict[str, list[str]] = {}
    for file in files:
        for erratum in file.errata:
            cases_of.setdefault(erratum.text, []).append(f"`{file.id}`")
    return [f"- {', '.join(names)}: {text}\n" for text, names in cases_of.items()]
