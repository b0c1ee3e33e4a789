"""Least known reactions of supports that move: a support becomes a block that one load moves along its settlement.

Without dilatancy the reaction is the multiplier of a collapse state. The moving support is freed and guided by bars,
so that it moves along the settlement u_s alone, and loaded by -R f with f . u_s = 1: R is the work of the wall on the
settlement. It stands at some R0 between the extremes of associated flow, Rmin <= R0 <= Rmax. A support that pushes back
collapses the wall at R0 + lambda, one that gives way at R0 - lambda (Portioli and Cascini 2016). Collapse states and
their judge are those of any wall with props and ties (`harness.model.bars`).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

import numpy as np

from harness.engine.judge import judge
from harness.engine.pipeline import Runs
from harness.model.assembly import Assembly, FloatArray, IntArray
from harness.model.bars import Bars
from harness.model.case import Case
from harness.model.content import exact_hash_of
from harness.model.errors import InputError
from harness.model.result import Result, vertex_velocities

STRONG = 1e3
"""Yield force of the guiding bars in dead loads; an answer in which one of them yields is none."""


@dataclass(frozen=True, eq=False)
class OtherSupports:
    """A wall whose moving supports are at rest or released, as a run sees it.

    Attributes:
        case: the wall as it is described.
        assembly: the wall with its supports so.
    """

    case: Case
    assembly: Assembly

    @property
    def id(self) -> str:
        """The name of the wall."""
        return self.case.id

    @property
    def content(self) -> str:
        """Hash of the assembly."""
        return exact_hash_of(self.assembly)

    @property
    def warnings(self) -> tuple[str, ...]:
        """Those of the wall as it is described."""
        return self.case.warnings


@dataclass(frozen=True, eq=False)
class ReleasedWall:
    """A wall whose moving supports are one guided block.

    Attributes:
        assembly: of it: the joints of the wall in their order, its bars and then those that guide.
        carrier: index of the guided block; moving: indices of the supports that it stands for.
    """

    assembly: Assembly
    carrier: int
    moving: IntArray

    def result(self, case: Case, method: str, settings: Mapping[str, Any], runs: Runs) -> Result:
        """The judged answer of a method, whose multiplier is how far the reaction has changed."""
        wall = OtherSupports(case, self.assembly)
        return runs.result(wall, method, settings, partial(judge, quantity="change of the reaction", alone=True))

    def holds(self, tensions: FloatArray) -> bool:
        """Whether no guiding bar yields in tensions (k + 2,)."""
        limit = self.assembly.bars.greatest[-2:]
        return bool((abs(tensions[-2:]) < (1.0 - 1e-6) * limit).all())

    def of_wall(self, mechanism: FloatArray, drawn: Assembly) -> FloatArray:
        """The mechanism (n, 3) of the wall as drawn from that of this one (n + 1, 3), scaled to the settlement."""
        motion = drawn.support_motion[self.carrier]
        along = float(abs(mechanism[self.carrier] @ motion)) / float(motion @ motion)
        found = mechanism[:-1] / along
        sense = np.sign(found[self.carrier] @ motion)
        found[self.moving] = sense * drawn.support_motion[self.moving]
        return np.asarray(found)


def released(assembly: Assembly, reaction: float, greatest: bool) -> ReleasedWall:
    """The wall whose moving supports are a guided block that bears `reaction` under dead load.

    Args:
        assembly: with `support_motion` of one rigid motion.
        reaction: R0 [force, for a motion of length one].
        greatest: whether the live load pushes the support against its motion, R = R0 + lambda; else R = R0 - lambda.

    Raises:
        InputError: the supports do not move as one rigid body.
    """
    moving = np.flatnonzero(np.any(assembly.support_motion, axis=1))
    carrier = int(moving[0])
    motion = assembly.support_motion[carrier]
    _check_rigid(assembly, moving, motion)
    fixed, centroid = assembly.fixed.copy(), assembly.centroid
    fixed[carrier] = False
    place = np.arange(assembly.n_blocks)
    place[moving] = carrier
    unit = motion / float(motion @ motion) if not motion[2] else np.array([0.0, 0.0, 1.0 / motion[2]])
    dead, live = assembly.dead.copy(), np.zeros_like(assembly.dead)
    on_support = assembly.bars.generalised(assembly.bars.prestress, centroid)
    dead[carrier] = -reaction * unit + _of_one_body(on_support, centroid, moving, carrier)
    live[carrier] = (-1.0 if greatest else 1.0) * unit
    ground, guide = assembly.n_blocks, _guide(assembly, carrier, motion)
    bars = assembly.bars
    strong = np.full(2, STRONG * assembly.force_scale)
    guides = Bars(
        names=("guide 1", "guide 2"),
        kinds=("prop", "prop"),
        block_a=np.array([ground, ground]),
        block_b=np.array([carrier, carrier]),
        end1=guide[:, 0],
        end2=guide[:, 1],
        prestress=np.zeros(2),
        least=-strong,
        greatest=strong,
    )
    guided = replace(bars, block_a=place[bars.block_a], block_b=place[bars.block_b]).followed_by(guides)
    size = assembly.length_scale
    square = assembly.polygons[carrier].min(axis=0) - 3.0 * size + size * np.array([[0, 0], [1, 0], [1, 1], [0, 1.0]])
    none = np.zeros((1, 3))
    wall = replace(
        assembly,
        block_ids=(*assembly.block_ids, "ground of the guide"),
        polygons=(*assembly.polygons, square),
        centroid=np.vstack([centroid, square.mean(axis=0)]),
        weight=np.append(assembly.weight, 0.0),
        fixed=np.append(fixed, True),
        block_a=place[assembly.block_a],
        block_b=place[assembly.block_b],
        dead=np.vstack([dead, none]),
        live=np.vstack([live, none]),
        support_motion=np.zeros((assembly.n_blocks + 1, 3)),
        bars=guided,
    )
    return ReleasedWall(wall, carrier, moving)


def _check_rigid(assembly: Assembly, moving: IntArray, motion: FloatArray) -> None:
    """Refuse supports whose motions are not those of one rigid body, that of the first."""
    carrier = int(moving[0])
    for block in moving.tolist():
        at = vertex_velocities(assembly.centroid[block][None], assembly.centroid[carrier], motion)[0]
        other = assembly.support_motion[block]
        if not np.allclose([*at, motion[2]], other, rtol=1e-9, atol=1e-12 * float(abs(motion).max())):
            raise InputError(
                f"{assembly.block_ids[carrier]} and {assembly.block_ids[block]} do not move as one rigid body",
                'Give them one translation, or a rotation "about" one point; or ask for associated flow',
                "settlements",
            )


def _of_one_body(load: FloatArray, centroid: FloatArray, moving: IntArray, carrier: int) -> FloatArray:
    """The sum of loads (n, 3) on some blocks, about the centroid of one of them."""
    arm = centroid[moving] - centroid[carrier]
    moment = load[moving, 2] + arm[:, 0] * load[moving, 1] - arm[:, 1] * load[moving, 0]
    return np.array([*load[moving, :2].sum(axis=0), moment.sum()])


def _guide(assembly: Assembly, carrier: int, motion: FloatArray) -> FloatArray:
    """Ends (2, 2, 2) of two bars, on the ground and on the block, that leave it no motion but this one.

    They are square to the motion at two points for a translation, and meet in the centre of a rotation.
    """
    centre, size = assembly.centroid[carrier], assembly.length_scale
    if not motion[2]:
        along = motion[:2] / float(np.hypot(motion[0], motion[1]))
        across = np.array([-along[1], along[0]])
        points = np.array([centre - size * along, centre + size * along])
        return np.stack([points + size * across, points], axis=1)
    pole = centre + np.array([-motion[1], motion[0]]) / motion[2]
    return np.stack([pole + size * np.eye(2), np.stack([pole, pole])], axis=1)
