"""Walls and ways of looking at them that the tests of limit analysis share."""

from __future__ import annotations

import itertools
from collections.abc import Callable
from dataclasses import replace

import numpy as np

from harness.model.assembly import Assembly
from methods.la.bench import running_bond

__all__ = ["VIEWS", "block_on_halves", "column", "running_bond", "with_friction"]


def stack(widths: list[float], heights: list[float], friction: float, halves: int = 1) -> Assembly:
    """Blocks on a fixed base, one above the other, each joint cut into equal parts; pushed by their own weight."""
    polygons = [np.array([[-5.0, -1.0], [5.0, -1.0], [5.0, 0.0], [-5.0, 0.0]])]
    end1, end2, first, second = [], [], [], []
    top = 0.0
    for k, (width, height) in enumerate(zip(widths, heights, strict=True)):
        polygons.append(
            np.array([[0.0, top], [width, top], [width, top + height], [0.0, top + height]]) - [width / 2, 0.0]
        )
        reach = min(width, widths[k - 1] if k else width) / 2
        cuts = np.linspace(-reach, reach, halves + 1)
        for left, right in itertools.pairwise(cuts):
            first.append(k)
            second.append(k + 1)
            end1.append([left, top])
            end2.append([right, top])
        top += height
    n, m = len(polygons), len(first)
    weight = np.array([0.0, *(w * h for w, h in zip(widths, heights, strict=True))])
    dead, live = np.zeros((n, 3)), np.zeros((n, 3))
    dead[:, 1], live[:, 0] = -weight, weight
    return Assembly(
        name="stack",
        block_ids=tuple(f"b{k}" for k in range(n)),
        polygons=tuple(polygons),
        centroid=np.array([polygon.mean(axis=0) for polygon in polygons]),
        weight=weight,
        fixed=np.arange(n) == 0,
        block_a=np.array(first),
        block_b=np.array(second),
        end1=np.array(end1),
        end2=np.array(end2),
        face1=np.array(end1),
        face2=np.array(end2),
        normal=np.tile([0.0, 1.0], (m, 1)),
        friction=np.full(m, friction),
        joint=("bed",) * m,
        dead=dead,
        live=live,
    )


def block_on_halves() -> Assembly:
    """The single block of Baggio and Trovalusci (1995): 1 x 0.5 on two halves of friction 0.6 and 0.4."""
    return with_friction(stack([1.0], [0.5], 0.5, halves=2), np.array([0.6, 0.4]))


def column(widths: list[float], heights: list[float], friction: float, halves: int = 1) -> Assembly:
    """A stack of blocks; see `stack`."""
    return stack(widths, heights, friction, halves)


def with_friction(wall: Assembly, friction: float | np.ndarray) -> Assembly:
    """The wall with another friction on all its interfaces."""
    return replace(wall, friction=np.broadcast_to(friction, wall.friction.shape).astype(float).copy())


def _moved(wall: Assembly, turn: np.ndarray, move: np.ndarray, scale: float = 1.0) -> Assembly:
    def place(points: np.ndarray) -> np.ndarray:
        return scale * points @ turn.T + move

    sense = float(np.sign(np.linalg.det(turn)))

    def load(values: np.ndarray) -> np.ndarray:
        return np.column_stack([values[:, :2] @ turn.T, sense * scale * values[:, 2]])

    return replace(
        wall,
        polygons=tuple(place(polygon)[:: int(sense)] for polygon in wall.polygons),
        centroid=place(wall.centroid),
        end1=place(wall.end1),
        end2=place(wall.end2),
        face1=place(wall.face1),
        face2=place(wall.face2),
        normal=wall.normal @ turn.T,
        dead=load(wall.dead),
        live=load(wall.live),
    )


def _renumbered(wall: Assembly) -> Assembly:
    new = np.random.default_rng(3).permutation(wall.n_blocks)
    rank = np.argsort(new)
    joints = np.random.default_rng(4).permutation(wall.n_interfaces)
    names = ("end1", "end2", "face1", "face2", "friction")
    return replace(
        wall,
        block_ids=tuple(wall.block_ids[k] for k in new),
        polygons=tuple(wall.polygons[k] for k in new),
        joint=tuple(wall.joint[k] for k in joints),
        block_a=rank[wall.block_b][joints],
        block_b=rank[wall.block_a][joints],
        normal=-wall.normal[joints],
        **{name: getattr(wall, name)[new] for name in ("centroid", "weight", "fixed", "dead", "live")},
        **{name: getattr(wall, name)[joints] for name in names},
    )


TURN = np.array([[np.cos(0.7), -np.sin(0.7)], [np.sin(0.7), np.cos(0.7)]])
STAY, FLIP = np.eye(2), np.diag([-1.0, 1.0])
NOWHERE = np.zeros(2)
VIEWS: dict[str, Callable[[Assembly], Assembly]] = {
    "translated": lambda wall: _moved(wall, STAY, np.array([31.0, -7.0])),
    "rotated": lambda wall: _moved(wall, TURN, NOWHERE),
    "mirrored": lambda wall: _moved(wall, FLIP, NOWHERE),
    "scaled": lambda wall: _moved(wall, STAY, NOWHERE, 250.0),
    "heavier": lambda wall: replace(wall, weight=1e4 * wall.weight, dead=1e4 * wall.dead, live=1e4 * wall.live),
    "renumbered": _renumbered,
}
