"""Why do three methods give three answers for one block on two kinds of joint?

Statics does not say how the weight is shared between the rough half (0.6) and the smooth half (0.4) of the base. The
least multiplier is 0.4, gap springs give 0.5/1.05, the associated maximum is 0.6/1.1, and distinct elements lie
within this range: docs/theory-single-block.md derives them by hand (Baggio and Trovalusci 1995 print the same three).

Expected:

    la 0.400000
    fe 0.476190
    la-associated 0.545455
    de within the range: True
"""

import drystone


def main() -> None:
    """Print the answer."""
    wall = drystone.library_wall("single-block")
    for method in ("la", "fe", "la-associated"):
        print(f"{method} {drystone.analyse(wall, method).multiplier:.6f}")
    bracket = drystone.analyse(wall, "de").bracket
    assert bracket is not None
    print(f"de within the range: {0.4 * 0.995 <= bracket[0] <= bracket[1] <= 0.6 / 1.1 * 1.005}")


if __name__ == "__main__":
    main()
