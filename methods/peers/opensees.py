"""`opensees`: rigid blocks on the zero-length contact elements of OpenSees, loaded until its path converges no more.

Each free block is a node with three degrees of freedom; each contact point is a pair of nodes tied to their blocks by
rigid links, with a `zeroLengthContactASDimplex` element between them in its implicit form: a penalty across and along,
and Coulomb friction without dilatancy. A point that opens within a load step keeps the shear that it had before, so
that steps must be small. (`zeroLengthContact2D` loses the balance of forces where points slide.) Displacements are
small: the geometry stays as drawn. Lengths are in length scales of the wall and forces in mean dead loads of a block.
Source: F. McKenna, OpenSees: a framework for earthquake engineering simulation, 2011; the elements: its documentation.

What it says is where Newton's method stopped to converge, no proof that no equilibrium lies above. Then weak springs
to the ground are put on the blocks, and the load a little higher: what moves is the mechanism.
"""

from __future__ import annotations

import os
from typing import Any

import numpy as np

from harness.model.assembly import Assembly, FloatArray
from harness.model.deadline import Deadline, best_so_far
from harness.model.errors import MissingPackage, optional
from harness.model.method import Answer, Finding, Solver, Status
from methods.numerics.claims import analysed
from methods.peers.settings import OpenSeesSettings

_TOLERANCE = 1e-9
"""Of the forces out of balance, in mean dead loads of a block."""
_MOST_DEAD = 20_000
"""Iterations for the dead load."""
_MOST = 60
"""Iterations of a load step."""
_SPRINGS = 1e-9
"""Stiffness to the ground with which the mechanism is found, as a part of that of the joints: too weak to carry what
the judge would see."""
_EXCESS = 1e-6
"""Of the load with which the mechanism is found, as a part of the multiplier."""

_CONTACT = "zeroLengthContactASDimplex"


class _ContactModel:
    """A wall in the one domain that OpenSees has in a process.

    Args:
        assembly: the wall.
        settings: stiffness of the joints.
    """

    def __init__(self, assembly: Assembly, settings: OpenSeesSettings) -> None:
        self._ops = ops = _load_opensees()
        self._stiffness = settings.stiffness
        self.assembly, self._free = assembly, assembly.free.tolist()
        length, force = assembly.length_scale, assembly.force_scale / assembly.n_free
        self._length, self._force = length, force
        self._units = np.array([force, force, force * length])
        self._last = 0
        ops.wipe()
        ops.logFile(os.devnull, "-noEcho")
        ops.model("basic", "-ndm", 2, "-ndf", 3)
        self._node_of = {i: self._add_node(assembly.centroid[i]) for i in self._free}
        for p in range(assembly.n_interfaces):
            self._add_joint(p, settings)
        for tag in (1, 2):
            ops.timeSeries("Linear", tag)
        ops.constraints("Transformation")
        ops.numberer("RCM")
        ops.system("UmfPack")
        ops.test("NormUnbalance", _TOLERANCE, _MOST_DEAD, 0)
        ops.algorithm("Newton", "-initial")
        ops.integrator("LoadControl", 0.0)
        ops.analysis("Static")

    def _add_node(self, place: FloatArray) -> int:
        self._last += 1
        self._ops.node(self._last, *(float(x) for x in (place - self.assembly.middle) / self._length))
        return self._last

    def _add_joint(self, p: int, settings: OpenSeesSettings) -> None:
        wall, ops = self.assembly, self._ops
        stiffness = 0.5 * settings.stiffness * float(wall.length[p]) / self._length
        for k, end in enumerate((wall.end1[p], wall.end2[p])):
            nodes = []
            for block in (int(wall.block_a[p]), int(wall.block_b[p])):
                nodes.append(self._add_node(end))
                if block in self._node_of:
                    ops.rigidLink("beam", self._node_of[block], nodes[-1])
                else:
                    ops.fix(nodes[-1], 1, 1, 1)
            across = (stiffness, settings.shear_ratio * stiffness, float(wall.friction[p]))
            normal = (float(wall.normal[p, 0]), float(wall.normal[p, 1]), 0.0)
            ops.element(_CONTACT, 2 * p + k + 1, *nodes, *across, "-orient", *normal, "-intType", 0)

    def _pattern(self, tag: int, loads: FloatArray) -> None:
        self._ops.pattern("Plain", tag, tag)
        for i in self._free:
            self._ops.load(self._node_of[i], *(float(x) for x in loads[i] / self._units))

    def stands_dead_load(self) -> bool:
        """Put the dead load on at once; whether that converged.

        With the stiffness of closed joints, which does not jump between open and closed points as Newton's method does.
        """
        self._pattern(1, self.assembly.dead)
        if not self.converges(1.0):
            return False
        self._ops.loadConst("-time", 0.0)
        self._ops.algorithm("Newton")
        self._ops.test("NormUnbalance", _TOLERANCE, _MOST, 0)
        self._pattern(2, self.assembly.live)
        return True

    def converges(self, step: float) -> bool:
        """Whether the load can be raised by a step; if not, everything is as before."""
        Deadline.of_run().ask()
        self._ops.integrator("LoadControl", step)
        return bool(self._ops.analyze(1) == 0)

    @property
    def multiplier(self) -> float:
        """Of the live load, at the last step that converged."""
        return float(self._ops.getTime())

    def displacements(self) -> FloatArray:
        """(n, 3) displacements of the blocks (ux, uy, omega) [length, length, radian]."""
        result = np.zeros((self.assembly.n_blocks, 3))
        for i in self._free:
            result[i] = self._ops.nodeDisp(self._node_of[i])
        result[:, :2] *= self._length
        return result

    def contact_forces(self) -> FloatArray:
        """(m, 3) contact forces (n1, n2, s) [force], from those with which elements resist at the node of block a."""
        wall = self.assembly
        forces = np.zeros((wall.n_interfaces, 3))
        for p in range(wall.n_interfaces):
            for k in range(2):
                on_b = np.array(self._ops.eleForce(2 * p + k + 1)[:2])
                forces[p, k] = on_b @ wall.normal[p]
                forces[p, 2] += on_b @ wall.tangent[p]
        return forces * self._force

    def add_springs(self) -> None:
        """Put weak springs between the blocks and the ground."""
        ops = self._ops
        ops.uniaxialMaterial("Elastic", 1, _SPRINGS * self._stiffness)
        for i in self._free:
            ground = self._add_node(self.assembly.centroid[i])
            ops.fix(ground, 1, 1, 1)
            tag = 2 * self.assembly.n_interfaces + i + 1
            ops.element("zeroLength", tag, ground, self._node_of[i], "-mat", 1, 1, 1, "-dir", 1, 2, 6)


def _load_opensees() -> Any:
    """The package openseespy.

    Raises:
        InputError: it is not installed, or a library that it needs is not.
    """
    try:
        return optional("openseespy.opensees", "opensees", "method opensees")
    except RuntimeError as error:  # what openseespy says where it cannot load a library
        raise MissingPackage(
            "openseespy is installed, but a library that it needs is not", "Install BLAS (Debian: libblas3)", "opensees"
        ) from error


class OpenSeesContacts(Solver):
    """Load control in OpenSees to the last step that converges."""

    def solve(self, assembly: Assembly, settings: OpenSeesSettings) -> Answer:
        """The last load that converged, with its forces and what moves above it.

        Raises:
            InputError: openseespy is not installed.
        """
        _load_opensees()
        return analysed(assembly, lambda part: self._of_component(part, settings))

    def _of_component(self, assembly: Assembly, settings: OpenSeesSettings) -> Answer:
        if assembly.n_free == 0:
            return Answer(Status.OK, Finding.STANDS, "every block is fixed: nothing can move")
        model = _ContactModel(assembly, settings)
        if not model.stands_dead_load():
            sentence = "OpenSees does not converge under the dead load, which does not show that the wall falls"
            return Answer(Status.NOT_CONVERGED, Finding.NONE, sentence)
        if not assembly.has_live_load:
            answer = Answer(Status.OK, Finding.STANDS, "OpenSees converges under the dead load; no live load is given")
            answer.forces, answer.forces_multiplier = model.contact_forces(), 0.0
            return answer
        unit = assembly.load_unit
        path: dict[str, list[float]] = {"multiplier": [0.0], "live_displacement": [0.0]}
        start = model.displacements()

        def loaded() -> bool:
            """Whether the path ended by itself, below the cap."""
            step = settings.load_step * unit
            while step > settings.least_step * unit:
                if not model.converges(step):
                    step *= 0.5
                    continue
                path["multiplier"].append(model.multiplier)
                path["live_displacement"].append(float(np.sum(assembly.live * (model.displacements() - start))))
                if model.multiplier > settings.load_cap * unit:
                    return False
            return True

        ended = best_so_far(loaded, lambda: None)
        return self._concluded(model, settings, path, ended)

    def _concluded(
        self, model: _ContactModel, settings: OpenSeesSettings, path: dict[str, list[float]], ended: bool | None
    ) -> Answer:
        reached = model.multiplier
        forces = model.contact_forces()
        if ended is None or not ended:
            why = "the time ended" if ended is None else "larger loads were not tried"
            answer = Answer(
                Status.NOT_CONVERGED, Finding.NONE, f"OpenSees converged up to multiplier {reached:.6g}; {why}"
            )
            return _with(answer, forces, reached, path)
        answer = Answer(
            Status.OK,
            Finding.COLLAPSES,
            f"the load path of OpenSees converged up to multiplier {reached:.6g} and not a step of "
            f"{settings.least_step:g} of the dead load further, which is not a proof of collapse",
            multiplier=reached,
        )
        before = model.displacements()
        model.add_springs()
        if model.converges(0.0) and model.converges(_EXCESS * reached):
            forces, reached = model.contact_forces(), model.multiplier
            moved = model.displacements() - before
            answer.mechanism = moved / (float(np.abs(moved).max()) or 1.0)
        else:
            answer.sentence += "; nor did it converge with weak springs, so that no mechanism is known"
        return _with(answer, forces, reached, path)


def _with(answer: Answer, forces: FloatArray, multiplier: float, path: dict[str, list[float]]) -> Answer:
    answer.forces, answer.forces_multiplier = forces, multiplier
    answer.path, answer.iterations = path, len(path["multiplier"])
    return answer
