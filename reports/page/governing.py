"""The load case of a wall that governs, as a drawing with its mechanism and its loads."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from markupsafe import Markup

from harness.model.comparison import ComparisonRun
from harness.model.envelope import Envelope
from reports.drawing.mechanism_drawing import loaded_mechanism
from reports.drawing.svg import inline
from reports.labels.wall_summary import value_in_words

MOST_BLOCKS = 2_000
"""Blocks of a wall that is drawn: a drawing of more takes as much room as the rest of the page."""


@dataclass(frozen=True)
class Governing:
    """The governing load case of one wall by one method.

    Attributes:
        number: of its section; drawing: of its mechanism; sentence: what it shows.
    """

    number: int
    drawing: Markup
    sentence: str


def governing_case(run: ComparisonRun, found: Sequence[Envelope]) -> Governing | None:
    """The governing load case of the envelopes of one wall: by a method that seeks the least state, else by the first.

    None where none governs, or its answer has no mechanism.
    """
    known = [each for each in found if each.governing]
    if not known:
        return None
    chosen = next((each for each in known if each.results[0].traits.seeks_least), known[0])
    name = chosen.governing[0]
    result = chosen.results[chosen.names.index(name)]
    places = (k for k, item in enumerate(run.cases) if (item.case.wall_id, item.case.load_case) == (chosen.wall, name))
    number = next(places, None)
    if number is None or result.mechanism is None or len(result.mechanism) > MOST_BLOCKS:
        return None
    drawing = Markup(inline(loaded_mechanism(run.cases[number].case, result)))
    others = f" (and {len(chosen.governing) - 1} more alike)" if len(chosen.governing) > 1 else ""
    sentence = f"{result.method}: {name}{others} governs, {value_in_words(result)}. Its mechanism, with the loads"
    return Governing(number, drawing, sentence)
