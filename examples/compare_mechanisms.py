"""Do finite elements, limit analysis and distinct elements find the same mechanism of the 21-brick wall?

The cosine of two mechanisms is 1 if all blocks move alike; above 0.95 they are called the same. Finite and distinct
elements and the associated maximum move alike, as Baggio and Trovalusci (1995) report. The least state known to `la`
has another mechanism. Multipliers: 1567589759/2809311829, an exact state, and 13/23, the plateau of two other codes.

Expected:

    la 0.557998
    fe 0.565217
    same motion by fe and de: True
    same motion by fe and la-associated: True
    same motion by fe and la: False
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
        print(f"same motion by fe and {name}: {cosine > 0.95}")


if __name__ == "__main__":
    main()
