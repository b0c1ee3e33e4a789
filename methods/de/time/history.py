"""A wall on ground that accelerates, followed in time by distinct elements: rigid blocks in pymunk.

In the frame of the ground blocks carry their weight W and the inertial force -a W / g of its acceleration a. Contacts
are rigid, with Coulomb's friction and impacts without restitution (Moreau 1988), which pymunk solves by sequential
impulses. At the impact of a slender block on its other edge this is the law of Housner (1963), angular velocity after
over before 1 - (3/2) sin^2(alpha): `methods.de.time.impact` measures it.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from harness.model.assembly import Assembly, FloatArray
from harness.model.deadline import Deadline
from harness.model.ground_motion import GroundMotion
from harness.model.method import Finding
from methods.de.engines.pymunk_blocks import BodyTuning, PymunkBlocks
from methods.de.settings import TimeSteps
from methods.de.time.fallen import Stillness, below_supports, fallen_blocks, patience


@dataclass(frozen=True, eq=False)
class TimeHistory:
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


class Count(NamedTuple):
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


def count_steps(assembly: Assembly, motion: GroundMotion, gravity: float, steps: TimeSteps) -> Count:
    """The steps of a motion; gravity in lengths of the wall per s2."""
    step = steps.time_step * float(np.sqrt(assembly.length_scale / gravity))
    moving, after = (int(np.ceil(seconds / step)) for seconds in (motion.duration, steps.after))
    frames = min(steps.frames, max(200, 100 * steps.frames // assembly.n_blocks))
    return Count(step, moving, after, int(np.ceil((moving + after) / frames)))


_SETTLING = 2000
"""Steps in which contacts are loaded at most: an arch of 13 voussoirs takes 300."""
_BALANCED = 1e-6
"""Out-of-balance acceleration of a wall whose contacts are loaded, as a part of gravity."""


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


def follow(assembly: Assembly, motion: GroundMotion, gravity: float, steps: TimeSteps) -> TimeHistory:
    """Follow a wall from rest until it has fallen, all motion has died, or the time is over.

    It has fallen when a block lies below all supports. Once the ground does no more work it has also fallen when a
    block has (`fallen_blocks`) and either the energy of the wall is less than at rest as drawn, so that it cannot come
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
    still = Stillness(int(np.ceil(patience(assembly) / (count.stride * steps.time_step))), assembly.length_scale)
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
        if below_supports(assembly, places[-1]).any():
            finding = Finding.FALLS
        elif made >= count.moving:
            at_rest = still.lasts(places[-1], space.speed())
            fallen = fallen_blocks(assembly, places[-1]).any()
            if fallen and (at_rest or space.energy() < 0.0):
                finding = Finding.FALLS
            elif at_rest:
                finding = Finding.STANDS
    return TimeHistory(
        finding,
        np.array(times),
        np.array(places),
        space.energy() * assembly.force_scale / max(assembly.n_free, 1) * assembly.length_scale,
        tuple(np.flatnonzero(fallen_blocks(assembly, places[-1])).tolist()),
        at_rest,
        made,
    )
