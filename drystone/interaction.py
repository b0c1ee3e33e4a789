"""The interaction domain of two live loads: every pair of multipliers (x, y) under which a wall stands."""

from __future__ import annotations

import csv
import io
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property, partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from drystone.boundary import FAR, Boundary, BoundaryPoint, Stopped
from drystone.walls import Wall, checked_wall
from harness.engine.judge import judge
from harness.engine.measures import magnitudes
from harness.engine.pipeline import Runs
from harness.engine.plan import check_methods, check_taken
from harness.engine.run import Limits
from harness.model.assembly import Assembly, FloatArray
from harness.model.case import Case
from harness.model.content import exact_hash_of
from harness.model.errors import MOST_NAMED, InputError, first_few
from harness.model.live_load import with_live_load
from harness.model.load_cases import load_cases_of, named_loads_of
from harness.model.method import Method
from harness.model.method_registry import load_method
from harness.model.reading import validate
from harness.model.result import Result

if TYPE_CHECKING:
    from matplotlib.figure import Figure

FINEST = 1e-6
"""Accuracy of a polygon unless another is asked: a thousand times what the judge tolerates of an associated state."""
_LIVE = ((1.0, 0.0), (0.0, -1.0))
"""The loads of a wall without load cases: its weight to the right, and its weight downwards."""


@dataclass(frozen=True)
class LoadPair:
    """Two live loads of one wall that grow independently.

    Attributes:
        names: what they are called.
        cases: the wall under each of them alone, with the same dead load.
    """

    names: tuple[str, str]
    cases: tuple[Case, Case]

    def __post_init__(self) -> None:
        """Both have a live load, the dead loads are the same.

        Raises:
            InputError: if not.
        """
        first, second = (case.assembly for case in self.cases)
        for name, assembly in zip(self.names, (first, second), strict=True):
            if not assembly.has_live_load:
                raise InputError(f'"{name}" has no live load', "Name two load cases with one", source=self.source)
        if not np.array_equal(first.dead, second.dead):
            raise InputError(
                f'the dead loads of "{self.names[0]}" and "{self.names[1]}" differ',
                "Name two load cases with the same dead load and gravity, because only live loads vary in a domain",
                source=self.source,
            )

    @property
    def source(self) -> str:
        """The file of the wall."""
        return self.cases[0].origin

    def loads(self) -> FloatArray:
        """Both live loads (2, n, 3)."""
        return np.array([case.assembly.live for case in self.cases])

    @property
    def scale(self) -> FloatArray:
        """(2,) sizes of the loads beside the first, as powers of two: divided by them they are of about one size."""
        first, second = (magnitudes(case.assembly, case.assembly.live).sum() for case in self.cases)
        return np.array([1.0, 2.0 ** np.round(np.log2(second) - np.log2(first))])

    @classmethod
    def of(cls, case: Case, *, load_cases: Sequence[str] = (), live: Sequence[tuple[float, float]] = ()) -> LoadPair:
        """Two load cases of a wall, or two multiples of its weights.

        Args:
            case: the wall.
            load_cases: two names; none: those of the file, if it has exactly two with a live load.
            live: two multiples of every weight, in place of load cases.

        Raises:
            InputError: not two, or one that the wall does not have.
        """
        if load_cases and live:
            raise InputError("load cases and multiples of the weight are both given", "Give two of one kind")
        for given, kind in ((load_cases, "load cases"), (live, "live loads")):
            if given and (len(given) != 2 or given[0] == given[1]):
                raise InputError(
                    f"a domain is that of two different {kind}", f"Give two of them instead of {len(set(given))}"
                )
        if load_cases or (case.wall.load_case_fields and not live):
            cases = named_loads_of(case)
            names = list(load_cases) or [name for name, load in cases.items() if load.own.live is not None]
            if len(names) != 2:
                raise InputError(
                    f"the wall has {len(names)} load cases with a live load",
                    f"Name two of {first_few(list(cases), MOST_NAMED)} (--load-cases A,B)",
                    case.wall.load_cases_place,
                    case.origin,
                )
            found = [load_cases_of(case, name)[0] for name in names]
        else:
            names = [f"{x:g},{y:g} of the weight" for x, y in live or _LIVE]
            found = [with_live_load(case, x, y) for x, y in live or _LIVE]
        return cls((names[0], names[1]), (found[0], found[1]))


@dataclass(frozen=True)
class CombinedWall:
    """A wall under x times the first and y times the second load of a pair, as a run sees it."""

    pair: LoadPair
    x: float
    y: float

    @property
    def id(self) -> str:
        """The name of the wall."""
        return self.pair.cases[0].wall_id or self.pair.cases[0].id

    @property
    def content(self) -> str:
        """Hash of the assembly."""
        return exact_hash_of(self.assembly)

    @cached_property
    def assembly(self) -> Assembly:
        """The wall with the sum of both loads as its live load; what cancels to rounding is zero."""
        first, second = (case.assembly for case in self.pair.cases)
        parts = self.x * first.live, self.y * second.live
        live = parts[0] + parts[1]
        rounding = 16.0 * np.finfo(float).eps * (abs(parts[0]) + abs(parts[1]))  # of direction, loads and products
        return replace(first, live=np.where(abs(live) <= rounding, 0.0, live))

    @property
    def warnings(self) -> tuple[str, ...]:
        """Those of the wall as it is described."""
        return self.pair.cases[0].warnings


@dataclass(frozen=True, eq=False)
class Domain:
    """All pairs of multipliers under which a wall stands, by one method.

    Attributes:
        names: of the two loads.
        method: that answered.
        bounds_above: whether the method's multipliers are upper bounds: a wall may fall inside the boundary.
        exact: whether it is the whole polygon of an associated method; otherwise points of the boundary.
        points: counter-clockwise by direction; of an exact domain the vertices, and the directions of unbounded edges.
        edges: (k, 2) normals of the edges of an exact domain, normal . (x, y) <= 1.
        excess: largest relative distance by which a meeting point of two edges lies outside what the wall bears, or
            one of two neighbours off the edge of the other that was taken for theirs.
        runs: number of runs.
        reason: why it is incomplete; empty where it is not.
    """

    names: tuple[str, str]
    method: str
    bounds_above: bool
    exact: bool
    points: tuple[BoundaryPoint, ...]
    edges: FloatArray
    excess: float
    runs: int
    reason: str

    @property
    def vertices(self) -> FloatArray:
        """(k, 2) points of the boundary where the wall collapses, counter-clockwise."""
        return np.array([point.at for point in self.points if point.bounded]).reshape(-1, 2)

    @property
    def unbounded(self) -> FloatArray:
        """(k, 2) directions that were asked and in which the wall bears every multiple."""
        return np.array([point.direction for point in self.points if not point.bounded]).reshape(-1, 2)

    @property
    def sentence(self) -> str:
        """What was found and how sure it is."""
        loads = f'of "{self.names[0]}" (x) and "{self.names[1]}" (y)'
        count = len(self.vertices)
        whole = self.exact and not self.reason
        if whole and not len(self.edges):
            what = f"The wall bears every pair of multipliers {loads}: the domain has no boundary."
        elif not count and not whole:
            what = f"No boundary of the domain {loads} was found."
        elif whole:
            opened = f", unbounded as far as it was followed ({FAR:g} times)" if len(self.unbounded) else ""
            corners = "vertex" if count == 1 else "vertices"
            shape = f"convex polygon of {len(self.edges)} edges and {count} {corners}"
            if not count:
                shape = "half-plane behind one edge" if len(self.edges) == 1 else "strip between two parallel edges"
            what = (
                f"The domain {loads} is a {shape}{opened}. "
                "Outside its edges no equilibrium within yield exists, whatever the flow of the joints."
            )
            if self.excess > FINEST:
                what += f" Its vertices lie inside the lines of its edges by up to {self.excess:.1%}."
        else:
            what = (
                f"{count} points of the boundary of the domain {loads} by {self.method}; between them it is not known."
            )
        inside = " It is an upper bound: inside, a wall whose joints slide without dilatancy may fall."
        return f"{what}{inside if self.bounds_above and (count or len(self.edges)) else ''} {self.reason}".strip()

    def as_json(self) -> dict[str, Any]:
        """JSON values: loads, points with their brackets, edges, sentence."""
        return {
            "loads": list(self.names),
            "method": self.method,
            "bounds_above": self.bounds_above,
            "exact": self.exact and not self.reason,
            "points": [
                {
                    "direction": point.direction.tolist(),
                    "at": point.at.tolist() if point.bounded else None,
                    "bracket": list(point.bracket) if point.bounded else None,
                    "finding": str(point.result.finding),
                    "judge": str(point.result.judge.outcome),
                }
                for point in self.points
            ],
            "edges": self.edges.tolist(),
            "runs": self.runs,
            "sentence": self.sentence,
        }

    def as_csv(self) -> str:
        """One row a point: x, y, the ends of its bracket; a direction without a boundary has the finding only."""
        text = io.StringIO()
        out = csv.writer(text, lineterminator="\n")
        out.writerow(["direction_x", "direction_y", "x", "y", "bracket_lower", "bracket_upper", "finding"])
        for point in self.points:
            place = [*point.at, *point.bracket] if point.bounded else ["", "", "", ""]
            out.writerow([*point.direction, *place, str(point.result.finding)])
        return text.getvalue()

    def plot(self) -> Figure:
        """A figure of the domain."""
        from reports.figures.domain import domain_figure

        whole = self.exact and not self.reason
        bound = ", an upper bound" if self.bounds_above else ""
        head = f"{self.method}: {'the whole domain' if whole else 'points of the boundary'}{bound}"
        return domain_figure(self.names, head, self.vertices, self.unbounded, exact=whole)


def domain(
    wall: Wall,
    method: str = "la-associated",
    *,
    load_cases: Sequence[str] = (),
    live: Sequence[tuple[float, float]] = (),
    accuracy: float | None = None,
    most: int = 200,
    isolated: bool = False,
    seconds: float = Limits().seconds,
    memory_bytes: int = Limits().memory_bytes,
    store: str | Path | None = None,
    **settings: Any,
) -> Domain:
    """The interaction domain of two live loads of a wall.

    >>> from drystone import library_wall
    >>> found = domain(library_wall("single-block"))
    >>> len(found.edges), len(found.vertices)
    (2, 1)

    Args:
        wall: the wall.
        method: the name of the method; one of an associated maximum gives the whole polygon.
        load_cases, live: which loads, as of `LoadPair.of`.
        accuracy: relative distance at which a meeting point of two edges is a vertex, or a boundary between two points
            straight; None: 1e-6 for a polygon, 1 % for points.
        most: number of runs after which it stops.
        isolated, seconds, memory_bytes, store, settings: as of `analyse`; limits are of one run.

    Raises:
        InputError: an unknown method or setting, loads that are not two, or a wall that the method refuses.
    """
    pair = LoadPair.of(checked_wall(wall).case, load_cases=load_cases, live=live)
    runs = Runs(Limits(seconds, memory_bytes) if isolated else None, store)
    return domain_by(pair, method, settings, accuracy=accuracy, most=most, runs=runs)


def domain_by(
    pair: LoadPair,
    method: str,
    settings: dict[str, Any],
    *,
    accuracy: float | None = None,
    most: int = 200,
    runs: Runs = Runs(),
) -> Domain:
    """As `domain`, of two loads, with settings that may have any name; `runs` says how they are made.

    Raises:
        InputError: as `domain`.
    """
    loaded = _checked(pair, method, settings)
    # Where joints crush the domain of an associated method is convex, but no polygon.
    exact = loaded.traits.bounds_above and not pair.cases[0].assembly.crushes
    if accuracy is None:
        accuracy = FINEST if exact else 1e-2
    if not 1e-9 <= accuracy < 1.0:
        raise InputError(f"the accuracy {accuracy:g} is out of range", "Give one from 1e-9 to below 1", "accuracy")
    scale = pair.scale

    def run(direction: FloatArray) -> Result:
        x, y = (direction / scale).tolist()
        return runs.result(CombinedWall(pair, x, y), method, settings, partial(judge, alone=True))

    unit = pair.cases[0].assembly.load_unit
    boundary = Boundary(pair.loads() / scale[:, None, None], unit, run, accuracy, most)
    try:
        (boundary.polygon if exact else boundary.points_between)()
    except Stopped as stop:
        boundary.reason = str(stop)
    found = boundary.corners() if exact and not boundary.reason else boundary.all_points()
    return Domain(
        pair.names,
        method,
        loaded.traits.bounds_above,
        exact,
        tuple(point.of_loads(scale) for point in found),
        boundary.edges() * scale,
        boundary.excess,
        boundary.runs,
        boundary.reason,
    )


def _checked(pair: LoadPair, method: str, settings: dict[str, Any]) -> Method:
    check_methods([method], "--method")
    loaded = load_method(method)
    validate(loaded.Settings, settings, "settings")
    check_taken(loaded, pair.cases[0], "--method")
    return loaded
