"""Which of several load cases of one wall governs: the one with the lowest multiplier, for every method by itself.

Of joints with cohesion or tensile strength the residual multiplier counts too, that of the wall without them: mortar is
brittle, so a load case that is safe by its strength alone is not safe. It need not be the lower one: without dilatancy
a wall may collapse at less with strength than without.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from harness.model.case import Case
from harness.model.comparison import CaseResults
from harness.model.details import AnswerDetails
from harness.model.errors import first_few
from harness.model.method import Status
from harness.model.result import Result, bears_less_with_strength, plastic_and_residual_of, size_of
from harness.model.result_texts import answer_text

EQUAL = 1e-9
"""Relative difference of two multipliers that is rounding: the judge's own tolerance."""
_MOST_NAMED = 6
"""Load cases that a sentence names one by one; `governing` has all."""


def safe_size(result: Result, *, residual: bool) -> float | None:
    """What a load case is ordered by, as `size_of`; None without an accepted answer.

    Args:
        result: the answer to it.
        residual: whether the lower of two counts, with the cohesion and tensile strength of the joints and without.
    """
    if result.judge.accepted is False:
        return None
    answers = (result,) if not residual else plastic_and_residual_of(result) or ()
    sizes = [size for answer in answers if (size := size_of(answer)) is not None]
    return min(sizes) if sizes and len(sizes) == len(answers) else None


def counts_residual(result: Result) -> bool:
    """Whether the residual multiplier counts too, because the joints have cohesion or tensile strength."""
    details = AnswerDetails(result.details)
    return details.has_without_strength or details.has_with_strength


def ranked_text(result: Result) -> str:
    """The answer by which a load case is ranked; of two, with strength of joints and without, the other behind it."""
    pair = plastic_and_residual_of(result)
    if pair is None or result.status is not Status.OK:
        return answer_text(result)
    plastic, residual = pair
    if bears_less_with_strength(plastic, residual):
        return f"{answer_text(plastic)} with the strength of its joints ({answer_text(residual)} residual)"
    return f"{answer_text(residual)} residual ({answer_text(plastic)} with the strength of its joints)"


@dataclass(frozen=True)
class Envelope:
    """Answers of one method to all load cases of a wall.

    Attributes:
        wall: id of the wall.
        method: that answered.
        names: (k,) of the load cases.
        results: (k,) in the same order.
        places: (k,) where loads that travel stand, in words; empty without any.
    """

    wall: str
    method: str
    names: tuple[str, ...]
    results: tuple[Result, ...]
    places: tuple[str, ...]

    def named(self, name: str) -> str:
        """A load case in quotes, with where loads that travel stand in it."""
        place = self.places[self.names.index(name)]
        return f'"{name}" ({place})' if place else f'"{name}"'

    @property
    def governing(self) -> tuple[str, ...]:
        """The load cases of the lowest multiplier, several if equal to rounding; none unless all are answered."""
        sizes = self._sizes
        known = [size for size in sizes if size is not None]
        if len(known) < len(sizes) or min(known) == math.inf:
            return ()
        least = min(known)
        return tuple(name for name, size in zip(self.names, known, strict=True) if size <= least * (1.0 + EQUAL))

    @property
    def by_residual(self) -> bool:
        """Whether residual multipliers count, because the joints have cohesion or tensile strength."""
        return any(map(counts_residual, self.results))

    @property
    def _sizes(self) -> list[float | None]:
        return [safe_size(result, residual=self.by_residual) for result in self.results]

    @property
    def verdict(self) -> str:
        """Which load case governs, or why none does."""
        missing = [f'"{name}"' for name, size in zip(self.names, self._sizes, strict=True) if size is None]
        if missing:
            kind = "accepted residual answer" if self.by_residual else "accepted answer"
            to = first_few(missing, _MOST_NAMED)
            verdict = f"which load case governs is not known, because there is no {kind} to {to}"
        elif not self.governing:
            verdict = "no load case makes the wall collapse"
        else:
            lowest = ranked_text(self.results[self.names.index(self.governing[0])])
            named = first_few([self.named(name) for name in self.governing], _MOST_NAMED)
            alike = len(self.governing) > 1
            verdict = f"load case{'s' * alike} {named} govern{'s' * (not alike)}, {lowest}"
        return f"{self.method}: {verdict}."

    @property
    def sentence(self) -> str:
        """The answers, and which of them governs or why none does."""
        answers = [f'"{name}" {ranked_text(result)}' for name, result in zip(self.names, self.results, strict=True)]
        return f"{self.verdict} Answers: {', '.join(answers)}."

    def as_json(self) -> dict[str, Any]:
        """JSON values: wall, method, answers by load case, what they are ranked by, and the governing ones."""
        pairs = [plastic_and_residual_of(result) for result in self.results]
        ranked_by = "residual_multiplier" if self.by_residual else "multiplier"
        if any(pair is not None and bears_less_with_strength(*pair) for pair in pairs):
            ranked_by = "lower_multiplier"
        return {
            "wall": self.wall,
            "method": self.method,
            "load_cases": [
                {"load_case": name, "finding": str(result.finding), "multiplier": result.multiplier}
                | ({} if pair is None else {"residual_multiplier": pair[1].multiplier})
                | ({"load_place": place} if place else {})
                for name, place, result, pair in zip(self.names, self.places, self.results, pairs, strict=True)
            ],
            "ranked_by": ranked_by,
            "governing": list(self.governing),
            "sentence": self.sentence,
        }


def envelope(cases: Sequence[Case], results: Sequence[Result]) -> Envelope:
    """The envelope of the answers (k,) of one method to the load cases (k,) of one wall."""
    names, places = zip(*((case.load_case, case.load_place) for case in cases), strict=True)
    return Envelope(cases[0].wall_id, results[0].method, names, tuple(results), places)


def envelopes(compared: Sequence[CaseResults]) -> list[Envelope]:
    """An envelope for every wall of several load cases and every method that was asked about all of them."""
    walls: dict[str, list[CaseResults]] = {}
    for item in compared:
        if item.case.load_case:
            walls.setdefault(item.case.wall_id, []).append(item)
    found = []
    for items in walls.values():
        for method in dict.fromkeys(result.method for item in items for result in item.results):
            answers = [item.of(method) for item in items]
            results = [answer for answer in answers if answer is not None]
            if len(items) > 1 and len(results) == len(items):
                found.append(envelope([item.case for item in items], results))
    return found


def by_wall(found: Sequence[Envelope]) -> dict[str, list[Envelope]]:
    """Envelopes by the id of their wall, in the order given."""
    walls: dict[str, list[Envelope]] = {}
    for each in found:
        walls.setdefault(each.wall, []).append(each)
    return walls
