"""Ways to look at the same wall differently; the multiplier must not notice."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from harness.model.assembly import Assembly


def translated(wall: Assembly) -> Assembly:
    move = np.array([12.3, -4.5])
    return replace(
        wall,
        polygons=tuple(p + move for p in wall.polygons),
        centroid=wall.centroid + move,
        end1=wall.end1 + move,
        end2=wall.end2 + move,
        face1=wall.face1 + move,
        face2=wall.face2 + move,
    )


def mirrored(wall: Assembly) -> Assembly:
    flip = np.array([-1.0, 1.0])
    return replace(
        wall,
        polygons=tuple((p * flip)[::-1] for p in wall.polygons),
        centroid=wall.centroid * flip,
        end1=wall.end1 * flip,
        end2=wall.end2 * flip,
        face1=wall.face1 * flip,
        face2=wall.face2 * flip,
        normal=wall.normal * flip,
        dead=wall.dead * np.array([-1.0, 1.0, -1.0]),
        live=wall.live * np.array([-1.0, 1.0, -1.0]),
    )


def scaled(wall: Assembly) -> Assembly:
    return replace(
        wall,
        polygons=tuple(p * 3.0 for p in wall.polygons),
        centroid=wall.centroid * 3.0,
        end1=wall.end1 * 3.0,
        end2=wall.end2 * 3.0,
        face1=wall.face1 * 3.0,
        face2=wall.face2 * 3.0,
    )


def heavier(wall: Assembly) -> Assembly:
    return replace(wall, weight=wall.weight * 2.4e4, dead=wall.dead * 2.4e4, live=wall.live * 2.4e4)


def renumbered(wall: Assembly) -> Assembly:
    new = np.random.default_rng(7).permutation(wall.n_blocks)
    rank = np.argsort(new)
    joints = np.random.default_rng(8).permutation(wall.n_interfaces)
    return replace(
        wall,
        block_ids=tuple(wall.block_ids[i] for i in new),
        polygons=tuple(wall.polygons[i] for i in new),
        centroid=wall.centroid[new],
        weight=wall.weight[new],
        fixed=wall.fixed[new],
        block_a=rank[wall.block_a][joints],
        block_b=rank[wall.block_b][joints],
        end1=wall.end1[joints],
        end2=wall.end2[joints],
        face1=wall.face1[joints],
        face2=wall.face2[joints],
        normal=wall.normal[joints],
        friction=wall.friction[joints],
        joint=tuple(wall.joint[i] for i in joints),
        dead=wall.dead[new],
        live=wall.live[new],
    )


def turned_interfaces(wall: Assembly) -> Assembly:
    return replace(wall, block_a=wall.block_b, block_b=wall.block_a, normal=-wall.normal)


VIEWS: dict[str, Callable[[Assembly], Assembly]] = {
    "translated": translated,
    "mirrored": mirrored,
    "scaled": scaled,
    "heavier": heavier,
    "renumbered": renumbered,
    "turned_interfaces": turned_interfaces,
}


@pytest.fixture(params=sorted(VIEWS))
def view(request: pytest.FixtureRequest) -> Callable[[Assembly], Assembly]:
    chosen: Callable[[Assembly], Assembly] = VIEWS[request.param]
    return chosen
