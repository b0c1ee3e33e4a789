"""Certificates that methods hand on: each is checked here, the highest counts, and outputs say what is refused."""

from __future__ import annotations

import json
from dataclasses import replace
from fractions import Fraction
from functools import cache
from pathlib import Path
from typing import Any

import pytest

import drystone
from drystone.certificates import certified_results, with_certificates
from drystone.cli.terminal import comparison_json, print_comparison, print_result
from drystone.walls import Wall
from harness.model.answer_check import DEEPEST, checked
from harness.model.comparison import CaseResults, ComparisonRun
from harness.model.json_text import MOST_NESTED, nested_deeper
from harness.model.method import Answer, Finding, Status
from harness.model.proof import Standing, proof_of
from harness.model.result import Result
from methods.la.bounds import BoundedLimitAnalysis
from methods.la.find_certificate import certificate
from methods.la.settings import BoundSettings
from methods.proof.verify.document import digest
from reports.page.build import write_report
from tests.walls import case, stack

FRICTION = 0.37
WALL = case(stack(1), FRICTION)
"""A block that slides at its friction: no wall of the library, so that no certificate of those is its own."""


@cache
def least() -> Result:
    (found,) = drystone.compare(Wall(WALL), ["la"], isolated=False).run.cases[0].results
    return found


def proof_for(wall: Any = WALL) -> dict[str, Any]:
    document = certificate(wall.assembly)
    assert document is not None
    return document


def lowered(bound: str) -> dict[str, Any]:
    """The certificate with another bound; forces of its leaves balance as much more live load as the bound is lower."""
    document = proof_for()
    less = Fraction(document["bound"]) - Fraction(bound)
    for leaf in document["leaves"]:
        if "parts" in leaf:
            dead, live = map(Fraction, leaf["parts"])
            leaf["parts"] = [str(dead), str(live + less * dead)]
    document["bound"] = bound
    return document | {"digest": digest(document)}


def handed_on(**documents: Any) -> ComparisonRun:
    """Results of methods of these names, each with what it hands on as a certificate."""
    plain = {name: value for name, value in least().details.items() if name not in ("certificate", "proved_least")}
    results = [
        least().model_copy(update={"method": name, "details": plain | {"certificate": document}})
        for name, document in documents.items()
    ]
    return ComparisonRun("handed on", "a test", "2026-01-01T00:00:00Z", [CaseResults(WALL, results)])


@pytest.mark.parametrize("order", [("low", "high", "none"), ("high", "none", "low"), ("none", "low", "high")])
def test_the_highest_of_several_checked_bounds_counts_whichever_comes_first(order: tuple[str, ...]) -> None:
    documents = {"low": lowered("1/10"), "high": lowered("3/10"), "none": lowered("1/2")}
    (item,) = with_certificates(handed_on(**{name: documents[name] for name in order})).cases
    assert item.certified is not None
    assert (item.certified.bound, item.certified.source) == (pytest.approx(0.3, rel=1e-15), "certificate of high")
    assert Fraction(item.certified.bound) <= Fraction(3, 10)
    assert set(item.refused) == {"none"}
    assert {proof_of(item, result).standing for result in item.results} <= {Standing.KNOWN, Standing.NONE}


def test_a_certificate_that_meets_the_state_makes_it_the_minimum_and_another_one_of_less_does_not_take_that_away():
    (item,) = with_certificates(handed_on(good=proof_for(), weak=lowered("1/10"))).cases
    assert proof_of(item, item.results[0]).standing is Standing.MINIMUM
    assert item.refused == {}


OTHERS: dict[str, Any] = {
    "a text": "proved",
    "a list": [1],
    "nothing in it": {},
    "of another friction": proof_for(case(stack(1), 0.38)),
    "of another size": proof_for(case(stack(1, width=0.31), FRICTION)),
    "of more blocks": proof_for(case(stack(2), FRICTION)),
    "with a raised bound": proof_for() | {"bound": "36999999/100000000"},
    "that is a promise": {"bound": "37/100", "multiplier": "37/100", "proved": True},
}


@pytest.mark.parametrize("name", OTHERS)
def test_what_is_no_certificate_of_this_wall_proves_nothing_and_its_refusal_is_said(name: str) -> None:
    (item,) = with_certificates(handed_on(other=OTHERS[name])).cases
    proof = proof_of(item, item.results[0])
    assert (item.certified, proof.standing, proof.bound) == (None, Standing.KNOWN, None)
    assert "The certificate that other hands on is refused" in proof.sentence


def test_a_refusal_reaches_every_output(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    run = with_certificates(handed_on(other={"bound": "1"}))
    said = "The certificate that other hands on is refused"
    print_comparison(run, None)
    assert said in " ".join(capsys.readouterr().out.split())
    assert said in json.dumps(comparison_json(run, None))
    write_report(run, tmp_path / "report.html")
    assert said in (tmp_path / "report.html").read_text()
    tables = [path for path in tmp_path.rglob("*.*") if path.suffix in (".csv", ".json")]
    assert {path.suffix for path in tables if said in path.read_text()} == {".csv", ".json"}
    (result,) = run.cases[0].results
    print_result(result, WALL, proof_of(certified_results(WALL, result), result))
    assert said in " ".join(capsys.readouterr().out.split())


def test_the_seconds_for_what_methods_hand_on_are_shared_and_end() -> None:
    run = handed_on(first=proof_for(), second=proof_for())
    (item,) = with_certificates(run, seconds=0.0).cases
    assert item.certified is None
    assert set(item.refused) == {"first", "second"}
    assert all("time limit" in why for why in item.refused.values())
    assert with_certificates(run).cases[0].refused == {}


def test_a_refused_certificate_of_a_result_that_the_judge_rejects_is_said_too() -> None:
    result = handed_on(other={"bound": "1"}).cases[0].results[0]
    rejected = result.model_copy(update={"judge": result.judge.model_copy(update={"accepted": False})})
    proof = proof_of(certified_results(WALL, rejected), rejected)
    assert (proof.standing, bool(proof.refused)) == (Standing.NONE, True)


def test_a_bound_above_a_state_of_another_method_is_no_bound_of_any() -> None:
    """A certificate and a state below it cannot both be right: nothing is called proved then."""
    (item,) = with_certificates(handed_on(good=proof_for())).cases
    lower = item.results[0].model_copy(update={"method": "lower", "multiplier": 0.3})
    both = replace(item, results=[*item.results, lower])
    assert {proof_of(both, result).standing for result in both.results} == {Standing.NONE, Standing.KNOWN}


def nested(levels: int) -> Any:
    return [] if levels == 1 else [nested(levels - 1)]


def test_a_certificate_of_as_many_divisions_as_those_of_the_library_fits_into_an_answer_and_its_files() -> None:
    """That of wall-21-friction-075 is nested 23 deep; a document with results adds six levels."""
    answer = Answer(Status.OK, Finding.NONE, "", details={"certificate": {"cases": nested(22)}})
    assert checked(answer, WALL.assembly).details == answer.details
    deepest = {"cases": [{"results": [{"details": {"certificate": nested(DEEPEST)}}]}]}
    assert not nested_deeper(deepest, MOST_NESTED)


def test_a_bound_that_is_not_sought_because_joints_dilate_is_said() -> None:
    wall = case(stack(2), {"default": 0.5, "dilatancy": 0.1}).assembly
    answer = BoundedLimitAnalysis().solve(wall, BoundSettings(bound_seconds=5.0, effort="quick"))
    assert answer.sentence.endswith("No bound below it is sought: some joints have dilatancy.")
    assert "certificate" not in answer.details
