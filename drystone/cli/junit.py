"""Outcomes as JUnit XML, the form that servers of continuous integration show test by test.

A value that misses its reference, an answer that the judge rejects and a statement of theory that does not hold are
failures; a run that crashed or met a limit is an error; what a method refuses or what cannot be tested is skipped.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal
from xml.etree import ElementTree

from harness.model.comparison import CaseResults, ComparisonRun
from harness.model.difference import Difference, Kind
from harness.model.errors import visible
from harness.model.method import Status
from harness.model.result import Result, Verdict
from harness.model.writing import write_whole

Outcome = Literal["passed", "failure", "error", "skipped"]


@dataclass(frozen=True)
class TestCase:
    """One test.

    Attributes:
        group: what it is of, e.g. the case.
        name: what is tested.
        outcome: how it went.
        sentence: the figures.
        seconds: CPU time, where it was measured.
    """

    group: str
    name: str
    outcome: Outcome
    sentence: str
    seconds: float | None = None


def write_junit(name: str, tests: Iterable[TestCase], path: Path) -> None:
    """Write tests as one suite of a JUnit file. Either the whole file is there or the old one."""
    listed = list(tests)
    counts = {word: sum(test.outcome == word for test in listed) for word in ("failure", "error", "skipped")}
    suite = ElementTree.Element(
        "testsuite",
        name=visible(name),
        tests=str(len(listed)),
        failures=str(counts["failure"]),
        errors=str(counts["error"]),
        skipped=str(counts["skipped"]),
        time=f"{sum(test.seconds or 0.0 for test in listed):.3f}",
    )
    for test in listed:
        element = ElementTree.SubElement(
            suite,
            "testcase",
            classname=visible(test.group),
            name=visible(test.name),
            time=f"{test.seconds or 0.0:.3f}",
        )
        if test.outcome == "passed":
            ElementTree.SubElement(element, "system-out").text = visible(test.sentence)
        else:
            ElementTree.SubElement(element, test.outcome, message=visible(test.sentence))
    suites = ElementTree.Element("testsuites")
    suites.append(suite)
    ElementTree.indent(suites)
    write_whole(path, ElementTree.tostring(suites, encoding="utf-8", xml_declaration=True))


def tests_of_check(lines: Iterable[dict[str, Any]]) -> Iterator[TestCase]:
    """The checked references of `drystone check`."""
    for line in lines:
        settings = "".join(f" {name}={value}" for name, value in sorted(line["settings"].items()))
        outcome = _held(Verdict(line["verdict"]))
        name = f"{line['method']}{settings}: {line['quantity']} {line['reference']}"
        yield TestCase(line["case"], name, outcome, line["sentence"])


def tests_of_comparison(compared: ComparisonRun) -> Iterator[TestCase]:
    """The runs, checked references and statements of theory of `drystone compare`."""
    for item in compared.cases:
        yield from _tests_of_case(item)


def _held(verdict: Verdict) -> Outcome:
    """The outcome of a checked reference."""
    return "skipped" if verdict is Verdict.NOT_TESTED else "passed" if verdict is Verdict.AGREES else "failure"


def _tests_of_case(item: CaseResults) -> Iterator[TestCase]:
    for result in item.results:
        yield _run(item.case.id, result)
        for comparison in result.comparisons:
            if comparison.gate:
                name = f"{result.method}: {comparison.quantity} {comparison.reference}"
                yield TestCase(item.case.id, name, _held(comparison.verdict), comparison.sentence)
    for gate in item.gates:
        outcome: Outcome = "skipped" if gate.passed is None else "passed" if gate.passed else "failure"
        yield TestCase(item.case.id, f"theory: {gate.statement}", outcome, gate.sentence)


_OF_STATUS: dict[Status, Outcome] = {
    Status.OK: "passed",
    Status.REFUSED: "skipped",
    Status.NOT_CONVERGED: "error",
    Status.TIMEOUT: "error",
    Status.OUT_OF_MEMORY: "error",
    Status.CRASHED: "error",
}


def _run(case: str, result: Result) -> TestCase:
    if result.judge.accepted is False:
        return TestCase(
            case, f"{result.method}: run", "failure", f"rejected: {result.judge.sentence}", result.cpu_seconds
        )
    value = "" if result.multiplier is None else f" ({result.multiplier!r})"
    sentence = f"{str(result.status).replace('_', ' ')}: {result.sentence}{value}"
    return TestCase(case, f"{result.method}: run", _OF_STATUS[result.status], sentence, result.cpu_seconds)


def tests_of_difference(found: Difference) -> Iterator[TestCase]:
    """The rows of `drystone diff`."""
    for row in found.rows:
        bad = row.kind in (Kind.WORSE, Kind.GONE, Kind.SLOWER)
        time = "" if row.ratio is None else f", {row.ratio:.2f} times the CPU time"
        sentence = f"{row.kind}: {row.figures}{time}"
        yield TestCase(row.case, row.method, "failure" if bad else "passed", sentence, row.new_seconds)
