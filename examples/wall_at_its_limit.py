"""Does a stack that leans out exactly as far as it may stand under its own weight?

Two blocks of 1 m: the greatest overhang is 1/4 + 1/2 = 3/4 m. A block of it less stands, a block more falls.

Expected:

    overhang 0.74: stands
    overhang 0.76: falls
"""

import drystone


def main() -> None:
    """Print the answer."""
    for overhang in (0.74, 0.76):
        offsets = [overhang / 3 - 1, overhang - 1]
        pattern = {"type": "stack", "width": 1, "height": 0.25, "count": 2, "offsets": offsets, "base": [-1, 0]}
        document = {"format": "wall/1", "unit_weight": 20, "friction": 0.5, "pattern": pattern}
        print(f"overhang {overhang}: {drystone.analyse(drystone.build_wall(document), 'la').finding}")


if __name__ == "__main__":
    main()
