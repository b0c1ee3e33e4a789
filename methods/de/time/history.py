"""A wall on ground that accelerates, followed in time by distinct elements: rigid blocks in pymunk.

In the frame of the ground blocks carry their weight W and the inertial force -a W / g of its acceleration a. Contacts
are rigid, with Coulomb's friction and impacts without restitution (Moreau 1988), which pymunk solves by sequential
impulses. At the impact of a slender block on its other edge this is the law of Housner (1963), angular velocity after
over before 1 - (3/2) sin^2(alpha): `methods.de.time.impact` measures it.
"""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from harness.model.assembly import Assembly, BoolArray, FloatArray, polygon_area
from harness.model.deadline import Deadline
from harness.model.ground_motion import GroundMotion
from harness.model.method import Finding
from methods.de.engines.pymunk_blocks import BodyTuning, PymunkBlocks
from methods.de.settings import TimeSteps

_SETTLING = 2000
"""Steps in which contacts are loaded at most: an arch of 13 voussoirs takes 300."""
_BALANCED = 1e-6
"""Out-of-balance acceleration of a wall whose contacts are loaded, as a part of gravity."""
_TURNED = np.pi / 3.0
"""A block that has turned so far has tipped over: one that rocks turns back from less than atan(b / h)."""
_DROPPED = 0.5
"""A block has dropped off its seat whose centroid is so much of its size, the square root of its area, too low."""
_SLOW = 1e-3
"""Speed of a wall at rest [sqrt(size x gravity)]: a fall over a millionth of the size makes more."""
_STILL = 1e-4
"""Displacement within `_patience` of a wall at rest, in sizes of a block."""


@dataclass(frozen=True, eq=False)
class _TimeHistory:
    """A motion that was followed. k states.

    Attributes:
        finding: stands, falls, or none where neither was shown.
        time: (k,) of the states [s].
        places: (k, n, 3) displacements of the centroids from where they were drawn [length] and rotations [rad].
        energy: kinetic and potential in the end, zero for the wall at rest as drawn [force x length]; nan: no number.
        fallen: (n,) indices of the blocks that have fallen in the end.
        at_rest: whether all motion has died.
        steps: time steps made.
    """

    finding: Finding
    time: FloatArray
    places: FloatArray
    energy: float
    fallen: tuple[int, ...]
    at_rest: bool
    steps: int


def tuning(steps: TimeSteps) -> BodyTuning:
    """Of the blocks in pymunk."""
    return BodyTuning(steps.time_step, steps.radius, steps.slop)


class _Count(NamedTuple):
    """How many steps a motion takes.

    Attributes:
        step: length of a step [s].
        moving: steps while the ground accelerates.
        after: steps that follow at most.
        stride: steps between two states that are kept.
    """

    step: float
    moving: int
    after: int
    stride: int


def count_steps(assembly: Assembly, motion: GroundMotion, gravity: float, steps: TimeSteps) -> _Count:
    """The steps of a motion; gravity in lengths of the wall per s2."""
    step = steps.time_step * float(np.sqrt(assembly.length_scale / gravity))
    moving, after = (int(np.ceil(seconds / step)) for seconds in (motion.duration, steps.after))
    frames = min(steps.frames, max(200, 100 * steps.frames // assembly.n_blocks))
    return _Count(step, moving, after, int(np.ceil((moving + after) / frames)))


def _load_contacts(space: PymunkBlocks, steps: TimeSteps) -> bool:
    """Let the contacts bear the dead load before anything moves: steps whose motion is taken back; whether they do.

    The solver begins a step with the impulses of the last one. Without any, an arch drops until its joints catch it.
    """
    as_drawn = np.zeros((space.assembly.n_blocks, 3))
    space.load(0.0)
    for _ in range(_SETTLING):
        space.advance(1)
        speed = space.speed()
        space.put(as_drawn)
        if speed < _BALANCED * steps.time_step:
            return True
    return False


def follow(assembly: Assembly, motion: GroundMotion, gravity: float, steps: TimeSteps) -> _TimeHistory:
    """Follow a wall from rest until it has fallen, all motion has died, or the time is over.

    It has fallen when a block lies below all supports. Once the ground does no more work it has also fallen when a
    block has (`_fallen_blocks`) and either the energy of the wall is less than at rest as drawn, so that it cannot come
    back, or all motion has died. Without such a block it stands once all motion has died.

    Args:
        assembly: dry joints, no bars, no loads but the weights of its blocks.
        motion: of the ground.
        gravity: acceleration g [length/s2].
        steps: see `TimeSteps`.

    Raises:
        OutOfTime: the time of the run is over.
    """
    count = count_steps(assembly, motion, gravity, steps)
    push = np.zeros((assembly.n_blocks, 3))
    push[:, 0] = np.where(assembly.fixed, 0.0, -assembly.weight)
    moved = replace(assembly, live=push)
    space = PymunkBlocks(moved, iterations=steps.iterations, options=tuning(steps), weighed=True)
    _load_contacts(space, steps)
    pushes = motion.means(count.step * np.arange(count.moving + 1, dtype=float))
    still = _Stillness(int(np.ceil(_patience(assembly) / (count.stride * steps.time_step))), assembly.length_scale)
    times, places = [0.0], [space.places()]
    finding, at_rest, made = Finding.NONE, False, 0
    deadline = Deadline.of_run()
    while finding is Finding.NONE and made < count.moving + count.after:
        deadline.ask()
        for push_now in pushes[made : made + count.stride]:
            space.load(float(push_now))
            space.advance(1)
        further = count.stride - len(pushes[made : made + count.stride])
        if further:
            space.load(0.0)
            space.advance(further)
        made += count.stride
        now = space.places()
        if not np.isfinite(now).all():  # the engine has failed, and nothing is found
            break
        times.append(made * count.step)
        places.append(now)
        if _below_supports(assembly, places[-1]).any():
            finding = Finding.FALLS
        elif made >= count.moving:
            at_rest = still.lasts(places[-1], space.speed())
            fallen = _fallen_blocks(assembly, places[-1]).any()
            if fallen and (at_rest or space.energy() < 0.0):
                finding = Finding.FALLS
            elif at_rest:
                finding = Finding.STANDS
    return _TimeHistory(
        finding,
        np.array(times),
        np.array(places),
        space.energy() * assembly.force_scale / max(assembly.n_free, 1) * assembly.length_scale,
        tuple(np.flatnonzero(_fallen_blocks(assembly, places[-1])).tolist()),
        at_rest,
        made,
    )


def _fallen_blocks(assembly: Assembly, places: FloatArray) -> BoolArray:
    """(n,) blocks that have tipped over or dropped off their seats.

    Args:
        assembly: the wall as drawn.
        places: (n, 3) displacements of the centroids [length] and rotations [rad].
    """
    sizes = np.sqrt([polygon_area(polygon) for polygon in assembly.polygons])
    return np.asarray((abs(places[:, 2]) > _TURNED) | (-places[:, 1] > _DROPPED * sizes))


def _below_supports(assembly: Assembly, places: FloatArray) -> BoolArray:
    """(n,) blocks that lie wholly below all supports, where nothing can stop their fall; places as `_fallen_blocks`."""
    ground = min(float(assembly.polygons[i][:, 1].min()) for i in np.flatnonzero(assembly.fixed))
    return np.asarray((assembly.centroid[:, 1] + places[:, 1] + assembly.radius < ground) & ~assembly.fixed)


def _patience(assembly: Assembly) -> float:
    """Time for which a wall at rest has to be still: 4 / p, p^2 = 3 g / (4 R) [sqrt(length_scale / gravity)].

    R is half the diagonal of the free blocks together. A block balanced on its edge, which falls as exp(p t), moves off
    within this time by 27 times (cosh 4) its distance from the balance.
    """
    corners, block = assembly.corners
    radius = 0.5 * float(np.hypot(*np.ptp(corners[~assembly.fixed[block]], axis=0)))
    return 4.0 / float(np.sqrt(0.75 * assembly.length_scale / radius))


class _Stillness:
    """Whether a wall has been at rest for long enough.

    Args:
        count: states that have to follow each other at rest.
        size: of a block [length].
    """

    def __init__(self, count: int, size: float) -> None:
        self._states: deque[FloatArray] = deque(maxlen=max(count, 2))
        self._size = size

    def lasts(self, places: FloatArray, speed: float) -> bool:
        """Take notice of a state: places (n, 3), and largest speed of a block [sqrt(size x gravity)]."""
        if not speed < _SLOW:
            self._states.clear()
            return False
        self._states.append(places * [1.0, 1.0, self._size])
        if len(self._states) < (self._states.maxlen or 0):
            return False
        return bool(np.ptp(np.array(self._states), axis=0).max(initial=0.0) < _STILL * self._size)
