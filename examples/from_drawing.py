"""At which multiplier does the pier of my drawing collapse?

`data/pier.svg` has two stones of 0.4 m on a support; `data/pier.toml` beside it says what a drawing does not: units,
friction 0.8, unit weight and load. The pier of width b = 0.4 m and height h = 0.8 m topples at b/h.

Expected:

    2 blocks, multiplier 0.500000
"""

from pathlib import Path

import drystone


def main() -> None:
    """Print the answer."""
    wall = drystone.read_wall(Path(__file__).parent / "data" / "pier.svg")
    result = drystone.analyse(wall, "la")
    print(f"{wall.assembly.n_free} blocks, multiplier {result.multiplier:.6f}")


if __name__ == "__main__":
    main()
