"""Requirements on the table that `drystone compare` prints."""

from __future__ import annotations

from typing import Any

import pytest

import drystone
from drystone.cli.terminal import print_comparison, print_result
from harness.model.columns import PRINTED
from harness.model.comparison import CaseResults, ComparisonRun
from harness.model.method import Finding, Status
from harness.model.result import Comparison, Result, Verdict
from harness.model.result_texts import answer_text, references_text
from reports.labels.numbers import met


def test_a_reference_that_asks_for_other_settings_is_not_shown_as_that_of_the_value_beside_it():
    def held(value, expected):
        given = {"reference": "made-up", "quantity": "multiplier", "value": value, "expected": expected}
        return Comparison(**given, tolerance=0.01, gate=True, verdict=Verdict.AGREES, sentence="It holds.")

    result = Result(
        case="wall",
        method="de-soft",
        family="de",
        status=Status.OK,
        finding=Finding.COLLAPSES,
        sentence="It collapses.",
        multiplier=0.52,
        bracket=(0.51, 0.53),
        blocks=1,
        interfaces=1,
        comparisons=[held(0.52, 0.525), held([0.51, 0.53], [0.5, 0.6]), held(0.49, 0.495)],
    )
    assert references_text(result) == "0.525, [0.5, 0.6], 0.495 (other settings)"


def test_one_of_one_is_singular(capsys):
    """It read "All 1 checked references are met"."""
    known = {"reference": "known", "quantity": "multiplier", "value": 0.5, "expected": 0.5, "tolerance": 0.01}
    held = Comparison(**known, gate=True, verdict=Verdict.AGREES, sentence="It holds.")
    case = drystone.new_wall("stack", count=2, width=0.3, height=0.2, friction=0.8).case
    about = {"case": case.id, "method": "la", "family": "la", "blocks": 2, "interfaces": 2, "multiplier": 0.5}
    result = Result(**about, status=Status.OK, finding=Finding.COLLAPSES, sentence="It falls.", comparisons=[held])
    print_comparison(ComparisonRun("t", "", "", [CaseResults(case, [result])]), None)
    assert "1 of 1 checked reference is met; no statement" in capsys.readouterr().out
    said = [met(held, tested, "reference") for held, tested in ((3, 3), (1, 3), (0, 1), (0, 0))]
    assert said == [
        "3 of 3 references are met",
        "1 of 3 references is met",
        "0 of 1 reference is met",
        "0 of 0 references are met",
    ]


@pytest.mark.parametrize(
    ("strength", "said"),
    [
        ({}, "at the multiplier 0.2."),
        ({"cohesion": 20}, "at the multiplier 0.3, with the strength of the joints."),
        ({"cohesion": 20, "after": "residual"}, "at the multiplier 0.2, without the strength of brittle joints."),
    ],
)
def test_reactions_say_of_which_of_two_multipliers_they_are(strength: dict[str, Any], said: str, capsys):
    """With the strength of joints they stood below "rely on the residual answer", and belong to the other one."""
    blocks = [
        {"id": "ground", "polygon": [[-1, -0.2], [2, -0.2], [2, 0], [-1, 0]], "fixed": True},
        {"id": "block", "polygon": [[0, 0], [0.4, 0], [0.4, 2], [0, 2]]},
    ]
    friction = {"default": 0.7, "tensile_strength": 20 if strength else 0} | strength
    loads = {"loads": {"live": {"body": [{"per_weight": [1, 0]}]}}}
    wall = drystone.build_wall({"format": "wall/1", "unit_weight": 20, "friction": friction, "blocks": blocks} | loads)
    result = drystone.analyse(wall, "la")
    print_result(result, wall.case, result.proof)
    shown = " ".join(capsys.readouterr().out.split())
    assert f"The forces below are those {said} reaction ground: Fx" in shown


def test_one_refusal_of_many_load_cases_is_told_once(capsys):
    """Twenty load cases and four methods gave eighty lines."""
    stack = drystone.new_wall("stack", count=2, width=0.3, height=0.2, friction=0.8)
    cases = [stack.called(f"stack-{k}").case for k in range(20)]
    shared = {"method": "de", "family": "de", "status": Status.REFUSED, "finding": Finding.NONE}
    results = [Result(case=case.id, sentence="de takes no mortar.", blocks=2, interfaces=2, **shared) for case in cases]
    run = ComparisonRun("t", "", "", [CaseResults(case, [each]) for case, each in zip(cases, results, strict=True)])
    print_comparison(run, None)
    shown = capsys.readouterr().out
    assert shown.count("takes no mortar") == 1
    assert "stack-0, stack-1, stack-2 and 17 more, de: de takes no mortar." in shown


def test_heads_are_those_of_the_declared_columns(capsys):
    print_comparison(ComparisonRun("t", "", "", []), None)
    shown = capsys.readouterr().out
    assert [column.name for column in PRINTED if column.head not in shown] == []
    assert "CPU time [s]" in shown


def test_a_value_of_associated_flow_is_called_an_upper_bound_whoever_found_it(capsys):
    wall = drystone.library_wall("single-block")
    result = drystone.analyse(wall, "la-associated")
    print_result(result, wall.case, result.proof)
    shown = " ".join(capsys.readouterr().out.split())
    assert "finding 0.5454545 (upper bound) The greatest multiplier" in shown
    assert "an upper bound whatever the flow." in shown
    stopped = result.model_copy(update={"method": "la", "traits": drystone.analyse(wall, "la").traits})
    assert answer_text(stopped) == "0.5454545 (upper bound)", "all that a search knows that is stopped early"
    assert answer_text(stopped.model_copy(update={"flow": "non-associated"})) == "0.5454545"
