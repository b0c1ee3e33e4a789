"""The associated maximum: the greatest multiplier in equilibrium within yield, by SciPy's linear programming.

Source: Livesley (1978). The dual solution of the programme is the mechanism.
"""

from typing import Any

import numpy as np
import scipy.sparse as sp
from scipy.optimize import linprog

from harness.model.assembly import Assembly, FloatArray
from harness.model.method import Answer, Finding, Method, Settings, Status, Traits


class CLASS(Method):
    """The greatest multiplier in equilibrium within yield, with proofs of falls and of loads without limit."""

    name = "NAME"
    family = "NAME"
    title = "associated maximum by linprog"
    tolerance = 1e-7  # the largest relative residual the judge may find
    traits = Traits(caption="associated maximum", bounds_above=True)

    def solve(self, assembly: Assembly, settings: Settings) -> Answer:
        """The dead load first, then the greatest live load upon it."""
        dead, live = assembly.free_loads()
        nothing = np.zeros_like(dead)
        share, standing, fall = greatest(assembly, nothing, dead, most=1.0)
        if share < 1.0 - 1e-9:
            sentence = f"The joints balance {share:.3g} of the dead load."
            return Answer(Status.OK, Finding.FALLS, sentence, mechanism=fall, flow="associated")
        if not assembly.has_live_load:
            return Answer(Status.OK, Finding.STANDS, "Forces within yield balance the dead load.", forces=standing)
        unit = assembly.load_unit  # the multiplier at which the live load is as large as the dead load
        share, borne, _ = greatest(assembly, nothing, unit * live, most=1.0)
        if share > 1.0 - 1e-9:
            details = {"live_forces": (borne / unit).tolist()}
            sentence = "The joints bear any multiple of the live load."
            return Answer(Status.OK, Finding.UNBOUNDED, sentence, forces=standing, details=details)
        most, forces, mechanism = greatest(assembly, dead, unit * live)
        return Answer(
            Status.OK,
            Finding.COLLAPSES,
            f"No equilibrium within yield above {most * unit:.6g}.",
            multiplier=most * unit,
            forces=forces,
            mechanism=mechanism,
            flow="associated",
        )


def greatest(
    assembly: Assembly, constant: FloatArray, growing: FloatArray, most: float | None = None
) -> tuple[float, FloatArray, FloatArray]:
    """The greatest factor, up to `most`, of a load upon a constant one; its forces (m, 3) and its mechanism (n, 3)."""
    m, size, weight = assembly.n_interfaces, assembly.length_scale, assembly.force_scale
    scale = np.tile([1.0, 1.0, 1.0 / size], assembly.n_free)  # moments as forces, so that rows have one size
    load = sp.csr_matrix((scale * growing / weight)[:, None])
    balance: Any = sp.csr_matrix(sp.hstack([sp.diags(scale) @ assembly.kinematic_matrix.T, load]))
    n1, n2, s = (sp.csr_matrix((np.ones(m), (range(m), range(k, 3 * m, 3))), (m, 3 * m)) for k in range(3))
    friction = sp.diags(assembly.friction) @ (n1 + n2)
    slacks = sp.vstack([-n1, -n2, -friction - s, -friction + s])
    within: Any = sp.csr_matrix(sp.hstack([slacks, sp.csr_matrix((4 * m, 1))]))
    found: Any = linprog(
        np.append(np.zeros(3 * m), -1.0),
        within,
        np.zeros(4 * m),
        balance,
        -scale * constant / weight,
        bounds=[(None, None)] * (3 * m) + [(0.0, most)],
        options={"primal_feasibility_tolerance": 1e-10, "dual_feasibility_tolerance": 1e-10},
    )
    if found.status != 0:
        raise ArithmeticError(f"linprog: {found.message}")
    mechanism = np.zeros((assembly.n_blocks, 3))
    mechanism[assembly.free] = -(scale * found.eqlin.marginals).reshape(-1, 3)
    return float(found.x[-1]), weight * found.x[:-1].reshape(-1, 3), mechanism
