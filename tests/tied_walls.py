"""Walls with ties and props, of which closed forms or a linear programme give the multiplier."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
from scipy.optimize import linprog

from harness.engine.judge import answered
from harness.model.assembly import Assembly
from harness.model.bars import Bars
from harness.model.build import build
from harness.model.method_registry import load_method
from harness.model.result import Result
from harness.model.wall import Wall
from tests.walls import assembly

TAKEN = ("la", "la-associated", "la-associated-cvxpy")
EXACT = 1e-9
"""Relative accuracy that the methods declare."""
PRINTED = 5e-7
"""Of values that are known to seven digits."""
SIDE, BLOCK = [-0.6, 1.8], [0.0, 1.8]


def block(friction: float = 5.0, width: float = 0.4, height: float = 2.0, **further: Any) -> dict[str, Any]:
    """A block of weight 16 on a base, pushed to the right, beside fixed blocks on both sides of it."""

    def stone(name: str, left: float, bottom: float, right: float, top: float, **more: Any) -> dict[str, Any]:
        return {"id": name, "polygon": [[left, bottom], [right, bottom], [right, top], [left, top]], **more}

    return {
        "format": "wall/1",
        "friction": friction,
        "blocks": [
            stone("base", 0.0, -0.5, width, 0.0, fixed=True),
            stone("block", 0.0, 0.0, width, height, weight=16.0),
            stone("left", -1.0, 0.0, -0.6, height, fixed=True),
            stone("right", width + 0.6, 0.0, width + 1.0, height, fixed=True),
        ],
        "loads": {"live": {"body": [{"per_weight": [1, 0]}]}},
        **further,
    }


def bar(start: tuple[str, list[float]], end: tuple[str, list[float]], force: float, **more: Any) -> dict[str, Any]:
    """A tie or a prop between points of two blocks."""
    return {
        "from": {"block": start[0], "at": start[1]},
        "to": {"block": end[0], "at": end[1]},
        "yield_force": force,
    } | more


def tied(force: float, **more: Any) -> Assembly:
    """The block tied to the left at the height 1.8."""
    return built(block(ties=[bar(("left", SIDE), ("block", BLOCK), force, **more)]))


def built(data: dict[str, Any]) -> Assembly:
    return build(Wall.model_validate(data)).assembly


def asked(method: str, wall: Assembly) -> Result:
    """The answer of a method, accepted by the judge."""
    result, judgement = answered(load_method(method), wall)
    assert judgement.accepted, (result.sentence, judgement.sentence)
    return result


def arch(thickness: float, yield_force: float) -> Assembly:
    """A semicircle of radius 1 and 20 voussoirs that do not slide, on rollers, tied at its springings."""
    angles = np.radians(np.linspace(180.0, 0.0, 21))
    inner, outer = 1.0 - 0.5 * thickness, 1.0 + 0.5 * thickness
    ring = np.column_stack([np.cos(angles), np.sin(angles)])
    ring[[0, -1], 1] = 0.0
    radii = (inner, outer, outer, inner)
    blocks: list[dict[str, Any]] = [
        {
            "id": f"v{k}",
            "polygon": [[r * x, r * y] for r, (x, y) in zip(radii, ring[[k, k, k + 1, k + 1]], strict=True)],
        }
        for k in range(20)
    ]
    for name, sign in (("left", -1.0), ("right", 1.0)):
        x, y = sorted([sign * inner, sign * outer])
        blocks.append({"id": name, "polygon": [[x, -0.2], [y, -0.2], [y, 0.0], [x, 0.0]], "fixed": True})
    rollers = [{"between": ["v0", "left"], "value": 0.0}, {"between": ["v19", "right"], "value": 0.0}]
    data = {
        "format": "wall/1",
        "unit_weight": 1.0,
        "friction": {"default": 50.0, "rules": rollers},
        "blocks": blocks,
        "ties": [bar(("v0", [-1.0, 0.0]), ("v19", [1.0, 0.0]), yield_force)],
    }
    return built(data)


def random_wall(seed: int) -> Assembly:
    """Bricks with some ties and props between points of random blocks, a part of them prestressed."""
    rng = np.random.default_rng(seed)
    bond = {"type": "running_bond", "block_length": 1.0, "block_height": 0.5, "count": 4, "bricks": 2}
    wall = assembly(bond, float(rng.uniform(0.4, 0.8)), unit_weight=1.0)
    k, n = 4, wall.n_blocks
    pairs = []
    while len(pairs) < k:
        pair = rng.choice(n, 2, replace=False)
        if not wall.fixed[pair].all():
            pairs.append(pair)
    a, b = np.array(pairs).T
    ends = [wall.centroid[block] + rng.uniform(-0.2, 0.2, (k, 2)) for block in (a, b)]
    sign = np.where(np.arange(k) % 2 == 0, 1.0, -1.0)
    prestress = sign * np.array([0.0, 0.0, 0.1, 0.1])
    further = sign * rng.uniform(0.05, 0.6, k)
    bars = Bars(
        names=tuple(f"bar {i}" for i in range(k)),
        kinds=tuple("tie" if s > 0.0 else "prop" for s in sign),
        block_a=a,
        block_b=b,
        end1=ends[0],
        end2=ends[1],
        prestress=prestress,
        least=np.minimum(further, 0.0),
        greatest=np.maximum(further, 0.0),
    )
    pull = np.where(wall.fixed[:, None], 0.0, bars.generalised(prestress, wall.centroid))
    return replace(wall, dead=wall.dead + pull, bars=bars)


def greatest_by_hand(wall: Assembly) -> float:
    """The associated maximum by a linear programme over contact forces, tensions of bars and the multiplier."""
    bars, columns = wall.bars, []

    def column(pairs: list[tuple[int, np.ndarray, np.ndarray]]) -> np.ndarray:
        sums = np.zeros((wall.n_blocks, 3))
        for number, at, force in pairs:
            arm = at - wall.centroid[number]
            sums[number] += [force[0], force[1], arm[0] * force[1] - arm[1] * force[0]]
        return sums[wall.free].ravel()

    for p in range(wall.n_interfaces):
        a, b, along = int(wall.block_a[p]), int(wall.block_b[p]), wall.end2[p] - wall.end1[p]
        for at, way in (
            (wall.end1[p], wall.normal[p]),
            (wall.end2[p], wall.normal[p]),
            (wall.end1[p], along / np.hypot(*along)),
        ):
            columns.append(column([(a, at, -way), (b, at, way)]))
    for k in range(len(bars)):
        along = bars.end2[k] - bars.end1[k]
        way = along / np.hypot(*along)
        columns.append(column([(int(bars.block_a[k]), bars.end1[k], way), (int(bars.block_b[k]), bars.end2[k], -way)]))
    columns.append(wall.live[wall.free].ravel())
    limits = []
    for p in range(wall.n_interfaces):
        for sign in (1.0, -1.0):
            row = np.zeros(len(columns))
            row[3 * p : 3 * p + 3] = [-wall.friction[p], -wall.friction[p], sign]
            limits.append(row)
    bounds = [(0, None), (0, None), (None, None)] * wall.n_interfaces
    bounds += [*zip(bars.least.tolist(), bars.greatest.tolist(), strict=True), (None, None)]
    found = linprog(
        np.append(np.zeros(len(columns) - 1), -1.0),
        A_ub=np.array(limits),
        b_ub=np.zeros(len(limits)),
        A_eq=np.array(columns).T,
        b_eq=-wall.dead[wall.free].ravel(),
        bounds=bounds,
    )
    return float(found.x[-1]) if found.status == 0 else -np.inf
