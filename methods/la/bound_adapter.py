"""The least state known and a lower bound on every other, as the harness knows it."""

from __future__ import annotations

from typing import Any

from harness.model.assembly import Assembly
from harness.model.method import Answer, Finding
from methods.la.bounds import with_bound
from methods.la.certify.tree_certificate import certificate
from methods.la.certify.window_certificate import certified_bracket
from methods.la.core.newton_matrix import NewtonMatrix
from methods.la.core.problem import Problem, make_problem
from methods.la.core.search_settings import SearchSettings
from methods.la.declared_la import DeclaredBound
from methods.la.family import LimitAnalysisFamily
from methods.la.least import least_known
from methods.springs.warm_up import load_kernels

load_kernels()


class BoundedLimitAnalysis(LimitAnalysisFamily, DeclaredBound):
    """The state of `la`, and a multiplier below which there is no collapse state (`la-bound`)."""

    def answer(self, assembly: Assembly, problem: Problem, newton: NewtonMatrix, settings: Any) -> Answer:
        """The search of `la`, then windows on the multiplier below its state."""
        known = least_known(problem, newton, settings.search(), self.tolerance)
        return with_bound(assembly, problem, known, settings)


def find_certificate(
    assembly: Assembly, nodes: int, seconds: float, search: SearchSettings | None = None
) -> dict[str, Any] | None:
    """The certificate of the tree where that ends, else of windows; None where neither proves anything.

    Args:
        assembly: a wall of one component, which stands under its dead load.
        nodes: of the tree at most.
        seconds: of CPU time for the windows.
        search: of the state below which the windows lie.
    """
    document = certificate(assembly, nodes)
    if document is not None or not assembly.has_live_load:
        return document
    problem = make_problem(assembly)
    known = least_known(problem, NewtonMatrix(problem), search or SearchSettings(), BoundedLimitAnalysis.tolerance)
    if known.finding is not Finding.COLLAPSES or known.mechanism is None or not (known.multiplier or 0.0) > 0.0:
        return None
    assert known.multiplier is not None
    return certified_bracket(problem, known.multiplier, known.mechanism, seconds)[1]
