"""Load cases of one wall are searched together: the mechanism found in one is tried in the others.

Whether forces fit a mechanism depends on the loads, how its joints move does not. A method that can take up motions
therefore searches one load case, and the others take up what it found. It searches a further one where no mechanism
known leads to a collapse state, and the governing one in any case. Only a state that the method finds under the loads
of that case, and the judge accepts, counts. The order is that of the load cases: the answers do not depend on the
number of workers.
"""

from __future__ import annotations

import json
from collections import defaultdict
from collections.abc import Callable, Hashable, Iterator, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from harness.engine.preload import shipped
from harness.engine.run import Motion, Run
from harness.model.envelope import EQUAL, counts_residual, safe_size
from harness.model.method_registry import load_method
from harness.model.result import Result

Make = Callable[[Sequence[Run]], list[Result]]
"""Makes runs, or finds them in the store; results in the order of the runs."""


@dataclass(eq=False)
class _LoadCase:
    """A load case of a group: the run and result that stand for it, and what was done about it.

    Attributes:
        number: of its run among all; run, result: those with the lowest answer so far.
        alone: the run without motions; searched: whether it was made.
        handed: how many of the motions of the group were taken up.
    """

    number: int
    alone: Run
    run: Run
    result: Result | None = None
    searched: bool = False
    handed: int = 0

    @property
    def size(self) -> float:
        """What it is ordered by; infinite where no collapse is known."""
        return np.inf if self.result is None else _size(self.result)


@dataclass(eq=False)
class _Group:
    """The load cases of one wall by one method, and the motions that its searches found."""

    cases: list[_LoadCase] = field(default_factory=list)
    motions: list[Motion] = field(default_factory=list)

    def asks(self) -> list[tuple[_LoadCase, Run]]:
        """What is to be run next: motions taken up, then the search of one load case; nothing at the end."""
        waiting = [case for case in self.cases if case.handed < len(self.motions)]
        if waiting:
            return [(case, replace(case.alone, given=tuple(self.motions[case.handed :]))) for case in waiting]
        unknown = [case for case in self.cases if case.result is None]
        governing = min(self.cases, key=lambda case: case.size)
        chosen = unknown[0] if unknown else governing
        return [] if chosen.searched else [(chosen, chosen.alone)]

    def takes(self, case: _LoadCase, run: Run, result: Result) -> None:
        """Note what a run found: a search stands for its case unless that is higher, and hands on what is lower."""
        size = _size(result)
        lower = size < case.size * (1.0 - EQUAL)
        if run.given:
            case.handed = len(self.motions)
        else:
            case.searched = True
        if lower or not (run.given or size > case.size * (1.0 + EQUAL)):
            case.run, case.result = run, result
        if lower and not run.given and result.mechanism is not None:
            self.motions.append(Motion.of(run.key, run.case.assembly, result.mechanism))


def made_together(runs: Sequence[Run], wall_of: Callable[[Run], str], make: Make) -> tuple[list[Run], list[Result]]:
    """The runs that stand for those planned, and their results, in the order planned.

    Args:
        runs: planned, each a search of its own.
        wall_of: the wall of which a run answers one load case; empty where it answers a wall of its own.
        make: makes runs.
    """
    groups = list(_groups(runs, wall_of))
    in_groups = {case.number for group in groups for case in group.cases}
    others = [number for number in range(len(runs)) if number not in in_groups]
    stand, results = list(runs), dict[int, Result]()
    asked = [(group, *pair) for group in groups for pair in group.asks()]
    while others or asked:
        made = make([*(runs[number] for number in others), *(run for _, _, run in asked)])
        results |= dict(zip(others, made, strict=False))
        for (group, case, run), result in zip(asked, made[len(others) :], strict=True):
            group.takes(case, run, result)
        others, asked = [], [(group, *pair) for group in groups for pair in group.asks()]
    for group in groups:
        for case in group.cases:
            assert case.result is not None
            stand[case.number], results[case.number] = case.run, case.result
    return stand, [results[number] for number in range(len(runs))]


def _groups(runs: Sequence[Run], wall_of: Callable[[Run], str]) -> Iterator[_Group]:
    """Runs of one method, with the same settings, on several load cases of one wall.

    Whether a method of others takes up motions is known only where it is loaded: in the process that runs it.
    """
    follow = {name for name in shipped({run.method for run in runs}) if load_method(name).follows_motions}
    groups = defaultdict[Hashable, _Group](_Group)
    for number, run in enumerate(runs):
        if run.method in follow and wall_of(run):
            group = groups[wall_of(run), run.method, json.dumps(dict(run.settings), sort_keys=True)]
            group.cases.append(_LoadCase(number, run, run))
    yield from (group for group in groups.values() if len(group.cases) > 1)


def _size(result: Result) -> float:
    """What load cases are ordered by, of an accepted collapse or fall; infinite of anything else."""
    size = safe_size(result, residual=counts_residual(result))
    return np.inf if size is None else size
