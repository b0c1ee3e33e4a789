"""Results of one wall side by side: which counts as the upper bound, and who disagrees that it stands."""

from __future__ import annotations

from typing import Any

import pytest

from harness.engine.compare import gather
from harness.engine.run import Limits, Run
from harness.model import columns
from harness.model.comparison import CaseResults
from harness.model.library import Library, library
from harness.model.method import Finding, Status
from harness.model.result import Result
from tests.reports import samples

CASE = samples.bond("mine")


def found(method: str, finding: Finding, **more: Any) -> Result:
    multiplier = 0.5 if finding.has_multiplier else None
    changes = {"finding": finding, "multiplier": multiplier} | more
    return samples.solved(CASE, method, 0.5).model_copy(update=changes)


def split(*results: Result) -> str:
    return CaseResults(CASE, list(results)).split_on_dead_load


def test_methods_that_disagree_whether_a_wall_stands_are_named():
    said = split(found("fe", Finding.FALLS), found("de", Finding.STANDS))
    assert said.startswith("Under the dead load the wall falls for fe and stands for de: it may be at the limit")
    for stands in (Finding.COLLAPSES, Finding.UNBOUNDED):
        assert "falls for fe and stands for de" in split(found("fe", Finding.FALLS), found("de", stands))


def test_limit_analysis_alone_stands_by_self_stress():
    said = split(found("fe", Finding.FALLS), found("la", Finding.COLLAPSES), found("de", Finding.FALLS))
    assert said.startswith("Under the dead load the wall falls for fe, de and stands for la. Limit analysis allows")
    both = split(found("fe", Finding.FALLS), found("la", Finding.STANDS), found("de", Finding.STANDS))
    assert "or one of them is wrong" in both
    turned = split(found("la-associated", Finding.FALLS), found("la", Finding.STANDS))
    assert "or one of them is wrong" in turned


@pytest.mark.parametrize(
    "others",
    [
        [found("la", Finding.FALLS)],
        [found("la", Finding.AT_LIMIT)],
        [found("la", Finding.NONE)],
        [found("la", Finding.STANDS, status=Status.NOT_CONVERGED)],
        [],
    ],
)
def test_methods_at_the_limit_or_without_an_answer_disagree_with_none(others: list[Result]):
    assert split(found("fe", Finding.FALLS), *others) == ""


def test_walls_that_stand_for_all_are_no_matter_of_dispute():
    assert split(found("fe", Finding.STANDS), found("la", Finding.COLLAPSES)) == ""


def test_the_upper_bound_is_an_associated_maximum_that_was_found_and_not_rejected():
    best = found("la-associated", Finding.COLLAPSES).model_copy(update={"flow": "associated"})
    rejected = best.model_copy(update={"judge": best.judge.model_copy(update={"accepted": False})})
    open_end = found("la-associated", Finding.UNBOUNDED)
    lost = best.model_copy(update={"status": Status.NOT_CONVERGED})
    of_no_flow = best.model_copy(update={"flow": "non-associated"})
    for others in ([], [found("la", Finding.COLLAPSES)], [rejected], [open_end], [lost], [of_no_flow]):
        assert CaseResults(CASE, [*others, best]).associated is best
        assert CaseResults(CASE, others).associated is None
    assert CaseResults(CASE, [best]).of("la-associated") is best
    assert CaseResults(CASE, [best]).of("la") is None


def test_a_run_without_an_answer_tells_the_upper_bound_that_another_method_found():
    best = found("la-associated", Finding.COLLAPSES).model_copy(update={"flow": "associated", "multiplier": 0.75})
    lost = samples.failed(CASE, "fe", Status.TIMEOUT, "It was stopped at the limit of 2 s.")
    own = samples.failed(CASE, "la", Status.NOT_CONVERGED, "nothing; above 0.8 no equilibrium within yield exists")
    own.details["associated"] = 0.8
    refused = samples.failed(CASE, "de", Status.REFUSED, "de takes no mortar.")
    rows = [lost, own, refused, best]
    runs = [Run(CASE, row.method, {}, Limits()) for row in rows]
    (told,) = gather([CASE], runs, rows)
    assert [row.sentence for row in told.results] == [
        "It was stopped at the limit of 2 s; above 0.75 no equilibrium within yield exists, so the wall moves there at "
        "the latest, by la-associated",
        *(row.sentence for row in rows[1:]),
    ]
    (alone,) = gather([CASE], runs[:3], rows[:3])
    assert [row.sentence for row in alone.results] == [row.sentence for row in rows[:3]]


def test_methods_are_listed_by_family_its_main_method_first_and_strangers_last():
    own = Library.model_validate(library().model_dump() | {"families": {"b": "Family B", "a": "Family A"}})
    methods = [("z", "other"), ("a-exact", "a"), ("a", "a"), ("b-fast", "b"), ("b", "b"), ("c", "other")]
    ordered = sorted(methods, key=lambda pair: own.order(*pair))
    assert [name for name, _ in ordered] == ["b", "b-fast", "a", "a-exact", "c", "z"]
    assert (own.family_title("a", "a-exact"), own.family_title("", "z"), own.family_title("x", "z")) == (
        "Family A",
        "z",
        "x",
    )


def test_tables_name_each_column_once_and_no_other():
    for table in (columns.PRINTED, columns.LISTED, columns.REPEATED):
        assert len({column.name for column in table}) == len(table)
        assert all(column.meaning for column in table)
