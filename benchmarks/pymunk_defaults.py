"""What pymunk gives when it is used as games use it: `python -m benchmarks pymunk_defaults` prints a table of the docs.

The same walls as whole blocks, with the engine's default settings, a live load raised in time, and collapse read off
when a block has moved by a tenth of its size. Nothing else in Drystone uses this.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import pymunk

from benchmarks.walls import bond, stack
from harness.model.assembly import Assembly, polygon_area
from methods.de.engines.pymunk_joints import polygon_gyration


@dataclass(frozen=True)
class Setup:
    """A way to use the engine.

    Attributes:
        name: what it stands for.
        iterations: sweeps of the contact solver.
        slop: allowed overlap, in units of the wall's file.
        step: time step [s].
        rate: growth of the multiplier in a second.
        scale: engine lengths in a metre.
    """

    name: str
    iterations: int
    slop: float
    step: float
    rate: float
    scale: float


SETUPS = (
    Setup("defaults, metres, 60 steps a second", 10, 0.1, 1 / 60, 0.02, 1.0),
    Setup("defaults, 100 units a metre, 60 steps a second", 10, 0.1, 1 / 60, 0.02, 100.0),
    Setup("100 units a metre, 1,000 steps a second", 10, 0.1, 1e-3, 0.02, 100.0),
    Setup("100 units a metre, 1,000 steps a second, 50 sweeps, slop 0.001", 50, 1e-3, 1e-3, 0.02, 100.0),
    Setup("100 units a metre, 1,000 steps a second, slop 0", 10, 0.0, 1e-3, 0.02, 100.0),
)


def ramp(assembly: Assembly, setup: Setup, greatest: float = 1.2) -> float | None:
    """Multiplier at which a block has moved by a tenth of the mean block size, or None up to `greatest`."""
    space = pymunk.Space()
    space.iterations = setup.iterations
    space.collision_slop = setup.slop
    bodies = []
    for i, polygon in enumerate(assembly.polygons):
        corners = (polygon - assembly.centroid[i]) * setup.scale
        if assembly.fixed[i]:
            body = space.static_body
            corners = polygon * setup.scale
        else:
            mass = polygon_area(polygon) * setup.scale**2
            body = pymunk.Body(mass, mass * polygon_gyration(corners))
            body.position = tuple(assembly.centroid[i] * setup.scale)
            space.add(body)
            bodies.append(body)
        shape = pymunk.Poly(body, [(float(x), float(y)) for x, y in corners])
        shape.friction = float(np.sqrt(assembly.friction[0]))
        space.add(shape)
    start = np.array([tuple(body.position) for body in bodies])
    gravity = 9.81 * setup.scale
    far = 0.1 * assembly.length_scale * setup.scale
    for k in range(int(greatest / setup.rate / setup.step)):
        multiplier = setup.rate * setup.step * k
        space.gravity = (multiplier * gravity, -gravity)
        space.step(setup.step)
        if k % 10 == 0 and np.abs(np.array([tuple(body.position) for body in bodies]) - start).max() > far:
            return multiplier
    return None


def main(arguments: Sequence[str] | None = None) -> int:
    """Print the table; takes no arguments."""
    if sys.argv[1:] if arguments is None else arguments:
        print("usage: python -m benchmarks pymunk_defaults", file=sys.stderr)
        return 2
    walls = (
        ("block that slides at 0.3", stack(1, 0.4, 0.2, 0.3), 0.3),
        ("stack of 10", stack(10, 0.4, 0.2, 0.7), 0.2),
        ("21 bricks, friction 0.65", bond(6, 3, 0.65, 0.2), 13 / 23),
    )
    print("| setup | " + " | ".join(name for name, _, _ in walls) + " |")
    print("|---" * (len(walls) + 1) + "|")
    for setup in SETUPS:
        cells = []
        for _, assembly, exact in walls:
            found = ramp(assembly, setup)
            cells.append(
                "did not fall up to 1.2" if found is None else f"{found:.3f} ({100 * (found / exact - 1):+.0f} %)"
            )
        print(f"| {setup.name} | " + " | ".join(cells) + " |", flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
