"""Walls that are small to write and large to read: lists that are long, look-ups that are many, faults by the thousand.

Each is made by a rule and has a size, so that the same kind can be asked for larger.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

Document = dict[str, Any]
GROUND = {"id": "ground", "polygon": [[-1, -1], [5, -1], [5, 0], [-1, 0]], "fixed": True}
BLOCK = {"id": "a", "polygon": [[0, 0], [1, 0], [1, 0.5], [0, 0.5]], "groups": ["g"]}
BOND = {"type": "running_bond", "block_length": 0.4, "block_height": 0.2}
PUSH = {"per_weight": [1, 0]}


def wall(**more: Any) -> Document:
    """A block on the ground, pushed, with other fields in place of its own or beside them."""
    made = {"format": "wall/1", "unit_weight": 20, "friction": 0.5, "blocks": [GROUND, BLOCK]}
    return {**made, "loads": {"live": {"body": [PUSH]}}, **more}


def bonded(count: int, **more: Any) -> Document:
    """A wall of `count` courses of as many bricks."""
    return wall(blocks=[], pattern=BOND | {"count": count, "bricks": count}, **more)


def circle(count: int, x: float, y: float) -> list[list[float]]:
    """A polygon of so many vertices on a circle of radius 1."""
    turns = [2.0 * math.pi * k / count for k in range(count)]
    return [[x + math.cos(turn), y + math.sin(turn)] for turn in turns]


def flat(count: int, y: float) -> list[list[float]]:
    """A square whose upper and lower faces have `count` parts in one line."""
    return [[k / count, y] for k in range(count + 1)] + [[1.0 - k / count, y + 1.0] for k in range(count + 1)]


def box(x0: float, y0: float, x1: float, y1: float) -> list[list[float]]:
    """A rectangle by two opposite corners."""
    return [[x0, y0], [x1, y0], [x1, y1], [x0, y1]]


def aside(number: int) -> tuple[float, float]:
    """The lower left corner of a square of side 1 among others, a thousandth of it from each and all off the ground."""
    return 1.001 * (number % 70), 1.001 + 1.001 * (number // 70)


def comb(count: int) -> list[list[float]]:
    """A polygon of so many teeth of height 2, side by side on a bar of length 1."""
    teeth = [[[k, 0], [k, 2], [k + 0.5, 2], [k + 0.5, 0]] for k in range(count)]
    return [[0.0, -1.0], *([x / count, y] for tooth in teeth for x, y in tooth), [1.0, -1.0]]


KINDS: dict[str, Callable[[int], Document]] = {
    "rules for the same materials": lambda n: bonded(
        10, friction={"default": 0.5, "rules": [{"materials": ["stone", "stone"], "value": 0.1}] * n}
    ),
    "rules for no block": lambda n: wall(
        friction={"default": 0.5, "rules": [{"between": ["ground", f"n{k}"], "value": 0.1} for k in range(n)]}
    ),
    "forces on all blocks": lambda n: bonded(60, loads={"live": {"body": [PUSH] * n}}),
    "forces on a group each": lambda n: wall(
        blocks=[GROUND, {**BLOCK, "groups": [f"g{k}" for k in range(n)]}],
        loads={"live": {"body": [PUSH | {"group": f"g{k}"} for k in range(n)]}},
    ),
    "forces on groups that there are not": lambda n: wall(
        loads={"live": {"body": [PUSH | {"group": f"h{k}"} for k in range(n // 10)]}}
    ),
    "forces at a point": lambda n: wall(
        loads={"live": {"points": [{"block": "a", "at": [0.5, 0.5], "force": [1, 0]}] * n}}
    ),
    "pressures": lambda n: bonded(
        60, loads={"live": {"pressures": [{"from": [0, 0], "to": [0, 0.2], "uniform": 1}] * n}}
    ),
    "settlements": lambda n: wall(settlements=[{"blocks": ["ground"], "translation": [0, -1]}] * n),
    "load cases": lambda n: wall(loads={}, load_cases={f"c{k}": {"live": {"body": [PUSH]}} for k in range(n)}),
    "faults of one kind": lambda n: wall(blocks=[{**BLOCK, "id": f"s{k}", "frction": 1} for k in range(n)]),
    "faults of all kinds": lambda n: wall(**{f"f{k}": 0 for k in range(n)}),
    "blocks that are none": lambda n: wall(blocks=[{}] * n),
    "ids that are one": lambda n: wall(blocks=[GROUND, *[BLOCK] * n]),
    "blocks that are one": lambda n: wall(blocks=[GROUND, *({**BLOCK, "id": f"s{k}"} for k in range(n))]),
    "as many blocks that are one as are compared": lambda n: wall(
        blocks=[GROUND, *({**BLOCK, "id": f"s{k}"} for k in range(min(n, 250)))]  # compared twice, 1 s each
    ),
    "blocks within blocks": lambda n: wall(
        blocks=[GROUND, *({"id": f"s{k}", "polygon": [[k, k], [-k, k], [-k, -k], [k, -k]]} for k in range(1, n))]
    ),
    "bars across bars": lambda n: wall(
        blocks=[GROUND]
        + [{"id": f"h{k}", "polygon": box(0.0, k, n, k + 0.5)} for k in range(n // 2)]
        + [{"id": f"v{k}", "polygon": box(k, 0.0, k + 0.5, n)} for k in range(n // 2)]
    ),
    "combs across combs": lambda n: wall(
        blocks=[
            GROUND,
            {"id": "h", "polygon": comb(n // 4 - 1)},
            {"id": "v", "polygon": [[y - 0.5, x + 0.5] for x, y in reversed(comb(n // 4 - 1))]},
        ]
    ),
    "blocks in the air": lambda n: wall(
        blocks=[GROUND] + [{"id": f"s{k}", "polygon": box(*aside(k), *(1.0 + at for at in aside(k)))} for k in range(n)]
    ),
    "slivers": lambda n: wall(
        blocks=[GROUND]
        + [
            {"id": f"s{k}", "polygon": [[0, k * 1e-9], [1, k * 1e-9], [1, (k + 1) * 1e-9], [0, (k + 1) * 1e-9]]}
            for k in range(min(n, 300))
        ]
    ),
    "faces in one line": lambda n: wall(
        blocks=[{**GROUND, "polygon": [[0, -1], [1, -1], [1, 0], [0, 0]]}]
        + [{"id": f"s{k}", "polygon": flat(2400, float(k))} for k in range(20)]
    ),
    "round blocks": lambda n: wall(
        blocks=[GROUND, *({"id": f"s{k}", "polygon": circle(5000, 2.0 * k, 1.0)} for k in range(20))]
    ),
    "combinations of load cases": lambda n: wall(
        loads={},
        load_cases={"c": {"live": {"points": [{"block": "a", "at": [0.5, 0.5], "force": [1, 0]}] * n}}},
        combinations={f"x{k}": {"c": 1.5} for k in range(400)},
    ),
    "products of loads that travel": lambda n: wall(
        loads={},
        travelling={f"t{k}": {"force": [0, -1], "per_face": 60} for k in range(5)},
        combinations={"x": {f"t{k}": 1.0 for k in range(5)}},
    ),
    "loads that travel on far more faces": lambda n: bonded(
        60, loads={}, travelling={f"t{k}": {"force": [0, -1], "per_face": 100} for k in range(400)}
    ),
    "load cases on many blocks": lambda n: bonded(
        60, loads={}, load_cases={f"c{k}": {"live": {"body": [PUSH]}} for k in range(500)}
    ),
    "rules for materials that there are not": lambda n: wall(
        blocks=[GROUND, *({**BLOCK, "id": f"s{k}", "material": f"m{k}"} for k in range(200))],
        friction={"default": 0.5, "rules": [{"materials": [f"n{k}", "x"], "value": 0.1} for k in range(n)]},
    ),
    "names near to many": lambda n: wall(
        blocks=[GROUND, *({**BLOCK, "id": f"stone{k}"} for k in range(2000))],
        interfaces={"removed": [[f"stoneage{k}", f"stony{k}"] for k in range(n)]},
    ),
    "settlements of a group": lambda n: wall(
        blocks=[{**BLOCK, "groups": []}]
        + [
            {"id": f"s{k}", "polygon": box(1.1 * k, -1, 1.1 * k + 1, 0), "fixed": True, "groups": ["g"]}
            for k in range(n)
        ],
        settlements=[{"group": "g", "translation": [0, -1]}] * n,
    ),
    "forces beside a block": lambda n: wall(
        loads={"live": {"points": [{"block": "a", "at": [50, 0.5], "force": [1, 0]}] * n}}
    ),
    "blocks that lie apart": lambda n: wall(
        blocks=[GROUND, *({"id": f"s{k}", "polygon": box(6.1 + 1.1 * k, 0, 7.1 + 1.1 * k, 1)} for k in range(n))]
    ),
    "sight without end": lambda n: bonded(60, interfaces={"sight": 1e15}),
    "every block fixed": lambda n: wall(
        blocks=[{**GROUND, "id": f"s{k}", "polygon": [[7 * k, 0], [7 * k + 6, 0], [7 * k, 1]]} for k in range(100)]
    ),
}
"""Kinds by what there is too much of, each made for a size."""
