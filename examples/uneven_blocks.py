"""How far does the multiplier change when blocks are not quite even?

`de-uneven` draws defects of the blocks, of a `size` and a `seed`. On dry joints without redundancy they matter
little: the even stack topples at b/h = 0.5. The cuts of both faces of the lowest joint, up to 0.03 x 0.2 m each, turn
the stack by at most 2 x 0.006/0.3 = 0.04, which changes the multiplier by at most 0.04 (1 + 0.5^2) = 0.05.

Expected:

    even blocks 0.500
    uneven blocks within 0.05 of it: True
"""

import drystone


def main() -> None:
    """Print the answer."""
    wall = drystone.new_wall("stack", count=3, width=0.3, height=0.2, friction=0.8)
    even = drystone.analyse(wall, "de")
    uneven = drystone.analyse(wall, "de-uneven")
    assert even.multiplier is not None
    assert uneven.multiplier is not None
    print(f"even blocks {even.multiplier:.3f}")
    print(f"uneven blocks within 0.05 of it: {abs(uneven.multiplier - 0.5) <= 0.05}")


if __name__ == "__main__":
    main()
