"""In which direction does an earthquake collapse an overhanging wall first?

A block of 1 m x 2 m carries one of the same size that stands 0.2 m to the right. The couple topples about the right
toe at (0.5 W + 0.3 W) / (1 W + 3 W) = 0.2 and about the left one at (0.5 W + 0.7 W) / (4 W) = 0.3.

Expected:

    to the right 0.200000
    to the left 0.300000
"""

import drystone


def main() -> None:
    """Print the answer."""
    pattern = {"type": "stack", "width": 1, "height": 2, "count": 2, "offsets": [0, 0.2]}
    for direction, push in (("right", 1), ("left", -1)):
        live = {"body": [{"per_weight": [push, 0]}]}
        document = {"format": "wall/1", "unit_weight": 20, "friction": 0.7, "pattern": pattern, "loads": {"live": live}}
        print(f"to the {direction} {drystone.analyse(drystone.build_wall(document), 'la').multiplier:.6f}")


if __name__ == "__main__":
    main()
