"""What is the least horizontal thrust of an arch?

Supports do not move yet. So one springing of the wall in `data/thrust-min.json` lies on a smooth plane, held by a dead
force, and the live load is a force along the plane that lets go. The reference 0.3680362 was computed by a linear
programme independent of Drystone.

Expected:

    multiplier 0.368036
"""

from pathlib import Path

import drystone


def main() -> None:
    """Print the answer."""
    wall = drystone.read_wall(Path(__file__).parent / "data" / "thrust-min.json")
    print(f"multiplier {drystone.analyse(wall, 'la-associated').multiplier:.6f}")


if __name__ == "__main__":
    main()
