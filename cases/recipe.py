"""What the generators share: short ways to say a wall, a reference and a case."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any, Literal

from harness.model.case import CaseFile, Erratum, Reference, ReferenceType
from harness.model.wall import Wall

_STATIC = ("la", "la-associated", "fe")
"""Methods that give one exact number where theory has one."""

ROUND_OFF = 1e-9
ROUND_OFF_REASON = "round-off of an exact method"

DE_TOLERANCE = 0.005
DE_REASON = "damped load steps end within 0.5 % on walls: a rigid contact chooses one vertex of the admissible forces"


@dataclass(frozen=True)
class Recipe:
    """A case before it is written: the content of its two files."""

    file: CaseFile
    wall: Wall


STATICS = "elementary statics"
"""Source of values by hand."""
BOND_21 = {"type": "running_bond", "block_length": 0.4, "block_height": 0.2, "count": 6, "bricks": 3}
"""Pattern of the 21-brick wall."""


def push(x: float = 1.0) -> dict[str, Any]:
    """Loads of a tilting table: gravity dead, a horizontal multiple `x` of every weight live."""
    return {"live": {"body": [{"per_weight": (x, 0.0)}]}}


def wall(title: str, **content: Any) -> Wall:
    """A wall of format wall/1 with this title."""
    return Wall.model_validate({"format": "wall/1", "title": title} | content)


def reference(
    name: str,
    kind: Literal["exact", "bound", "published", "measured", "regression"],
    value: float | tuple[float, float] | str,
    methods: Sequence[str],
    source: str,
    requirement: str,
    **more: Any,
) -> Reference:
    """One reference; `more` holds tolerance, tolerance_reason, relation, gate, tier, quantity."""
    return Reference(
        id=name,
        type=ReferenceType(kind),
        value=value,
        applies_to=list(methods),
        source=source,
        requirement=requirement,
        **more,
    )


def box(name: str, left: float, bottom: float, right: float, top: float, **more: Any) -> dict[str, Any]:
    """A rectangular block; `more` holds its other fields."""
    return {"id": name, "polygon": [(left, bottom), (right, bottom), (right, top), (left, top)], **more}


def closed_form(
    value: float, source: str, requirement: str, methods: Sequence[str] = _STATIC, scale: float = 1.0
) -> Reference:
    """The exact multiplier for methods of statics, to round-off relative to `scale`, the size of the multiplier."""
    return reference(
        "closed-form",
        "exact",
        value,
        methods,
        source,
        requirement,
        tolerance=ROUND_OFF * scale,
        tolerance_reason=ROUND_OFF_REASON,
        gate=True,
    )


def exact(
    value: float, source: str, requirement: str, *, relative_de: float = 0.001, scale: float = 1.0
) -> list[Reference]:
    """The references of a case with one multiplier for all methods: exact ones to round-off, DE to `relative_de`.

    `scale` is the size of the multiplier that round-off is relative to.
    """
    reason = f"damped load steps end within {100 * relative_de:g} % here"
    value = round(value, 14)
    return [
        closed_form(value, source, requirement, scale=scale),
        of_de("closed-form-de", value, source, requirement, relative_de, reason),
    ]


def of_de(
    name: str, value: float, source: str, requirement: str, relative: float = 5e-3, reason: str = DE_REASON
) -> Reference:
    """An exact value for the bracket of DE, to a relative accuracy."""
    return reference(
        name,
        "exact",
        value,
        ["de"],
        source,
        f"DE: {requirement}",
        tolerance=relative * abs(value),
        tolerance_reason=reason,
        gate=True,
    )


def finding(word: str, source: str, requirement: str, *, gate_de: bool = True) -> list[Reference]:
    """The references of a stability case: the finding of limit analysis and FE, and that of DE."""
    return [
        reference(word, "exact", word, _STATIC, source, requirement, quantity="finding", gate=True),
        reference(f"{word}-de", "exact", word, ["de"], source, f"DE: {requirement}", quantity="finding", gate=gate_de),
    ]


@dataclass(frozen=True)
class Remarks:
    """What surrounds the references of a case."""

    source: str
    summary: str
    suites: Sequence[str]
    errata: Sequence[str] = field(default_factory=tuple)
    kind: Literal["multiplier", "stability"] = "multiplier"
    methods: Sequence[str] | None = None


def recipe(name: str, content: Wall, references: Sequence[Reference], remarks: Remarks) -> Recipe:
    """A case of this id; its title is the wall's."""
    file = CaseFile(
        id=name,
        title=content.title,
        summary=remarks.summary,
        kind=remarks.kind,
        suites=list(remarks.suites),
        source=remarks.source,
        methods=None if remarks.methods is None else list(remarks.methods),
        errata=[Erratum(text=text) for text in remarks.errata],
        references=list(references),
    )
    return Recipe(file, content)
