"""Cooked answers: wrong on purpose, each of a kind, about walls of which it is known by other means what is true.

Each kind leads the judge astray in its own way: with forces that hide others, with violations that are small one by
one, with numbers that are compared in the units of something else. Many are the best of a linear programme: the largest
gain, or the smallest violation, that an answer which is false can have.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
from scipy.optimize import linprog

from harness.model.displaced import DisplacedState
from harness.model.method import Answer, Finding
from tests.best_cheats import bearing, gaining, self_stress, strains
from tests.known_claims import SLACK, Rng, any_claim, base, claim, collapse, loads, magnitude
from tests.known_walls import WALLS, Item, item

Cook = Callable[[Rng, Item], Answer | None]


def self_stress_over_wrong_forces(rng: Rng, item: Item) -> Answer | None:
    """Forces of a right state at another multiplier, under self-stress that dwarfs what is missing."""
    answer, stress = base(rng, item), self_stress(rng, item.wall)
    assert answer.forces is not None
    forces = answer.forces + magnitude(rng, 0.0, 15.0) * abs(item.wall.dead).max() * stress
    return any_claim(rng, item, replace(answer, forces=forces), collapse(rng, item))


def self_stress_alone(rng: Rng, item: Item) -> Answer | None:
    """Self-stress in powers of two, which floating-point numbers hold exactly, and nothing that bears the loads."""
    forces = 2.0 ** np.ceil(rng.uniform(0.0, 60.0)) * np.round(self_stress(rng, item.wall), 3)
    return any_claim(rng, item, replace(base(rng, item), forces=forces), collapse(rng, item))


def self_stress_over_tension(rng: Rng, item: Item) -> Answer | None:
    """Forces in equilibrium that pull, under self-stress that dwarfs the tension."""
    at, wall = collapse(rng, item), item.wall
    heaviest = abs(wall.dead).max()
    forces = bearing(rng, wall, loads(wall, at), 100.0 * heaviest, tension=10.0)
    if forces is None:
        return None
    forces = forces + magnitude(rng, 0.0, 15.0) * heaviest * self_stress(rng, wall)
    return any_claim(rng, item, replace(base(rng, item), forces=forces), at)


def immense_forces(rng: Rng, item: Item) -> Answer | None:
    """Forces up to 1e15 loads that balance a load that cannot be borne as well as they can."""
    at, wall = collapse(rng, item), item.wall
    forces = bearing(rng, wall, loads(wall, at), magnitude(rng, 0.0, 15.0) * abs(wall.dead).max())
    return None if forces is None else any_claim(rng, item, replace(base(rng, item), forces=forces), at)


def closings_that_gain(rng: Rng, item: Item) -> Answer | None:
    """A fall by the motion that gains most of closings that are small one by one."""
    motion = gaining(item.wall, item.wall.dead, magnitude(rng, -12.0, -5.0), magnitude(rng, -3.0, 3.0))
    return claim(base(rng, item), Finding.FALLS, None, mechanism=motion)


def closings_in_the_proof(rng: Rng, item: Item) -> Answer | None:
    """The same, as the proof beside a motion that was measured."""
    motion = gaining(item.wall, item.wall.dead, magnitude(rng, -12.0, -5.0), magnitude(rng, -3.0, 3.0))
    details = {} if motion is None else {"dilatant_mechanism": motion.tolist()}
    return claim(base(rng, item), Finding.FALLS, None, flow="approximate", details=details)


def closings_under_live_load(rng: Rng, item: Item) -> Answer | None:
    """A collapse by the motion on which the live load does most work, with forces of a multiplier that is borne."""
    at, wall = collapse(rng, item), item.wall
    motion = gaining(wall, loads(wall, at), magnitude(rng, -12.0, -5.0), magnitude(rng, -3.0, 3.0))
    forces = bearing(rng, wall, loads(wall, at), 100.0 * abs(wall.dead).max())
    if motion is None or forces is None:
        return None
    return claim(base(rng, item), Finding.COLLAPSES, at, mechanism=motion, forces=forces, flow="associated")


def other_multiplier(rng: Rng, item: Item) -> Answer | None:
    """A right state, with another multiplier than that of its forces."""
    answer = base(rng, item)
    return claim(answer, Finding.COLLAPSES, collapse(rng, item), forces_multiplier=answer.multiplier or 0.0)


def higher_lower_end(rng: Rng, item: Item) -> Answer | None:
    """A bracket that begins above what its forces bear."""
    answer, low = base(rng, item), collapse(rng, item)
    bracket, at = (low, 2.0 * low + 1.0), answer.multiplier or 0.0
    return claim(answer, Finding.COLLAPSES, low, flow="approximate", bracket=bracket, forces_multiplier=at)


def ray_of_small_violations(rng: Rng, item: Item) -> Answer | None:
    """No end, by forces that balance the live load but for violations that are small."""
    wall, answer = item.wall, base(rng, item)
    most = magnitude(rng, 0.0, 12.0) * (abs(wall.live).max() or 1.0)
    ray = bearing(rng, wall, wall.live, most, tension=magnitude(rng, -13.0, -4.0))
    if ray is None:
        return None
    ray = ray + magnitude(rng, -3.0, 14.0) * abs(wall.dead).max() * self_stress(rng, wall)
    details = answer.details | {"live_forces": ray.tolist()}
    at = answer.multiplier or 0.0
    return claim(answer, Finding.UNBOUNDED, None, forces_multiplier=at, details=details)


def another_mechanism(rng: Rng, item: Item) -> Answer | None:
    """A right mechanism with forces of another multiplier, as good as there are."""
    at, wall = collapse(rng, item), item.wall
    forces = bearing(rng, wall, loads(wall, at), magnitude(rng, 0.0, 6.0) * abs(wall.dead).max())
    return None if forces is None else claim(base(rng, item), Finding.COLLAPSES, at, forces=forces)


def heavy_block_that_creeps(rng: Rng, item: Item) -> Answer | None:
    """A mechanism in which every block creeps besides, by so little that the loads of heavy ones do work."""
    answer, wall = base(rng, item), item.wall
    assert answer.mechanism is not None
    creep = magnitude(rng, -15.0, -6.0) * rng.normal(size=(wall.n_blocks, 3)) * ~wall.fixed[:, None]
    at = collapse(rng, item)
    more = {"forces_multiplier": at} if rng.random() < 0.5 else {"forces_multiplier": answer.multiplier or 0.0}
    return claim(answer, Finding.COLLAPSES, at, mechanism=answer.mechanism + creep, **more)


def fast_and_slow(rng: Rng, item: Item) -> Answer | None:
    """Another motion of one block, which flies or hardly moves beside the rest."""
    answer, wall = base(rng, item), item.wall
    assert answer.mechanism is not None
    motion = answer.mechanism.copy()
    motion[rng.choice(wall.free)] = magnitude(rng, -14.0, 14.0) * rng.normal(size=3)
    return claim(answer, (Finding.COLLAPSES, Finding.FALLS)[rng.integers(2)], collapse(rng, item), mechanism=motion)


def supports_that_move(rng: Rng, item: Item) -> Answer | None:
    """The wall moves with its supports, fast or hardly, which gains dead work without any closing."""
    answer, wall = base(rng, item), item.wall
    motion = np.zeros((wall.n_blocks, 3))
    motion[:, :2] = rng.normal(size=2)
    motion = motion + magnitude(rng, -14.0, 0.0) * rng.normal(size=motion.shape)
    if rng.random() < 0.5:
        motion[wall.fixed] *= magnitude(rng, -14.0, 0.0)
    return claim(answer, (Finding.COLLAPSES, Finding.FALLS)[rng.integers(2)], collapse(rng, item), mechanism=motion)


def ends_exchanged(rng: Rng, item: Item) -> Answer | None:
    """Forces at the wrong ends, of the wrong sign, of the wrong joint, or none."""
    answer = base(rng, item)
    assert answer.forces is not None
    forces = [
        answer.forces[:, [1, 0, 2]],
        answer.forces * [1.0, 1.0, -1.0],
        np.roll(answer.forces, 1, axis=0),
        0.0 * answer.forces,
        -answer.forces,
    ][rng.integers(5)]
    return any_claim(rng, item, replace(answer, forces=forces), collapse(rng, item))


def digits_dropped(rng: Rng, item: Item) -> Answer | None:
    """A right state written with few digits, at a multiplier that is off by more."""
    answer, digits = base(rng, item), int(rng.integers(1, 9))
    assert answer.forces is not None
    forces = np.vectorize(lambda value: float(f"{value:.{digits}g}"))(answer.forces)
    return any_claim(rng, item, replace(answer, forces=forces), collapse(rng, item))


def other_finding(rng: Rng, item: Item) -> Answer | None:
    """A right state under another finding, with its forces as a ray and its mechanism as a proof."""
    answer = base(rng, item)
    assert answer.forces is not None
    assert answer.mechanism is not None
    details = {"live_forces": answer.forces.tolist(), "dilatant_mechanism": answer.mechanism.tolist()}
    finding = (Finding.FALLS, Finding.STANDS, Finding.UNBOUNDED)[rng.integers(3)]
    return claim(answer, finding, None, details=details, forces_multiplier=answer.multiplier or 0.0)


def displaced(rng: Rng, item: Item) -> Answer | None:
    """Forces where the blocks are said to have moved to: at invented points, across other faces, on moved supports."""
    wall, at = item.wall, collapse(rng, item)
    m, n = wall.n_interfaces, wall.n_blocks
    forces = bearing(rng, wall, loads(wall, at), magnitude(rng, 0.0, 9.0) * abs(wall.dead).max())
    if forces is None:
        return None
    half = 0.5 * forces[:, 2:] * wall.tangent
    force = np.stack([forces[:, :1] * wall.normal + half, forces[:, 1:2] * wall.normal + half], axis=1).reshape(-1, 2)
    interface = np.repeat(np.arange(m), 2)
    point, normal = np.stack([wall.end1, wall.end2], axis=1).reshape(-1, 2), np.repeat(wall.normal, 2, axis=0)
    places, onto = np.zeros((n, 3)), wall.block_b[interface]
    match rng.integers(5):
        case 0:
            point = point + magnitude(rng, -1.0, 1.0) * rng.normal(size=point.shape)
        case 1:
            normal = force / np.maximum(np.hypot(*force.T), 1e-300)[:, None]
        case 2:
            places[wall.fixed] = magnitude(rng, -3.0, 1.0) * rng.normal(size=3)
        case 3:
            places[wall.free] = magnitude(rng, -1.0, 1.0) * rng.normal(size=(wall.n_free, 3))
        case _:
            normal = normal * magnitude(rng, -9.0, 9.0)
    state = DisplacedState(places, interface, onto, point, normal, force)
    answer = any_claim(rng, item, replace(base(rng, item), forces=None, flow="approximate"), at)
    return replace(answer, forces=None, flow="approximate", details=state.as_details())


def small_violations_of_flow(rng: Rng, item: Item) -> Answer | None:
    """The motion on which the live load does most work among those that break flow and complementarity by little."""
    at, wall = collapse(rng, item), item.wall
    forces = bearing(rng, wall, loads(wall, at), 100.0 * abs(wall.dead).max())
    if forces is None:
        return None
    little, m = magnitude(rng, -12.0, -6.0), wall.n_interfaces
    strength, small = wall.friction * forces[:, :2].sum(axis=1), 1e-9 * abs(forces).max()
    low, high = np.full((m, 3), -little), np.full((m, 3), little)
    high[:, :2][forces[:, :2] <= small] = np.inf
    high[:, 2][strength + forces[:, 2] <= small] = np.inf
    low[:, 2][strength - forces[:, 2] <= small] = -np.inf
    inside = np.concatenate([high.ravel(), -low.ravel()])
    rows = np.vstack([strains(wall), -strains(wall)])[np.isfinite(inside)]
    size = magnitude(rng, -3.0, 3.0)
    bounds = [(0.0, 0.0) if wall.fixed[block] else (-size, size) for block in range(wall.n_blocks) for _ in range(3)]
    cost = -wall.live.ravel() / (abs(wall.live).max() or 1.0)
    answer = linprog(cost, A_ub=rows, b_ub=inside[np.isfinite(inside)], bounds=bounds)
    if answer.status != 0:
        return None
    motion = answer.x.reshape(-1, 3)
    return claim(base(rng, item), Finding.COLLAPSES, at, forces=forces, mechanism=motion, flow="non-associated")


def no_end_above_what_falls(rng: Rng, item: Item) -> Answer | None:
    """No end, by forces at a multiplier that is borne, on a wall that may fall before it gets there."""
    wall, at = item.wall, magnitude(rng, -3.0, 3.0)
    forces = bearing(rng, wall, loads(wall, at), 1e6 * abs(wall.dead).max())
    ray = bearing(rng, wall, wall.live, 1e6 * (abs(wall.live).max() or 1.0))
    if forces is None or ray is None:
        return None
    at = at if rng.random() < 0.8 else 0.0
    details = {"live_forces": ray.tolist()}
    return claim(base(rng, item), Finding.UNBOUNDED, None, forces=forces, forces_multiplier=at, details=details)


def share_left_unbalanced(rng: Rng, item: Item) -> Answer | None:
    """Forces of another multiplier and, of what they lack, a share so small that it may pass for rounding."""
    answer, wall = base(rng, item), item.wall
    assert answer.forces is not None
    at = (answer.multiplier or 0.5) * (1.0 + magnitude(rng, -5.9, 0.0))
    share = magnitude(rng, -9.0, 0.0)
    near = bearing(rng, wall, loads(wall, at), 1e3 * abs(wall.dead).max(), tension=magnitude(rng, -9.0, 0.0))
    if near is None:
        return None
    forces = near + share * (answer.forces - near) + magnitude(rng, 8.0, 16.0) * self_stress(rng, wall)
    return claim(answer, Finding.COLLAPSES, at, forces=forces)


def glued(rng: Rng, item: Item) -> Answer | None:
    """Forces in equilibrium that pull, or exceed friction, by what is small beside the heaviest load."""
    wall, at = item.wall, collapse(rng, item)
    heaviest = float(abs(wall.dead).max())
    forces = bearing(rng, wall, loads(wall, at), 1e3 * heaviest, tension=magnitude(rng, -14.0, -3.0))
    return None if forces is None else any_claim(rng, item, replace(base(rng, item), forces=forces), at)


def halfway(rng: Rng, item: Item) -> Answer | None:
    """The mean of two right states, or of a right state and one under the dead load, between their multipliers."""
    answer, wall, share = base(rng, item), item.wall, float(rng.random())
    dead = bearing(rng, wall, wall.dead, 1e3 * abs(wall.dead).max())
    if dead is None or answer.forces is None:
        return None
    forces, at = share * answer.forces + (1.0 - share) * dead, share * (answer.multiplier or 0.0)
    return any_claim(rng, item, replace(answer, forces=forces), at)


def backwards(rng: Rng, item: Item) -> Answer | None:
    """A state under the live load turned round, with a negative multiplier or with the sign dropped."""
    answer, wall, at = base(rng, item), item.wall, collapse(rng, item)
    forces = bearing(rng, wall, loads(wall, -at), 1e3 * abs(wall.dead).max())
    if forces is None or answer.mechanism is None:
        return None
    sign = float(rng.choice([-1.0, 1.0]))
    return claim(answer, Finding.COLLAPSES, sign * at, forces=forces, mechanism=sign * answer.mechanism)


def immense_and_tiny_numbers(rng: Rng, item: Item) -> Answer | None:
    """Numbers at the ends of the range of floating point, of which sums and products are not finite."""
    answer, size = base(rng, item), float(rng.choice([1e-320, 1e-200, 1e200, 1e307]))
    assert answer.forces is not None
    assert answer.mechanism is not None
    forces, motion = answer.forces.copy(), answer.mechanism.copy()
    if rng.random() < 0.5:
        forces[rng.integers(len(forces))] = size * rng.normal(size=3)
    motion[rng.integers(len(motion))] = size * rng.normal(size=3)
    at = float(rng.choice([collapse(rng, item), size]))
    return any_claim(rng, item, replace(answer, forces=forces, mechanism=motion), at)


def loads_of_another_wall(rng: Rng, item: Item) -> Answer | None:
    """A right state of the same blocks with other weights, or other friction."""
    wall, at = item.wall, collapse(rng, item)
    weights = wall.dead * 10.0 ** rng.uniform(-6.0, 1.0, (wall.n_blocks, 1))
    other = replace(wall, dead=weights, friction=wall.friction + magnitude(rng, -5.0, 0.0))
    forces = bearing(rng, other, loads(other, at), 1e3 * abs(wall.dead).max())
    motion = gaining(other, loads(other, at), 0.0)
    if forces is None or motion is None:
        return None
    answer = replace(base(rng, item), forces=forces, mechanism=motion)
    return any_claim(rng, item, answer, at) if rng.random() < 0.7 else claim(answer, Finding.FALLS)


def parts_of_two_states(rng: Rng, item: Item) -> Answer | None:
    """Every joint's forces from one of two states under different multipliers."""
    answer, wall, at = base(rng, item), item.wall, collapse(rng, item)
    other = bearing(rng, wall, loads(wall, at), 1e3 * abs(wall.dead).max())
    if other is None or answer.forces is None:
        return None
    forces = np.where(rng.random(wall.n_interfaces)[:, None] < 0.5, other, answer.forces)
    return any_claim(rng, item, replace(answer, forces=forces), at)


def zero_that_is_none(rng: Rng, item: Item) -> Answer | None:
    """Multipliers that are nearly nothing, and forces that are exactly those of the dead load."""
    wall, at = item.wall, float(rng.choice([0.0, 1e-300, 1e-17, -1e-17, 1e-12]))
    dead = bearing(rng, wall, wall.dead, 1e3 * abs(wall.dead).max())
    if dead is None:
        return None
    said_at = float(rng.choice([at, collapse(rng, item)]))
    return claim(base(rng, item), Finding.COLLAPSES, said_at, forces=dead, forces_multiplier=at)


KINDS: tuple[Cook, ...] = (
    self_stress_over_wrong_forces,
    self_stress_alone,
    self_stress_over_tension,
    immense_forces,
    closings_that_gain,
    closings_in_the_proof,
    closings_under_live_load,
    other_multiplier,
    higher_lower_end,
    ray_of_small_violations,
    another_mechanism,
    heavy_block_that_creeps,
    fast_and_slow,
    supports_that_move,
    ends_exchanged,
    digits_dropped,
    other_finding,
    displaced,
    small_violations_of_flow,
    no_end_above_what_falls,
    share_left_unbalanced,
    glued,
    halfway,
    backwards,
    immense_and_tiny_numbers,
    loads_of_another_wall,
    parts_of_two_states,
    zero_that_is_none,
)


def cook(number: int, slack: float = SLACK) -> tuple[str, str, Item, Answer] | None:
    """The cooked answer of a number: wall, kind, and the two; None where the kind has none, or one that is true.

    True are also those that are off by less than the accuracy a thousand times the judge's tolerance would allow.
    """
    names = list(WALLS)
    kind = KINDS[number % len(KINDS)]
    name = names[number // len(KINDS) % len(names)]
    it = item(name)
    answer = kind(np.random.default_rng(number), it)
    if answer is None or not it.denies(answer, slack):
        return None
    return name, kind.__name__, it, answer
