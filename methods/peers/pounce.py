"""POUNCE, a port of Ipopt to Rust, on relaxations y.g <= epsilon of the programme of limit analysis in all unknowns.

The sequence of relaxations is that of Ferris and Tin-Loi (2001) and of `la-paper`, which writes it in reduced unknowns.
Complementarity is the only row that is not linear; its derivatives are exact.
"""

from __future__ import annotations

import time
from typing import Any

import numpy as np
import scipy.sparse as sp

from harness.model.assembly import FloatArray, IntArray
from methods.peers.answers import Ended, ProgrammePeer, time_left
from methods.peers.programme import CollapseProgramme
from methods.peers.settings import PounceSettings


class _Functions:
    """The programme as the interface of Ipopt asks for it, in unknowns (lambda, r, u, g).

    Its rows are equilibrium, slacks, compatibility, live work and y.g over the live work.
    """

    def __init__(self, programme: CollapseProgramme) -> None:
        m, n = programme.assembly.n_interfaces, programme.assembly.n_free
        self.slacks, self.live_work = programme.yield_rows, float(n)
        self.forces, self.rates = slice(1, 1 + 3 * m), slice(1 + 3 * m + 3 * n, 1 + 7 * m + 3 * n)
        live = sp.csr_matrix(programme.live[None, :])
        rows: Any = [
            [live.T, programme.kinematic.T, None, None],
            [None, programme.yield_rows, None, None],
            [None, None, programme.kinematic, -programme.flow],
            [None, None, live, None],
        ]
        self.linear: sp.csr_matrix = sp.csr_matrix(sp.bmat(rows))
        self._entries, self._curved = self.linear.tocoo(), self.slacks.tocoo()
        columns = np.arange(self.linear.shape[1])
        self._last = np.append(columns[self.forces], columns[self.rates])

    def objective(self, x: FloatArray) -> float:
        """The multiplier."""
        return float(x[0])

    def gradient(self, x: FloatArray) -> FloatArray:
        """Of the multiplier."""
        return np.append(1.0, np.zeros(len(x) - 1))

    def constraints(self, x: FloatArray) -> FloatArray:
        """Values of all rows."""
        return np.append(self.linear @ x, (self.slacks @ x[self.forces]) @ x[self.rates] / self.live_work)

    def jacobianstructure(self) -> tuple[IntArray, IntArray]:
        """Rows and columns of the entries of the Jacobian."""
        last = np.full(len(self._last), self.linear.shape[0])
        return np.append(self._entries.row, last), np.append(self._entries.col, self._last)

    def jacobian(self, x: FloatArray) -> FloatArray:
        """Entries of the Jacobian."""
        product = np.append(self.slacks.T @ x[self.rates], self.slacks @ x[self.forces]) / self.live_work
        return np.append(self._entries.data, product)

    def hessianstructure(self) -> tuple[IntArray, IntArray]:
        """Rows and columns of the lower triangle of the Hessian: rates by forces."""
        return np.int64(self.rates.start) + self._curved.row, np.int64(self.forces.start) + self._curved.col

    def hessian(self, x: FloatArray, multipliers: FloatArray, factor: float) -> FloatArray:
        """Entries of the Hessian of the Lagrangian."""
        return np.asarray(self._curved.data * multipliers[-1] / self.live_work)


class Pounce(ProgrammePeer):
    """A local optimum of the relaxed programme in all unknowns (`pounce`)."""

    name, package, extra = "pounce", "pounce", "pounce"

    def ended(self, package: Any, programme: CollapseProgramme, settings: PounceSettings) -> Ended | str:
        """Where the last relaxation ends, from the one before; the first begins at small rates and no forces."""
        m, size, functions = programme.assembly.n_interfaces, programme.unknowns, _Functions(programme)
        lower, upper = np.full(size, -np.inf), np.full(size, np.inf)
        lower[0], lower[functions.rates], upper[functions.rates] = 0.0, 0.0, settings.greatest_rate
        point = np.zeros(size)
        point[functions.rates] = 0.1
        least = np.concatenate([-programme.dead, np.zeros(7 * m), [functions.live_work, -np.inf]])
        most = np.concatenate([-programme.dead, np.full(4 * m, np.inf), np.zeros(3 * m), [functions.live_work, 0.0]])
        began, iterations, said = time.perf_counter(), 0, ""
        for epsilon in settings.epsilons:
            left = time_left(settings.seconds - (time.perf_counter() - began))
            if left <= 0.0:
                break
            most[-1] = epsilon
            problem = package.Problem(size, len(least), functions, lower, upper, least, most)
            for option, value in (
                ("print_level", 0),
                ("sb", "yes"),
                ("tol", 1e-9),
                ("max_iter", settings.most_iterations),
                ("max_wall_time", left),
            ):
                problem.add_option(option, value)
            point, info = problem.solve(point)
            point = np.asarray(point, dtype=float)
            iterations, said = iterations + int(info.get("iter_count", 0)), str(info.get("status_msg", ""))
            if not np.isfinite(point).all():
                return Ended(said, iterations=iterations)
        slacks = np.maximum(programme.yield_rows @ point[functions.forces], 0.0)
        return Ended(
            said,
            multiplier=float(point[0]),
            slacks=slacks,
            rates=np.maximum(point[functions.rates], 0.0),
            iterations=iterations,
        )
