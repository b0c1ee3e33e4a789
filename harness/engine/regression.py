"""The gate: which references and statements of theory do not hold, one line each."""

from __future__ import annotations

from harness.model.comparison import ComparisonRun
from harness.model.method import Status
from harness.model.result import Verdict


def violations(compared: ComparisonRun) -> list[str]:
    """Sentences about checked references and statements of theory that are not met, and about rejected answers.

    A comparison in which no run ended with an answer says so too: it shows nothing.
    """
    found = []
    if not any(result.status is Status.OK for case in compared.cases for result in case.results):
        found.append("no run ended with an answer")
    for case in compared.cases:
        for result in case.results:
            if result.judge.accepted is False:
                found.append(f"{case.case.id}, {result.method}: the judge rejects the answer: {result.judge.sentence}")
            for comparison in result.comparisons:
                if comparison.gate and comparison.verdict not in (Verdict.AGREES, Verdict.NOT_TESTED):
                    found.append(f"{case.case.id}, {result.method}: {comparison.reference}: {comparison.sentence}")
        for gate in case.gates:
            if gate.passed is False:
                found.append(f"{case.case.id}: {gate.name}: {gate.statement}, but {gate.sentence}")
    return found
