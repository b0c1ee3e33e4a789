"""What a hold needs of a rigid-body engine: loads, time steps, velocities, and contact impulses to come back to."""

from __future__ import annotations

from typing import Protocol

from harness.model.assembly import FloatArray


class Engine(Protocol):
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

    def surplus(self, velocity: FloatArray) -> float:
        """Power of the loads less that of the damping, in the units of `velocity` and `unbalance`.

        Friction takes power too. A wall that moves on, or comes back, has a mean of at least zero: what shakes in place
        with less is fed by the contact solver's errors.
        """
        ...

    def save(self) -> FloatArray:
        """The contact state, to be given to `restore`."""
        ...

    def restore(self, state: FloatArray) -> None:
        """Back to rest with this contact state."""
        ...

    def contact_forces(self) -> FloatArray:
        """(m, 3) contact forces (n1, n2, s) of the last time step [force], conventions of the assembly."""
        ...
