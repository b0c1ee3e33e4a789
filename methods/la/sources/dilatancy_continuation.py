"""The state at the end of a path along which flow changes from associated to that of zero dilatancy."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import ClassVar

from methods.la.core.problem import Problem
from methods.la.core.state import CollapseState
from methods.la.interior.arc import ArcPath
from methods.la.interior.interior_point import PathSettings, start_point
from methods.la.sources.search import Search


@dataclass(frozen=True)
class DilatancyContinuation:
    """The path of the whole wall from its associated one to zero dilatancy, past its folds, where no state is known.

    Joints that the dead load leaves unloaded may press under the live load, as those between the openings of a facade
    do. Forces of the wall then fit no mechanism of paths with part of their friction; this one has all of it.

    Attributes:
        least: interfaces from which it is followed.
        begin: how far the associated path is followed; full steps may end below its gap.
        faded: share of the first tau at which the dilatancy is that of the joints.
        gaps: at which the mechanism of the path is tried.
        least_steps: Newton steps from one of them to the next, or one a block where those are more.
    """

    name: ClassVar[str] = "dilatancy continuation"
    least: int = 1001
    begin: PathSettings = field(default_factory=lambda: PathSettings(dilatancy=1.0, gap=0.1, residual=1e-3))
    faded: float = 1e-2
    gaps: tuple[float, ...] = (1e-8, 1e-9)
    least_steps: int = 1000

    def applies(self, problem: Problem) -> bool:
        """On walls too large for descents."""
        return problem.n_interfaces >= self.least

    def states(self, search: Search) -> Iterator[CollapseState]:
        """One state a gap at which forces fit the mechanism."""
        if search.record.known:
            return
        problem = search.problem
        begun = search.follow(start_point(problem), self.begin)
        if not begun.converged:
            return
        arc = ArcPath(problem, search.newton, begun.point, spread=1.0, faded=self.faded)
        for gap in self.gaps:
            path = arc.follow(gap, max(self.least_steps, problem.n_velocities // 3))
            search.stepped(path.iterations)
            if not path.converged:
                return
            state = search.nearest_state(path.point.slack)
            if state is not None:
                yield state
