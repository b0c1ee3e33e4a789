"""Margins of joints: how much of its strength each joint uses, where its force acts, and the stress at its edge.

The joint law gives the yield slacks y1, y2 of its two ends and its shear strength (`harness.model.joint_law`). The
shear utilisation is |s| / strength, the eccentricity utilisation |y1 - y2| / (F (1 - F / F0)), F = y1 + y2: in a dry
joint 2 |e| / L, and one in every joint where an end is about to open or to crush; F0 is the force that crushes it
evenly. The crushing utilisation is F / (F0 (1 - |y1 - y2| / F)): without tensile strength the edge stress over the
compressive strength. The edge stress is that of the rectangular stress block: without tensile strength
N / (t (L - 2 |e|)), of the face length L and thickness t (Heyman 1966; EN 1996-1-1, 6.1.2.2). With it the rest of the
face pulls with f_t, as in the joint law: F / (t (L - 2 |e_F|)) - f_t, with the eccentricity e_F of F.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from operator import attrgetter
from typing import Any

import numpy as np

from harness.model.assembly import Assembly, BoolArray, FloatArray
from harness.model.case import Case
from harness.model.details import AnswerDetails
from harness.model.result import Result, normalised_mechanism, relative_velocities
from harness.model.table import TableColumn

_ROUNDING = 1e-12
"""Share of the length of a joint below which an eccentricity is none: doubles leave 1e-16 of both normal forces."""
CLOSED, UNLOADED, AT_LIMIT, SLIPS, OPENS = "closed", "unloaded", "at its limit", "slips", "opens"


@dataclass(frozen=True, eq=False)
class JointMargins:
    """What m joints bear and use of their strength, arrays (m,); not a number where a quantity does not exist.

    Attributes:
        normal: compression N = n1 + n2 [force].
        shear: s [force].
        eccentricity: of N from the middle of the joint, towards end 2 [length]; exists where N > 0.
        length: of the touching face L [length].
        thickness: out of plane t [length].
        shear_utilisation: |s| / shear strength; exists where there is a strength.
        eccentricity_utilisation: see the module; exists where the ends have a slack.
        crushing_utilisation: see the module; exists where the joint crushes and its force acts on a width.
        edge_stress: greatest stress [force/length^2]; exists where N > 0 and its block has a width.
    """

    normal: FloatArray
    shear: FloatArray
    eccentricity: FloatArray
    length: FloatArray
    thickness: FloatArray
    shear_utilisation: FloatArray
    eccentricity_utilisation: FloatArray
    crushing_utilisation: FloatArray
    edge_stress: FloatArray

    @cached_property
    def utilisation(self) -> FloatArray:
        """(m,) the largest utilisation."""
        return np.fmax(np.fmax(self.shear_utilisation, self.eccentricity_utilisation), self.crushing_utilisation)


def joint_margins(
    assembly: Assembly, thickness: FloatArray, forces: FloatArray, negligible: float = 1e-9
) -> JointMargins:
    """The margins of contact forces.

    Args:
        assembly: the wall.
        thickness: (m,) out of plane [length].
        forces: (m, 3) contact forces [force].
        negligible: share of the dead load of the wall below which a force, and of a length below which a width, is
            none.
    """
    forces = np.asarray(forces, dtype=float).reshape(-1, 3)
    normal, shear = forces[:, 0] + forces[:, 1], forces[:, 2]
    strength, slacks = assembly.law.strength(forces), assembly.law.slacks(forces)[:, :2]
    small = negligible * assembly.force_scale
    eccentricity = 0.5 * assembly.length * _share(forces[:, 1] - forces[:, 0], normal, small)
    eccentricity[abs(eccentricity) <= _ROUNDING * assembly.length] = 0.0
    length = np.linalg.norm(assembly.face2 - assembly.face1, axis=1)
    pressed, uneven = slacks.sum(axis=1), abs(slacks[:, 0] - slacks[:, 1])
    tension = 2.0 * assembly.law.constant[:, 0]
    whole = assembly.crushing + tension
    strip = length - assembly.length * _share(uneven, pressed, small)  # width of the stress block on the face
    stress = _share(pressed / thickness, strip, negligible * length) - tension / (thickness * length)
    free = 1.0 - _share(uneven, pressed, small)  # the part of the face that the stress block covers
    block = np.multiply(whole, free, out=np.full(len(whole), np.nan), where=np.isfinite(whole) & (free > negligible))
    return JointMargins(
        normal,
        shear,
        eccentricity,
        length,
        np.asarray(thickness, dtype=float),
        _share(abs(shear), strength, small),
        _share(uneven, pressed * (1.0 - pressed / whole), small),
        _share(pressed, block, 0.0),
        np.where(normal > small, stress, np.nan),
    )


def as_answered(assembly: Assembly, result: Result | None) -> Assembly:
    """The wall whose strength the forces of an answer use: joints that it calls broken have none left."""
    broken = np.zeros(assembly.n_interfaces, dtype=bool)
    listed = None if result is None else AnswerDetails(result.details).broken
    if isinstance(listed, list):
        broken[[p for p in listed if type(p) is int and 0 <= p < len(broken)]] = True
    return assembly.with_broken(broken & assembly.brittle)


def _share(part: FloatArray, whole: FloatArray, small: FloatArray | float) -> FloatArray:
    """`part` / `whole` (m,), not a number where the whole is small or not a number."""
    found = np.full(len(whole), np.nan)
    np.divide(part, whole, out=found, where=whole > small)
    return found


def _moves(assembly: Assembly, result: Result, still: float) -> tuple[BoolArray, BoolArray]:
    """(m,) whether joints open, beyond what a slip lifts, and whether they slip; nowhere in a measured motion."""
    if result.mechanism is None or len(result.mechanism) != assembly.n_blocks or result.flow == "approximate":
        none = np.zeros(assembly.n_interfaces, dtype=bool)
        return none, none
    opening, slip = relative_velocities(assembly, normalised_mechanism(assembly, np.array(result.mechanism, float)))
    law = assembly.law.associated if result.flow == "associated" else assembly.law
    moves = law.rates(np.column_stack([opening, slip])) > still
    return np.asarray(moves[:, :2].any(axis=1)), np.asarray(moves[:, 2:].any(axis=1))


@dataclass(frozen=True)
class JointRow:
    """One joint of an answer.

    Attributes:
        result: the answer.
        units: of force and length.
        interface: number of the joint, from 0, in the order of `drystone expand`.
        block_a, block_b: ids of its blocks.
        joint: name of its kind.
        margins: of all joints.
        state: see `joint_rows`.
    """

    result: Result
    units: str
    interface: int
    block_a: str
    block_b: str
    joint: str
    margins: JointMargins
    state: str

    def number(self, name: str) -> float | None:
        """A quantity of its margins; None where it does not exist."""
        value = float(getattr(self.margins, name)[self.interface])
        return value if math.isfinite(value) else None

    @property
    def relative_eccentricity(self) -> float | None:
        """e / L."""
        e, length = self.number("eccentricity"), self.number("length")
        return None if e is None or not length else e / length


def joint_rows(case: Case, result: Result, reached: float = 1e-6, still: float = 1e-5) -> list[JointRow]:
    """The joints of an answer, the most critical first; none where it has no contact forces of this wall.

    They stand by utilisation, the largest first; of those equal to nine decimals, the ones that move come first.
    A joint that moves in the mechanism opens (at one end or both), or else slips. One that does not is at its limit
    where a utilisation is one, unloaded where it bears nothing and has no strength, and closed otherwise. Measured
    motions do not count: nothing is at rest in them.

    Args:
        case: the wall.
        result: the answer.
        reached: how far below one a utilisation counts as one.
        still: relative velocity that counts as none; the fastest vertex has 1.
    """
    if result.forces is None or len(result.forces) != case.assembly.n_interfaces:
        return []
    assembly = as_answered(case.assembly, result)
    margins = joint_margins(assembly, case.built.joint_thickness, np.asarray(result.forces, dtype=float))
    opens, slips = _moves(assembly, result, still)
    states = np.full(assembly.n_interfaces, CLOSED, dtype=object)
    states[np.isnan(margins.utilisation)] = UNLOADED
    states[margins.utilisation >= 1.0 - reached] = AT_LIMIT
    states[slips] = SLIPS
    states[opens] = OPENS
    critical = np.round(np.nan_to_num(margins.utilisation, nan=-1.0), 9)
    order = np.lexsort((~(opens | slips), -critical))
    ids, units = assembly.block_ids, f"{case.wall.units.force}, {case.wall.units.length}"
    return [
        JointRow(
            result, units, p, ids[assembly.block_a[p]], ids[assembly.block_b[p]], assembly.joint[p], margins, states[p]
        )
        for p in order.tolist()
    ]


JointColumn = TableColumn[JointRow]


def _number(name: str, unit: str, meaning: str, title: str = "") -> JointColumn:
    def value(row: JointRow) -> Any:
        return row.number(name)

    return JointColumn(name, "Float64", unit, meaning, value, title)


def _text(name: str, meaning: str, value: Callable[[JointRow], Any] | None = None) -> JointColumn:
    return JointColumn(name, "string", "", meaning, value or attrgetter(name))


JOINTS: tuple[JointColumn, ...] = (
    JointColumn("interface", "Int64", "", "its number, from 0, as in `drystone expand`", attrgetter("interface")),
    _text("block_a", "id of the first block"),
    _text("block_b", "id of the second block"),
    _text("joint", "kind of the joint: bed, head or as given"),
    _text("state", "opens, slips, at its limit, closed, or unloaded"),
    _number("utilisation", "1", "the largest of the three utilisations; the most critical joint stands first"),
    _number("shear_utilisation", "1", "shear over shear strength; empty where there is no strength", "shear"),
    _number(
        "eccentricity_utilisation",
        "1",
        "2 e / distance of the contact points in a dry joint; one where an end is about to open",
        "eccentricity",
    ),
    _number(
        "crushing_utilisation",
        "1",
        "stress of the rectangular stress block over the compressive strength; empty where the joint does not crush",
        "crushing",
    ),
    _number("normal", "force", "compression N", "N"),
    _number("shear", "force", "shear s of the first block on the second, towards end 2", "s"),
    _number("eccentricity", "length", "e of N from the middle, towards end 2; empty without compression", "e"),
    JointColumn("relative_eccentricity", "Float64", "1", "e / length", attrgetter("relative_eccentricity"), "e / L"),
    _number(
        "edge_stress",
        "force/length2",
        "greatest stress of the rectangular stress block, in a joint without tensile strength N / (t (L - 2 e)); empty "
        "where the block has no width",
    ),
    _number("length", "length", "of the face, L", "L"),
    _number("thickness", "length", "out of plane, t", "t"),
)
"""Columns of joints; their units are kinds, which `in_units` replaces by the units of a wall."""
ANSWERED: tuple[JointColumn, ...] = (
    _text("case", "id of the wall", attrgetter("result.case")),
    _text("method", "name of the method", attrgetter("result.method")),
    JointColumn(
        "multiplier",
        "Float64",
        "1",
        "of the live load to which the forces belong",
        attrgetter("result.forces_multiplier"),
    ),
    *JOINTS,
    _text("units", "of force and length"),
)
"""Columns of joints.csv and `joints_to_pandas()`."""
