"""Load the compiled sweeps before the clock of a run starts, and before a run is shared out among processes."""

from __future__ import annotations

from functools import cache

from methods.de.engines.mass_scaling import courses, insertion_orders, tunings
from methods.de.engines.sequential_impulses import SequentialImpulses
from methods.springs.patterns import block_on_halves


@cache
def load_impulses() -> None:
    """Make a time step of a single block, once in a process."""
    block = block_on_halves((0.6, 0.4))
    course = courses(block)
    ((_, blocks, joints),) = insertion_orders(block, course, 1, 0)
    SequentialImpulses(block, blocks, joints, 1, tunings(course, None)[0]).advance(1)
