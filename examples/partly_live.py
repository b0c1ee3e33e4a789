"""How much of the weight of a lintel may grow as a live load when a tenth of it is dead and it pushes on a block?

Nine tenths of the gravity of the upper of two blocks (b = 0.4 m, h = 0.4 m each) are lifted by a dead body force, and
a horizontal multiple of its weight W is live. Moments about the toe of both: (W + 0.1 W) b/2 = lambda W 3h/2, so
lambda = 0.11/0.3/2 = 0.366667; it slides on the lower one before, at 0.8 x 0.1.

Expected:

    multiplier 0.080000
"""

import drystone


def main() -> None:
    """Print the answer."""
    document = {
        "format": "wall/1",
        "unit_weight": 20,
        "friction": 0.8,
        "pattern": {"type": "stack", "width": 0.4, "height": 0.4, "count": 2},
        "loads": {
            "dead": {"body": [{"per_weight": [0, 0.9], "blocks": ["2"]}]},
            "live": {"body": [{"per_weight": [1, 0], "blocks": ["2"]}]},
        },
    }
    print(f"multiplier {drystone.analyse(drystone.build_wall(document), 'la').multiplier:.6f}")


if __name__ == "__main__":
    main()
