"""Least and greatest reactions of supports that move, each with forces and mechanism, judged."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from drystone.walls import Wall
from harness.engine.reaction_judge import judge_reaction
from harness.model.assembly import FloatArray
from harness.model.errors import InputError
from harness.model.result import Judgement


@dataclass(frozen=True, eq=False)
class Reaction:
    """A reaction of the supports along their prescribed motion, under the dead load.

    Attributes:
        value: work on the motion: a force where the motion is a translation by one, a moment for a rotation by one.
        forces: (m, 3) contact forces [force]; mechanism: (n, 3) motion of all blocks dual to them.
        moving: names of the free blocks that move in it.
        judgement: of the judge.
    """

    value: float
    forces: FloatArray
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
            "mechanism": self.mechanism.tolist(),
        }


def reactions(wall: Wall, tolerance: float = 1e-9) -> tuple[Reaction, Reaction] | str:
    """The least and the greatest reaction of the supports that settle, with associated flow; or why there are none.

    The least is that of supports that give way, the greatest that of supports that push against their motion.

    Args:
        wall: with settlements; its live load does not act.
        tolerance: the largest residual that the judge accepts.

    Raises:
        InputError: no support with a joint moves, or joints crush.
    """
    from methods.la.core.reaction import extreme_reaction

    assembly = wall.assembly
    if not np.any(assembly.support_strains):
        remedy = 'Give "settlements": [{"blocks": [...], "translation": [0, -1]}]'
        raise InputError("no support with a joint moves", remedy, "settlements")
    if assembly.crushes:
        remedy = "Leave compressive strength out: the programmes of reactions are linear"
        raise InputError("some joints have compressive strength", remedy, "settlements")
    found: list[Reaction] = []
    for greatest in (False, True):
        answer = extreme_reaction(assembly, greatest)
        if isinstance(answer, str):
            if answer == "infeasible":
                return (
                    "No equilibrium within yield exists under the dead load: the wall falls, wherever its supports go."
                )
            return f"The linear programme of the {'greatest' if greatest else 'least'} reaction is {answer}."
        speed = abs(answer.mechanism * [1.0, 1.0, assembly.length_scale]).max(axis=1)
        moves = ~assembly.fixed & (speed > 1e-9 * speed.max())
        names = tuple(assembly.block_ids[k] for k in np.flatnonzero(moves))
        said = judge_reaction(
            assembly, answer.reaction, answer.forces, answer.mechanism, greatest=greatest, tolerance=tolerance
        )
        found.append(Reaction(answer.reaction, answer.forces, answer.mechanism, names, said))
    return found[0], found[1]
