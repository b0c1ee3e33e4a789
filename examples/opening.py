"""What does a window under a lintel cost a wall?

The values of the wall with a window are the checked references of the case `opening-lintel`: the associated maximum
0.497757 and a collapse state at 0.475101.

Expected:

    greatest 0.497757
    least known at most 0.475101: True
"""

import drystone


def main() -> None:
    """Print the answer."""
    wall = drystone.library_wall("opening-lintel")
    print(f"greatest {drystone.analyse(wall, 'la-associated').multiplier:.6f}")
    least = drystone.analyse(wall, "la").multiplier
    print(f"least known at most 0.475101: {least is not None and least <= 0.475101 + 1e-6}")


if __name__ == "__main__":
    main()
