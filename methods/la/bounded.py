"""The method `la-bound`: the least state known and a lower bound on every other (`methods.la.bounds`)."""

from __future__ import annotations

from typing import Any

from harness.model.assembly import Assembly
from harness.model.method import Answer
from methods.la.bounds import with_bound
from methods.la.core.newton_matrix import NewtonMatrix
from methods.la.core.problem import Problem
from methods.la.family import LimitAnalysisFamily
from methods.la.least import least_known
from methods.la.methods import LA_BOUND
from methods.springs.warm_up import load_kernels

load_kernels()


class BoundedLimitAnalysis(LimitAnalysisFamily):
    """The state of `la`, and a multiplier below which there is no collapse state (`la-bound`)."""

    def answer(self, assembly: Assembly, problem: Problem, newton: NewtonMatrix, settings: Any) -> Answer:
        """The search of `la`, then windows on the multiplier below its state."""
        known = least_known(problem, newton, settings.search(), LA_BOUND.tolerance)
        return with_bound(assembly, problem, known, settings)
