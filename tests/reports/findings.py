"""Results of methods on one wall, for the tests of what is said of them."""

from __future__ import annotations

from harness.model.comparison import CaseResults
from tests.reports import samples


def of_one_wall(**more: object) -> CaseResults:
    case = samples.bond("mine")
    least = samples.solved(case, "la", 0.558, turn=0.5)
    least.details.update(more)
    return CaseResults(
        case,
        [
            least,
            samples.solved(case, "fe", 0.5652),
            samples.solved(case, "la-associated", 0.584, flow="associated"),
            samples.solved(case, "de", 0.47, flow="approximate", bracket=(0.45, 0.61)),
        ],
    )
