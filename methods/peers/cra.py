"""`rbe` and `cra`: rigid-block equilibrium and coupled rigid-block analysis of compas_cra, by bisection.

compas_cra asks whether blocks under their weight have a solution. Here its problem is built from the wall's own joints,
each a rectangle through a wall one length scale thick, and its loads are exchanged for dead + multiplier x live, all in
the plane; the multiplier is bisected between one with a solution and one without.

RBE: equilibrium of compression and friction; the tension that its program allows at a price is taken away. That asks
for the associated maximum. CRA: besides, the blocks must be able to move so little that contacts that press close and
friction opposes slip, within bounds on that motion which belong to the method. Ipopt's "no solution" is no proof.
Source: G. T.-C. Kao, A. Iannuzzo, B. Thomaszewski, S. Coros, T. Van Mele, P. Block, Coupled rigid-block analysis,
Computer-Aided Design 146, 2022, equations 6 and 11.
"""

from __future__ import annotations

import contextlib
import io
from typing import Any

import numpy as np

from harness.model.assembly import Assembly, FloatArray
from harness.model.deadline import Deadline
from harness.model.errors import optional
from methods.peers.bisection import Bisection, Words, prism
from methods.peers.settings import BisectionSettings, CraSettings

_MODULE = "compas_cra.equilibrium"
"""Of compas_cra, which states its problems."""
_NO_PROOF = "that it finds none is no proof of collapse"


class _Solvable:
    """The problem of compas_cra for a wall, solved at one multiplier after another.

    Args:
        assembly: the wall, with one friction coefficient.
        settings: those of `cra`; of `rbe` alone for RBE.
        package: the module of compas_cra that states problems.
    """

    def __init__(self, assembly: Assembly, settings: BisectionSettings, package: Any) -> None:
        self._solve = optional("compas_cra.nlp", "cra", "method cra").solve_nlp
        self.assembly = assembly
        self._length, self._force = assembly.length_scale, assembly.force_scale / assembly.n_free
        self._wall = self._extruded()
        self._coupled = isinstance(settings, CraSettings)
        friction = float(assembly.friction[0])
        with contextlib.redirect_stdout(io.StringIO()):
            if isinstance(settings, CraSettings):
                bounds = {"d_bnd": settings.motion, "eps": settings.overlap}
                self._problem, layout = package.cra_problem(self._wall, mu=friction, **bounds)
            else:
                self._problem, layout = package.rbe_problem(self._wall, mu=friction)
                self._problem.x_u[layout["f"]][1::4] = 0.0
        self._forces_at = layout["f"]
        self._options = self._tolerances() if self._coupled else None
        self.forces: FloatArray | None = None
        self.motion: FloatArray | None = None
        self.said: list[str] = []

    @staticmethod
    def _tolerances() -> dict[str, float | str]:
        """What `cra_solve` of compas_cra 0.8 asks of Ipopt, and for which it has no public name."""
        return {
            "tol": 1e-4,
            "dual_inf_tol": 1e-4,
            "compl_inf_tol": 1e-4,
            "constr_viol_tol": 1e-8,
            "acceptable_tol": 1e-3,
            "acceptable_constr_viol_tol": 1e-6,
            "acceptable_compl_inf_tol": 1e-3,
            "mu_strategy": "adaptive",
            "mu_target": 1e-5,
            "max_iter": 9000,
        }

    @staticmethod
    def refusal(assembly: Assembly) -> str:
        """Why a wall cannot be modelled; empty where it can."""
        return ""

    def _extruded(self) -> Any:
        """The wall as blocks one length scale thick; x, y of the wall are x, z of it."""
        wall = self.assembly
        structures = optional("compas_cra.datastructures", "cra", "method cra")
        block = optional("compas_assembly.datastructures", "cra", "method cra").Block
        frame = optional("compas.geometry", "cra", "method cra").Frame
        result = structures.CRA_Assembly()
        for i, polygon in enumerate(wall.polygons):
            result.add_block(block.from_vertices_and_faces(*prism((polygon - wall.middle) / self._length)), node=i)
            result.graph.node_attribute(i, "is_support", bool(wall.fixed[i]))
        self._joints_of: dict[tuple[int, int], list[int]] = {}
        for p in range(wall.n_interfaces):
            one, two = sorted((int(wall.block_a[p]), int(wall.block_b[p])))
            (x1, y1), (x2, y2) = (((end[p] - wall.middle) / self._length).tolist() for end in (wall.end1, wall.end2))
            points = [[x1, -0.5, y1], [x2, -0.5, y2], [x2, 0.5, y2], [x1, 0.5, y1]]
            across, (tx, ty) = wall.normal[p] * self._way(p), wall.tangent[p].tolist()
            side = float(np.sign(tx * across[1] - ty * across[0]))
            plane = frame([0.5 * (x1 + x2), 0.0, 0.5 * (y1 + y2)], [tx, 0.0, ty], [0.0, side, 0.0])
            result.add_to_interfaces(one, two, float(wall.length[p] / self._length), points, plane)
            self._joints_of.setdefault((one, two), []).append(p)
        return result

    def _way(self, p: int) -> float:
        """1 if block a of an interface comes first in compas_cra, else -1."""
        return 1.0 if self.assembly.block_a[p] < self.assembly.block_b[p] else -1.0

    def _loads(self, multiplier: float) -> FloatArray:
        """(6 n_free,) forces and moments about the points that compas_cra calls the centres of the blocks."""
        wall = self.assembly
        total = wall.dead + multiplier * wall.live
        loads = np.zeros((wall.n_free, 6))
        for k, i in enumerate(wall.free.tolist()):
            x, _, y = self._wall.graph.node_attribute(i, "block").center()
            arm = (wall.centroid[i] - wall.middle) / self._length - np.array([x, y])
            fx, fy, moment = total[i] / np.array([self._force, self._force, self._force * self._length])
            loads[k] = fx, 0.0, fy, 0.0, -(moment + arm[0] * fy - arm[1] * fx), 0.0
        return loads.ravel()

    def at(self, multiplier: float) -> bool:
        """Whether there is a solution; its forces are kept then."""
        Deadline.of_run().ask()
        loads = self._loads(multiplier)
        self._problem.g_l[: len(loads)] = self._problem.g_u[: len(loads)] = -loads
        result = self._solve(self._problem, backend="native", options=self._options)
        self.said.append(f"{multiplier:.6g}: {result.status_message}")
        if result.success:
            self.forces = self._contact_forces(np.asarray(result.x)[self._forces_at])
        return bool(result.success)

    def _contact_forces(self, found: FloatArray) -> FloatArray:
        """(m, 3) contact forces (n1, n2, s) [force] from those of four corners a joint."""
        forces = np.zeros((self.assembly.n_interfaces, 3))
        corners = found.reshape(-1, 4, 3 if self._coupled else 4)
        order = [p for edge in self._wall.graph.edges() for p in self._joints_of[edge]]
        for p, corner in zip(order, corners, strict=True):
            forces[p] = (
                corner[0, 0] + corner[3, 0],
                corner[1, 0] + corner[2, 0],
                self._way(p) * corner[:, -2].sum(),
            )
        return forces * self._force


class RigidBlockEquilibrium(Bisection):
    """Rigid-block equilibrium (`rbe`)."""

    def __init__(self) -> None:
        words = Words("compas_cra", "found an equilibrium without tension", _NO_PROOF)
        super().__init__("rbe", words, _MODULE, "cra", _Solvable)


class CoupledRigidBlockAnalysis(Bisection):
    """Coupled rigid-block analysis (`cra`)."""

    def __init__(self) -> None:
        words = Words("compas_cra", "found coupled forces and motions", _NO_PROOF)
        super().__init__("cra", words, _MODULE, "cra", _Solvable)
