"""The certificate of a wall by the tree of `methods/la/certify/proof.py`, whose leaves `methods/proof/tree` proves."""

from __future__ import annotations

import math
import time
from typing import Any

from harness.model.assembly import Assembly, FloatArray
from methods.la.certify.proof import prove
from methods.la.core.newton_matrix import NewtonMatrix
from methods.la.core.problem import make_problem
from methods.la.core.state import CollapseState
from methods.la.sources.search import Search
from methods.proof.tree.certificate import tree_certificate


def certificate(
    assembly: Assembly, nodes: int = 1500, seconds: float = math.inf, mechanism: FloatArray | None = None
) -> dict[str, Any] | None:
    """The certificate of a wall of one component, which stands under its dead load; None where none was found.

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
    return tree_certificate(assembly, problem.unit_force, proof.state.moving, proof.leaves, end)


def _state_of(search: Search, mechanism: FloatArray) -> CollapseState | None:
    velocities = search.problem.from_mechanism(mechanism)
    return search.state_of(velocities, search.problem.rates_of_velocities(velocities, False))
