"""The boundary of an interaction domain: the edges of a convex polygon, or points of a curve.

With associated flow the domain is a convex polygon, possibly unbounded. A collapse state in one direction gives one of
its edges, because the power of the loads on the mechanism is (Drucker, Prager and Greenberg 1952)

    p1 x + p2 y <= p1 x0 + p2 y0,   p_k = l_k . u

at every (x, y) that the wall bears, with l_k the loads (n, 3), u the motion (n, 3), and (x0, y0) the multipliers of the
state. Two neighbouring edges meet in a point; if the wall bears it, it is a vertex, otherwise its direction gives a new
edge. The polygon is complete when every meeting point is a vertex. Without dilatancy the domain need not be convex, so
its boundary is sampled: directions are halved until the boundary between them is straight enough.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field, replace

import numpy as np

from harness.model.assembly import FloatArray
from harness.model.method import Finding, Status
from harness.model.result import Result

_PARALLEL = 1e-9
"""Sine of an angle between two directions that is rounding."""
SAME = 1e-6
"""Relative distance of two points from the edge of the other up to which both edges are one: a thousand times what the
judge tolerates of an associated state. A coarser one would join edges that differ, and the lines of neither would pass
through both ends of what they were taken for."""
FAR = 100.0
"""The edge of a polygon is followed to this multiple of its nearest point, and points to this multiple of the dead load
or of their nearest. Farther out the weight is so small beside the live load that a linear programme has too few digits
for the judge's tolerance of 1e-9."""


@dataclass(frozen=True, eq=False)
class BoundaryPoint:
    """Where the boundary of a domain lies in one direction.

    Attributes:
        direction: (2,) of the plane of the two multipliers.
        reach: multiple of the direction at which the wall collapses; infinite: it bears every multiple;
            nan: unknown.
        bracket: the ends between which a measured reach lies; both are the reach if it is computed.
        normal: (2,) of the edge, with normal . (x, y) <= 1 in the whole domain; None: no edge follows from it.
        result: the judged answer.
    """

    direction: FloatArray
    reach: float
    bracket: tuple[float, float]
    normal: FloatArray | None
    result: Result

    @property
    def at(self) -> FloatArray:
        """The point (2,), or the direction in which there is none."""
        return self.direction * (self.reach if math.isfinite(self.reach) else 1.0)

    @property
    def bounded(self) -> bool:
        """Whether the wall collapses in this direction."""
        return math.isfinite(self.reach)

    def of_loads(self, scale: FloatArray) -> BoundaryPoint:
        """The same point in the plane of loads that are `scale` (2,) times larger."""
        normal = None if self.normal is None else self.normal * scale
        return replace(self, direction=self.direction / scale, normal=normal)


class Stopped(Exception):
    """No further run helps: the text says why."""


class Refused(Stopped):
    """One direction has no accepted answer.

    Attributes:
        result: that is none.
    """

    def __init__(self, text: str, result: Result) -> None:
        """The text says why."""
        super().__init__(text)
        self.result = result


@dataclass
class Boundary:
    """The boundary of a domain as its runs trace it.

    Attributes:
        loads: (2, n, 3), of about the same size, so that angles of the plane have digits on both axes; unit: multiplier
            at which one is as large as the dead load; run: makes the judged result of a direction; accuracy, most: as
            of `domain`.
        found: every point, by the angle of its direction; vertices: ids of those that are corners of a polygon.
        excess, runs, reason: as of `Domain`.
    """

    loads: FloatArray
    unit: float
    run: Callable[[FloatArray], Result]
    accuracy: float
    most: int
    found: list[BoundaryPoint] = field(default_factory=list)
    vertices: list[BoundaryPoint] = field(default_factory=list)
    excess: float = 0.0
    runs: int = 0
    reason: str = ""

    def polygon(self) -> None:
        """Find every edge, from the four directions of the axes on.

        Raises:
            Stopped: two neighbouring vertices have no edge in common, so one was missed; or as `ask`.
        """
        self._all_sides(self.ask, self._edge_between)
        sides = self._sides()
        if missing := sum(line is None for line in sides):
            raise Stopped(
                f"The edges and vertices found make no whole polygon: {missing} of {len(sides)} sides have no edge, "
                "because the two loads are so nearly multiples of each other that their digits do not suffice."
            )

    def points_between(self) -> None:
        """Halve directions, from the four of the axes on, the most curved part of the boundary first."""
        self._all_sides(self._asked, self._halve)

    def _all_sides(
        self,
        ask: Callable[[FloatArray], BoundaryPoint],
        between: Callable[[BoundaryPoint, BoundaryPoint], list[tuple[BoundaryPoint, BoundaryPoint]]],
    ) -> None:
        axes = [ask(np.array(way)) for way in ((1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0))]
        waiting = list(zip(axes, [*axes[1:], axes[0]], strict=True))
        while waiting:
            waiting += between(*waiting.pop(0))

    def ask(self, direction: FloatArray) -> BoundaryPoint:
        """The boundary in a direction.

        Raises:
            Refused: the answer is not accepted.
            Stopped: the wall does not stand under its dead load, or there were enough runs.
        """
        if self.runs >= self.most:
            raise Stopped(f"It stopped after {self.runs} runs; ask for more.")
        self.runs += 1
        result = self.run(direction)
        if result.status is not Status.OK or result.judge.accepted is not True:
            said = result.sentence if result.status is not Status.OK else result.judge.sentence
            raise Refused(
                f"In the direction ({direction[0]:.6g}, {direction[1]:.6g}) there is no accepted answer: {said}", result
            )
        if result.finding is Finding.FALLS:
            raise Stopped("The wall falls under its dead load.")
        point = self._point(direction, result)
        self.found.append(point)
        return point

    def _point(self, direction: FloatArray, result: Result) -> BoundaryPoint:
        if not result.finding.has_multiplier or result.multiplier is None:
            return BoundaryPoint(direction, math.inf, (math.inf, math.inf), None, result)
        reach = result.multiplier
        bracket = (reach, reach) if result.bracket is None else (result.bracket[0], result.bracket[1])
        normal = None
        if result.mechanism is not None and reach > 0.0:
            powers = np.einsum("kij,ij->k", self.loads, np.asarray(result.mechanism, dtype=float))
            normal = powers / (powers @ direction * reach)
        return BoundaryPoint(direction, reach, bracket, normal, result)

    def _edge_between(self, a: BoundaryPoint, b: BoundaryPoint) -> list[tuple[BoundaryPoint, BoundaryPoint]]:
        """Ask the direction in which the edges of two neighbours meet; the two pairs that it leaves, or none."""
        if not a.bounded and not b.bounded:
            return []
        if (a.bounded and a.normal is None) or (b.bounded and b.normal is None):
            raise Stopped("The wall is at its limit under its dead load: no edge follows from its mechanism.")
        if a.bounded and b.bounded:
            assert a.normal is not None
            assert b.normal is not None
            difference = a.normal - b.normal
            apart = float(max(abs(a.normal @ b.at - 1.0), abs(b.normal @ a.at - 1.0)))
            if apart <= min(self.accuracy, SAME):
                self.excess = max(self.excess, apart)
                return []  # one edge
        else:
            normal = a.normal if a.bounded else b.normal
            assert normal is not None
            difference = normal
        meeting = np.array([-difference[1], difference[0]])
        meeting *= np.sign(_cross(a.direction, meeting)) or 1.0
        meeting /= np.hypot(*meeting)
        at_a, at_b = _cross(a.direction, meeting) <= _PARALLEL, _cross(meeting, b.direction) <= _PARALLEL
        if at_a or at_b:
            self.vertices.append(a if at_a else b)  # the edge of one ends at the other, or in its direction
            return []
        if not a.bounded or not b.bounded:
            return self._along(meeting, a, b)
        point = self.ask(meeting)
        beyond = max(float(line @ point.at) for line in (a.normal, b.normal) if line is not None)
        if point.bounded and beyond >= 1.0 - self.accuracy:
            self.excess = max(self.excess, abs(1.0 - beyond))
            self.vertices.append(point)
            return []
        return [(a, point), (point, b)]

    def _along(
        self, asymptote: FloatArray, a: BoundaryPoint, b: BoundaryPoint
    ) -> list[tuple[BoundaryPoint, BoundaryPoint]]:
        """Ask far along the edge of the one neighbour that is bounded: it goes on, or another edge cuts it."""
        near = a if a.bounded else b
        assert near.normal is not None
        point = self.ask(asymptote + near.direction / FAR)
        if point.bounded and abs(near.normal @ point.at - 1.0) > self.accuracy:
            return [(a, point), (point, b)]
        self.vertices.append(BoundaryPoint(asymptote, math.inf, (math.inf, math.inf), None, point.result))
        return []

    def _asked(self, direction: FloatArray) -> BoundaryPoint:
        """The boundary in a direction, or one of unknown reach where the answer is not accepted.

        Raises:
            Stopped: as `ask`.
        """
        try:
            return self.ask(direction)
        except Refused as refused:
            self.reason = self.reason or str(refused)
            return BoundaryPoint(direction, math.nan, (math.nan, math.nan), None, refused.result)

    def _halve(self, a: BoundaryPoint, b: BoundaryPoint) -> list[tuple[BoundaryPoint, BoundaryPoint]]:
        """Ask the direction half-way between neighbours; the two pairs that it leaves, or none where the chord holds.

        There is no chord to a direction that ends at the origin, is followed no further or of unknown reach.
        """
        far = FAR * max(self.unit, min((end.reach for end in self.found), default=0.0))
        narrow = _cross(a.direction, b.direction) <= self.accuracy
        if narrow or a.reach == b.reach == 0.0 or not (a.reach < far or b.reach < far):
            return []
        middle = a.direction + b.direction
        middle /= np.hypot(*middle)
        point = self._asked(middle)
        if all(0.0 < end.reach < far for end in (a, b)):
            chord = _cross(a.at, b.at) / (_cross(a.at, middle) + _cross(middle, b.at))
            if abs(point.reach - chord) <= self.accuracy * chord:
                return []
        return [(a, point), (point, b)]

    def all_points(self) -> tuple[BoundaryPoint, ...]:
        """Every point by the angle of its direction."""
        return _by_angle(self.found)

    def corners(self) -> tuple[BoundaryPoint, ...]:
        """The corners of a polygon by angle, with the directions of its unbounded edges."""
        return _by_angle({id(point): point for point in self.vertices}.values())

    def edges(self) -> FloatArray:
        """(k, 2) normals of the edges, by angle: lines through two vertices, or one and an unbounded direction."""
        lines = [line for line in self._sides() if line is not None]
        return np.array(sorted(lines, key=lambda line: math.atan2(line[1], line[0]))).reshape(-1, 2)

    def _sides(self) -> list[FloatArray | None]:
        """The edge of every two neighbouring corners; None: no line found passes through both.

        Between two unbounded directions there is none, except that of a strip or half-plane, where they are opposite.
        """
        corners = self.corners()
        sides: list[FloatArray | None] = []
        for a, b in zip(corners, [*corners[1:], *corners[:1]], strict=True):
            turn = _cross(a.direction, b.direction)
            opposite = abs(turn) <= _PARALLEL and float(a.direction @ b.direction) < 0.0
            if a.bounded or b.bounded:
                sides.append(self._line_through(a, b) if turn > 0.0 else None)
            elif opposite and (line := self._line_through(a, b)) is not None:
                sides.append(line)
            elif not opposite and turn < 0.0:
                sides.append(None)
        return sides

    def _line_through(self, a: BoundaryPoint, b: BoundaryPoint) -> FloatArray | None:
        """The line of a point between two corners that passes through both; where there is none, of one at a corner.

        The mechanism at a vertex may be any mixture of those of its two edges, therefore the points between come first.
        """
        for least in (_PARALLEL, -_PARALLEL):
            lines = [
                point.normal
                for point in self.found
                if point.normal is not None
                and _cross(a.direction, point.direction) > least * np.hypot(*a.direction) * np.hypot(*point.direction)
                and _cross(point.direction, b.direction) > least * np.hypot(*b.direction) * np.hypot(*point.direction)
            ]
            best = min(lines, key=lambda line: max(_beside(line, a), _beside(line, b)), default=None)
            if best is not None and max(_beside(best, a), _beside(best, b)) <= self.accuracy:
                return best
        return None


def _beside(line: FloatArray, corner: BoundaryPoint) -> float:
    """Relative distance of a corner from a line, or sine of the angle between an unbounded direction and the line."""
    if corner.bounded:
        return float(abs(line @ corner.at - 1.0))
    return float(abs(line @ corner.direction) / (np.hypot(*line) * np.hypot(*corner.direction)))


def _by_angle(points: Iterable[BoundaryPoint]) -> tuple[BoundaryPoint, ...]:
    return tuple(sorted(points, key=lambda point: math.atan2(point.direction[1], point.direction[0])))


def _cross(a: FloatArray, b: FloatArray) -> float:
    return float(a[0] * b[1] - a[1] * b[0])
