"""Which live load cannot make a block collapse?

A vertical force within the middle of the base presses the joint and can be as large as it likes.

Expected:

    unbounded, multiplier None
"""

import drystone


def main() -> None:
    """Print the answer."""
    ground = {"id": "ground", "fixed": True, "polygon": [[0, -0.2], [1, -0.2], [1, 0], [0, 0]]}
    block = {"id": "block", "polygon": [[0, 0], [1, 0], [1, 0.5], [0, 0.5]]}
    force = {"block": "block", "at": [0.5, 0.5], "force": [0, -1]}
    wall = drystone.build_wall(
        {
            "format": "wall/1",
            "unit_weight": 20,
            "friction": 0.5,
            "blocks": [ground, block],
            "loads": {"live": {"points": [force]}},
        }
    )
    result = drystone.analyse(wall, "la")
    print(f"{result.finding}, multiplier {result.multiplier}")


if __name__ == "__main__":
    main()
