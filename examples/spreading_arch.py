"""How far can the abutment of an arch spread before it falls?

A semicircle of radius 1 and thickness 0.15, in 12 voussoirs, turns about three joints. The spread 0.1410498 at which no
admissible state is left was computed by a programme independent of Drystone. The thrust grows on the way, because the
arch becomes flatter.

Expected:

    the arch stands up to 0.141050
    thrust 1.650266 at first, 2.255011 at last
"""

import drystone
from drystone.settling import settled_until_collapse


def main() -> None:
    """Print the answer."""
    wall = drystone.build_wall(
        {
            "format": "wall/1",
            "unit_weight": 20,
            "friction": 0.7,
            "pattern": {"type": "ring", "inner_radius": 0.925, "outer_radius": 1.075, "count": 12},
            "settlements": [{"blocks": ["abutment-2"], "translation": [1, 0]}],
        }
    )
    found = settled_until_collapse(wall)
    if isinstance(found, str):
        print(found)
        return
    print(f"the arch stands up to {found.stands:.6f}")
    print(f"thrust {found.reaction[0]:.6f} at first, {found.reaction[-1]:.6f} at last")


if __name__ == "__main__":
    main()
