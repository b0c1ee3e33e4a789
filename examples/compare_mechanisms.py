"""Do finite elements, limit analysis and distinct elements find the same mechanism of the 21-brick wall?

The cosine of two mechanisms is 1 if all blocks move alike. Baggio and Trovalusci (1995) report that the three agree
closely. The multipliers: 1567589759/2809311829 is an exact collapse state, 13/23 the plateau of two other codes.

Expected:

    la 0.557998
    fe 0.565217
    cosine of la and fe above 0.95: True
    cosine of la and de above 0.95: True
"""

import numpy as np

import drystone


def main() -> None:
    """Print the answer."""
    wall = drystone.library_wall("wall-21")
    results = {name: drystone.analyse(wall, name) for name in ("la", "fe", "de")}
    for name in ("la", "fe"):
        print(f"{name} {results[name].multiplier:.6f}")
    motions = {name: np.ravel(result.mechanism) for name, result in results.items()}
    for name in ("fe", "de"):
        one, other = motions["la"], motions[name]
        cosine = one @ other / np.linalg.norm(one) / np.linalg.norm(other)
        print(f"cosine of la and {name} above 0.95: {cosine > 0.95}")


if __name__ == "__main__":
    main()
