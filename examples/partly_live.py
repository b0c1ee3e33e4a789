"""How much of the weight of a stone may come on as live load when a tenth of it is dead?

The lower block leans 0.2 m over the edge of its support, so its centroid lies 0.3 m behind the edge. The stone on it,
of the same weight W, has its centroid 0.15 m in front of the edge; nine tenths of its gravity are lifted. Moments about
the edge: (0.1 + lambda) W 0.15 = W 0.3, so lambda = 1.9.

Expected:

    multiplier 1.900000
"""

import drystone


def main() -> None:
    """Print the answer."""
    offsets = [-0.8, -0.35]
    document = {
        "format": "wall/1",
        "unit_weight": 20,
        "friction": 0.8,
        "pattern": {"type": "stack", "width": 1, "height": 0.4, "count": 2, "offsets": offsets, "base": [-1, 0]},
        "loads": {
            "dead": {"body": [{"per_weight": [0, 0.9], "blocks": ["2"]}]},
            "live": {"body": [{"per_weight": [0, -1], "blocks": ["2"]}]},
        },
    }
    print(f"multiplier {drystone.analyse(drystone.build_wall(document), 'la').multiplier:.6f}")


if __name__ == "__main__":
    main()
