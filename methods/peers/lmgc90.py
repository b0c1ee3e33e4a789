"""`lmgc90`: the non-smooth contact dynamics of LMGC90 through compas_lmgc90, by bisection.

Blocks are convex prisms, one length scale thick, with the law of Signorini and Coulomb in every contact that LMGC90
finds between their faces. The load dead + multiplier x live is put on the wall at once; steps of the theta method
follow it until it is at rest or a block has moved. Gravity, 9.81 in LMGC90, is taken off each block as a force. The
multiplier is bisected between one at which the wall came to rest and one at which it moved; it starts anew each time.
Source: M. Jean, The non-smooth contact dynamics method, Computer Methods in Applied Mechanics and Engineering 177,
1999, sections 3 and 9.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from harness.model.assembly import Assembly, FloatArray, signed_area
from harness.model.deadline import Deadline
from methods.peers.bisection import Bisection, Words, prism
from methods.peers.settings import Lmgc90Settings

_GRAVITY = 9.81
"""Acceleration that LMGC90 puts on every body."""
_PLANE = (0, 2)
"""Coordinates of LMGC90 that are x and y of the wall; the turn from the first to the second is minus its turn."""


class _Followed:
    """A wall under one load after another in LMGC90, each from the wall as drawn.

    Args:
        assembly: the wall, of convex blocks and one friction coefficient.
        settings: of the method.
        package: the module with the solver of compas_lmgc90.

    Attributes:
        said: what came of each multiplier.
        forces: (m, 3) contact forces of the greatest load at rest [force].
        motion: (n, 3) velocities of the least load in motion.
    """

    def __init__(self, assembly: Assembly, settings: Lmgc90Settings, package: Any) -> None:
        self.assembly, self._settings = assembly, settings
        self._solver_of = package.Solver
        self._length, self._force = assembly.length_scale, assembly.force_scale / assembly.n_free
        self._step = settings.time_step / np.sqrt(_GRAVITY)  # lengths are in length scales
        self.said: list[str] = []
        self.forces: FloatArray | None = None
        self.motion: FloatArray | None = None
        self._held, self._moved = -1.0, np.inf

    @staticmethod
    def refusal(assembly: Assembly) -> str:
        """Why a wall cannot be modelled; empty where it can."""
        crooked = next((i for i, polygon in enumerate(assembly.polygons) if not _convex(polygon)), None)
        if crooked is not None:
            return f"LMGC90 takes convex blocks; {assembly.block_ids[crooked]} is none"
        return ""

    def _built(self, multiplier: float) -> Any:
        """The wall in LMGC90 under a load, ready to step."""
        wall = self.assembly
        solver = self._solver_of(dt=self._step, theta=self._settings.theta)
        sizes = np.empty(wall.n_blocks)
        for i, polygon in enumerate(wall.polygons):
            corners = (polygon - wall.middle) / self._length
            sizes[i] = signed_area(corners)
            corners = corners if sizes[i] > 0.0 else corners[::-1]
            vertices, faces = prism(corners)
            # A mean dead load of a block weighs as much as a block does, so that all move alike.
            solver.geometry_from_v_f({"vertices": vertices, "faces": faces}, density=1.0)
        mass = np.abs(sizes)
        unit = _GRAVITY * float(mass[wall.free].mean()) / self._force
        loads = (wall.dead + multiplier * wall.live) * unit
        for i in range(wall.n_blocks):
            if wall.fixed[i]:
                for name in ("Vx", "Vy", "Vz", "Rx", "Ry", "Rz"):
                    solver.apply_velocity(i, name, 0.0)
                continue
            solver.apply_force(i, "Fx", float(loads[i, 0]))
            solver.apply_force(i, "Fz", float(loads[i, 1] + mass[i] * _GRAVITY))
            solver.apply_force(i, "My", float(-loads[i, 2] / self._length))
        solver.contact_law("IQS_CLB", float(wall.friction[0]), alert=self._settings.alert)
        solver.preprocess()
        self._unit = unit
        return solver

    def at(self, multiplier: float) -> bool:
        """Whether the wall comes to rest; forces at rest and motion are kept."""
        settings, deadline = self._settings, Deadline.of_run()
        solver = self._built(multiplier)
        try:
            start = before = np.array(solver.init_coor, dtype=float)
            frames, rest, moved = solver.init_frame, 0, 0.0
            for step in range(settings.most_steps):
                deadline.ask()
                state = solver.lmgc90.compute_one_step()
                places = np.array(state.bodies, dtype=float)
                moved = float(np.abs(places - start).max())
                speed = float(np.abs(places - before).max()) / self._step**2 / _GRAVITY
                if moved > settings.moved:
                    self.said.append(f"{multiplier:.6g}: moved by {moved:.1e} in {step} steps")
                    if multiplier < self._moved:
                        self._moved, self.motion = multiplier, self._turned(before, places, frames, state.body_frames)
                    return False
                rest = rest + 1 if speed <= settings.at_rest else 0
                if rest >= settings.rest_steps:
                    self.said.append(f"{multiplier:.6g}: at rest after {step} steps, moved by {moved:.1e}")
                    if multiplier > self._held:
                        self._held, self.forces = multiplier, self._contact_forces(state)
                    return True
                before, frames = places, state.body_frames
            self.said.append(f"{multiplier:.6g}: not at rest in {settings.most_steps} steps, moved by {moved:.1e}")
            return False
        finally:
            solver.finalize()

    def _turned(self, before: FloatArray, places: FloatArray, old: Any, new: Any) -> FloatArray:
        """(n, 3) motion of the blocks in the last step, at any scale."""
        found = np.zeros((self.assembly.n_blocks, 3))
        found[:, :2] = (places - before)[:, _PLANE] * self._length
        for i, (was, now) in enumerate(zip(old, new, strict=True)):
            turn = np.reshape(now, (3, 3)).T @ np.reshape(was, (3, 3))
            found[i, 2] = turn[_PLANE[1], _PLANE[0]]
        found[self.assembly.fixed] = 0.0
        return found

    def _contact_forces(self, state: Any) -> FloatArray:
        """(m, 3) contact forces (n1, n2, s) [force]: those of the contact points nearest to each joint."""
        wall = self.assembly
        forces = np.zeros((wall.n_interfaces, 3))
        one = (wall.end1 - wall.middle) / self._length
        along = wall.length / self._length
        pairs: dict[frozenset[int], list[int]] = {}
        for p in range(wall.n_interfaces):
            pairs.setdefault(frozenset((int(wall.block_a[p]), int(wall.block_b[p]))), []).append(p)
        for bodies, point, force, local in zip(
            state.interaction_bodies,
            state.interaction_coords,
            state.interaction_force_global,
            state.interaction_rloc,
            strict=True,
        ):
            pressed = np.array(force)[list(_PLANE)]
            if not pressed.any():
                continue
            joints = pairs.get(frozenset(int(number) - 1 for number in bodies), [])
            at = np.array(point)[list(_PLANE)]
            if not joints:
                continue
            p = min(joints, key=lambda k: abs(float((at - one[k]) @ wall.normal[k])))
            if pressed @ wall.normal[p] * np.sign(local[1]) < 0.0:
                pressed = -pressed  # on b, which compression pushes along the normal
            share = float((at - one[p]) @ wall.tangent[p]) / along[p]
            across = float(pressed @ wall.normal[p])
            forces[p] += np.array([(1.0 - share) * across, share * across, pressed @ wall.tangent[p]])
        return forces / self._unit


def _convex(polygon: FloatArray) -> bool:
    """Whether a polygon turns one way only, to rounding."""
    edges = np.roll(polygon, -1, axis=0) - polygon
    turns = edges[:, 0] * np.roll(edges[:, 1], -1) - edges[:, 1] * np.roll(edges[:, 0], -1)
    slack = 1e-12 * float((edges**2).sum())
    return bool((turns >= -slack).all() or (turns <= slack).all())


class ContactDynamics(Bisection):
    """Bisection between rest and motion in LMGC90 (`lmgc90`)."""

    def __init__(self) -> None:
        words = Words("LMGC90", "came to rest", "a motion that was followed is no proof of collapse")
        super().__init__("lmgc90", words, "compas_lmgc90.solver", "lmgc90", _Followed)
