"""The suite finds the faults of methods that have one, and tells a refusal from a fault."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from harness.conformance import conforms, suite
from harness.conformance.suite import CheckFound, Outcome
from harness.model.assembly import Assembly
from harness.model.errors import InputError
from harness.model.method import Answer, Finding, Method, Settings, Status
from harness.model.method_registry import load_method


class Faulty(Method):
    """The associated maximum, with one thing wrong."""

    name, family, title, tolerance = "faulty", "faulty", "one thing wrong", 1e-7

    def __init__(self, what: str) -> None:
        self.what, self.calls = what, 0

    def solve(self, assembly: Assembly, settings: Settings) -> Answer:
        """The right answer, spoiled."""
        if self.what == "refuses all":
            raise InputError("it takes no wall", "Take another method")
        inner: Any = load_method("la-associated")
        answer: Answer = inner.solve(assembly, inner.Settings())
        self.calls += 1
        match self.what:
            case "sign" if answer.forces is not None:
                answer.forces[:, 2] *= -1.0
            case "changes the wall":
                assembly.friction[:] = 9.0
            case "wanders" if answer.multiplier is not None:
                answer.multiplier *= 1.0 + 1e-9 * self.calls
            case "global axes" if answer.mechanism is not None:
                answer.mechanism[:, 1] = 0.0
            case "no proof":
                answer.details, answer.mechanism = {}, None
            case "raises":
                raise ZeroDivisionError("as ordered")
            case "no answer":
                return None  # type: ignore[return-value]
            case "stands" if answer.finding is Finding.FALLS:
                return Answer(Status.OK, Finding.STANDS, "It stands.", forces=np.zeros((assembly.n_interfaces, 3)))
        return answer


def rows_of(what: str) -> dict[str, CheckFound]:
    method = Faulty(what)
    return {check.name: check.row(method) for check in suite() if check.group != "limits"}


@pytest.mark.parametrize(
    ("what", "failing"),
    [
        ("sign", {"slide", "stack-slides", "bond-slides", "odd-names"}),
        ("changes the wall", {"leaves-the-wall"}),
        ("wanders", {"repeats"}),
        ("global axes", {"topple", "stack-topples"}),
        ("no proof", {"slide", "topple", "falls", "unbounded"}),
        ("raises", {"slide", "view-scaled", "stands", "leaves-the-wall"}),
        ("no answer", {"slide", "falls"}),
        ("stands", {"falls"}),
    ],
)
def test_a_fault_is_found(what: str, failing: set[str]):
    rows = rows_of(what)
    assert failing <= {name for name, row in rows.items() if row.outcome is Outcome.FAILS}
    assert not conforms(list(rows.values()))


def test_the_same_method_without_a_fault_conforms():
    rows = rows_of("nothing")
    assert conforms(list(rows.values()))
    assert rows["slide"].cpu_seconds > 0.0
    assert rows["own-process"].outcome is Outcome.NOT_TESTED  # an object that no other process can load


def test_a_method_that_refuses_every_wall_does_not_conform():
    rows = rows_of("refuses all")
    assert {row.outcome for row in rows.values()} == {Outcome.REFUSED}
    assert not conforms(list(rows.values()))
