"""The judge of walls that have moved far: that one stands, or just bears a load, and falls a hair further.

The wall is put together from the places of its blocks by complex numbers, apart from the methods. The ends of each
joint are points of both its blocks; where they meet they are a contact, and an end that has parted bears nothing.
Forces at the contacts in equilibrium with the dead load, within yield, show that the wall can stand there. A dilatant
mechanism with the supports at rest on which the dead load does work shows that no forces exist. Residuals are relative:
lengths to the size of a block, velocities to the fastest vertex.

supports           distance of a support from the place to which its prescribed motion leads by finite rotations
interpenetration   depth by which blocks share area, or by which a joint has closed beyond touching
parted             normal force at an end that has parted, beside the mean weight of a block
sliding            distance along a joint of the two points of a contact
lifted             distance across the joint of an end that bore force where the wall last stood
further            distance from where the wall last bore a load to where it falls, of a collapse that goes on
closings           closing velocity at a contact, beyond dilatant flow
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import shapely
from numpy.typing import NDArray

from harness.engine.judge_dead_load import GAIN, IMMENSE
from harness.engine.judge_decision import UNCOUNTABLE, countable, said_of
from harness.engine.judge_law import beyond_lift
from harness.engine.reaction_judge import held
from harness.engine.residuals import block_sums, force_residuals, power
from harness.model.assembly import Assembly, BoolArray, FloatArray
from harness.model.displaced import carried
from harness.model.followed import FollowedWall
from harness.model.geometry import shapes_of
from harness.model.limit import gross_power
from harness.model.result import Judgement, fastest_vertex, relative_velocities

_MEETS = 1e-9
"""Distance, in sizes of a block, up to which the two points of an end meet: pins are closed to 1e-13."""
_DEPTH = 1e-9
"""Depth of a common area, in sizes of a block, that is rounding of places."""
_FURTHER = 1e-4
"""Distance, in sizes of a block, within which a collapse that goes on ends: a proof of the fall takes 1e-7, and from
further away the last multiplier is not zero to three digits of the first."""


@dataclass(frozen=True, eq=False)
class _Moved:
    """A wall put together at the places of its blocks.

    Attributes:
        assembly: of it, an end that has parted on the line of its joint; meets: (m, 2) ends that are contacts.
        gap: (m, 2) distance of the two points of each end, across the joint [length].
        residuals: of its places: supports, interpenetration, sliding.
    """

    assembly: Assembly
    meets: BoolArray
    gap: FloatArray
    residuals: dict[str, float]


def judge_last_state(assembly: Assembly, states: FollowedWall, tolerance: float) -> tuple[Judgement, ...]:
    """What is said of the last state of a wall whose supports move and, where there is one, of the fall.

    Args:
        assembly, tolerance: as for `judge_settled`.
        states: of the wall, with reactions.
    """
    at, value = float(states.displacement[-1]), float(states.value[-1])
    last = judge_settled(assembly, at, states.places[-1], value, states.forces[-1], tolerance)
    return (last, *_judge_end(assembly, states, states.falls, tolerance))


def judge_every_state(assembly: Assembly, states: FollowedWall, tolerance: float) -> tuple[Judgement, ...]:
    """What is said of all states of a collapse that goes on and, where there is one, of the fall.

    Args:
        assembly, tolerance: as for `judge_moved_collapse`.
        states: of the wall, with multipliers.
    """
    said = [
        judge_moved_collapse(assembly, places, value, forces, mechanism, tolerance)
        for places, value, forces, mechanism in zip(
            states.places, states.value.tolist(), states.forces, states.mechanisms, strict=True
        )
    ]
    return (*said, *(_no_further(assembly, states, fall) for fall in _judge_end(assembly, states, 0.0, tolerance)))


def _no_further(assembly: Assembly, states: FollowedWall, fall: Judgement) -> Judgement:
    """What is said of a fall, which has to lie a hair beyond the last state."""
    assert states.fallen is not None
    ways = zip(carried(assembly, states.places[-1]), carried(assembly, states.fallen), strict=True)
    further = max(float(abs(there - here).max()) for here, there in ways) / assembly.length_scale
    if further <= _FURTHER:
        return fall
    sentence = f"{fall.sentence} The last state lies {further:.3g} sizes of a block before, at most {_FURTHER:g} do."
    update = {"residuals": fall.residuals | {"further": further}, "accepted": False, "sentence": sentence}
    return fall.model_copy(update=update)


def states_in_words(said: tuple[Judgement, ...]) -> str:
    """How many states of an answer are accepted."""
    rejected = [each.sentence for each in said if not each.accepted]
    number = len(said)
    if rejected:
        return f"The judge rejects {len(rejected)} of {number} states: {rejected[0]}"
    return f"The judge accepts {'the state' if number == 1 else f'all {number} states'}."


def judged_as_one(said: tuple[Judgement, ...]) -> Judgement:
    """One judgement of all states of an answer, accepted where each is; the residuals are the largest of each name."""
    residuals: dict[str, float] = {}
    for each in said:
        residuals |= {name: max(value, residuals.get(name, value)) for name, value in each.residuals.items()}
    accepted = all(each.accepted for each in said)
    return Judgement(
        residuals=residuals, tolerance=said[0].tolerance, accepted=accepted, sentence=states_in_words(said)
    )


def _judge_end(
    assembly: Assembly, states: FollowedWall, displacement: float | None, tolerance: float
) -> tuple[Judgement, ...]:
    """What is said of the fall behind the last state; nothing where none was found."""
    if displacement is None or states.fallen is None or states.falling is None:
        return ()
    bore = states.forces[-1]
    return (judge_settled_fall(assembly, displacement, states.fallen, states.falling, tolerance, bore=bore),)


def judge_settled(
    assembly: Assembly, displacement: float, places: FloatArray, reaction: float, forces: FloatArray, tolerance: float
) -> Judgement:
    """Whether a wall can stand where the supports have moved in the direction of their prescribed motion.

    Args:
        assembly: the wall as drawn with its `support_motion`; dry joints, no bars, dead loads through the centroids.
        displacement: that multiple.
        places: (n, 3) displacements of the centroids [length] and rotations [rad].
        reaction: work of the contact forces on the present motion of the supports.
        forces: (m, 3) contact forces, along the joints as they have turned [force].
        tolerance: the largest residual that is acceptable.
    """
    if not all(countable(each) for each in (displacement, places, reaction, forces)):
        return said_of(tolerance, False, UNCOUNTABLE)
    moved = _put_together(assembly, displacement, places)
    wall = moved.assembly
    parted = float(abs(np.where(moved.meets, 0.0, forces[:, :2])).max(initial=0.0))
    work = max(assembly.force_scale * (fastest_vertex(wall, wall.support_motion) or 1.0), abs(reaction))
    shown = power(block_sums(wall, forces), wall.support_motion)
    residuals = moved.residuals | force_residuals(wall, forces, 0.0)
    residuals |= {
        "parted": parted * assembly.n_free / assembly.force_scale,
        "reaction": abs(shown - reaction) / work,
    }
    return held(residuals, tolerance, "Places and forces where the wall last stands were")


def judge_moved_collapse(
    assembly: Assembly,
    places: FloatArray,
    multiplier: float,
    forces: FloatArray,
    mechanism: FloatArray,
    tolerance: float,
) -> Judgement:
    """Whether a wall, its supports at rest, bears just this multiple of its live load where its blocks have moved to.

    Forces within yield show that it bears as much. A dilatant mechanism on which the live load works forwards shows by
    virtual work that it bears no more; where nothing slides in it, it is a collapse state of any flow.

    Args:
        assembly: the wall as drawn; dry joints, no bars, dead and live loads through the centroids.
        places: (n, 3) displacements of the centroids [length] and rotations [rad].
        multiplier: of the live load.
        forces: (m, 3) contact forces, along the joints as they have turned [force]; mechanism: (n, 3) at any scale.
        tolerance: the largest residual that is acceptable.
    """
    if not all(countable(each) for each in (places, multiplier, forces, mechanism)):
        return said_of(tolerance, False, UNCOUNTABLE)
    moved = _put_together(assembly, 0.0, places)
    wall = moved.assembly
    parted = float(abs(np.where(moved.meets, 0.0, forces[:, :2])).max(initial=0.0))
    motion = mechanism / (fastest_vertex(wall, mechanism) or 1.0)
    opening, slip = relative_velocities(wall, motion)
    beyond = beyond_lift(wall, opening, slip)
    live = power(wall.live, motion)
    bears = -power(wall.dead, motion) / live if live > 0.0 else None
    residuals = moved.residuals | force_residuals(wall, forces, multiplier)
    residuals |= {
        "parted": parted * assembly.n_free / assembly.force_scale,
        "moving_supports": fastest_vertex(wall, np.where(wall.fixed[:, None], motion, 0.0)),
        "closings": max(0.0, float(np.where(moved.meets, -beyond, 0.0).max(initial=0.0))),
        "virtual_work": 1.0 if bears is None else abs(bears - multiplier) / max(assembly.load_unit, abs(multiplier)),
    }
    return held(residuals, tolerance, "Places, forces and mechanism were")


def judge_settled_fall(
    assembly: Assembly,
    displacement: float,
    places: FloatArray,
    mechanism: FloatArray,
    tolerance: float,
    *,
    bore: FloatArray,
) -> Judgement:
    """Whether a wall falls where the supports have moved in the direction of their prescribed motion and rest.

    Args:
        assembly, displacement, places, tolerance: as for `judge_settled`.
        mechanism: (n, 3) motion of all blocks.
        bore: (m, 3) contact forces where it last stood; blocks lifted off what bore them fall anywhere.
    """
    if not all(countable(each) for each in (displacement, places, mechanism, bore)):
        return said_of(tolerance, False, UNCOUNTABLE)
    moved = _put_together(assembly, displacement, places)
    wall = moved.assembly
    borne = bore[:, :2] * assembly.n_free > tolerance * assembly.force_scale
    speed = fastest_vertex(wall, mechanism) or 1.0
    motion = mechanism / speed
    opening, slip = relative_velocities(wall, motion)
    beyond = np.where(moved.meets, beyond_lift(wall, opening, slip), 0.0)
    closings = np.maximum(0.0, -beyond)
    gain = power(wall.dead, motion)
    enough = max(GAIN * gross_power(wall, motion), IMMENSE * wall.force_scale * float(closings.sum()))
    residuals = moved.residuals | {
        "lifted": float(np.where(borne, moved.gap, 0.0).max(initial=0.0)) / assembly.length_scale,
        "moving_supports": fastest_vertex(wall, np.where(wall.fixed[:, None], motion, 0.0)),
        "closings": float(closings.max(initial=0.0)),
        "no_work": 0.0 if gain > enough else 1.0,
    }
    return held(residuals, tolerance, "Places and mechanism where the wall falls were")


def _put_together(assembly: Assembly, displacement: float, places: FloatArray) -> _Moved:
    """The wall at these places, about its middle, where coordinates have the most digits."""
    middle_of_wall = complex(*assembly.middle)
    size = assembly.length_scale
    turn = np.exp(1j * places[:, 2])
    was = _complex(assembly.centroid) - middle_of_wall
    centre = was + _complex(places)

    def of(block: NDArray[np.int64], points: FloatArray) -> NDArray[np.complex128]:
        return np.asarray(centre[block] + turn[block] * (_complex(points) - middle_of_wall - was[block]))

    half = np.exp(0.5j * (places[assembly.block_a, 2] + places[assembly.block_b, 2]))
    normal, tangent = half * _complex(assembly.normal), half * _complex(assembly.tangent)
    pairs = [[of(side, end) for side in (assembly.block_a, assembly.block_b)] for end in (assembly.end1, assembly.end2)]
    apart = np.column_stack([b - a for a, b in pairs])
    gap, shift = ((apart * axis.conj()[:, None]).real for axis in (normal, tangent))
    meets = gap <= _MEETS * size
    middle = [0.5 * (a + b) for a, b in pairs]
    along = assembly.length * tangent
    first = np.where(~meets[:, 0] & meets[:, 1], middle[1] - along, middle[0])
    second = np.where(meets[:, 0] & ~meets[:, 1], middle[0] + along, middle[1])
    second = np.where(meets.any(axis=1), second, first + along)
    parts = [
        _pairs(centre[k] + turn[k] * (_complex(polygon) - middle_of_wall - was[k]))
        for k, polygon in enumerate(assembly.polygons)
    ]
    velocity = _complex(assembly.support_motion) * np.exp(1j * displacement * assembly.support_motion[:, 2])
    end1, end2 = _pairs(first), _pairs(second)
    wall = replace(
        assembly,
        polygons=tuple(parts),
        centroid=_pairs(centre),
        normal=_pairs(normal),
        end1=end1,
        end2=end2,
        face1=end1,
        face2=end2,
        support_motion=np.column_stack([_pairs(velocity), assembly.support_motion[:, 2]]),
    )
    closed = max(0.0, float((-gap).max(initial=0.0)))
    residuals = {
        "supports": _off_their_way(assembly, displacement, places) / size,
        "interpenetration": max(closed, _depth(parts, assembly.fixed, _DEPTH * size)) / size,
        "sliding": float(abs(np.where(meets, shift, 0.0)).max(initial=0.0)) / size,
    }
    return _Moved(wall, meets, gap, residuals)


def _off_their_way(assembly: Assembly, displacement: float, places: FloatArray) -> float:
    """Largest distance of a vertex of a support from where its motion leads [length].

    A motion (v, omega) turns about the pole at v i / omega from the centroid; a translation has none.
    """
    worst = 0.0
    for k in np.flatnonzero(assembly.fixed).tolist():
        x, y, omega = assembly.support_motion[k]
        points = _complex(assembly.polygons[k] - assembly.centroid[k])
        there = complex(*places[k, :2]) + np.exp(1j * places[k, 2]) * points
        if omega:
            pole = 1j * complex(x, y) / omega
            wanted = pole + np.exp(1j * displacement * omega) * (points - pole)
        else:
            wanted = points + displacement * complex(x, y)
        worst = max(worst, float(abs(there - wanted).max()))
    return worst


def _depth(polygons: list[FloatArray], fixed: BoolArray, rounding: float) -> float:
    """Largest common area of two blocks, not both supports, over the shorter outline [length]; 0 for rounding."""
    shapes = shapes_of(polygons)
    i, j = shapely.STRtree(shapes).query(shapes, predicate="intersects")
    pairs = (i < j) & ~(fixed[i] & fixed[j])
    i, j = i[pairs], j[pairs]
    outline = shapely.length(shapes)
    # Without a grid the common area of two faces that coincide to rounding may come out as a whole block.
    common = shapely.intersection(shapes[i], shapes[j], grid_size=0.1 * rounding)
    depth = shapely.area(common) / np.minimum(outline[i], outline[j])
    deepest = float(depth.max(initial=0.0))
    return deepest if deepest > rounding else 0.0


def _complex(vectors: FloatArray) -> NDArray[np.complex128]:
    """x + i y of vectors (..., 2 or more)."""
    return np.asarray(vectors[..., 0] + 1j * vectors[..., 1])


def _pairs(points: NDArray[np.complex128]) -> FloatArray:
    return np.stack([points.real, points.imag], axis=-1)
