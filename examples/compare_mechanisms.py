"""How alike are the mechanisms of the 21-brick wall by finite elements, limit analysis and distinct elements?

The cosine of two mechanisms is 1 if all blocks move alike. Finite and distinct elements and the associated maximum
move alike, as Baggio and Trovalusci (1995) report. The least state known to `la` has another mechanism.
Multipliers: 1567589759/2809311829, an exact state, and 13/23, the plateau of two other codes.

Expected:

    la 0.557998
    fe 0.565217
    cosine of fe and de: 1.00
    cosine of fe and la-associated: 0.99
    cosine of fe and la: 0.72
"""

import numpy as np

import drystone


def main() -> None:
    """Print the answer."""
    wall = drystone.library_wall("wall-21")
    results = {name: drystone.analyse(wall, name) for name in ("la", "fe", "de", "la-associated")}
    for name in ("la", "fe"):
        print(f"{name} {results[name].multiplier:.6f}")
    motions: dict[str, np.ndarray] = {
        name: np.array(result.mechanism, float).ravel() for name, result in results.items()
    }
    for name in ("de", "la-associated", "la"):
        one, other = motions["fe"], motions[name]
        cosine = one @ other / np.linalg.norm(one) / np.linalg.norm(other)
        print(f"cosine of fe and {name}: {cosine:.2f}")


if __name__ == "__main__":
    main()
