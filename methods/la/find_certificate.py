"""The certificate of a wall by what closes, the tree where it may end or windows, and what stopped where none does."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

from harness.model.assembly import Assembly, FloatArray
from harness.model.method import Finding, Status
from methods.la.answers import dead_load_answer
from methods.la.certify.proof import prove
from methods.la.certify.window_certificate import certified_bracket
from methods.la.core.newton_matrix import NewtonMatrix
from methods.la.core.problem import Problem, make_problem
from methods.la.core.state import CollapseState
from methods.la.least import least_known
from methods.la.methods import LA_BOUND
from methods.la.settings import BoundSettings, SearchSettings
from methods.la.sources.budget import Sizes
from methods.la.sources.search import Search
from methods.proof.search.options import PROVED, ProofOptions
from methods.proof.search.window_search import Bracket
from methods.proof.tree.certificate import tree_certificate
from methods.proof.verify.document import share_of_largest, written


def certificate(
    assembly: Assembly, nodes: int = 1500, seconds: float = math.inf, mechanism: FloatArray | None = None
) -> dict[str, Any] | None:
    """The certificate of a wall of one component, which stands under its dead load; None where none was found.

    One larger than is checked is none.

    Args:
        assembly: the wall, whose numbers must be short fractions.
        nodes: of the tree at most.
        seconds: of CPU time after which no further leaf is begun, and there is no certificate.
        mechanism: (n_blocks, 3) velocities of a collapse state that is known; None takes the one that the interior
            point leads to, which leads to none where statics allows any live load.
    """
    end = time.process_time() + seconds
    # The equations in fractions are of dry joints and lift none.
    beyond_dry = assembly.dilates or assembly.strong or assembly.crushes or len(assembly.bars)
    if not assembly.has_live_load or beyond_dry:
        return None
    problem = make_problem(assembly)
    search = Search(problem, NewtonMatrix(problem))
    known = search.interior() if mechanism is None else _state_of(search, mechanism)
    if known is None:
        return None
    proof = prove(search, known, nodes)
    if not proof.complete:
        return None
    least = proof.state.multiplier * problem.unit_multiplier, proof.state.moving
    document = tree_certificate(assembly, problem.unit_force, least, proof.leaves, end)
    return None if document is None or share_of_largest(written(document)) > 1.0 else document


def _state_of(search: Search, mechanism: FloatArray) -> CollapseState | None:
    velocities = search.problem.from_mechanism(mechanism)
    return search.state_of(velocities, search.problem.rates_of_velocities(velocities, False))


_LOOSE = 140
"""Interfaces above which the bound after some minutes is far below the state."""


@dataclass(frozen=True)
class _Attempt:
    """Results of the attempt to certify a wall.

    Attributes:
        document: the certificate; None where nothing is proved in fractions.
        sentence: how far the bound came and why it ended there; empty where it meets the state.
    """

    document: dict[str, Any] | None
    sentence: str = ""


def find_certificate(
    assembly: Assembly,
    seconds: float,
    search: SearchSettings,
    nodes: int | None = None,
    say_before: Callable[[str], None] = lambda sentence: None,
    jobs: int = 1,
) -> _Attempt:
    """The certificate of the tree where that ends, else of windows.

    Args:
        assembly: a wall of one component.
        seconds: of CPU time for the windows; of elapsed time with several processes.
        search: of the state below which the windows lie.
        nodes: of the tree at most; None as many as `la` takes, which are none on walls where hardly any ends.
        say_before: called with what is known of the bound of such walls, before time is spent on it.
        jobs: processes that work on the parts of divided states.
    """
    problem = make_problem(assembly)
    newton = NewtonMatrix(problem)
    early = dead_load_answer(problem, newton, assembly.has_live_load)
    if early is not None:
        return _Attempt(None, early.sentence)
    most = Sizes().limits(search.effort, problem).nodes if nodes is None else nodes
    document = certificate(assembly, most) if most else None
    if document is not None:
        return _Attempt(document)
    too_large = beyond(problem, BoundSettings().most_interfaces)
    if too_large:
        return _Attempt(None, too_large)
    if problem.n_interfaces > _LOOSE:
        say_before(
            f"The wall has {problem.n_interfaces} interfaces: above {_LOOSE} the bound after some minutes "
            f"lies well below the least state known. The search for that state comes first, then {seconds:g} s"
            f"{_of_time(jobs)} for the bound."
        )
    known = least_known(problem, newton, search, LA_BOUND.tolerance)
    if known.status is not Status.OK or known.finding is not Finding.COLLAPSES or known.multiplier is None:
        return _Attempt(None, known.sentence)
    if known.multiplier <= 0.0 or known.mechanism is None:
        return _Attempt(None, f"{known.sentence} A bound is sought below states above zero only.")
    if most and known.details["proved_least"]:
        document = certificate(assembly, most, mechanism=known.mechanism)
        if document is not None:
            return _Attempt(document)
    clock = ProofOptions(jobs=jobs).clock
    began = clock()
    found, document = certified_bracket(problem, known.multiplier, known.mechanism, seconds, jobs)
    return _Attempt(document, account(problem, known.multiplier, found, document, clock() - began, jobs))


def beyond(problem: Problem, most: int) -> str:
    """Why no bound is tried on a wall of more interfaces than `most`; empty for others."""
    if problem.n_interfaces <= most:
        return ""
    return (
        f"No lower bound is tried: the wall has {problem.n_interfaces} interfaces, more than {most}, above which the "
        "matrices of products are too large."
    )


def account(
    problem: Problem, multiplier: float, found: Bracket, document: dict[str, Any] | None, seconds: float, jobs: int = 1
) -> str:
    """How far a bracket came in floating point and in fractions, and why it ended; empty where its end is certified.

    Args:
        problem: the scaled wall; multiplier: of the state; found: its bracket; document: of its certificate.
        seconds: that were spent, of CPU time; of elapsed time with several processes.
        jobs: number of processes.
    """
    proved = float(Fraction(document["bound"])) if document is not None else 0.0
    if proved >= multiplier * (1.0 - PROVED):
        return ""
    bound = found.in_floats * problem.unit_multiplier
    in_floats = f"at {bound:.7g} in floating point" if bound > 0.0 else "still at zero"
    in_fractions = f"at {proved:.7g} in fractions" if proved > 0.0 else "nothing is proved in fractions"
    reasons = [f"no certificate of an interval, because {found.refused}"] if found.refused else []
    reasons += [found.stopped] if found.stopped else []
    if not reasons:
        reasons = ["exact arithmetic gives a lower bound of some subproblem than floating point"]
    return (
        f"After {seconds:.1f} s{_of_time(jobs)} the bound is {in_floats}, {in_fractions}; "
        f"the least state known is {multiplier:.7g}. Reasons: {'; '.join(reasons)}."
    )


def _of_time(jobs: int) -> str:
    return " of CPU time" if jobs == 1 else f" of {jobs} processes"
