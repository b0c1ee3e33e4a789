"""The capacity curve: the multiplier that a wall bears against its displacement, on updated geometry.

The collapse begins at the associated maximum of the wall as drawn. The blocks follow its mechanism by finite rotations
about joints that have opened, and at every point the multiplier is found again in the wall as it stands there
(`methods.la.settling`). It falls to zero at the ultimate displacement, beyond which the wall falls under its dead load.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from drystone.reactions import length_unit, with_unit
from drystone.settling import check_simple, run_followed
from drystone.walls import Wall, checked_wall
from harness.engine.pipeline import Runs
from harness.engine.settled_judge import judge_every_state, states_in_words
from harness.model.assembly import Assembly, FloatArray
from harness.model.errors import Hints, InputError, in_file
from harness.model.names import unknown_block
from harness.model.result import Judgement

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from methods.la.settings import SettlingSteps


@dataclass(frozen=True, eq=False)
class CapacityCurve:
    """The multiplier of the live load against the displacement of a wall, an upper bound of what it bears. k points.

    Attributes:
        assembly: the wall as drawn.
        control: what the displacement is of, in words.
        displacement: (k,) of it [length].
        multiplier: (k,) greatest in the wall as it stands there.
        places: (k, n, 3) displacements [length] and rotations [rad] of the blocks.
        ultimate: displacement at which the multiplier is zero [length], or None.
        judgements: (k,) of the points, and where there is one of the fall a hair beyond.
        reason: why it was followed no further; empty where it falls.
        unit: of displacements; empty where the wall has none.
    """

    assembly: Assembly
    control: str
    displacement: FloatArray
    multiplier: FloatArray
    places: FloatArray
    ultimate: float | None
    judgements: tuple[Judgement, ...]
    reason: str
    unit: str

    @property
    def accepted(self) -> bool:
        """Whether the wall was followed until it falls, and the judge accepts every point and the fall."""
        return self.ultimate is not None and all(each.accepted for each in self.judgements)

    @property
    def sentence(self) -> str:
        """What was found, and what the judge says."""
        said = states_in_words(self.judgements)
        begins = f"The multiplier, an upper bound, is {self.multiplier[0]:.7g} as drawn"
        if self.ultimate is None:
            last = with_unit(f"{self.displacement[-1]:.7g}", self.unit)
            return (
                f"{begins} and {self.multiplier[-1]:.7g} at the displacement {last} of {self.control}. "
                f"{self.reason} {said}"
            )
        ultimate = with_unit(f"{self.ultimate:.7g}", self.unit)
        return (
            f"{begins} and falls to zero at the displacement {ultimate} of {self.control}, beyond which the "
            f"wall falls under its dead load. {said}"
        )

    def as_json(self) -> dict[str, Any]:
        """JSON values."""
        return {
            "control": self.control,
            "displacement": self.displacement.tolist(),
            "multiplier": self.multiplier.tolist(),
            "bounds_above": True,
            "ultimate": self.ultimate,
            "places": self.places[-1].tolist(),
            "judge": [each.model_dump(mode="json") for each in self.judgements],
            "reason": self.reason,
        }

    def as_csv(self) -> str:
        """One row a point; the head of the displacement has its unit."""
        import pandas as pd

        from reports.labels.numbers import labelled

        columns = {labelled("displacement", self.unit): self.displacement, "multiplier": self.multiplier}
        return str(pd.DataFrame(columns).to_csv(index=False))

    def plot(self) -> Figure:
        """The multiplier against the displacement, and the wall where it last bears a load."""
        from reports.figures.settling import settled_figure
        from reports.labels.numbers import labelled

        labels = (labelled(f"displacement of {self.control}", self.unit), "multiplier, an upper bound")
        return settled_figure(self.assembly, self.places[-1], (self.displacement, self.multiplier), labels)


def capacity(
    wall: Wall,
    block: str | None = None,
    tolerance: float = 1e-9,
    steps: SettlingSteps | None = None,
    *,
    runs: Runs = Runs(),
) -> CapacityCurve | str:
    """Follow the collapse of a wall on updated geometry until its multiplier is zero; or why this cannot be begun.

    Args:
        wall: of dry joints, with a live load.
        block: whose centroid is the control point; None: the mean displacement of the live load along itself.
        tolerance: the largest residual that the judge accepts.
        steps: between two points; None: a hundredth of a block, at most a fiftieth.
        runs: how they are made.

    Raises:
        InputError: no block is called so or the wall has no live load; strength, bars, loads beside the centroids, or
            supports that move.
    """
    wall = checked_wall(wall)
    assembly = wall.assembly
    with in_file(wall.case.origin):
        _check(assembly, block)
    settings = {} if steps is None else steps.model_dump(mode="json")
    followed = run_followed(wall, "la-capacity", settings, partial(judge_every_state, tolerance=tolerance), runs)
    if isinstance(followed, str):
        return followed
    states, said = followed
    displacement = np.array([_control(assembly, block, each) for each in states.places])
    return CapacityCurve(
        assembly,
        "the live load" if block is None else f"block {block}",
        displacement,
        states.value,
        states.places,
        None if states.falls is None else float(displacement[-1]),
        said,
        states.reason,
        length_unit(wall),
    )


def _control(assembly: Assembly, block: str | None, places: FloatArray) -> float:
    """Displacement of the centroid of a block, or mean one of the live load along itself [length]."""
    if block is not None:
        return float(np.hypot(*places[assembly.block_ids.index(block), :2]))
    live = assembly.live[:, :2]
    return float((live * places[:, :2]).sum() / np.hypot(live[:, 0], live[:, 1]).sum())


def _check(assembly: Assembly, block: str | None) -> None:
    """Refuse what is not followed. Raises InputError."""
    if not assembly.has_live_load:
        raise InputError("the wall has no live load, so that it has no multiplier", "Give a live load", "loads.live")
    if np.any(assembly.support_motion):
        remedy = "Ask `drystone reaction --until-collapse`, or leave them out"
        raise InputError("the wall has settlements", remedy, "settlements")
    if block is not None and block not in assembly.block_ids:
        raise unknown_block(block, "--block", Hints(assembly.block_ids))
    check_simple(assembly, "ask `drystone run` for the multiplier as drawn", assembly.dead, assembly.live)
