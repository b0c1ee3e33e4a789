"""How far supports can move before a wall falls, on updated geometry: bracketed, and judged at both ends."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from drystone.reactions import check_reactions
from drystone.walls import Wall
from harness.engine.settled_judge import judge_settled, judge_settled_fall
from harness.model.assembly import Assembly, FloatArray
from harness.model.errors import InputError, first_few
from harness.model.result import Judgement

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@dataclass(frozen=True, eq=False)
class SettledCollapse:
    """The displacement of supports at which no admissible state is left. k points.

    Attributes:
        assembly: the wall as drawn.
        stands: largest displacement at which the wall was found to stand, as a multiple of the prescribed motion.
        falls: a displacement a hair larger at which it falls, or None.
        displacement, reaction: (k,) on the way; the least reaction in the wall as it stands there.
        places: (n, 3) displacements [length] and rotations [rad] of the blocks at `stands`.
        forces: (m, 3) contact forces there, along the joints as they have turned [force].
        pins: joints that have opened at one end there, by the names of their blocks.
        fallen: (n, 3) places at `falls`; mechanism: (n, 3) dilatant motion that proves the fall; or None.
        judgements: of the last state at which it stands and, where there is one, of the fall.
        reason: why it was followed no further; empty where it falls.
    """

    assembly: Assembly
    stands: float
    falls: float | None
    displacement: FloatArray
    reaction: FloatArray
    places: FloatArray
    forces: FloatArray
    pins: tuple[str, ...]
    fallen: FloatArray | None
    mechanism: FloatArray | None
    judgements: tuple[Judgement, ...]
    reason: str

    @property
    def accepted(self) -> bool:
        """Whether the wall falls, and the judge accepts both ends of the bracket."""
        return self.falls is not None and all(each.accepted for each in self.judgements)

    @property
    def sentence(self) -> str:
        """What was found, and what the judge says."""
        pins = f", turning about {len(self.pins)} joints: {first_few(self.pins, 8)}" if self.pins else ""
        said = " ".join(each.sentence for each in self.judgements)
        stands, falls = _apart(self.stands, self.falls)
        if self.falls is None:
            return f"The wall stands up to {stands} times the prescribed motion{pins}. {self.reason} {said}"
        return (
            f"The wall stands up to {stands} times the prescribed motion{pins}. At {falls} times no "
            f"admissible state is left. {said}"
        )

    def as_json(self) -> dict[str, Any]:
        """JSON values."""
        return {
            "stands": self.stands,
            "falls": self.falls,
            "displacement": self.displacement.tolist(),
            "reaction": self.reaction.tolist(),
            "pins": list(self.pins),
            "places": self.places.tolist(),
            "forces": self.forces.tolist(),
            "fallen": None if self.fallen is None else self.fallen.tolist(),
            "mechanism": None if self.mechanism is None else self.mechanism.tolist(),
            "judge": [each.model_dump(mode="json") for each in self.judgements],
            "reason": self.reason,
        }

    def as_csv(self) -> str:
        """One row a point on the way."""
        import pandas as pd

        return str(pd.DataFrame({"displacement": self.displacement, "reaction": self.reaction}).to_csv(index=False))

    def plot(self) -> Figure:
        """The reaction against the displacement, and the wall where it last stands."""
        from reports.drawing.settling import settled_figure

        return settled_figure(self.assembly, self.places, (self.displacement, self.reaction))


def settled_until_collapse(wall: Wall, tolerance: float = 1e-9) -> SettledCollapse | str:
    """Move the supports as prescribed, on updated geometry, until the wall falls; or why this cannot be begun.

    Args:
        wall: with settlements, of dry joints; its live load does not act.
        tolerance: the largest residual that the judge accepts.

    Raises:
        InputError: no support with a joint moves; or the wall has strength, bars, or loads beside the centroids.
    """
    from methods.la.moved_wall import MovedWall
    from methods.la.settling import settle

    assembly = wall.assembly
    check_reactions(assembly, wall.case.origin)
    check_simple(assembly, assembly.dead)
    found = settle(MovedWall.at_rest(assembly))
    if isinstance(found, str):
        return f"The linear programme of the least reaction is {found} where the supports begin to move."
    last = found.points[-1]
    stands, places = last.wall.displacement, last.wall.places
    said = [judge_settled(assembly, stands, places, last.value, last.forces, tolerance)]
    if found.fall is not None and found.mechanism is not None:
        at = found.fall.displacement
        bore = last.forces
        said.append(judge_settled_fall(assembly, at, found.fall.places, found.mechanism, tolerance, bore=bore))
    return SettledCollapse(
        assembly,
        stands,
        None if found.fall is None else found.fall.displacement,
        np.array([point.wall.displacement for point in found.points]),
        np.array([point.value for point in found.points]),
        places,
        last.forces,
        tuple(
            f"{assembly.block_ids[assembly.block_a[p]]} and {assembly.block_ids[assembly.block_b[p]]}"
            for p in np.flatnonzero(last.wall.closed.sum(axis=1) == 1)
        ),
        None if found.fall is None else found.fall.places,
        found.mechanism,
        tuple(said),
        found.reason,
    )


def _apart(low: float, high: float | None) -> tuple[str, str]:
    """Two numbers with as many digits as tell them apart, seven at least."""
    for digits in range(7, 18):
        texts = f"{low:.{digits}g}", "" if high is None else f"{high:.{digits}g}"
        if texts[0] != texts[1]:
            break
    return texts


def check_simple(assembly: Assembly, *loads: FloatArray) -> None:
    """Refuse what is not followed on updated geometry: strength, bars, and loads (n, 3) beside the centroids.

    Raises:
        InputError: naming what is not.
    """
    faults = {
        "ties, props or passive fill": len(assembly.bars) > 0,
        "joints with cohesion or tensile strength": assembly.strong,
        "joints with compressive strength": assembly.crushes,
    }
    what = next((name for name, there in faults.items() if there), None)
    if what is not None:
        raise InputError(
            f"the wall has {what}, which are not followed on updated geometry",
            "Leave them out, or ask for the reactions as drawn",
        )
    for load in loads:
        moment = abs(load[assembly.free, 2])
        if not moment.max(initial=0.0) > 1e-12 * assembly.force_scale * assembly.length_scale:
            continue
        block = assembly.block_ids[assembly.free[int(np.argmax(moment))]]
        raise InputError(
            f"the load on {block} does not act at its centroid, and its arm changes as the block turns",
            "Leave it out, or ask for the reactions as drawn",
            "loads",
        )
