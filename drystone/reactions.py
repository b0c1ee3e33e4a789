"""Least and greatest reactions of supports that move, each with forces and mechanism, judged."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np

from drystone.released_supports import released
from drystone.walls import Wall
from harness.engine.judge import judge
from harness.engine.pipeline import Runs
from harness.engine.reaction_judge import judge_reaction
from harness.model.assembly import Assembly, FloatArray
from harness.model.bars import bar_tensions, with_bars_as_joints
from harness.model.errors import InputError, in_file
from harness.model.followed import DrivenWall
from harness.model.passive import FILL
from harness.model.result import Judgement, Result, fastest_vertex
from harness.model.units import DIMENSIONLESS


@dataclass(frozen=True, eq=False)
class Reaction:
    """A reaction of the supports along their prescribed motion, under the dead load.

    Attributes:
        value: along the direction of the motion [force; moment of rotations alone].
        forces: (m, 3) contact forces [force]; tensions: (k,) of ties and props [force].
        mechanism: (n, 3) motion of all blocks that belongs to them.
        moving: names of the free blocks that move in it.
        judgement: of the judge.
    """

    value: float
    forces: FloatArray
    tensions: FloatArray
    mechanism: FloatArray
    moving: tuple[str, ...]
    judgement: Judgement

    def as_json(self) -> dict[str, Any]:
        """JSON values."""
        return {
            "value": self.value,
            "moving": list(self.moving),
            "judge": self.judgement.model_dump(mode="json"),
            "forces": self.forces.tolist(),
            "tensions": self.tensions.tolist(),
            "mechanism": self.mechanism.tolist(),
        }


def reactions(wall: Wall, tolerance: float = 1e-9, *, runs: Runs = Runs()) -> tuple[Reaction, Reaction] | str:
    """The least and the greatest reaction of the supports that settle, with associated flow; or why there are none.

    The least is that of supports that give way, the greatest that of supports that push against their motion.

    Args:
        wall: with settlements; its live load does not act.
        tolerance: the largest residual that the judge accepts.
        runs: how they are made.

    Raises:
        InputError: no support with a joint moves, or joints crush or are brittle.
    """
    assembly = wall.assembly
    check_reactions(assembly, wall.case.origin)
    found: list[Reaction] = []
    for greatest in (False, True):
        word = partial(_word, greatest=greatest, within=tolerance)
        result = runs.result(wall.case, "la-reaction", {"greatest": greatest}, word)
        driven = DrivenWall.of(result.details, assembly)
        if driven is None:
            return result.sentence
        moving = moving_blocks(assembly, driven.mechanism)
        found.append(Reaction(driven.reaction, driven.forces, driven.tensions, driven.mechanism, moving, result.judge))
    return found[0], found[1]


def _word(assembly: Assembly, result: Result, tolerance: float, *, greatest: bool, within: float) -> Judgement:
    """The word of the judge, with a tolerance other than that of the method."""
    driven = DrivenWall.of(result.details, assembly)
    if driven is None:
        return judge(assembly, result, tolerance)
    return judge_reaction(
        assembly,
        driven.reaction,
        driven.forces,
        driven.mechanism,
        greatest=greatest,
        tolerance=within,
        tensions=driven.tensions,
    )


def proved_extremes(wall: Wall, tolerance: float = 1e-9, *, runs: Runs = Runs()) -> tuple[float, float] | str:
    """The values of `reactions`, where the judge accepts both; or why there are none. Arguments and errors as there."""
    extremes = reactions(wall, tolerance, runs=runs)
    if isinstance(extremes, str):
        return extremes
    rejected = [each.judgement.sentence for each in extremes if not each.judgement.accepted]
    if rejected:
        return f"The judge rejects an extreme reaction with associated flow: {rejected[0]}"
    return extremes[0].value, extremes[1].value


def reaction_unit(wall: Wall) -> str:
    """The unit of a reaction along the settlements of a wall, as "kN" or "kN m"; empty where the wall has no units.

    A translation is a direction, so the reaction is a force; of rotations alone, in radians, it is a moment.
    """
    force, length = wall.units["force"], wall.units["length"]
    return " ".join(unit for unit in (force, length if _turns_alone(wall) else "1") if unit != DIMENSIONLESS)


def motion_unit(wall: Wall) -> str:
    """The unit in which the motion of supports is counted, as "m" or "rad"; empty where the wall has no units."""
    return "rad" if _turns_alone(wall) else length_unit(wall)


def length_unit(wall: Wall) -> str:
    """The unit of a displacement, as "m"; empty where the wall has no units."""
    length = wall.units["length"]
    return length if length != DIMENSIONLESS else ""


def with_unit(number: str, unit: str) -> str:
    """A number and its unit, if it has one."""
    return f"{number} {unit}".rstrip()


def _turns_alone(wall: Wall) -> bool:
    """Whether no settlement has a translation."""
    return not any(any(settlement.translation) for settlement in wall.case.wall.settlements)


def check_reactions(assembly: Assembly, file: str) -> None:
    """Refuse a wall whose reactions are not asked by linear programmes.

    Raises:
        InputError: no support with a joint, a tie or a prop moves, or joints crush or break.
    """
    if not np.any(with_bars_as_joints(assembly).support_strains):
        remedy = 'Give "settlements": [{"blocks": [...], "translation": [0, -1]}]'
        raise InputError("no support with a joint, a tie or a prop moves", remedy, "settlements", file)
    bars = assembly.bars
    if any(
        kind == FILL and np.any(assembly.support_motion[k]) for kind, k in zip(bars.kinds, bars.block_a, strict=True)
    ):
        remedy = "Add a fixed block that does not move, or leave passive fill out"
        raise InputError("every support moves, and passive fill has no ground that rests", remedy, "settlements", file)
    if assembly.crushes:
        remedy = "Leave compressive strength out: the programmes of reactions are linear"
        raise InputError("some joints have compressive strength", remedy, "settlements", file)
    if assembly.breaks:
        remedy = (
            'Leave out "after" to ask of a wall whose joints stay whole, their strength of one whose joints are broken'
        )
        raise InputError("some joints are brittle; a reaction depends on those that broke", remedy, "settlements", file)


def moving_blocks(assembly: Assembly, mechanism: FloatArray) -> tuple[str, ...]:
    """Names of the free blocks that move in a mechanism (n, 3)."""
    speed = abs(mechanism * [1.0, 1.0, assembly.length_scale]).max(axis=1)
    moves = ~assembly.fixed & (speed > 1e-9 * speed.max())
    return tuple(assembly.block_ids[k] for k in np.flatnonzero(moves))


def one_alone(assembly: Assembly, low: float, high: float) -> str:
    """That the extremes are one reaction, in words; empty where they are apart by more than programmes to 1e-9 tell."""
    speed = fastest_vertex(assembly, assembly.support_motion)
    if high - low > 1e-9 * max(assembly.force_scale * speed, abs(low)):
        return ""
    return f"Equilibrium leaves one reaction alone, {low:.7g}: it does not depend on the flow."


def least_known_reactions(
    wall: Wall, method: str = "la", inside: float = 0.01, tolerance: float = 1e-9, *, runs: Runs = Runs()
) -> tuple[Reaction, Reaction] | str:
    """The reactions at which the wall collapses without dilatancy, as far as known; or why there are none.

    The first is that of supports that give way, the greatest known; the second that of supports that push against their
    motion, the least known. Both lie between the extremes of associated flow. The judge holds each to be a collapse
    state (`drystone.released_supports`).

    Args:
        wall: with settlements of one rigid motion; its live load does not act.
        method: that looks for collapse states and takes props, as "la".
        inside: share of the range between the extremes by which the search begins inside it, where the wall stands
            beyond doubt: states in that share are not found.
        tolerance: the largest residual that the judge accepts.
        runs: how they are made.

    Raises:
        InputError: no support with a joint moves, or the supports do not move as one rigid body.
    """
    extremes = proved_extremes(wall, tolerance, runs=runs)
    if isinstance(extremes, str):
        return extremes
    assembly, (low, high) = wall.assembly, extremes
    if alone := one_alone(assembly, low, high):
        return alone
    found: list[Reaction] = []
    for greatest, begins in ((False, high - inside * (high - low)), (True, low + inside * (high - low))):
        with in_file(wall.case.origin):
            guided = released(assembly, begins, greatest)
        # The multiplier of the released wall is how far the reaction has changed since the search began.
        result = guided.result(wall.case, method, {}, runs)
        tensions = bar_tensions(guided.assembly, result)
        if result.multiplier is None or result.mechanism is None or result.forces is None or tensions is None:
            return f"No reaction without dilatancy is known: {result.sentence}"
        if not guided.holds(tensions):
            return "No reaction without dilatancy is known: the support would leave its direction by immense forces."
        mechanism = guided.of_wall(np.asarray(result.mechanism, dtype=float), assembly)
        found.append(
            Reaction(
                begins + (result.multiplier if greatest else -result.multiplier),
                np.asarray(result.forces, dtype=float),
                tensions[: len(assembly.bars)],
                mechanism,
                moving_blocks(assembly, mechanism),
                result.judge,
            )
        )
    return found[0], found[1]
