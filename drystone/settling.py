"""How far supports can move before a wall falls, on updated geometry: bracketed, and judged at both ends."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from drystone.reactions import check_reactions, motion_unit, reaction_unit, with_unit
from drystone.walls import Wall
from harness.engine.judge import judge
from harness.engine.pipeline import Runs
from harness.engine.settled_judge import judge_last_state, judged_as_one
from harness.model.assembly import Assembly, FloatArray
from harness.model.errors import InputError, first_few, in_file
from harness.model.followed import FollowedWall
from harness.model.result import Judgement, Result

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@dataclass(frozen=True, eq=False)
class SettledCollapse:
    """The displacement of supports at which no admissible state is left. k points.

    Attributes:
        assembly: the wall as drawn.
        stands: largest displacement at which the wall was found to stand, along the motion of its supports [length;
            rad of rotations alone].
        falls: a displacement a hair larger at which it falls, or None.
        displacement, reaction: (k,) on the way; the least reaction in the wall as it stands there.
        places: (n, 3) displacements [length] and rotations [rad] of the blocks at `stands`.
        forces: (m, 3) contact forces there, along the joints as they have turned [force].
        pins: joints that have opened at one end there, by the names of their blocks.
        fallen: (n, 3) places at `falls`; mechanism: (n, 3) dilatant motion that proves the fall; or None.
        judgements: of the last state at which it stands and, where there is one, of the fall.
        reason: why it was followed no further; empty where it falls.
        units: of displacements and of reactions; empty where the wall has none.
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
    units: tuple[str, str]

    @property
    def accepted(self) -> bool:
        """Whether the wall falls, and the judge accepts both ends of the bracket."""
        return self.falls is not None and all(each.accepted for each in self.judgements)

    @property
    def sentence(self) -> str:
        """What was found, and what the judge says."""
        pins = f", turning about {len(self.pins)} joints: {first_few(self.pins, 8)}" if self.pins else ""
        said = " ".join(each.sentence for each in self.judgements)
        stands, falls = (with_unit(number, self.units[0]) for number in _apart(self.stands, self.falls))
        begins = f"The wall stands until its supports have moved by {stands}{pins}."
        if self.falls is None:
            return f"{begins} {self.reason} {said}"
        return f"{begins} At {falls} no admissible state is left. {said}"

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
        """One row a point on the way; heads have their units."""
        import pandas as pd

        from reports.labels.numbers import labelled

        names, columns = ("displacement", "reaction"), (self.displacement, self.reaction)
        heads = map(labelled, names, self.units)
        return str(pd.DataFrame(dict(zip(heads, columns, strict=True))).to_csv(index=False))

    def plot(self) -> Figure:
        """The reaction against the displacement, and the wall where it last stands."""
        from reports.figures.settling import settled_figure
        from reports.labels.numbers import labelled

        names = ("displacement of the supports", "least reaction")
        displacement, reaction = (labelled(name, unit) for name, unit in zip(names, self.units, strict=True))
        return settled_figure(self.assembly, self.places, (self.displacement, self.reaction), (displacement, reaction))


def settled_until_collapse(wall: Wall, tolerance: float = 1e-9, *, runs: Runs = Runs()) -> SettledCollapse | str:
    """Move the supports as prescribed, on updated geometry, until the wall falls; or why this cannot be begun.

    Args:
        wall: with settlements, of dry joints; its live load does not act.
        tolerance: the largest residual that the judge accepts.
        runs: how they are made.

    Raises:
        InputError: no support with a joint moves; or the wall has strength, bars, or loads beside the centroids.
    """
    assembly = wall.assembly
    check_reactions(assembly, wall.case.origin)
    with in_file(wall.case.origin):
        check_simple(assembly, "ask for the reactions as drawn", assembly.dead)
    followed = run_followed(wall, "la-settling", {}, partial(judge_last_state, tolerance=tolerance), runs)
    if isinstance(followed, str):
        return followed
    states, said = followed
    return SettledCollapse(
        assembly,
        float(states.displacement[-1]),
        states.falls,
        states.displacement,
        states.value,
        states.places[-1],
        states.forces[-1],
        tuple(
            f"{assembly.block_ids[assembly.block_a[p]]} and {assembly.block_ids[assembly.block_b[p]]}"
            for p in np.flatnonzero(states.closed.sum(axis=1) == 1)
        ),
        states.fallen,
        states.falling,
        said,
        states.reason,
        (motion_unit(wall), reaction_unit(wall)),
    )


def run_followed(
    wall: Wall,
    method: str,
    settings: Mapping[str, Any],
    judge_states: Callable[[Assembly, FollowedWall], tuple[Judgement, ...]],
    runs: Runs,
) -> tuple[FollowedWall, tuple[Judgement, ...]] | str:
    """The states of a wall that a method follows, with what the judge says of them one by one; or why there are none.

    The run itself is accepted where all of them are.
    """
    said: tuple[Judgement, ...] = ()

    def word(assembly: Assembly, result: Result, tolerance: float) -> Judgement:
        nonlocal said
        states = FollowedWall.of(result.details, assembly)
        if states is None:
            return judge(assembly, result, tolerance)
        said = judge_states(assembly, states)
        return judged_as_one(said)

    result = runs.result(wall.case, method, settings, word)
    states = FollowedWall.of(result.details, wall.assembly)
    return result.sentence if states is None else (states, said)


def _apart(low: float, high: float | None) -> tuple[str, str]:
    """Two numbers with as many digits as tell them apart, seven at least."""
    for digits in range(7, 18):
        texts = f"{low:.{digits}g}", "" if high is None else f"{high:.{digits}g}"
        if texts[0] != texts[1]:
            break
    return texts


def check_simple(assembly: Assembly, instead: str, *loads: FloatArray) -> None:
    """Refuse what is not followed on updated geometry: strength, bars, and loads (n, 3) beside the centroids.

    Args:
        assembly: the wall; instead: what can be asked of a wall that has them, as "ask this".
        loads: that act on it.

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
            f"Leave them out, or {instead}",
        )
    for load in loads:
        moment = abs(load[assembly.free, 2])
        if not moment.max(initial=0.0) > 1e-12 * assembly.force_scale * assembly.length_scale:
            continue
        block = assembly.block_ids[assembly.free[int(np.argmax(moment))]]
        raise InputError(
            f"the load on {block} does not act at its centroid, and its arm changes as the block turns",
            f"Leave it out, or {instead}",
            "loads",
        )
