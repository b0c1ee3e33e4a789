"""What is the least horizontal thrust of an arch?

`drystone reaction` asks it of a support that moves. Here it is a multiplier: one springing of the wall in
`data/thrust-min.json` lies on a smooth plane, held by a dead force, and the live load along the plane lets go. The
reference 0.3680362 was computed by a linear programme independent of Drystone.

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
