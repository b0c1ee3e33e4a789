"""How much does a running bond gain from longer bricks?

Length over height 2 gives the reference of the case `wall-21`, 0.584461 by two independent programmes. No wall can
exceed its friction 0.65, at which it slides on its base, and flat bricks reach that. The stockier bricks have no closed
form: less than the others, as overturning of every part of the wall gets easier with the height of its bricks.

Expected:

    proportion 1.0: below that of 2: True
    proportion 2.0: 0.584461
    proportion 3.0: 0.650000
"""

import drystone


def main() -> None:
    """Print the answer."""
    wall = drystone.library_wall("wall-21")
    table = drystone.sweep(wall, {"proportion": [1.0, 2.0, 3.0]}, ["la-associated"]).to_pandas()
    stocky, paper, flat = table["multiplier"]
    print(f"proportion 1.0: below that of 2: {0.0 < stocky < paper}")
    print(f"proportion 2.0: {paper:.6f}")
    print(f"proportion 3.0: {flat:.6f}")


if __name__ == "__main__":
    main()
