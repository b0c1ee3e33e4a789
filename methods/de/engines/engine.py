"""What a hold needs of a rigid-body engine: loads, time steps, velocities, and contact impulses to come back to."""

from __future__ import annotations

from typing import Protocol

from harness.model.assembly import Assembly, FloatArray


class Measured(Protocol):
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


class Engine(Measured, Protocol):
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
        """(n, 3) velocities (ux, uy, omega) of all blocks; zero on fixed blocks.

        Scaled such that the largest entry is the out-of-balance acceleration as a part of gravity, (ux, uy) in unit
        lengths and omega in radians.
        """
        ...

    def unbalance(self, velocity: FloatArray) -> float:
        """Largest out-of-balance force that goes with this velocity field, as a part of the mean dead load of a block.

        Moments count divided by the unit length.
        """
        ...

    def save(self) -> FloatArray:
        """The contact state, to be given to `restore`."""
        ...

    def restore(self, state: FloatArray) -> None:
        """Back to rest with this contact state."""
        ...
