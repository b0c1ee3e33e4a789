"""How far may the friction below a block on a slope be overestimated before it slides?

Friction 0.6 on a plane of 20 degrees: F = mu / tan(alpha) = 0.6 / tan(20 degrees) = 1.64849. All methods find it, as
the block is statically determinate; distinct elements measure it to 0.5 %. Without the slope no friction is needed.

Expected:

    la 1.64849
    fe 1.64849
    de lies between 1.646 and 1.650
    level: inf
"""

import math

import drystone


def main() -> None:
    """Print the answer."""
    document = {
        "format": "wall/1",
        "unit_weight": 20,
        "friction": 0.6,
        "pattern": {"type": "stack", "width": 1, "height": 0.2, "count": 1},
    }
    angle = math.radians(20)
    slope = drystone.build_wall({**document, "loads": {"gravity": [-math.sin(angle), -math.cos(angle)]}})
    for method in ("la", "fe"):
        print(f"{method} {drystone.factor(slope, method, accuracy=1e-6).value:.5f}")
    measured = drystone.factor(slope, "de")
    print(f"de lies between {measured.lower:.3f} and {measured.upper:.3f}")
    print(f"level: {drystone.factor(drystone.build_wall(document)).value}")


if __name__ == "__main__":
    main()
