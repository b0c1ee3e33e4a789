"""How much more of its vault does a Matera wall carry when its three bonding stones are well placed?

The multipliers are the checked references of the cases `matera-poor` and `matera-good`; a tenth of the weight of the
vault is dead, so a wall carries 0.1 + lambda. Baggio and Trovalusci (1995) report 0.30 and 1.35 for such walls.

Expected:

    poor 0.291599
    good 1.651282
"""

import drystone


def main() -> None:
    """Print the answer."""
    for bonding in ("poor", "good"):
        result = drystone.analyse(drystone.library_wall(f"matera-{bonding}"), "la-associated")
        print(f"{bonding} {result.multiplier:.6f}")


if __name__ == "__main__":
    main()
