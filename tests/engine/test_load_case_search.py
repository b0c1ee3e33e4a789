"""Load cases of one wall take up each other's mechanisms, and the governing one is searched whatever they find."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import pytest

from drystone.comparing import Comparison, compare, recalled
from drystone.walls import Wall
from harness.engine.executors import InProcess
from harness.engine.load_case_search import made_together
from harness.engine.pipeline import execute
from harness.engine.plan import plan_case
from harness.engine.run import Run
from harness.model.load_cases import load_cases_of
from harness.model.method import Finding
from harness.model.result import Result
from tests.walls import case, running_bond, stack

BOND = running_bond(4, 3)
METHODS = ["la", "la-associated"]


def pushed(*directions: tuple[float, float]) -> dict[str, Any]:
    """Load cases that act along so many directions."""
    names = [f"push-{number}" for number in range(1, len(directions) + 1)]
    return {name: {"live": {"body": [{"per_weight": list(d)}]}} for name, d in zip(names, directions, strict=True)}


def compared(load_cases: dict[str, Any], pattern: dict[str, Any] = BOND, **more: Any) -> Comparison:
    wall = Wall(case(pattern, loads={}, load_cases=load_cases))
    return compare(wall, METHODS, isolated=False, **more)


def made(load_cases: dict[str, Any], pattern: dict[str, Any] = BOND) -> tuple[list[Run], list[Result], list[Run]]:
    """The runs that stand and their results, and every run that was made."""
    cases = load_cases_of(case(pattern, loads={}, load_cases=load_cases))
    wall_of = {each.id: each.wall_id for each in cases}
    asked: list[Run] = []

    def make(runs: Sequence[Run]) -> list[Result]:
        asked.extend(runs)
        return execute(runs, None, 1, executor=InProcess())

    planned = [run for each in cases for run in plan_case(each, METHODS, None)]
    return *made_together(planned, lambda run: wall_of[run.case.id], make), asked


def test_similar_load_cases_are_searched_twice_in_all_and_end_where_each_does_alone():
    directions = [(1.0, lift) for lift in (0.0, 0.05, 0.1, 0.15)]
    stand, results, asked = made(pushed(*directions))
    searched = [run.case.id for run in asked if run.method == "la" and not run.given]
    assert searched == ["made-up-push-1", "made-up-push-4"], "the first, and the one that governs"
    assert [run.method for run in stand] == METHODS * 4
    for run, result in zip(stand, results, strict=True):
        alone = execute([Run(run.case, run.method, {}, None)], None, 1, executor=InProcess())[0]
        assert result.multiplier == pytest.approx(alone.multiplier, rel=1e-9)
        assert result.judge.accepted
        assert result.key == run.key
        assert bool(result.given) == bool(run.given)
    assert [run.case.id for run in stand if run.method == "la" and not run.given] == searched
    taken = results[2]
    assert taken.given == [results[0].key]
    assert "mechanisms of other runs" in taken.sentence


def test_a_load_case_that_no_known_mechanism_fits_is_searched():
    to_both_sides = [(1.0, 0.0), (-1.0, 0.0), (1.0, 0.1)]
    stand, results, asked = made(pushed(*to_both_sides))
    searched = {run.case.id for run in asked if run.method == "la" and not run.given}
    assert searched == {"made-up-push-1", "made-up-push-2", "made-up-push-3"}
    assert all(result.finding is Finding.COLLAPSES for result in results)
    right, left = results[0].multiplier, results[2].multiplier
    assert right == pytest.approx(left, rel=1e-9), "the bond is its own mirror image"
    assert len(stand) == 6


def test_load_cases_without_a_collapse_are_each_searched_once():
    _, results, asked = made(pushed((0.0, -1.0), (0.0, -2.0)), stack(3))
    assert sum(run.method == "la" for run in asked) == 2
    assert all(result.finding is Finding.UNBOUNDED for result in results if result.method == "la")


def test_a_comparison_and_its_store_agree_and_a_repeat_makes_nothing_anew(tmp_path: Path):
    store, told = tmp_path / "runs.sqlite", list[tuple[str, str, bool]]()
    load_cases = pushed((1.0, 0.0), (1.0, 0.1), (-1.0, 0.0))
    arguments: dict[str, Any] = {
        "store": store,
        "progress": lambda run, _, stored: told.append((run.case.id, run.method, stored)),
    }
    first = compared(load_cases, **arguments)
    assert len(told) == len(set(told)) == 6, "each planned run is told once"
    told.clear()
    again = compared(load_cases, **arguments)
    assert len(told) == 6
    assert all(stored for _, _, stored in told)
    kept = [item for each in recalled(store).cases for item in each.results]
    for one in (again, kept):
        values = [item.multiplier for item in (one.results if isinstance(one, Comparison) else one)]
        assert values == [item.multiplier for item in first.results]


def test_answers_do_not_depend_on_the_number_of_workers():
    load_cases = pushed((1.0, 0.0), (1.0, 0.1), (-1.0, 0.0))
    one, two = (compare(Wall(case(BOND, loads={}, load_cases=load_cases)), METHODS, jobs=jobs) for jobs in (1, 2))
    assert [item.row.result.sentence for item in one.results] == [item.row.result.sentence for item in two.results]
