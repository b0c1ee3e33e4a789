"""A programme that runs in a library ends with the time that is given to the method."""

from __future__ import annotations

import signal

import numpy as np
import pytest
import scipy.sparse as sp

from harness.model.method import OutOfTime, seconds_left
from methods.numerics.linear_programme import INFINITY, Programme


def test_seconds_left_are_those_to_the_alarm(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(signal, "getitimer", lambda _: (0.0, 0.0))
    assert seconds_left() == np.inf
    monkeypatch.setattr(signal, "getitimer", lambda _: (2.5, 0.0))
    assert seconds_left() == 2.5


def test_programme_out_of_time_is_told_and_not_taken_for_infeasible(monkeypatch: pytest.MonkeyPatch):
    matrix = sp.csc_matrix(np.random.default_rng(0).normal(size=(200, 300)))
    bounds = (np.zeros(300), np.full(300, 10.0))
    programme = Programme(
        matrix, np.random.default_rng(1).normal(size=300), bounds, (-np.ones(200), np.full(200, INFINITY))
    )
    with monkeypatch.context() as patch:
        patch.setattr("methods.numerics.linear_programme.seconds_left", lambda: 0.0)
        with pytest.raises(OutOfTime):
            programme.run()
    assert programme.run()[0] == "optimal"
