"""How much does a running bond gain from longer bricks?

With friction 10 nothing slides in one course of bricks upon another; the flatter the brick, the greater the
multiplier. The values are those of two independent linear programmes for friction 0.65 at proportion 2.

Expected:

    PENDING
"""

import drystone


def main() -> None:
    """Print the answer."""
    wall = drystone.library_wall("wall-21")
    table = drystone.sweep(wall, {"proportion": [1.0, 2.0, 3.0]}, ["la-associated"]).to_pandas()
    for proportion, multiplier in zip(table["proportion"], table["multiplier"], strict=True):
        print(f"proportion {proportion}: {multiplier:.6f}")


if __name__ == "__main__":
    main()
