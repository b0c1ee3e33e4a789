"""Gap springs in a wall that has gaps, loaded from rest to rest at large displacements.

Where blocks are uneven, most faces touch at one point or not at all under the dead load, and close as the live load
grows. The springs of finite elements (`methods.springs`) take the gaps as they are. Every rest is found at small
displacements; then the blocks are moved, the gaps measured again, and so on until nothing moves any more, with the
shears of the contacts kept. So blocks that lean add to the load, and gaps close.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from harness.model.assembly import Assembly, FloatArray
from harness.model.displaced import DisplacedState
from methods.de.engines.edges import FacingEdges
from methods.de.engines.engine import motion_units
from methods.de.engines.pymunk_blocks import BodyTuning
from methods.de.holds.motion import by_travel
from methods.springs.model.factor import make_factor
from methods.springs.model.points import GapSettings
from methods.springs.model.wall_model import WallModel, build_model
from methods.springs.rest.newton import Equilibrium, newton
from methods.springs.rest.pseudo_transient import PseudoTransient

_CLOSED = 3.0
"""Opening, in radii of the blocks in the engine, up to which a gap counts as closed at first: it keeps blocks so far
apart."""
_STILL = 2e-4
"""Displacement, in length scales, below which the blocks are not moved again."""
_STRIDE = 0.02
"""Displacement, in length scales, by which a wall without rest is moved on at a time."""
_MOVES = 30
"""Times that the blocks are moved under one load, at most."""
_NEWTON_STEPS = 600
"""Of one motion to rest, at most."""


@dataclass(frozen=True)
class GappedTuning:
    """Springs in a wall that has gaps, and how its blocks are moved on.

    Attributes:
        stiffness: kn of a gap point in mean dead loads of a block over the length scale: springs give far less than
            gaps are wide.
        radius: of the blocks in the engine, in length scales.
    """

    stiffness: float = 1e4
    radius: float = BodyTuning().radius


@dataclass(frozen=True, eq=False)
class _GappedRest:
    """A rest of the wall.

    Attributes:
        places: (n, 3) where equilibrium was found; moved: (n, 3) a little farther on, where the blocks are then.
        structure: the wall with its contacts where equilibrium was found.
        pressed, shear: (2m,) compression and shear of its contact points, the shear against a slip along the tangent
            [mean dead load of a block].
    """

    places: FloatArray
    moved: FloatArray
    structure: Assembly
    pressed: FloatArray
    shear: FloatArray


class GappedWall:
    """A wall of blocks with given outlines, at rest somewhere, with springs in its contacts.

    Attributes:
        assembly: the wall of even blocks.
        rest: the last rest.
        moved: multipliers at which it is shown to move.
    """

    def __init__(
        self,
        assembly: Assembly,
        outlines: tuple[FloatArray, ...],
        places: FloatArray,
        reach: float,
        options: GappedTuning = GappedTuning(),
    ) -> None:
        """The wall where an engine left it.

        Args:
            assembly: the wall of even blocks.
            outlines: (n,) outlines of the uneven ones.
            places: (n, 3) where they are at rest under the dead load.
            reach: a wall whose blocks move by so many length scales under one load falls.
            options: of its springs, and how its blocks are moved on.
        """
        self._options = options
        self.assembly, self._edges, self._reach = assembly, FacingEdges.of(assembly, outlines), reach
        self._first = places
        self.moved: list[float] = []
        structure, openings = self._edges.at(places)
        self._shift = np.where(openings < _CLOSED * options.radius * assembly.length_scale, -openings, 0.0)
        none = np.zeros(2 * assembly.n_interfaces)
        self.rest = _GappedRest(places, places, structure, none, none)

    @property
    def drift(self) -> float:
        """Largest displacement of a block since the engine left it, in length scales."""
        return float(np.abs(self.rest.moved - self._first)[:, :2].max(initial=0.0)) / self.assembly.length_scale

    def rests(self, multiplier: float) -> bool:
        """Whether the wall comes to rest at a multiplier; if not it stays where it rested last."""
        unit, units, before = self.assembly.length_scale, motion_units(self.assembly), self.rest.moved
        places, shear, rest = before, self.rest.shear, None
        for _ in range(_MOVES):
            structure, openings = self._edges.at(places)
            model = self._model(structure, openings, shear)
            found = _at_rest(model, multiplier, _NEWTON_STEPS)
            step = model.block_displacements(found.u)
            size = float(np.abs(step / units).max(initial=0.0))
            if found.found:
                pressed, shear = model.forces(found.u, found.history, found.state)
                rest = _GappedRest(places, places + step, structure, pressed, shear)
            elif np.isfinite(size):
                rest, step = None, step * min(1.0, _STRIDE / max(size, _STILL))
            places = places + step
            if not np.abs(places - before)[:, :2].max(initial=0.0) < self._reach * unit:
                load = self.assembly.dead + multiplier * self.assembly.live
                if by_travel(self.assembly, load, places - before, self._reach) is not None:
                    self.moved.append(multiplier)
                return False
            if rest is not None and size < _STILL:
                break
        if rest is not None:
            self.rest = rest
        return rest is not None

    def state(self) -> DisplacedState:
        """The contacts and their forces at the last rest."""
        rest, wall = self.rest, self.rest.structure
        normal, tangent = np.repeat(wall.normal, 2, axis=0), np.repeat(wall.tangent, 2, axis=0)
        force = rest.pressed[:, None] * normal - rest.shear[:, None] * tangent
        return DisplacedState(
            places=rest.places,
            interface=np.repeat(np.arange(wall.n_interfaces), 2),
            onto=np.repeat(wall.block_b, 2),
            point=np.stack([wall.end1, wall.end2], axis=1).reshape(-1, 2),
            normal=normal,
            force=self.assembly.force_scale / self.assembly.n_free * force,
        )

    def _model(self, structure: Assembly, openings: FloatArray, shear: FloatArray) -> WallModel:
        """The springs with these openings (m, 2) and shears (2m,)."""
        mean = self.assembly.force_scale / self.assembly.n_free
        model = build_model(
            structure, GapSettings(normal_stiffness=self._options.stiffness * mean / self.assembly.length_scale)
        )
        opening = (openings + self._shift).ravel() / model.displacement
        return replace(model, initial_opening=opening, history=shear)


def _at_rest(model: WallModel, multiplier: float, steps: int) -> Equilibrium:
    """The equilibrium near no displacement, by Newton, or by pseudo-transient relaxation that freezes shears in."""
    factor, still = make_factor(model), np.zeros(model.n_unknowns)
    found = newton(model, factor, still, multiplier, model.history)
    if found.found:
        return found
    return PseudoTransient(model, factor, replace(found, u=still), True).move(multiplier, steps)
