"""The numeric view of a wall that every method computes on: blocks, interfaces and loads as arrays.

Sign conventions, used everywhere in Drystone
---------------------------------------------
* A block i has the velocity (ux, uy, omega) at its centroid c; omega is counter-clockwise.
  The velocity of its point x is (ux - omega (y - cy), uy + omega (x - cx)).
* An interface p joins block a to block b along the segment end 1 -> end 2. Its unit normal n points
  from a into b, its unit tangent t from end 1 to end 2; (t, n) is right-handed or left-handed as the
  geometry has it.
* Contact forces (n1, n2, s) are the forces *of a on b*: (n1 + n2) n + s t, with n1, n2 >= 0 compression at
  the two ends and s the shear. Block a receives the opposite.
* Generalised strains (open1, open2, slip) are the velocity of b relative to a: along n at end 1, along n at
  end 2, along t. Friction opposes slip: slip > 0 goes with s = -mu (n1 + n2).
* Equilibrium of the free blocks: C' r + dead + multiplier * live = 0, where C u = strains.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property, partial
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from harness.model.bars import Bars
from harness.model.joint_law import JointLaw

if TYPE_CHECKING:
    import scipy.sparse as sp  # walls are read, drawn and judged without: methods that need it load it

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]
BoolArray = NDArray[np.bool_]

OF_BLOCKS = ("polygons", "centroid", "weight", "fixed", "dead", "live", "support_motion")
_OF_JOINTS = (
    "block_a",
    "block_b",
    "end1",
    "end2",
    "face1",
    "face2",
    "normal",
    "friction",
    "dilatancy",
    "constant",
    "crushing",
    "brittle",
    "bar_stiffness",
)
_PLAIN = {"constant": 0.0, "crushing": np.inf, "brittle": False, "bar_stiffness": 0.0, "support_motion": 0.0}
"""What joints and blocks have in an array that is left out."""


@dataclass(frozen=True, eq=False)
class Assembly:
    """Blocks in contact, as arrays. n = number of blocks, m = number of interfaces.

    Attributes:
        name: what the wall is called, for messages.
        block_ids: (n,) names of the blocks.
        polygons: (n,) arrays (k, 2) of vertices, counter-clockwise [length].
        centroid: (n, 2) centroids [length].
        weight: (n,) weights, zero or more [force].
        fixed: (n,) whether the block cannot move.
        block_a, block_b: (m,) indices of the two blocks of each interface.
        end1, end2: (m, 2) the two contact points of each interface [length].
        face1, face2: (m, 2) ends of the touching segment before contact points were set in [length].
        normal: (m, 2) unit normals, from a into b.
        friction: (m,) friction coefficients mu = tan(phi), zero or more.
        dilatancy: (m,) coefficients by which a slip lifts the ends, from zero to the friction.
        joint: (m,) names of the joints ("bed", "head" or as given).
        dead, live: (n, 3) generalised loads (fx, fy, moment about the centroid); zero on fixed blocks.
        constant: (m, 4) constant parts of the yield slacks [force], as `joint_law` has them; zero for dry joints.
        crushing: (m,) compression f_c A at which a joint crushes, pressed evenly and without tension [force]; infinite
            where it does not.
        brittle: (m,) whether a joint loses its constant part once it has opened at an end or slipped.
        bar_stiffness: (m,) zero for joints; of rows that are ties and props (`with_bars_as_joints`) the force for a
            unit of elongation [force/length], nan where none is given.
        support_motion: (n, 3) prescribed motion (ux, uy, omega) of fixed blocks as a direction, whose greatest
            translation is one length or, of rotations alone, greatest rotation one radian; zero where supports rest,
            and on free blocks.
        bars: ties and props between blocks; their prestress is part of the dead load.
    """

    name: str
    block_ids: tuple[str, ...]
    polygons: tuple[FloatArray, ...]
    centroid: FloatArray
    weight: FloatArray
    fixed: BoolArray
    block_a: IntArray
    block_b: IntArray
    end1: FloatArray
    end2: FloatArray
    face1: FloatArray
    face2: FloatArray
    normal: FloatArray
    friction: FloatArray
    dilatancy: FloatArray
    joint: tuple[str, ...]
    dead: FloatArray
    live: FloatArray
    constant: FloatArray = field(default_factory=partial(np.zeros, (0, 4)))
    crushing: FloatArray = field(default_factory=partial(np.zeros, 0))
    brittle: BoolArray = field(default_factory=lambda: np.zeros(0, dtype=bool))
    bar_stiffness: FloatArray = field(default_factory=partial(np.zeros, 0))
    support_motion: FloatArray = field(default_factory=partial(np.zeros, (0, 3)))
    bars: Bars = field(default_factory=Bars)

    def __post_init__(self) -> None:
        """Every joint has one entry in each array of joints, every block in each of blocks; only fixed ones are moved.

        Raises:
            ValueError: if not, naming the array.
        """
        for name, plain in _PLAIN.items():
            given = getattr(self, name)
            if not len(given):
                count = len(self.block_ids if name in OF_BLOCKS else self.joint)
                object.__setattr__(self, name, np.full((count, *given.shape[1:]), plain))
        for names, count in ((OF_BLOCKS, len(self.block_ids)), (_OF_JOINTS, len(self.joint))):
            for name in names:
                if len(getattr(self, name)) != count:
                    raise ValueError(f"{name} has {len(getattr(self, name))} entries for {count}")
        if np.any(self.support_motion[~self.fixed]):
            raise ValueError("support_motion moves a block that is not fixed")

    @cached_property
    def law(self) -> JointLaw:
        """The law of its joints."""
        return JointLaw(self.friction, self.dilatancy, self.constant)

    @cached_property
    def is_bar(self) -> BoolArray:
        """(m,) rows that are ties and props, of `bars.with_bars_as_joints`."""
        return np.asarray(self.friction < 0.0)

    def with_joints(self, kept: IntArray | BoolArray) -> Assembly:
        """The same blocks with these interfaces alone, by index in this order or by a mask (m,)."""
        index = np.arange(self.n_interfaces)[kept]
        arrays = {name: getattr(self, name)[index] for name in _OF_JOINTS}
        return replace(self, joint=tuple(self.joint[p] for p in index), **arrays)

    def with_further_joints(self, names: Sequence[str], **arrays: NDArray[Any]) -> Assembly:
        """The wall with further joints behind those that it has.

        Args:
            names: (k,) of the joints.
            arrays: (k, ...) of them by name; those that are left out have what plain joints have.
        """
        further = {
            name: arrays[name]
            if name in arrays
            else np.full((len(names), *getattr(self, name).shape[1:]), _PLAIN[name])
            for name in _OF_JOINTS
        }
        joined: dict[str, Any] = {name: np.concatenate([getattr(self, name), more]) for name, more in further.items()}
        return replace(self, joint=(*self.joint, *names), **joined)

    def copied(self) -> Assembly:
        """The same wall in arrays of its own: what a method does to them changes no other."""
        names = (*OF_BLOCKS, *_OF_JOINTS)
        arrays = {name: getattr(self, name).copy() for name in names if name != "polygons"}
        polygons = tuple(polygon.copy() for polygon in self.polygons)
        return replace(self, polygons=polygons, bars=self.bars.copied(), **arrays)

    @property
    def dilates(self) -> bool:
        """Whether any joint has a dilatancy."""
        return bool(np.any(self.dilatancy != 0.0))

    @property
    def strong(self) -> bool:
        """Whether any joint has cohesion or tensile strength."""
        return not self.law.is_cone

    @property
    def crushes(self) -> bool:
        """Whether any joint has a compressive strength."""
        return bool(np.isfinite(self.crushing).any())

    @cached_property
    def breaks(self) -> bool:
        """Whether any joint is brittle."""
        return bool(self.brittle.any())

    @property
    def without_strength(self) -> Assembly:
        """The same wall without cohesion and tensile strength."""
        return self.with_broken(np.ones(self.n_interfaces, dtype=bool))

    @property
    def residual(self) -> Assembly:
        """The wall with what is left once its brittle joints have moved: without strength, where none is said to be."""
        return self.with_broken(self.brittle) if self.breaks else self.without_strength

    def with_broken(self, broken: BoolArray) -> Assembly:
        """The same wall whose joints `broken` (m,) have lost cohesion and tensile strength."""
        constant = np.where(broken[:, None], 0.0, self.constant)
        return replace(self, constant=constant, brittle=self.brittle & ~broken)

    @property
    def n_blocks(self) -> int:
        """Number of blocks, the fixed ones included."""
        return len(self.weight)

    @property
    def n_interfaces(self) -> int:
        """Number of interfaces."""
        return len(self.friction)

    @cached_property
    def free(self) -> IntArray:
        """(n_free,) indices of the blocks that can move."""
        return np.flatnonzero(~self.fixed)

    @property
    def n_free(self) -> int:
        """Number of blocks that can move: the paper's n."""
        return len(self.free)

    @cached_property
    def length(self) -> FloatArray:
        """(m,) distance between the two contact points of each interface [length]."""
        return np.asarray(np.linalg.norm(self.end2 - self.end1, axis=1))

    @cached_property
    def tangent(self) -> FloatArray:
        """(m, 2) unit tangents, from end 1 to end 2."""
        return np.asarray((self.end2 - self.end1) / self.length[:, None])

    @cached_property
    def corners(self) -> tuple[FloatArray, IntArray]:
        """(v, 2) vertices of all blocks, one block after the other [length], and (v,) the block of each."""
        block = np.repeat(np.arange(self.n_blocks), [len(polygon) for polygon in self.polygons])
        return np.concatenate(self.polygons), block

    @cached_property
    def radius(self) -> FloatArray:
        """(n,) largest distance of a vertex of every block from its centroid [length]."""
        pairs = zip(self.polygons, self.centroid, strict=True)
        return np.array([float(np.hypot(*(polygon - centroid).T).max()) for polygon, centroid in pairs])

    @cached_property
    def force_scale(self) -> float:
        """Total magnitude of the dead load on the free blocks (their total weight in the usual case) [force]."""
        total = float(np.linalg.norm(self.dead[self.free, :2], axis=1).sum())
        if total > 0.0:
            return total
        total = float(self.weight[self.free].sum())
        if total > 0.0:
            return total
        return float(np.linalg.norm(self.live[self.free, :2], axis=1).sum()) or 1.0

    @cached_property
    def length_scale(self) -> float:
        """Typical size of a free block: mean square root of the polygon areas [length]."""
        areas = [polygon_area(self.polygons[i]) for i in self.free]
        return float(np.mean(np.sqrt(areas)))

    @cached_property
    def middle(self) -> FloatArray:
        """Mean centroid (2,) of the free blocks [length]; about it coordinates of a national grid keep their digits."""
        return np.asarray(self.centroid[self.free].mean(axis=0))

    @cached_property
    def load_unit(self) -> float:
        """Multiplier at which the live load is as large as the dead load (sums of force and moment / size over blocks).

        One where the live load is a tilt; what is small of a multiplier is small against this.
        """
        live = self.live[self.free]
        size = np.hypot(live[:, 0], live[:, 1]) + np.abs(live[:, 2]) / self.length_scale
        total = float(size.sum())
        return self.force_scale / total if total > 0.0 else 1.0

    @property
    def has_live_load(self) -> bool:
        """Whether any free block carries a live load."""
        return bool(np.any(self.live[self.free] != 0.0))

    @cached_property
    def kinematic_matrix(self) -> sp.csr_matrix:
        """Sparse (3m, 3 n_free) matrix C: rows (open1, open2, slip), columns (ux, uy, omega) of the free blocks.

        Used by the methods; the judge does not use it.
        """
        return self._strains_of(self.free)

    @cached_property
    def support_strains(self) -> FloatArray:
        """(m, 3) strains (open1, open2, slip) that the motion of the supports makes while the free blocks rest."""
        fixed = np.flatnonzero(self.fixed)
        return np.asarray(self._strains_of(fixed) @ self.support_motion[fixed].ravel()).reshape(-1, 3)

    def _strains_of(self, blocks: IntArray) -> sp.csr_matrix:
        """Sparse (3m, 3k) matrix of the strains that the velocities of k blocks make."""
        import scipy.sparse as sp

        column = np.full(self.n_blocks, -1, dtype=np.int64)
        column[blocks] = np.arange(len(blocks))
        rows: list[IntArray] = []
        columns: list[IntArray] = []
        values: list[FloatArray] = []
        base = 3 * np.arange(self.n_interfaces)
        for side, sign in ((self.block_a, -1.0), (self.block_b, 1.0)):
            moving = column[side] >= 0
            for k, (direction, point) in enumerate(
                ((self.normal, self.end1), (self.normal, self.end2), (self.tangent, self.end1))
            ):
                arm = point - self.centroid[side]
                lever = arm[:, 0] * direction[:, 1] - arm[:, 1] * direction[:, 0]
                for j, value in enumerate((direction[:, 0], direction[:, 1], lever)):
                    rows.append((base + k)[moving])
                    columns.append((3 * column[side] + j)[moving])
                    values.append((sign * value)[moving])
        return sp.csr_matrix(
            (np.concatenate(values), (np.concatenate(rows), np.concatenate(columns))),
            shape=(3 * self.n_interfaces, 3 * len(blocks)),
        )

    def free_loads(self) -> tuple[FloatArray, FloatArray]:
        """Dead and live load vectors (3 n_free,) on the free blocks, in the column order of `kinematic_matrix`."""
        return self.dead[self.free].ravel(), self.live[self.free].ravel()

    def velocity_units(self) -> FloatArray:
        """(3 n_free,) units of velocity in which a rotation counts times the length scale, in the same order."""
        return np.tile([1.0, 1.0, 1.0 / (self.length_scale or 1.0)], self.n_free)


def polygon_area(polygon: FloatArray) -> float:
    """Area enclosed by a polygon (k, 2) [length^2], without sign."""
    return abs(signed_area(polygon))


def signed_area(polygon: FloatArray) -> float:
    """Area enclosed by a polygon (k, 2) [length^2], positive if its vertices run counter-clockwise.

    It is computed about the first vertex: in a national grid the coordinates are millions of times a block.
    """
    x, y = (polygon - polygon[0]).T
    following = [*range(1, len(polygon)), 0]
    return float(np.dot(x, y[following]) - np.dot(y, x[following])) / 2.0
