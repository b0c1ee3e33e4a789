"""Walls whose supports move, of which closed forms or values of other programmes are known."""

from __future__ import annotations

from typing import Any

import numpy as np

import drystone
from drystone.support_paths import ReactionPath
from harness.model.followed import SupportPath


def semicircle(thickness: float, voussoirs: int, friction: float) -> drystone.Wall:
    """A semicircular arch of radius 1 and unit weight 1, whose right springing spreads by 1."""
    angle = np.radians(np.linspace(180.0, 0.0, voussoirs + 1))
    ring = np.column_stack([np.cos(angle), np.sin(angle)])
    ring[[0, -1], 1] = 0.0
    inner, outer = 1.0 - 0.5 * thickness, 1.0 + 0.5 * thickness
    blocks: list[dict[str, Any]] = [
        {
            "id": f"v{k}",
            "polygon": [
                [r * x, r * y]
                for r, (x, y) in zip((inner, outer, outer, inner), ring[[k, k, k + 1, k + 1]], strict=True)
            ],
        }
        for k in range(voussoirs)
    ]
    for name, sign in (("left", -1.0), ("right", 1.0)):
        x, y = sorted([sign * inner, sign * outer])
        blocks.append({"id": name, "polygon": [[x, -0.2], [y, -0.2], [y, 0.0], [x, 0.0]], "fixed": True})
    spread = [{"blocks": ["right"], "translation": [1, 0]}]
    return drystone.build_wall(
        {"format": "wall/1", "unit_weight": 1.0, "friction": friction, "blocks": blocks, "settlements": spread}
    )


BRICKS = {0.4: (1.2931034, 7.7068966), 0.65: (1.0544815, 7.9455185), 1.0: (0.75, 8.25)}
"""Least and greatest reaction of `bricks` by their friction: associated flow, by a programme of other code."""


def bricks(friction: Any) -> drystone.Wall:
    """The 21-brick wall of unit weight 1 and weight 9, whose support beyond x = 1.5 goes down by 1."""
    pattern = {"type": "running_bond", "block_length": 1.0, "block_height": 0.5, "count": 6, "bricks": 3, "base": False}
    supports = [
        {"id": name, "polygon": [[left, -0.5], [right, -0.5], [right, 0], [left, 0]], "fixed": True}
        for name, left, right in (("left", 0.0, 1.5), ("right", 1.5, 3.0))
    ]
    down = [{"blocks": ["right"], "translation": [0, -1]}]
    content = {"format": "wall/1", "unit_weight": 1.0, "friction": friction, "pattern": pattern}
    return drystone.build_wall(content | {"blocks": supports, "settlements": down})


def tilted(width: float, height: float, friction: float) -> drystone.Wall:
    """A block on a base that turns by 1 rad clockwise about its right corner."""
    base = {"id": "base", "polygon": [[-1, -1], [3, -1], [3, 0], [-1, 0]], "fixed": True}
    block = {"id": "block", "polygon": [[0, 0], [width, 0], [width, height], [0, height]]}
    turn = [{"blocks": ["base"], "rotation": -1.0, "about": [3.0, 0.0]}]
    content = {"format": "wall/1", "unit_weight": 20.0, "friction": friction, "blocks": [base, block]}
    return drystone.build_wall(content | {"settlements": turn})


def segmental(friction: float, *settlements: dict[str, Any], origin: tuple[float, float] = (0.0, 0.0)) -> drystone.Wall:
    """A segmental arch of 15 voussoirs on two abutments."""
    ring = {"type": "ring", "inner_radius": 2, "outer_radius": 2.4, "count": 15, "angles": [150, 30], "origin": origin}
    content = {"format": "wall/1", "unit_weight": 20, "friction": friction, "pattern": ring}
    return drystone.build_wall(content | {"settlements": list(settlements)})


def keystone(friction: float) -> drystone.Wall:
    """A wedge of height 1 and unit weight 20 with faces at 60 degrees to the ground, whose right support spreads by 1.

    Each face bears half the weight: the reaction is W / 2 tan(60 degrees - phi) where it slides down and W / 2 tan(60
    degrees + phi) where it is pushed up (`thrusts`).
    """
    x = 1.0 / np.sqrt(3.0)
    polygons = {
        "wedge": [[0, 0], [x, 1], [-x, 1]],
        "left": [[0, 0], [-x, 1], [-2, 1], [-2, 0]],
        "right": [[0, 0], [2, 0], [2, 1], [x, 1]],
    }
    blocks = [{"id": name, "polygon": corners, "fixed": name != "wedge"} for name, corners in polygons.items()]
    spread = [{"blocks": ["right"], "translation": [1, 0]}]
    content = {"format": "wall/1", "unit_weight": 20.0, "friction": friction, "blocks": blocks}
    return drystone.build_wall(content | {"settlements": spread})


def thrusts(friction: float) -> list[float]:
    """The reactions of `keystone`, of the support that gives way and of the one that pushes."""
    return [10.0 / np.sqrt(3.0) * float(np.tan(np.pi / 3.0 + way * np.arctan(friction))) for way in (-1.0, 1.0)]


def weight(wall: drystone.Wall) -> float:
    """Of the free blocks."""
    return float(wall.assembly.weight[wall.assembly.free].sum())


def both(found: tuple[ReactionPath, ReactionPath] | str) -> tuple[ReactionPath, ReactionPath]:
    """Two paths that the judge accepts, from no displacement on."""
    assert not isinstance(found, str), found
    for each in found:
        assert each.accepted, each.sentence
        assert each.displacement[0] == 0.0
        assert np.all(np.diff(each.displacement) > 0.0)
    return found


def values(found: tuple[ReactionPath, ReactionPath]) -> list[float]:
    """The constant reactions."""
    return [float(each.reaction[-1]) for each in found]


def path_of(found: ReactionPath) -> SupportPath:
    """The path of which something was found, as its method gives it and the judge has it."""
    return SupportPath(
        found.displacement,
        found.reaction,
        np.array(found.slipping),
        np.array(found.opened),
        found.forces,
        found.mechanism,
        found.constant_from,
        found.reason,
    )
