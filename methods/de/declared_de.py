"""What the distinct-element methods are, without what solves them: naming them loads no library."""

from __future__ import annotations

from typing import ClassVar

from harness.model.method import Declared, Settings, Traits
from methods.de.hold_settings import MujocoSettings, ReleaseSettings, SweepSettings
from methods.de.soft_settings import SoftSettings
from methods.de.uneven_settings import ClosedSettings, UnevenSettings

UNEVEN_RESOLUTION = 0.005
"""Difference to which brackets of uneven walls are narrowed by default."""


class DeclaredDistinctElements(Declared):
    """A method of distinct elements."""

    family: ClassVar[str] = "de"


class DeclaredHolds(DeclaredDistinctElements):
    """Damped holds of a wall at frozen geometry, bracketed over body orders."""

    solver: ClassVar[str] = "methods.de.hold_adapter:DampedHolds"
    name: ClassVar[str] = "de"
    title: ClassVar[str] = "distinct elements (damped holds)"
    tolerance: ClassVar[float] = 1e-6
    traits: ClassVar[Traits] = Traits(
        caption="between held and moving",
        brackets=True,
        moves_no_lower=True,
        colour="#2f6b3a",
        marker="d",
    )
    Settings: ClassVar[type[Settings]] = SweepSettings
    shares_work: ClassVar[bool] = True


class DeclaredMujoco(DeclaredDistinctElements):
    """The holds, the bracket and the orders of `de` on MuJoCo, so that an answer does not hang on one engine."""

    solver: ClassVar[str] = "methods.de.hold_adapter:MujocoHolds"
    name: ClassVar[str] = "de-mujoco"
    title: ClassVar[str] = "distinct elements (MuJoCo, damped holds)"
    tolerance: ClassVar[float] = 1e-4
    traits: ClassVar[Traits] = Traits(
        # Three times the most that a held state lay above the associated maximum on 45 random walls: contacts give way.
        held_accuracy=5e-4,
        caption="between held and moving, in MuJoCo",
        brackets=True,
        moves_no_lower=True,
        colour="#2f6b3a",
        marker="<",
        line="dashed",
    )
    Settings: ClassVar[type[Settings]] = MujocoSettings


class DeclaredRelease(DeclaredDistinctElements):
    """The bracket of `de`, and the collapse followed through large displacements once the wall is released."""

    solver: ClassVar[str] = "methods.de.hold_adapter:ReleasedCollapse"
    name: ClassVar[str] = "de-tilt"
    title: ClassVar[str] = "distinct elements, released after the bracket"
    tolerance: ClassVar[float] = 1e-6
    traits: ClassVar[Traits] = Traits(
        caption="as de, then released and followed",
        brackets=True,
        moves_no_lower=True,
        colour="#2f6b3a",
        marker=">",
        line="dotted",
    )
    Settings: ClassVar[type[Settings]] = ReleaseSettings


class DeclaredUneven(DeclaredDistinctElements):
    """Distinct elements on a wall with seeded defects of planarity (C. Baggio and P. Trovalusci 1995, section 6)."""

    solver: ClassVar[str] = "methods.de.imperfect:UnevenBlocks"
    name: ClassVar[str] = "de-uneven"
    title: ClassVar[str] = "distinct elements, uneven blocks"
    tolerance: ClassVar[float] = 1e-6
    traits: ClassVar[Traits] = Traits(
        caption="between held and moving, uneven blocks",
        brackets=True,
        resolution=UNEVEN_RESOLUTION,
        colour="#2f6b3a",
        marker="h",
        line="dashdot",
    )
    Settings: ClassVar[type[Settings]] = UnevenSettings


class DeclaredClosed(DeclaredDistinctElements):
    """Contacts and gaps of an uneven wall from distinct elements, its multiplier from gap springs (`de-closed`)."""

    solver: ClassVar[str] = "methods.de.closed:ClosedContacts"
    name: ClassVar[str] = "de-closed"
    title: ClassVar[str] = "distinct elements find contacts and gaps, FE loads them"
    tolerance: ClassVar[float] = 1e-6
    traits: ClassVar[Traits] = Traits(
        caption="plateau over the contacts that closed",
        brackets=True,
        resolution=UNEVEN_RESOLUTION,
        colour="#2f6b3a",
        marker="p",
        line="dashed",
    )
    Settings: ClassVar[type[Settings]] = ClosedSettings


class DeclaredSoft(DeclaredDistinctElements):
    """Distinct elements with deformable joints and rounded corners (`de-soft`)."""

    solver: ClassVar[str] = "methods.de.soft:DeformableJoints"
    name: ClassVar[str] = "de-soft"
    title: ClassVar[str] = "distinct elements, deformable joints"
    tolerance: ClassVar[float] = 1e-5
    traits: ClassVar[Traits] = Traits(
        caption="between held and moving, joints that give",
        brackets=True,
        colour="#2f6b3a",
        marker="*",
        line="dotted",
    )
    Settings: ClassVar[type[Settings]] = SoftSettings
