"""What a hold needs of a rigid-body engine: loads, time steps, velocities, and contact impulses to come back to."""

from __future__ import annotations

from typing import Protocol

import numpy as np

from harness.model.assembly import Assembly, FloatArray


def motion_units(assembly: Assembly) -> FloatArray:
    """(3,) the units in which engines compute displacements and velocities (ux, uy, omega) of blocks.

    They are the length scale, twice [length], and a radian: what an engine returns is multiplied by them.
    """
    return np.array([assembly.length_scale, assembly.length_scale, 1.0])


class MeasuredState(Protocol):
    """A wall under a load whose contact forces can be read.

    Attributes:
        assembly: the wall.
        multiplier: of the live load that acts now.
    """

    assembly: Assembly
    multiplier: float

    def contact_forces(self) -> FloatArray:
        """(m, 3) contact forces (n1, n2, s) of the last time step [force], conventions of the assembly."""
        ...


class Engine(MeasuredState, Protocol):
    """A wall at frozen geometry inside a rigid-body engine.

    Attributes:
        relaxation: relaxation time 1 / (1 - damping) in time steps.
        courses: most interfaces between a block and the nearest support.
        steps: time steps made so far.
        interfaces: number of interfaces, the unit of work of a time step.
    """

    relaxation: float
    courses: int
    steps: int
    interfaces: int

    def load(self, multiplier: float) -> None:
        """Put dead + multiplier x live on the blocks from now on."""
        ...

    def advance(self, steps: int) -> None:
        """Make time steps."""
        ...

    def velocity(self) -> FloatArray:
        """(n, 3) velocities (ux, uy, omega) of all blocks [length, length, radian]; zero on fixed blocks.

        Scaled such that the largest of ux, uy and omega x length scale, over the length scale, is the out-of-balance
        acceleration as a part of gravity.
        """
        ...

    def unbalance(self, velocity: FloatArray) -> float:
        """Largest out-of-balance force that goes with velocities, as a part of the mean dead load of a block.

        Moments count divided by the length scale.

        Args:
            velocity: (n, 3) as `velocity` gives it.
        """
        ...

    def save(self) -> FloatArray:
        """The contact state, to be given to `restore`."""
        ...

    def restore(self, state: FloatArray) -> None:
        """Back to rest with this contact state."""
        ...
