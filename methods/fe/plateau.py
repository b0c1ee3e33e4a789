"""The finish: forces and mechanism of the plateau, and their check as an exact collapse state.

In the last cell the tangent K is singular with null vector v. The fastest displacement k of v is held and the
multiplier takes its place among the unknowns: K with column k replaced by -live is regular, and solves both for the
state on the plateau (residual on the right) and for the mechanism (minus column k of K on the right, v_k = 1).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp
from scipy.sparse.linalg import splu

from harness.model.assembly import Assembly, FloatArray
from methods.fe.continuation import Tracer
from methods.fe.factor import SingularTangent
from methods.fe.gap_law import equivalent_end_forces


@dataclass(frozen=True)
class CollapseState:
    """A pair of forces and mechanism at one multiplier.

    Attributes:
        multiplier: of the live load; work_multiplier: the same from the virtual work of the mechanism.
        forces: (m, 3) end forces [force]; mechanism: (n, 3) block velocities, live power 1.
        residuals: relative defects by name: equilibrium, yield, dilatancy, complementarity, work.
    """

    multiplier: float
    work_multiplier: float
    forces: FloatArray
    mechanism: FloatArray
    residuals: dict[str, float]

    @property
    def worst(self) -> float:
        """Largest of the residuals."""
        return max(self.residuals.values())


def finish(tracer: Tracer) -> CollapseState:
    """The collapse state of a tracer that has come to a plateau. Raises SingularTangent when it is not unique."""
    model = tracer.model
    u, multiplier = tracer.u, tracer.multiplier
    velocity = tracer.along()
    fastest = int(np.argmax(np.abs(velocity)))
    tangent = model.tangent(tracer.state)
    column = tangent[:, [fastest]].toarray().ravel()
    try:
        factor = splu(_with_column(tangent, fastest, -model.live))
    except RuntimeError as error:
        raise SingularTangent("the plateau is not unique: more than one mechanism moves at once") from error
    for _ in range(4):
        answer = factor.solve(model.residual(u, multiplier, tracer.history, tracer.state))
        multiplier += answer[fastest]
        answer[fastest] = 0.0
        u = u + answer
    mechanism = factor.solve(-column)
    mechanism[fastest] = 1.0
    mechanism *= np.sign(velocity[fastest])
    mechanism /= abs(float(model.live @ mechanism)) or 1.0
    normal, shear = model.forces(u, tracer.history, tracer.state)
    assembly = model.assembly
    forces = model.force * equivalent_end_forces(model.position, model.interface, normal, shear, assembly.n_interfaces)
    field = model.block_displacements(mechanism)
    return check(assembly, multiplier, forces, field)


def _with_column(matrix: sp.csc_matrix, k: int, column: FloatArray) -> sp.csc_matrix:
    """The matrix with its column k replaced."""
    filled = np.flatnonzero(column)
    single = sp.csc_matrix((column[filled], (filled, np.full(len(filled), k))), shape=matrix.shape)
    keep = np.ones(matrix.shape[1])
    keep[k] = 0.0
    return (matrix @ sp.diags(keep) + single).tocsc()


def check(assembly: Assembly, multiplier: float, forces: FloatArray, mechanism: FloatArray) -> CollapseState:
    """Measure how exactly forces and mechanism form a non-associated collapse state (zero dilatancy).

    Args:
        multiplier: of the live load; forces: (m, 3) end forces [force]; mechanism: (n, 3) block velocities.
    """
    matrix = assembly.kinematic_matrix
    dead, live = assembly.free_loads()
    velocity = mechanism[assembly.free].ravel()
    scale = assembly.force_scale / assembly.n_free
    lengths = np.tile([1.0, 1.0, assembly.length_scale], assembly.n_free)
    balance = (matrix.T @ forces.ravel() + dead + multiplier * live) / lengths
    rates = (matrix @ velocity).reshape(-1, 3)
    speed = float(np.abs(velocity * lengths).max()) or 1.0
    total = forces[:, 0] + forces[:, 1]
    slack = assembly.friction * total - np.abs(forces[:, 2])
    power = float(live @ velocity)
    residuals = {
        "equilibrium": float(np.abs(balance).max()) / scale,
        "yield": max(0.0, -float(forces[:, :2].min()), -float(slack.min())) / scale,
        "dilatancy": max(0.0, -float(rates[:, :2].min())) / speed,
        "complementarity": max(
            float(np.abs(forces[:, :2] * rates[:, :2]).max()), float(np.abs(slack * rates[:, 2]).max())
        )
        / (scale * speed),
        "direction": max(0.0, float((forces[:, 2] * rates[:, 2]).max())) / (scale * speed),
    }
    # power of the contact forces is friction only: n . opening = 0, s slip = -mu (n1 + n2) |slip|
    friction_work = float(np.sum(assembly.friction * total * np.abs(rates[:, 2])))
    work = (friction_work - float(dead @ velocity)) / power if power else float("inf")
    residuals["work"] = abs(work - multiplier) / max(1.0, abs(multiplier)) if power > 0.0 else 1.0
    return CollapseState(multiplier, work, forces, mechanism, residuals)
