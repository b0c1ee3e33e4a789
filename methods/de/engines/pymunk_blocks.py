"""A wall as whole blocks in a pymunk space, free to move: for what happens after collapse, and for uneven blocks.

Units: length_scale = 1, gravity = 1 (the mean dead load of a block is the weight of a mass of 1). Non-convex blocks
are decomposed into convex ones by Chipmunk. Friction between two blocks is that of their interface; where two blocks
share interfaces of different friction, and where blocks meet that did not touch, it is the least of the wall's.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
import pymunk
import shapely
from pymunk import batch
from pymunk.autogeometry import convex_decomposition

from harness.model.assembly import Assembly, FloatArray, polygon_area
from harness.model.rings import rings_of
from methods.de.engines.pymunk_joints import polygon_gyration


@dataclass(frozen=True)
class BodyTuning:
    """Whole blocks in pymunk.

    Attributes:
        time_step: in units of sqrt(length scale / gravity).
        radius: of the round that Chipmunk puts about a block, in length scales: it keeps blocks so far apart.
        slop: overlap that Chipmunk leaves, in length scales: some keeps contacts from coming and going.
    """

    time_step: float = 2e-3
    radius: float = 1e-4
    slop: float = 5e-4


_FORCE = batch.BodyFields.FORCE | batch.BodyFields.TORQUE
_PLACE = batch.BodyFields.POSITION | batch.BodyFields.ANGLE
_VELOCITY = batch.BodyFields.VELOCITY | batch.BodyFields.ANGULAR_VELOCITY


class PymunkBlocks:
    """Whole blocks under dead + multiplier x live, whose directions stay as they are.

    Args:
        assembly: the wall.
        polygons: (n,) outlines to use instead of the wall's, or None.
        damping: part of the velocity kept by a unit of time sqrt(length_scale / gravity); 1 is none.
        iterations: sweeps of the contact solver in a time step.
        options: of the blocks in pymunk.
        weighed: masses follow from the weights of the blocks, as motion in time needs them; else from their areas.
    """

    def __init__(
        self,
        assembly: Assembly,
        polygons: tuple[FloatArray, ...] | None = None,
        damping: float = 1.0,
        iterations: int = 30,
        options: BodyTuning = BodyTuning(),
        weighed: bool = False,
    ) -> None:
        self.options = options
        self.assembly = assembly
        self.unit = assembly.length_scale
        self._force = assembly.force_scale / max(assembly.n_free, 1)
        self._space = pymunk.Space()
        self._space.iterations = iterations
        self._space.collision_slop = self.options.slop
        self._space.damping = damping
        self._block_of: dict[pymunk.Shape, int] = {}
        self._bodies: list[pymunk.Body] = []
        shapes = assembly.polygons if polygons is None else polygons
        mean = float(np.mean([polygon_area(assembly.polygons[i]) for i in assembly.free]))
        for i in assembly.free:
            mass = assembly.weight[i] / self._force if weighed else polygon_area(assembly.polygons[i]) / mean
            self._add_block(int(i), shapes[i], float(mass))
        for i in np.flatnonzero(assembly.fixed):
            self._add_parts(self._space.static_body, int(i), shapes[i] / self.unit)
        self._set_friction()
        self._loads = batch.Buffer()
        self._out = batch.Buffer()
        self._in = batch.Buffer()
        self._now = np.zeros((assembly.n_free + 1, 3))
        self.load(0.0)

    def _add_block(self, i: int, polygon: FloatArray, mass: float) -> None:
        corners = (self.assembly.polygons[i] - self.assembly.centroid[i]) / self.unit
        body = pymunk.Body(mass, mass * polygon_gyration(corners))
        body.position = tuple(self.assembly.centroid[i] / self.unit)
        self._space.add(body)
        self._bodies.append(body)
        self._add_parts(body, i, (polygon - self.assembly.centroid[i]) / self.unit)

    def _add_parts(self, body: pymunk.Body, i: int, corners: FloatArray) -> None:
        for part in convex_parts(corners):
            shape = pymunk.Poly(body, part, radius=self.options.radius)
            shape.elasticity = 0.0
            self._space.add(shape)
            self._block_of[shape] = i

    def _set_friction(self) -> None:
        least = float(self.assembly.friction.min(initial=1.0e3))
        of_pair: dict[tuple[int, int], float] = {}
        for a, b, mu in zip(self.assembly.block_a, self.assembly.block_b, self.assembly.friction, strict=True):
            pair = (min(int(a), int(b)), max(int(a), int(b)))
            of_pair[pair] = float(mu) if of_pair.get(pair, float(mu)) == float(mu) else least
        for shape in self._block_of:
            shape.friction = float(np.sqrt(least))
        if any(mu != least for mu in of_pair.values()):

            def set_pair(arbiter: pymunk.Arbiter, _space: pymunk.Space, _data: Any) -> None:
                one, two = (self._block_of[shape] for shape in arbiter.shapes)
                arbiter.friction = of_pair.get((min(one, two), max(one, two)), least)

            self._space.on_collision(pre_solve=set_pair)

    def load(self, multiplier: float) -> None:
        """Put dead + multiplier x live on the blocks from now on."""
        total = self.assembly.dead[self.assembly.free] + multiplier * self.assembly.live[self.assembly.free]
        self._now[:-1] = total / np.array([self._force, self._force, self._force * self.unit])
        self._flat = np.ascontiguousarray(self._now).ravel()
        self._loads.set_float_buf(self._flat)

    def advance(self, steps: int) -> None:
        """Make time steps of 0.002 sqrt(length_scale / gravity)."""
        for _ in range(steps):
            batch.set_space_bodies(self._space, _FORCE, self._loads)
            self._space.step(self.options.time_step)

    def places(self) -> FloatArray:
        """(n, 3) displacement (x, y) of the centroids [length] and rotation [radians] of all blocks."""
        result = np.zeros((self.assembly.n_blocks, 3))
        free = self.assembly.free
        read = self._read(_PLACE)[: len(free)]
        result[free, :2] = read[:, :2] * self.unit - self.assembly.centroid[free]
        result[free, 2] = read[:, 2]
        return result

    def put(self, places: FloatArray) -> None:
        """All free blocks at rest at these places, see `places`."""
        free = self.assembly.free
        rows = np.zeros((len(free) + 1, 6))
        rows[:-1, :2] = (self.assembly.centroid[free] + places[free, :2]) / self.unit
        rows[:-1, 2] = places[free, 2]
        self._put = np.ascontiguousarray(rows).ravel()
        self._in.set_float_buf(self._put)
        batch.set_space_bodies(self._space, _PLACE | _VELOCITY, self._in)

    def speed(self) -> float:
        """Largest velocity component of a free block [sqrt(length_scale x gravity)]."""
        return float(np.abs(self._read(_VELOCITY)[: self.assembly.n_free]).max(initial=0.0))

    def energy(self) -> float:
        """Kinetic energy and potential of the dead load, zero at rest as drawn [mean dead load x length_scale]."""
        free, unit = self.assembly.free, np.array([self._force, self._force, self._force * self.unit])
        moved = self.places()[free] / np.array([self.unit, self.unit, 1.0])
        masses = np.array([[body.mass, body.mass, body.moment] for body in self._bodies])
        kinetic = 0.5 * np.sum(masses * self._read(_VELOCITY)[: len(free)] ** 2)
        return float(kinetic - np.sum(self.assembly.dead[free] / unit * moved))

    def _read(self, fields: batch.BodyFields) -> FloatArray:
        self._out.clear()
        batch.get_space_bodies(self._space, fields, self._out)
        return np.frombuffer(self._out.float_buf()).reshape(-1, 3).copy()

    def contacts(self) -> Iterator[tuple[int, int, FloatArray, FloatArray]]:
        """Touching pairs: blocks a < b, unit normal from a into b, and the contact points (1 or 2, 2) [length]."""
        found: list[tuple[int, int, FloatArray, FloatArray]] = []
        seen: set[tuple[int, int]] = set()
        number = {shape: k for k, shape in enumerate(self._block_of)}

        def note(arbiter: pymunk.Arbiter, _: None) -> None:
            one, two = arbiter.shapes
            key = (min(number[one], number[two]), max(number[one], number[two]))
            if key in seen:
                return
            seen.add(key)
            a, b = self._block_of[one], self._block_of[two]
            normal = np.array(arbiter.normal)
            points = [(np.array(p.point_a) + np.array(p.point_b)) / 2 for p in arbiter.contact_point_set.points]
            if a > b:
                a, b, normal = b, a, -normal
            found.append((a, b, normal, np.array(points) * self.unit))

        each: Callable[..., None] = note
        for body in self._bodies:
            body.each_arbiter(each, None)
        yield from sorted(found, key=lambda item: (item[0], item[1], tuple(item[3].ravel())))


def convex_parts(corners: FloatArray) -> list[list[tuple[float, float]]]:
    """A polygon (k, 2), counter-clockwise, as convex ones: itself if it is convex, triangles if it has holes."""
    outer, *holes = rings_of(corners)
    if holes:
        parts = shapely.get_parts(shapely.constrained_delaunay_triangles(shapely.Polygon(outer, holes)))
        return [[(float(x), float(y)) for x, y in part.exterior.coords[:-1]] for part in parts]
    edge = np.roll(corners, -1, axis=0) - corners
    onward = np.roll(edge, -1, axis=0)
    if np.all(edge[:, 0] * onward[:, 1] - edge[:, 1] * onward[:, 0] >= -1e-12):
        return [[(float(x), float(y)) for x, y in corners]]
    closed = [(float(x), float(y)) for x, y in [*corners, corners[0]]]
    return [[(v.x, v.y) for v in part[:-1]] for part in convex_decomposition(closed, 0.0)]
