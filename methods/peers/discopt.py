"""discopt (J. Kitchin) on the programme of limit analysis: spatial branch and bound over convex relaxations."""

from __future__ import annotations

from typing import Any

import numpy as np

from harness.model.assembly import FloatArray
from harness.model.joint_law import block_diagonal
from methods.peers.answers import Ended, ProgrammePeer, time_left
from methods.peers.programme import CollapseProgramme
from methods.peers.settings import DiscoptSettings


class Discopt(ProgrammePeer):
    """Complementarity as products y_k g_k = 0, relaxed between bounds on both factors (`discopt`)."""

    name, package, extra = "discopt", "discopt", "discopt"

    def ended(self, package: Any, programme: CollapseProgramme, settings: DiscoptSettings) -> Ended | str:
        """Where discopt ends; its clock counts seconds of the wall clock."""
        if not (np.isfinite(programme.greatest) and np.isfinite(programme.greatest_slack).all()):
            return (
                "discopt relaxes products between bounds on both factors, and statics gives the slacks of this wall "
                "none: its self-stress or its multiplier has no end. Take la or scip."
            )
        model = package.Model("limit_analysis")
        _write(model, programme, settings.greatest_rate)
        found = model.solve(
            time_limit=time_left(settings.seconds), gap_tolerance=settings.gap, threads=1, deterministic=True
        )
        values = found.x or {}
        best = found.objective is not None and "slacks" in values
        return Ended(
            str(found.status),
            optimal=found.status == "optimal" and bool(found.gap_certified),
            multiplier=float(found.objective) if best else None,
            slacks=np.maximum(np.asarray(values["slacks"], dtype=float).ravel(), 0.0) if best else None,
            rates=np.maximum(np.asarray(values["rates"], dtype=float).ravel(), 0.0) if best else None,
            bound=None if found.bound is None or not np.isfinite(found.bound) else float(found.bound),
            iterations=int(found.node_count),
        )


def _write(model: Any, programme: CollapseProgramme, greatest_rate: float) -> None:
    """Write the programme into a model of discopt, with the slacks for the forces: s = (y3 - y4) / 2."""
    m, n = programme.assembly.n_interfaces, programme.assembly.n_free
    multiplier = model.continuous("multiplier", lb=0.0, ub=programme.greatest * (1.0 + 1e-6) + 1e-6)
    slacks = model.continuous("slacks", shape=(4 * m,), lb=0.0, ub=programme.greatest_slack)
    rates = model.continuous("rates", shape=(4 * m,), lb=0.0, ub=greatest_rate)
    fastest = programme.greatest_speed(greatest_rate)
    velocities = model.continuous("velocities", shape=(3 * n,), lb=-fastest, ub=fastest)

    def row(*terms: tuple[Any, Any]) -> Any:
        parts = [float(c[k]) * v[int(k)] for c, v in terms for k in np.flatnonzero(c)]
        return sum(parts[1:], parts[0]) if parts else 0.0 * multiplier

    forces = np.zeros((m, 3, 4))
    forces[:, 0, 0] = forces[:, 1, 1] = 1.0
    forces[:, 2, 2], forces[:, 2, 3] = 0.5, -0.5
    equilibrium = programme.kinematic.T.toarray() @ _diagonal(forces)
    for left, live, dead in zip(equilibrium, programme.live, programme.dead, strict=True):
        model.subject_to(row((left, slacks)) + float(live) * multiplier == -float(dead))
    cone = 2.0 * (programme.assembly.law.rows @ forces - np.eye(4))[:, 2:3]  # slacks are those of their forces
    for left in _diagonal(cone):
        model.subject_to(row((left, slacks)) == 0.0)
    for left, right in zip(programme.kinematic.toarray(), -programme.flow.toarray(), strict=True):
        model.subject_to(row((left, velocities), (right, rates)) == 0.0)
    model.subject_to(row((programme.live, velocities)) == float(n))
    own, dead_load, friction = programme.virtual_work
    model.subject_to(row((dead_load, velocities), (friction, rates)) + own * multiplier >= 0.0)
    for k in range(4 * m):
        model.subject_to(slacks[k] * rates[k] == 0.0)
    model.minimize(multiplier)


def _diagonal(parts: FloatArray) -> FloatArray:
    return np.asarray(block_diagonal(parts).toarray())
