"""The reactions at which distinct elements hold supports that move: the support is released, and the reaction its load.

The wall comes to rest on supports that do not move, with the reaction R0 along the settlement. A support is then freed
to move along it alone (`drystone.released_supports`) and pressed with R0 - lambda where it gives way, with R0 + lambda
where it pushes. The bracket [held, moving] of lambda is one of the reaction. At lambda = 0 the wall rests as before, so
each reaction has the history of a support that rested and then moved. Source: Portioli and Cascini (2016), for the
reaction as the load.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import partial
from typing import Any

import numpy as np

from drystone.reactions import moving_blocks, one_alone, proved_extremes
from drystone.released_supports import OtherSupports, ReleasedWall, released
from drystone.walls import Wall
from harness.engine.judge import judge
from harness.engine.pipeline import Runs
from harness.engine.reaction_judge import judge_held, reaction_of, work_scale
from harness.model.assembly import FloatArray
from harness.model.bars import bar_tensions
from harness.model.errors import in_file
from harness.model.method import Finding, Method, Status
from harness.model.method_registry import check_takes, load_method
from harness.model.result import Judgement, Result


@dataclass(frozen=True, eq=False)
class HeldReaction:
    """A bracket of the reaction of supports along their prescribed motion, under the dead load.

    Attributes:
        gives_way: whether the supports move as prescribed; else they push, backwards.
        rest: reaction R0 of the wall at rest on supports that do not move.
        held, moving: ends of the bracket over all sweep orders: the reaction up to which every order held, and the
            farthest from R0 at which one moved [force; moment of rotations alone].
        value: middle of the bracket of the median order.
        extremes: least and greatest reaction of associated flow.
        forces_at: reaction at which the forces were measured, held in the median order.
        forces: (m, 3) contact forces at it [force]; tensions: (k,) of ties and props [force].
        mechanism: (n, 3) motion of all blocks beyond it, the supports as prescribed or backwards.
        moving_blocks: names of the free blocks that move in it.
        judgement: of bracket and forces.
    """

    gives_way: bool
    rest: float
    held: float
    moving: float
    value: float
    extremes: tuple[float, float]
    forces_at: float
    forces: FloatArray
    tensions: FloatArray
    mechanism: FloatArray
    moving_blocks: tuple[str, ...]
    judgement: Judgement

    @property
    def sentence(self) -> str:
        """What was found, and what the judge says."""
        what = "gives way" if self.gives_way else "pushes"
        low, high = self.extremes
        return (
            f"The support that {what} is held from {self.rest:.6g} to {self.held:.6g} and moves at {self.moving:.6g}; "
            f"the reaction {self.value:.6g} is the middle of the median sweep order's bracket. No equilibrium lies "
            f"outside {low:.7g} to {high:.7g}. {self.judgement.sentence}"
        )

    def as_json(self) -> dict[str, Any]:
        """JSON values."""
        return {
            "value": self.value,
            "bracket": [self.held, self.moving],
            "rest": self.rest,
            "extremes": list(self.extremes),
            "moving": list(self.moving_blocks),
            "judge": self.judgement.model_dump(mode="json"),
            "forces_at": self.forces_at,
            "forces": self.forces.tolist(),
            "tensions": self.tensions.tolist(),
            "mechanism": self.mechanism.tolist(),
        }


def held_reactions(wall: Wall, *, runs: Runs = Runs(), **settings: Any) -> tuple[HeldReaction, HeldReaction] | str:
    """The brackets of supports that give way and of supports that push, by `de`; or why there are none.

    Args:
        wall: with settlements of one rigid motion; its live load does not act.
        runs: how they are made.
        settings: of `de`, as orders and accuracy.

    Raises:
        InputError: no support with a joint moves, the supports do not move as one rigid body, or the wall has joints
            that `de` does not take.
    """
    assembly, method = wall.assembly, load_method("de")
    still = replace(assembly, live=np.zeros_like(assembly.live), support_motion=np.zeros_like(assembly.support_motion))
    with in_file(wall.case.origin):
        check_takes(method, still)
    ends = proved_extremes(wall, runs=runs)
    if isinstance(ends, str):
        return ends
    if alone := one_alone(assembly, *ends):
        return alone
    result = runs.result(OtherSupports(wall.case, still), "de", settings, partial(judge, alone=True))
    if result.finding is not Finding.STANDS or result.forces is None or not result.judge.accepted:
        return f"Distinct elements do not hold the wall on supports at rest: {result.sentence}"
    beyond = bar_tensions(still, result)
    tensions = np.zeros(0) if beyond is None else beyond
    measured = reaction_of(assembly, np.asarray(result.forces, dtype=float), tensions)
    # Forces hold to the tolerance of the method: within it a support that bears nothing is not one that bears a little.
    near = method.tolerance * work_scale(assembly, measured)
    begins = next((end for end in ends if abs(measured - end) <= near), measured)
    found: list[HeldReaction] = []
    for gives_way in (True, False):
        each = _bracket(wall, method, begins, gives_way, ends, settings, runs)
        if isinstance(each, str):
            return each
        found.append(each)
    return found[0], found[1]


def _bracket(
    wall: Wall,
    method: Method,
    begins: float,
    gives_way: bool,
    extremes: tuple[float, float],
    settings: dict[str, Any],
    runs: Runs,
) -> HeldReaction | str:
    """The bracket of one sense from the reaction at rest on."""
    assembly = wall.assembly
    with in_file(wall.case.origin):
        guided = released(assembly, begins, not gives_way)
    result = guided.result(wall.case, "de", settings, runs)
    state = _state(guided, result)
    if result.bracket is None or result.multiplier is None or result.forces_multiplier is None or state is None:
        return f"No reaction was found of a support that {'gives way' if gives_way else 'pushes'}: {result.sentence}"
    forces, tensions, mechanism = state
    if not guided.holds(tensions):
        return "No reaction was found: the support would leave its direction by immense forces."
    sense = -1.0 if gives_way else 1.0
    held, moving = (begins + sense * multiplier for multiplier in result.bracket)
    at = begins + sense * result.forces_multiplier
    own = tensions[: len(assembly.bars)]
    of_forces = judge_held(assembly, at, forces, own, tolerance=method.tolerance, extremes=extremes)
    motion = guided.of_wall(mechanism, assembly)
    return HeldReaction(
        gives_way,
        begins,
        held,
        moving,
        begins + sense * result.multiplier,
        extremes,
        at,
        forces,
        own,
        motion,
        moving_blocks(assembly, motion),
        _of_both(of_forces, result),
    )


def _state(guided: ReleasedWall, result: Result) -> tuple[FloatArray, FloatArray, FloatArray] | None:
    """Contact forces, tensions and mechanism of an answer for the released wall; None where it lacks one."""
    tensions = bar_tensions(guided.assembly, result)
    if result.forces is None or result.mechanism is None or tensions is None:
        return None
    return np.asarray(result.forces, dtype=float), tensions, np.asarray(result.mechanism, dtype=float)


def _of_both(of_forces: Judgement, bracket: Result) -> Judgement:
    """Accepted where the forces hold on the wall as drawn and the bracket on the wall with a guided support.

    A bracket that is no answer says why.
    """
    of_bracket = bracket.judge
    why = "" if bracket.status is Status.OK else f" The change of the reaction {bracket.sentence}."
    return of_forces.model_copy(
        update={
            "residuals": of_forces.residuals | {f"released_{k}": v for k, v in of_bracket.residuals.items()},
            "accepted": bool(of_forces.accepted and of_bracket.accepted),
            "sentence": f"{of_forces.sentence} With the support released: {of_bracket.sentence}{why}",
        }
    )
