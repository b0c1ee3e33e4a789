"""How does the multiplier of a stack grow with friction, and where does it stop growing?

Three blocks of 0.3 m x 0.2 m slide at the friction until they topple at b/h = 0.3/0.6 = 0.5.

Expected:

    friction 0.3: 0.300000
    friction 0.4: 0.400000
    friction 0.6: 0.500000
    friction 0.8: 0.500000
"""

import drystone


def main() -> None:
    """Print the answer."""
    wall = drystone.new_wall("stack", count=3, width=0.3, height=0.2)
    table = drystone.sweep(wall, {"friction": [0.3, 0.4, 0.6, 0.8]}, ["la-associated"]).to_pandas()
    for friction, multiplier in zip(table["friction"], table["multiplier"], strict=True):
        print(f"friction {friction}: {multiplier:.6f}")


if __name__ == "__main__":
    main()
