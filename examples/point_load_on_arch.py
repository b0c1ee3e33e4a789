"""Which force at the quarter span makes a segmental arch collapse?

The multiplier of a live force of 1 kN is the force itself. No closed form exists. The maximum of associated limit
analysis is above every state in equilibrium, so the least collapse state that `la` finds cannot lie above it; its own
mechanism, which the judge checks by virtual work, proves that no greater force is in equilibrium.

Expected:

    force 40.862 kN, accepted
    la is not above it: True
"""

import drystone


def main() -> None:
    """Print the answer."""
    ring = {"type": "ring", "inner_radius": 2, "outer_radius": 2.4, "count": 15, "angles": [150, 30]}
    force = {"block": "v4", "at": [-1.39, 1.91], "force": [0, -1]}
    wall = drystone.build_wall(
        {
            "format": "wall/1",
            "unit_weight": 22,
            "thickness": 0.5,
            "friction": 0.6,
            "pattern": ring,
            "loads": {"live": {"points": [force]}},
        }
    )
    least, greatest = (drystone.analyse(wall, method) for method in ("la", "la-associated"))
    assert least.multiplier is not None
    assert greatest.multiplier is not None
    print(f"force {greatest.multiplier:.3f} {wall.units['force']}, {greatest.judge.outcome}")
    print(f"la is not above it: {least.multiplier <= greatest.multiplier + 1e-6}")


if __name__ == "__main__":
    main()
