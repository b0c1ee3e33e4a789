"""What a wall is at other tolerances of its drawing: the joints that are found, and the answer with them."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import groupby

import numpy as np

from harness.engine.pipeline import Runs
from harness.model import geometry
from harness.model.assembly import Assembly
from harness.model.blocks import blocks_of_wall, polygons_of, support_faults
from harness.model.case import Case, CaseFile
from harness.model.errors import InputError, raise_faults
from harness.model.inspection import Inspection
from harness.model.interfaces import DEFAULT_TOLERANCE
from harness.model.load_cases import named_loads, under_load_case
from harness.model.method import Status
from harness.model.result import Result
from harness.model.result_texts import bound_in_words
from harness.model.wall import Detection, Wall

_WIDEST = 0.1
"""Greatest tolerance tried, in typical block sizes: 25 mm of mortar between bricks of 250 mm."""
_A_DECADE = 8
"""Tolerances tried in a decade: neighbours differ by a third, less than surveys do."""


_MOST_LOOKED = 2000
"""Blocks of a wall whose tolerances are looked through unasked; for others `drystone validate` does it."""
_FINEST = 0.01
"""Tolerances finer than this part of the greatest one tried, a thousandth of a block, add nothing to the width of a
plateau: no survey is that accurate, and drawings that are exact to all digits have one plateau anyway."""


@dataclass(frozen=True)
class Plateau:
    """Tolerances in a row at which the same joints are found.

    Attributes:
        low, high: the least and the greatest of them that was tried [length].
        joints: number of interfaces; None where the wall cannot be built.
        answer: what the method says with them, or why the wall cannot be built.
    """

    low: float
    high: float
    joints: int | None
    answer: str


def over_tolerance(wall: Wall, method: str = "", runs: Runs = Runs()) -> list[Plateau]:
    """The plateaus of a wall whose interfaces are found, from a millionth to a tenth of the typical block size.

    Args:
        wall: as read. One with load cases is asked about under the first of them.
        method: asked once a plateau, at its default settings; empty: the answers are.
        runs: how it is asked.

    Raises:
        InputError: blocks, names or load cases are wrong at any tolerance.
    """
    if wall.load_case_fields:
        known = named_loads(wall)
        wall = under_load_case(wall, next(iter(known)), known)
    detection = wall.interfaces if isinstance(wall.interfaces, Detection) else Detection()
    size = _typical_block_size(wall)
    decades = np.log10(_WIDEST / DEFAULT_TOLERANCE)
    tried: list[tuple[float, Case, Assembly | str]] = []
    for tolerance in np.geomspace(DEFAULT_TOLERANCE * size, _WIDEST * size, round(decades * _A_DECADE) + 1).tolist():
        allowed = {"tolerance": tolerance, "greatest_gap": None, "greatest_overlap": None}
        joined = wall.model_copy(update={"interfaces": detection.model_copy(update=allowed)})
        case = Case(CaseFile(id="wall", title="wall", source="its joints at another tolerance"), joined, "")
        try:
            found: Assembly | str = case.assembly
        except InputError as error:
            found = f"{error.element}: {error.problem}" if error.element else error.problem
        tried.append((tolerance, case, found))
    plateaus = []
    for _, group in groupby(tried, key=lambda item: _joints(item[2])):
        members = list(group)
        _, case, first = members[0]
        answer = first if isinstance(first, str) else _said(runs.result(case, method, {})) if method else ""
        joints = None if isinstance(first, str) else first.n_interfaces
        plateaus.append(Plateau(members[0][0], members[-1][0], joints, answer))
    return plateaus


def suggested(plateaus: list[Plateau]) -> tuple[float, Plateau] | None:
    """The middle of the widest plateau with joints, on a scale of ratios [length], and that plateau; None without."""
    if not plateaus:
        return None
    finest = _FINEST * plateaus[-1].high

    def width(plateau: Plateau) -> float:
        return plateau.high / max(plateau.low, finest)

    widest = max((plateau for plateau in plateaus if plateau.joints), key=width, default=None)
    if widest is None:
        return None
    return float(np.sqrt(min(max(widest.low, finest), widest.high) * widest.high)), widest


def advised(looked: Inspection) -> float | None:
    """A tolerance for the near misses of a wall [length]; None where it has none, too many blocks, or other faults."""
    if len(looked.names) > _MOST_LOOKED or not any(mark.near_miss for mark in looked.marks):
        return None
    try:
        advice = suggested(over_tolerance(looked.wall))
    except InputError:  # faults that no tolerance mends, which are reported themselves
        return None
    return advice[0] if advice else None


def _joints(found: Assembly | str) -> str | tuple[tuple[int, int], ...]:
    if isinstance(found, str):
        return found
    return tuple(zip(found.block_a.tolist(), found.block_b.tolist(), strict=True))


def _said(result: Result) -> str:
    if result.status is not Status.OK:
        return f"{result.status}: {result.sentence}"
    value = f"{result.multiplier:.6g}{bound_in_words(result)}" if result.multiplier is not None else str(result.finding)
    return value if result.judge.accepted else f"{value} ({result.judge.outcome.replace('_', ' ')})"


def _typical_block_size(wall: Wall) -> float:
    """The length that tolerances are measured by: the median over the free blocks of the square root of the area.

    Raises:
        InputError: a block is no polygon, or none is free.
    """
    blocks = blocks_of_wall(wall)
    raise_faults(support_faults(np.array([block.fixed for block in blocks], dtype=bool)))
    free = polygons_of([block for block in blocks if not block.fixed])
    return geometry.typical_size(geometry.shapes_of(free))
