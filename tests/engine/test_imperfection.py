"""The study of uneven blocks: means over walls, where they pass the experiment, walls without an answer."""

from __future__ import annotations

import pytest

from harness.engine.imperfection import imperfection_runs, imperfection_study
from harness.engine.plan import Limits
from harness.model.method import Answer, Finding, Status
from harness.model.result import Result, result_of
from tests.walls import case, stack

WALL = case(stack(1))


def found(multiplier: float | None) -> Result:
    status = Status.OK if multiplier is not None else Status.NOT_CONVERGED
    finding = Finding.COLLAPSES if multiplier is not None else Finding.NONE
    answer = Answer(status, finding, "", multiplier=multiplier)
    return result_of(answer, WALL.assembly, case="wall", method="de-uneven", family="de")


def test_study_interpolates_where_the_mean_passes_the_experiment_and_counts_lost_walls():
    runs = imperfection_runs(WALL, Limits(), sizes=(0.0, 0.1), seeds=range(2))
    values = [1.0, 0.7, 0.5, 1.0, 0.9, None]  # beds and heads: even, two walls; then beds alone
    study = imperfection_study(runs, [found(value) for value in values])
    both, beds = study["series"]
    assert both["y"] == pytest.approx([0.0, -40.0])
    assert (both["low"][1], both["high"][1]) == pytest.approx((-50.0, -30.0))
    assert "by −20 % at about 0.050" in study["sentence"]
    assert beds["y"] == pytest.approx([0.0, -10.0])
    assert "nowhere up to that (1 walls did not answer)" in study["sentence"]
    assert "2 walls a size" in study["sentence"]
