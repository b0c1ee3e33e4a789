"""How does a dead force on top change the multiplier of a column under a horizontal live load?

The column of W kN has b = 0.4 m, h = 2 m, so W = 20 x 0.4 x 2 = 16 kN. Without the force it topples at b/h = 0.2.
A dead force of P = 8 kN on its axis does not push but holds back: (W b/2 + P b/2) / (W h/2) = 0.3.

Expected:

    without 0.200000
    with 0.300000
"""

import drystone


def main() -> None:
    """Print the answer."""
    document = {
        "format": "wall/1",
        "unit_weight": 20,
        "friction": 0.8,
        "pattern": {"type": "stack", "width": 0.4, "height": 0.5, "count": 4},
        "loads": {"live": {"body": [{"per_weight": [1, 0]}]}},
    }
    bare = drystone.build_wall(document, "bare")
    force = {"block": "4", "at": [0.2, 2.0], "force": [0, -8]}
    loads = {"dead": {"points": [force]}, "live": {"body": [{"per_weight": [1, 0]}]}}
    loaded = drystone.build_wall({**document, "loads": loads}, "loaded")
    print(f"without {drystone.analyse(bare, 'la').multiplier:.6f}")
    print(f"with {drystone.analyse(loaded, 'la').multiplier:.6f}")


if __name__ == "__main__":
    main()
