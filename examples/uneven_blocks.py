"""How far may the multiplier fall when blocks are not quite even?

`de-uneven` draws defects of the blocks, of an `imperfection` and a `seed`. On dry joints without redundancy they do not
matter: the stack of three blocks topples at b/h = 0.5, less what defects take from the width of its joints.

Expected:

    PENDING
"""

import drystone


def main() -> None:
    """Print the answer."""
    wall = drystone.new_wall("stack", count=3, width=0.3, height=0.2, friction=0.8)
    even = drystone.analyse(wall, "de")
    uneven = drystone.analyse(wall, "de-uneven")
    print(even.bracket, uneven.bracket, uneven.multiplier)


if __name__ == "__main__":
    main()
