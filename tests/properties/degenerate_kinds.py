"""Twenty kinds of small walls on the edge of mechanics, each drawn at random."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from harness.model.assembly import Assembly
from harness.model.build import build
from harness.model.wall import Wall

PUSH = (1.0, 0.0)
Points = list[list[float]]
Rng = np.random.Generator


def block(name: str, points: Points, **more: Any) -> dict[str, Any]:
    return {"id": name, "polygon": [[short(x), short(y)] for x, y in points]} | more


def short(value: float) -> float:
    """A coordinate to a multiple of 2^-30, whose fractions exact arithmetic turns quickly."""
    return round(float(value) * 2.0**30) / 2.0**30


def box(name: str, left: float, low: float, width: float, height: float, **more: Any) -> dict[str, Any]:
    points = [[left, low], [left + width, low], [left + width, low + height], [left, low + height]]
    return block(name, points, **more)


def wall(blocks: list[dict[str, Any]], friction: Any = 0.6, push: Sequence[float] = PUSH, **more: Any) -> Assembly:
    live = {"live": {"body": [{"per_weight": [float(value) for value in push]}]}}
    data = {"format": "wall/1", "unit_weight": 20.0, "friction": friction, "blocks": blocks, "loads": live} | more
    return build(Wall.model_validate(data)).assembly


def column(rng: Rng, count: int = 0, sizes: tuple[float, float] = (0.3, 0.8)) -> list[dict[str, Any]]:
    """Blocks of different sizes one upon the other, a little off centre."""
    blocks, low = [box("base", -3.0, -1.0, 6.0, 1.0, fixed=True)], 0.0
    for k in range(count or int(rng.integers(2, 5))):
        width, height = rng.uniform(0.5, 1.0), rng.uniform(*sizes)
        blocks.append(box(f"b{k}", rng.uniform(-0.1, 0.1) - width / 2, low, width, height))
        low += height
    return blocks


def bond(rng: Rng, courses: int = 2, length: float = 1.0, height: float = 0.0) -> list[dict[str, Any]]:
    """Two bricks a course, the upper ones shifted, on a fixed block."""
    height = height or round(float(rng.uniform(0.3, 0.8)), 3)
    blocks = [box("base", -1.0, -1.0, 4.0, 1.0, fixed=True)]
    for row in range(courses):
        shift = 0.5 * length * (row % 2) * float(rng.choice([0.5, 1.0]))
        blocks += [box(f"r{row}c{k}", shift + k * length, row * height, length, height) for k in range(2)]
    return blocks


def portal(rng: Rng) -> list[dict[str, Any]]:
    """Two posts of two blocks each under a lintel."""
    width, height, reach = rng.uniform(0.3, 0.6), rng.uniform(0.3, 0.7), rng.uniform(1.2, 2.0)
    blocks = [box("base", -1.0, -1.0, 5.0, 1.0, fixed=True)]
    for side, left in (("l", 0.0), ("r", reach)):
        blocks += [box(f"{side}{k}", left, k * height, width, height) for k in range(2)]
    blocks.append(box("lintel", 0.0, 2 * height, reach + width, 0.3))
    return blocks


def any_base(rng: Rng) -> list[dict[str, Any]]:
    return [column, bond, portal][int(rng.integers(3))](rng)


def slivers(rng: Rng) -> Assembly:
    thin = 10.0 ** rng.uniform(-4.0, -2.0)
    blocks = column(rng, 2)
    top = max(y for each in blocks for _, y in each["polygon"])
    blocks.append(box("sliver", -0.2, top, 0.4, thin))
    blocks.append(box("top", -0.3, top + thin, 0.6, 0.4))
    return wall(blocks)


def dovetails(rng: Rng) -> Assembly:
    lean = float(rng.choice([-1.0, 1.0])) * rng.uniform(0.02, 0.3)
    half, height = 0.5, 0.6
    foot, head = half, half + lean * height
    blocks = [
        block("left", [[-2, 0], [-foot, 0], [-head, height], [-2, height]], fixed=True),
        block("right", [[foot, 0], [2, 0], [2, height], [head, height]], fixed=True),
        box("floor", -2, -1, 4, 1, fixed=True),
        block("tail", [[-foot, 0], [foot, 0], [head, height], [-head, height]]),
        box("upon", -0.4, height, 0.8, 0.5),
    ]
    push = [(0.0, 1.0), (1.0, 0.0), (0.6, 0.8), (0.0, -1.0)][int(rng.integers(4))]
    return wall(blocks, float(rng.uniform(0.0, 1.0)), push)


def mortises(rng: Rng) -> Assembly:
    depth, half = rng.uniform(0.1, 0.3), rng.uniform(0.1, 0.3)
    lower = [[-0.6, 0], [0.6, 0], [0.6, 0.5], [half, 0.5], [half, 0.5 + depth], [-half, 0.5 + depth], [-half, 0.5]]
    upper = [[-0.6, 0.5], [-half, 0.5], [-half, 0.5 + depth], [half, 0.5 + depth], [half, 0.5], [0.6, 0.5], [0.6, 1.1]]
    blocks = [
        box("base", -2, -1, 4, 1, fixed=True),
        block("tenon", [*lower, [-0.6, 0.5]]),
        block("mortise", [*upper, [-0.6, 1.1]]),
    ]
    return wall(blocks, float(rng.uniform(0.1, 1.2)))


def t_junctions(rng: Rng) -> Assembly:
    blocks = [box("base", -1, -1, 5, 1, fixed=True)]
    lefts = np.cumsum(rng.uniform(0.5, 0.9, 3))
    blocks += [box(f"p{k}", left, 0, 0.4, 0.6) for k, left in enumerate(lefts)]
    blocks.append(box("beam", lefts[0] - 0.1, 0.6, lefts[-1] - lefts[0] + 0.6, 0.3))
    blocks += [box("top", lefts[1] - rng.uniform(0.0, 0.4), 0.9, 0.7, 0.4)]
    return wall(blocks, float(rng.uniform(0.3, 0.9)))


def corner_contacts(rng: Rng) -> Assembly:
    touch = 10.0 ** rng.uniform(-5.0, -2.0)
    blocks = [box("base", -2, -1, 6, 1, fixed=True), box("upon", 0.5, 0.0, 1.0, 0.5)]
    blocks += [box("beside", 1.5, 0.5 - touch, 0.6, 0.5), box("prop", 1.5, 0.0, 0.6, 0.5 - touch)]
    return wall(blocks)


def near_parallel(rng: Rng) -> Assembly:
    tilt = 10.0 ** rng.uniform(-7.0, -2.0) * float(rng.choice([-1.0, 1.0]))
    blocks = [
        box("left", -2, 0, 1.5, 1, fixed=True),
        block("right", [[0.5, 0], [2, 0], [2, 1], [0.5 + tilt, 1]], fixed=True),
        box("floor", -2, -1, 4, 1, fixed=True),
        block("key", [[-0.5, 0], [0.5, 0], [0.5 + tilt / 2, 0.5], [-0.5, 0.5]]),
        block("over", [[-0.5, 0.5], [0.5 + tilt / 2, 0.5], [0.5 + tilt, 1], [-0.5, 1]]),
    ]
    return wall(blocks, float(rng.uniform(0.1, 0.8)), (0.0, 1.0) if rng.random() < 0.5 else (1.0, 0.5))


def zero_weights(rng: Rng) -> Assembly:
    blocks = any_base(rng)
    for each in blocks[1:]:
        if rng.random() < 0.4:
            each["weight"] = 0.0
    return wall(blocks)


def weight_ratios(rng: Rng) -> Assembly:
    blocks = any_base(rng)
    ratio = 10.0 ** float(rng.choice([3.0, 6.0, 9.0, 12.0]))
    for each in blocks[1:]:
        each["weight"] = float(rng.uniform(0.5, 2.0)) * (ratio if rng.random() < 0.5 else 1.0)
    return wall(blocks)


def smooth(rng: Rng) -> Assembly:
    blocks = any_base(rng)
    friction = {"default": 0.0 if rng.random() < 0.5 else 0.7, "rules": [{"joint": "head", "value": 0.0}]}
    return wall(blocks, friction)


def rough(rng: Rng) -> Assembly:
    return wall(any_base(rng), 1e4)


def uneven_friction(rng: Rng) -> Assembly:
    made = wall(any_base(rng))
    return replace(made, friction=rng.uniform(0.0, 1.5, made.n_interfaces))


def idle_loads(rng: Rng) -> Assembly:
    made = wall(any_base(rng))
    live = np.zeros_like(made.live)
    k = int(rng.choice(made.free))
    live[k] = 0.3 * made.dead[k]
    return replace(made, live=live)


def lifting_loads(rng: Rng) -> Assembly:
    return wall(any_base(rng), push=(float(rng.choice([0.0, 0.3])), 1.0))


def couples(rng: Rng) -> Assembly:
    made = wall(any_base(rng))
    live = np.zeros_like(made.live)
    for k in made.free:
        live[k, 2] = float(rng.choice([-1.0, 0.0, 1.0])) * abs(made.dead[k, 1]) * 0.3
    live[made.free[0], 2] = live[made.free[0], 2] or 1.0
    return replace(made, live=live)


def loads_on_supports(rng: Rng) -> Assembly:
    made = wall(any_base(rng))
    live = np.zeros_like(made.live)
    live[made.fixed, 0] = 1.0
    return replace(made, live=live if rng.random() < 0.5 else np.zeros_like(live))


def side_gravity(rng: Rng) -> Assembly:
    made = wall(any_base(rng), float(rng.uniform(0.4, 1.0)))
    angle = rng.uniform(-0.3, 0.3)
    dead = made.dead.copy()
    dead[:, 0] = dead[:, 1] * np.sin(angle)
    dead[:, 1] = dead[:, 1] * np.cos(angle)
    return replace(made, dead=dead)


def millimetres(rng: Rng) -> Assembly:
    blocks = any_base(rng)
    for each in blocks:
        each["polygon"] = [[round(1000.0 * x), round(1000.0 * y)] for x, y in each["polygon"]]
    return wall(blocks, units={"length": "mm", "force": "kN"})


def kilometres(rng: Rng) -> Assembly:
    blocks = any_base(rng)
    for each in blocks:
        each["polygon"] = [[1e-3 * x, 1e-3 * y] for x, y in each["polygon"]]
    return wall(blocks)


def offsets(rng: Rng) -> Assembly:
    """Blocks out of place by 1e-9 to 1e-3 of their size, with faces that overlap or gape by as much."""
    made = wall(any_base(rng))
    size = 10.0 ** rng.uniform(-9.0, -3.0) * made.length_scale
    shift = rng.uniform(-size, size, (4, made.n_interfaces, 2))
    end1, end2 = made.end1 + shift[0], made.end2 + shift[1]
    along = (end2 - end1) / np.linalg.norm(end2 - end1, axis=1)[:, None]
    turned = np.column_stack([-along[:, 1], along[:, 0]])
    turned *= np.sign((turned * made.normal).sum(axis=1))[:, None]
    return replace(made, end1=end1, end2=end2, normal=turned)


def arches(rng: Rng) -> Assembly:
    thin = rng.uniform(0.1, 0.3)
    pattern = {"type": "ring", "inner_radius": 1.0, "outer_radius": 1.0 + thin, "count": 5, "angles": [160.0, 20.0]}
    live = {"live": {"body": [{"per_weight": [1.0, 0.0]}]}}
    data = {"format": "wall/1", "unit_weight": 20.0, "friction": 0.7, "pattern": pattern, "loads": live}
    return build(Wall.model_validate(data)).assembly


KINDS: tuple[Callable[[Rng], Assembly], ...] = (
    slivers,
    dovetails,
    mortises,
    t_junctions,
    corner_contacts,
    near_parallel,
    zero_weights,
    weight_ratios,
    smooth,
    rough,
    uneven_friction,
    idle_loads,
    lifting_loads,
    couples,
    loads_on_supports,
    side_gravity,
    millimetres,
    kilometres,
    offsets,
    arches,
)
