"""How much of its weight may push sideways on a block that I describe by polygons?

The block is 1 m wide and 0.5 m high on friction 0.5. It slides at the friction 0.5, before it topples at b/h = 2.

Expected:

    multiplier 0.500000, accepted
"""

import drystone


def main() -> None:
    """Print the answer."""
    ground = {"id": "ground", "fixed": True, "polygon": [[-0.5, -0.2], [1.5, -0.2], [1.5, 0], [-0.5, 0]]}
    block = {"id": "block", "polygon": [[0, 0], [1, 0], [1, 0.5], [0, 0.5]]}
    wall = drystone.build_wall(
        {
            "format": "wall/1",
            "unit_weight": 20,
            "friction": 0.5,
            "blocks": [ground, block],
            "loads": {"live": {"body": [{"per_weight": [1, 0]}]}},
        }
    )
    result = drystone.analyse(wall, "la")
    print(f"multiplier {result.multiplier:.6f}, {result.judge.outcome}")


if __name__ == "__main__":
    main()
