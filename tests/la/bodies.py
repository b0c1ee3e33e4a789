"""Walls that the tests of limit analysis share."""

from __future__ import annotations

import itertools
from dataclasses import replace

import numpy as np

from harness.model.assembly import Assembly
from tests.walls import assembly
from tests.walls import running_bond as bond_of

__all__ = ["block_on_halves", "column", "running_bond", "with_friction"]


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
        dilatancy=np.zeros(m),
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


def running_bond(courses: int, bricks: int, height: float, friction: float) -> Assembly:
    """A wall of blocks 0.4 long in running bond, pushed sideways; odd courses start with half blocks."""
    return assembly(bond_of(courses, bricks, height=height) | {"start": "half"}, friction)
