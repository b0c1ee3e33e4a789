"""SCIP (Bolusani et al. 2024, "The SCIP Optimization Suite 9.0") on the programme of limit analysis."""

from __future__ import annotations

from typing import Any

import numpy as np
import scipy.sparse as sp

from harness.model.deadline import best_so_far
from methods.peers.answers import Ended, ProgrammePeer, time_left
from methods.peers.programme import CollapseProgramme
from methods.peers.settings import ScipSettings


class Scip(ProgrammePeer):
    """Complementarity as special ordered sets of type 1, which need no bounds on slacks and rates (`scip`)."""

    name, package, extra = "scip", "pyscipopt", "scip"

    def ended(self, package: Any, programme: CollapseProgramme, settings: ScipSettings) -> Ended | str:
        """Where SCIP ends; its clock is set to that of the wall, like that of the run."""
        model = package.Model()
        model.hideOutput()
        model.setParam("timing/clocktype", 2)
        model.setParam("randomization/randomseedshift", settings.seed)
        multiplier, slacks, rates = _programme(package, model, programme, settings.virtual_work)
        model.setParam("limits/time", time_left(settings.seconds))
        best_so_far(model.optimize, lambda: None)
        said, best = str(model.getStatus()), model.getNSols() > 0
        bound = float(model.getDualbound())
        return Ended(
            said,
            optimal=said == "optimal",
            multiplier=float(model.getVal(multiplier)) if best else None,
            slacks=np.maximum([model.getVal(each) for each in slacks], 0.0) if best else None,
            rates=np.maximum([model.getVal(each) for each in rates], 0.0) if best else None,
            bound=bound if abs(bound) < model.infinity() else None,
            iterations=int(model.getNTotalNodes()),
        )


def _programme(
    package: Any, model: Any, programme: CollapseProgramme, virtual_work: bool
) -> tuple[Any, list[Any], list[Any]]:
    """Write the programme into a model of SCIP: the multiplier, the slacks (4m,) and the rates (4m,)."""
    m, n = programme.assembly.n_interfaces, programme.assembly.n_free
    greatest = programme.greatest * (1.0 + 1e-6) + 1e-6  # statics bears no more; to the rounding of that programme
    multiplier = model.addVar(lb=0.0, ub=greatest if np.isfinite(greatest) else None, obj=1.0)
    forces = [model.addVar(lb=None) for _ in range(3 * m)]
    slacks, rates = ([model.addVar(lb=0.0) for _ in range(4 * m)] for _ in range(2))
    velocities = [model.addVar(lb=None) for _ in range(3 * n)]

    def rows(matrix: sp.csr_matrix, unknowns: list[Any]) -> list[Any]:
        ends = zip(matrix.indptr[:-1], matrix.indptr[1:], strict=True)
        return [
            package.quicksum(float(matrix.data[k]) * unknowns[matrix.indices[k]] for k in range(first, last))
            for first, last in ends
        ]

    for left, dead in zip(rows(programme.statics, [*forces, multiplier]), programme.dead, strict=True):
        model.addCons(left == -float(dead))
    for left, right in zip(rows(programme.yield_rows, forces), slacks, strict=True):
        model.addCons(left == right)
    pairs = zip(rows(programme.kinematic, velocities), rows(programme.flow, rates), strict=True)
    for left, right in pairs:
        model.addCons(left == right)
    model.addCons(package.quicksum(float(f) * u for f, u in zip(programme.live, velocities, strict=True)) == float(n))
    if virtual_work:
        own, dead_load, friction = programme.virtual_work
        work = [float(f) * u for f, u in zip([*dead_load, *friction], [*velocities, *rates], strict=True) if f]
        model.addCons(own * multiplier + package.quicksum(work) >= 0.0)
    for slack, rate in zip(slacks, rates, strict=True):
        model.addConsSOS1([slack, rate])
    return multiplier, slacks, rates
