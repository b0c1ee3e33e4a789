"""Reactions of the supports: the sum of the contact forces on each, and whether they balance the loads."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from operator import attrgetter

import numpy as np

from harness.model.assembly import Assembly, FloatArray
from harness.model.bars import bar_tensions
from harness.model.case import Case
from harness.model.passive import FILL
from harness.model.result import Result
from harness.model.table import TableColumn


@dataclass(frozen=True)
class SupportReaction:
    """The force of one support on the wall; the support's own weight is not in it.

    Attributes:
        support: id of the fixed block.
        fx, fy: of the force [force].
        moment: about the centroid of the support, counter-clockwise [force length].
        x, y: point of the line of action at the level y of the support's highest contact point [length]; None where the
            force is level.
    """

    support: str
    fx: float
    fy: float
    moment: float
    x: float | None
    y: float | None


_ReactionColumn = TableColumn[SupportReaction]

REACTIONS: tuple[_ReactionColumn, ...] = (
    _ReactionColumn("support", "string", "", "id of the fixed block", attrgetter("support")),
    _ReactionColumn("fx", "Float64", "force", "horizontal reaction, on the wall", attrgetter("fx"), "Fx"),
    _ReactionColumn("fy", "Float64", "force", "vertical reaction, on the wall", attrgetter("fy"), "Fy"),
    _ReactionColumn(
        "moment",
        "Float64",
        "force length",
        "of the reaction about the centroid of the support, counter-clockwise",
        attrgetter("moment"),
    ),
    _ReactionColumn("x", "Float64", "length", "where the line of action meets the level y", attrgetter("x"), "at x"),
    _ReactionColumn("y", "Float64", "length", "level of the support's highest contact point", attrgetter("y"), "at y"),
)
"""Columns of reactions; their units are kinds, which `harness.model.table.in_units` replaces by the units of a wall."""


def support_reactions(
    assembly: Assembly, forces: FloatArray, flat: float = 1e-9, tension: FloatArray | None = None
) -> list[SupportReaction]:
    """The reaction of each support that has a joint, a tie or a prop, and of passive fill about its centre of pressure.

    Args:
        assembly: the wall.
        forces: contact forces (m, 3) [force], tension included.
        flat: share of the vertical part in a force below which its line of action counts as level.
        tension: (k,) of the ties and props, prestress included [force]; None: they bear none.
    """
    bars = assembly.bars
    pull = np.zeros((len(bars), 2)) if tension is None else np.asarray(tension)[:, None] * bars.axis
    forces = np.asarray(forces, dtype=float).reshape(-1, 3)
    # The forces of a on b at end 1 and at end 2 (m, 2, 2); shear acts along the line through both.
    at_ends = forces[:, :2, None] * assembly.normal[:, None]
    at_ends[:, 0] += forces[:, 2:] * assembly.tangent
    ends = np.stack([assembly.end1, assembly.end2], axis=1)
    listed, of_fill = [], np.array([kind == FILL for kind in bars.kinds], dtype=bool)
    for block in np.flatnonzero(assembly.fixed):
        is_a, is_b = assembly.block_a == block, assembly.block_b == block
        chosen = np.flatnonzero(is_a | is_b)
        starts, stops = (bars.block_a == block) & ~of_fill, bars.block_b == block
        if not len(chosen) and not (starts | stops).any():
            continue
        # Of joints two vectors each at their ends; of bars one each, which pulls at the wall away from their other end.
        vectors = (np.where(is_a[chosen], 1.0, -1.0)[:, None, None] * at_ends[chosen]).reshape(-1, 2)
        vectors = np.concatenate([vectors, -pull[starts], pull[stops]])
        centroid = assembly.centroid[block]
        points = [ends[chosen].reshape(-1, 2), bars.end1[starts], bars.end2[stops]]
        arms = np.concatenate(points) - centroid
        fx, fy = (_sum_of(part) for part in vectors.T)
        moment = _sum_of(np.concatenate([arms[:, 0] * vectors[:, 1], -arms[:, 1] * vectors[:, 0]]))
        x = y = None
        if abs(fy) > flat * float(np.hypot(fx, fy)):
            level = float(arms[..., 1].max())
            x, y = float(centroid[0]) + (moment + level * fx) / fy, float(centroid[1]) + level
        listed.append(SupportReaction(assembly.block_ids[block], fx, fy, moment, x, y))
    pushed = [(bars.names[k], *(-pull[k]).tolist()) for k in np.flatnonzero(of_fill & np.any(pull, axis=1))]
    return listed + [SupportReaction(name, fx, fy, 0.0, None, None) for name, fx, fy in pushed]


def _sum_of(terms: FloatArray, rounding: float = 1e-12) -> float:
    """The sum of terms, zero where no more than their rounding is left: doubles leave 1e-16 of each."""
    total = float(terms.sum())
    return total if abs(total) > rounding * float(abs(terms).sum()) else 0.0


def reactions_of(case: Case, result: Result) -> list[SupportReaction]:
    """The reactions of an answer, at its `forces_multiplier`; none where it has no contact forces of this wall."""
    if result.forces is None or len(result.forces) != case.assembly.n_interfaces:
        return []
    tension = bar_tensions(case.assembly, result)
    return support_reactions(case.assembly, np.asarray(result.forces, dtype=float), tension=tension)


def out_of_balance(assembly: Assembly, listed: Sequence[SupportReaction], multiplier: float) -> float:
    """Largest part of the loads on free blocks that the reactions do not balance, relative to the loads."""
    bars = assembly.bars
    prestress = bars.generalised(bars.prestress, assembly.centroid) if len(bars) else 0.0  # of dead load, not outside
    loads = (assembly.dead - prestress + multiplier * assembly.live)[assembly.free]
    taken = np.array([(reaction.fx, reaction.fy) for reaction in listed]).reshape(-1, 2).sum(axis=0)
    left = loads[:, :2].sum(axis=0) + taken
    return float(np.linalg.norm(left) / max(float(np.linalg.norm(loads[:, :2], axis=1).sum()), 1e-300))
