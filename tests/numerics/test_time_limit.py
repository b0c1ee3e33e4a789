"""A deadline is asked for, stops a run once, and holds for programmes that run in a library."""

from __future__ import annotations

import math
import time

import numpy as np
import pytest
import scipy.sparse as sp

from harness.model.deadline import Deadline, OutOfTime, answering_by, best_so_far
from methods.la.core.newton_matrix import NewtonMatrix
from methods.la.core.problem import make_problem
from methods.la.interior.interior_point import PathSettings, follow_path, start_point
from methods.numerics.linear_programme import INFINITY, Programme
from methods.springs.model.factor import make_factor
from methods.springs.model.points import GapSettings
from methods.springs.model.wall_model import build_model
from methods.springs.rest.equilibrium import gravity_state
from tests.walls import assembly, running_bond


def over() -> Deadline:
    """A deadline that has passed."""
    return Deadline(time.perf_counter() - 1.0)


def test_without_a_limit_a_run_is_never_stopped():
    deadline = Deadline.of_run()
    assert deadline.left == math.inf
    assert not deadline.passed
    deadline.ask()


def test_a_deadline_is_that_of_the_run_inside_and_of_none_outside():
    deadline = Deadline(time.perf_counter() + 100.0)
    with answering_by(deadline):
        assert Deadline.of_run() is deadline
        assert 99.0 < Deadline.of_run().left <= 100.0
    assert Deadline.of_run().left == math.inf


def test_a_run_is_stopped_once_so_that_its_answer_is_made_in_peace():
    deadline = over()
    assert deadline.passed
    with pytest.raises(OutOfTime):
        deadline.ask()
    assert not deadline.passed
    assert deadline.left == math.inf
    deadline.ask()
    deadline.stop()


@pytest.mark.parametrize(("deadline", "found"), [(Deadline(), "the whole"), (over(), "a part")])
def test_what_is_known_is_the_answer_where_the_time_is_over(deadline: Deadline, found: str):
    def search() -> str:
        deadline.ask()
        return "the whole"

    assert best_so_far(search, lambda: "a part") == found


def test_programme_out_of_time_is_told_and_not_taken_for_infeasible():
    matrix = sp.csc_matrix(np.random.default_rng(0).normal(size=(200, 300)))
    bounds = (np.zeros(300), np.full(300, 10.0))
    cost, rows = np.random.default_rng(1).normal(size=300), (-np.ones(200), np.full(200, INFINITY))
    with answering_by(over()):
        programme = Programme(matrix, cost, bounds, rows)
    with pytest.raises(OutOfTime):
        programme.run()
    assert programme.run()[0] == "optimal"


def test_a_programme_that_takes_longer_than_there_is_time_stops_at_the_deadline():
    size = 1200
    matrix = sp.csc_matrix(np.random.default_rng(0).uniform(size=(size, size)))
    rows = (np.full(size, -INFINITY), np.random.default_rng(1).uniform(size, 2.0 * size, size))
    began = time.perf_counter()
    with answering_by(Deadline(began + 0.05)):
        programme = Programme(matrix, -np.ones(size), (np.zeros(size), np.full(size, INFINITY)), rows)
        with pytest.raises(OutOfTime):
            programme.run()


def test_paths_and_equilibria_ask_for_the_deadline_of_their_wall():
    wall = assembly(running_bond(6, 3), 0.65)
    with answering_by(over()):
        problem = make_problem(wall)
    with answering_by(over()):
        model = build_model(wall, GapSettings())
    with pytest.raises(OutOfTime):
        follow_path(problem, NewtonMatrix(problem), start_point(problem), PathSettings())
    with pytest.raises(OutOfTime):
        gravity_state(model, make_factor(model))
