"""The reaction of supports against the displacement that is imposed on them, judged at its end."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from drystone.reactions import length_unit, moving_blocks, proved_extremes, reaction_unit, with_unit
from drystone.walls import Wall
from harness.engine.judge import judge
from harness.engine.pipeline import Runs
from harness.engine.reaction_judge import judge_plateau
from harness.model.assembly import Assembly, FloatArray
from harness.model.errors import InputError, in_file
from harness.model.followed import SupportPath
from harness.model.method_registry import check_takes, load_method
from harness.model.result import Judgement, Result

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@dataclass(frozen=True, eq=False)
class ReactionPath:
    """The reaction along one path, from rest under the dead load. k points.

    Attributes:
        gives_way: whether the supports move as prescribed; else they push, backwards.
        displacement: (k,) of the fastest vertex of the supports [length]; it scales with the compliance of the springs.
        reaction: (k,) along the direction of the prescribed motion [force; moment of rotations alone].
        slipping, opened: (k,) numbers of gap points.
        constant_from: displacement from which the reaction is constant [length], or None.
        forces: (m, 3) contact forces at the end [force].
        mechanism: (n, 3) motion of all blocks at the end, or None.
        moving: names of the free blocks that move in it.
        extremes: least and greatest reaction of associated flow.
        judgement: of the constant reaction, or None where there is none.
        reason: why there is none; empty where there is one.
        units: of displacements and of reactions; empty where the wall has none.
    """

    gives_way: bool
    displacement: FloatArray
    reaction: FloatArray
    slipping: tuple[int, ...]
    opened: tuple[int, ...]
    constant_from: float | None
    forces: FloatArray
    mechanism: FloatArray | None
    moving: tuple[str, ...]
    extremes: tuple[float, float]
    judgement: Judgement | None
    reason: str
    units: tuple[str, str]

    @property
    def value(self) -> float | None:
        """The constant reaction, None where there is none."""
        return float(self.reaction[-1]) if self.judgement is not None else None

    @property
    def accepted(self) -> bool:
        """Whether there is a constant reaction that the judge accepts."""
        return bool(self.judgement is not None and self.judgement.accepted)

    @property
    def sentence(self) -> str:
        """What was found, and what the judge says."""
        what = "gives way" if self.gives_way else "pushes back"
        length, unit = self.units
        last = with_unit(f"{self.reaction[-1]:.7g}", unit)
        begins = f"The support {what}: its reaction goes from {self.reaction[0]:.7g} to {last}"
        if self.judgement is None:
            return f"{begins}. {self.reason}"
        low, high = self.extremes
        constant_from = with_unit(f"{self.constant_from:.4g}", length)
        return (
            f"{begins}, where it is constant from the displacement {constant_from} on; no equilibrium lies "
            f"outside {low:.7g} to {with_unit(f'{high:.7g}', unit)}. {self.judgement.sentence}"
        )

    def as_json(self) -> dict[str, Any]:
        """JSON values."""
        return {
            "value": self.value,
            "constant_from": self.constant_from,
            "extremes": list(self.extremes),
            "displacement": self.displacement.tolist(),
            "reaction": self.reaction.tolist(),
            "slipping_points": list(self.slipping),
            "open_points": list(self.opened),
            "moving": list(self.moving),
            "judge": None if self.judgement is None else self.judgement.model_dump(mode="json"),
            "forces": self.forces.tolist(),
            "mechanism": None if self.mechanism is None else self.mechanism.tolist(),
            "reason": self.reason,
        }


FOLLOWS = {"fe": "fe-reaction", "de-soft": "de-reaction"}
"""Methods that follow supports, by gap springs in small displacements and by deformable joints at rest after rest, and
those that give their paths."""


def reaction_paths(
    wall: Wall, by: str = "fe", *, runs: Runs = Runs(), **settings: Any
) -> tuple[ReactionPath, ReactionPath] | str:
    """The paths of supports that give way and of supports that push, or why there are none.

    Args:
        wall: with settlements; its live load does not act.
        by: "fe", the gap springs, or "de-soft", distinct elements with deformable joints.
        runs: how they are made.
        settings: of that method.

    Raises:
        InputError: no support with a joint moves, or the wall has joints or bars that the method does not take.
    """
    assembly, method = wall.assembly, load_method(by)
    with in_file(wall.case.origin):
        if len(assembly.bars):
            remedy = "Ask for the two reactions alone, or leave them out"
            raise InputError("the path takes no ties, props and passive fill", remedy)
        check_takes(method, replace(assembly, support_motion=np.zeros_like(assembly.support_motion)))
    ends = proved_extremes(wall, runs=runs)
    if isinstance(ends, str):
        return ends
    found: list[ReactionPath] = []
    for gives_way in (True, False):
        word = partial(_word, gives_way=gives_way, extremes=ends)
        result = runs.result(wall.case, FOLLOWS[by], settings | {"gives_way": gives_way}, word)
        path = SupportPath.of(result.details, assembly)
        if path is None:
            return result.sentence
        found.append(
            ReactionPath(
                gives_way,
                path.displacement,
                path.reaction,
                tuple(path.slipping.tolist()),
                tuple(path.opened.tolist()),
                path.constant_from,
                path.forces,
                path.mechanism,
                () if path.mechanism is None else moving_blocks(assembly, path.mechanism),
                ends,
                None if path.mechanism is None else result.judge,
                path.reason,
                (length_unit(wall), reaction_unit(wall)),
            )
        )
    return found[0], found[1]


def _word(
    assembly: Assembly, result: Result, tolerance: float, *, gives_way: bool, extremes: tuple[float, float]
) -> Judgement:
    """The word of the judge on the constant reaction, where there is one."""
    path = SupportPath.of(result.details, assembly)
    if path is None or path.mechanism is None:
        return judge(assembly, result, tolerance)
    return judge_plateau(
        assembly,
        path,
        gives_way=gives_way,
        tolerance=tolerance,
        extremes=extremes,
    )


def paths_as_csv(paths: tuple[ReactionPath, ...]) -> str:
    """One row a point of each path; heads have their units."""
    import pandas as pd

    from reports.labels.numbers import labelled

    tables = [
        pd.DataFrame(
            {
                "support": "gives way" if path.gives_way else "pushes",
                labelled("displacement", path.units[0]): path.displacement,
                labelled("reaction", path.units[1]): path.reaction,
                "slipping_points": path.slipping,
                "open_points": path.opened,
            }
        )
        for path in paths
    ]
    return str(pd.concat(tables).to_csv(index=False))


def paths_figure(paths: tuple[ReactionPath, ...], head: str) -> Figure:
    """Reaction against displacement of each path, between the extremes of associated flow."""
    from reports.figures.settling import reaction_figure

    curves = [
        ("gives way" if path.gives_way else "pushes", path.displacement, path.reaction, path.constant_from)
        for path in paths
    ]
    return reaction_figure(curves, paths[0].extremes, head, paths[0].units)
