"""What does a result hold, and how do I read the forces and the mechanism?

A stack of five blocks of 0.5 m x 0.4 m topples about its toe at b/h = 0.5/2 = 0.25. There the joint on the ground is
pressed at one contact point only, by the whole weight 5 x 20 x 0.5 x 0.4 x thickness, and sheared by 0.25 of it.

Expected:

    collapses, 0.250000, accepted
    pressed points of the lowest joint: 1
    shear over compression 0.250000
    blocks that turn: 5
"""

import drystone


def main() -> None:
    """Print the answer."""
    result = drystone.analyse(drystone.new_wall("stack", count=5, width=0.5, height=0.4), "la")
    print(f"{result.finding}, {result.multiplier:.6f}, {result.judge.outcome}")
    forces = result.forces_to_pandas()
    lowest = forces[(forces["block_a"] == "base") | (forces["block_b"] == "base")].iloc[0]
    print(f"pressed points of the lowest joint: {int(lowest['n1'] > 1e-9) + int(lowest['n2'] > 1e-9)}")
    print(f"shear over compression {abs(lowest['s']) / (lowest['n1'] + lowest['n2']):.6f}")
    print(f"blocks that turn: {int((result.mechanism_to_pandas()['omega'].abs() > 1e-9).sum())}")


if __name__ == "__main__":
    main()
