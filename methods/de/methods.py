"""The distinct-element methods, a row each; naming them imports no solver."""

from __future__ import annotations

from harness.model.method import Listed, Traits
from methods.de.settings import (
    Box2dSettings,
    ClosedSettings,
    MujocoSettings,
    ReleaseSettings,
    SoftPathSettings,
    SoftSettings,
    SweepSettings,
    TimeHistorySettings,
    UnevenSettings,
)

_UNEVEN_RESOLUTION = 0.005
"""Difference to which brackets of uneven walls are narrowed by default."""

DE = Listed(
    name="de",
    family="de",
    title="distinct elements (damped load steps)",
    solver="methods.de.damped_holds:DampedHolds",
    Settings=SweepSettings,
    tolerance=1e-6,
    shares_work=True,
    traits=Traits(
        caption="between held and moving",
        brackets=True,
        moves_no_lower=True,
        any_strength=True,
        any_bars=True,
        any_dilatancy=True,
        any_crushing=True,
        colour="#2f6b3a",
        marker="d",
    ),
)
"""Damped load steps of a wall at frozen geometry, bracketed over sweep orders."""

DE_MUJOCO = Listed(
    name="de-mujoco",
    family="de",
    title="distinct elements (MuJoCo, damped load steps)",
    solver="methods.de.damped_holds:MujocoHolds",
    Settings=MujocoSettings,
    tolerance=1e-4,
    traits=Traits(
        # Three times the most that a held state lay above the associated maximum on 45 random walls: contacts give way.
        held_accuracy=5e-4,
        caption="between held and moving, in MuJoCo",
        brackets=True,
        moves_no_lower=True,
        colour="#2f6b3a",
        marker="<",
        line="dashed",
    ),
)
"""The holds, the bracket and the orders of `de` on MuJoCo, so that an answer does not depend on one engine."""

DE_BOX2D = Listed(
    name="de-box2d",
    family="de",
    title="distinct elements (Box2D, damped load steps)",
    solver="methods.de.damped_holds:Box2dHolds",
    Settings=Box2dSettings,
    tolerance=1e-4,
    traits=Traits(
        caption="between held and moving, in Box2D",
        brackets=True,
        moves_no_lower=True,
        colour="#2f6b3a",
        marker="v",
        line="dashed",
    ),
)
"""The holds, the bracket and the orders of `de` on Box2D: a second engine in the plane, of other people."""

DE_TILT = Listed(
    name="de-tilt",
    family="de",
    title="distinct elements, released after the bracket",
    solver="methods.de.damped_holds:ReleasedCollapse",
    Settings=ReleaseSettings,
    tolerance=1e-6,
    traits=Traits(
        caption="as de, then released and followed",
        brackets=True,
        moves_no_lower=True,
        colour="#2f6b3a",
        marker=">",
        line="dotted",
    ),
)
"""The bracket of `de`, and the collapse followed through large displacements once the wall is released."""

DE_UNEVEN = Listed(
    name="de-uneven",
    family="de",
    title="distinct elements, uneven blocks",
    solver="methods.de.uneven_walls:UnevenBlocks",
    Settings=UnevenSettings,
    tolerance=1e-6,
    traits=Traits(
        caption="between held and moving, uneven blocks",
        brackets=True,
        resolution=_UNEVEN_RESOLUTION,
        colour="#2f6b3a",
        marker="h",
        line="dashdot",
    ),
)
"""Distinct elements on a wall with seeded defects of planarity (C. Baggio and P. Trovalusci 1995, section 6)."""

DE_CLOSED = Listed(
    name="de-closed",
    family="de",
    title="distinct elements find contacts and gaps, FE loads them",
    solver="methods.de.uneven_walls:ClosedContacts",
    Settings=ClosedSettings,
    tolerance=1e-6,
    traits=Traits(
        caption="plateau over the closed contacts",
        brackets=True,
        resolution=_UNEVEN_RESOLUTION,
        colour="#2f6b3a",
        marker="p",
        line="dashed",
    ),
)
"""Contacts and gaps of an uneven wall from distinct elements, its multiplier from gap springs (`de-closed`)."""

DE_SOFT = Listed(
    name="de-soft",
    family="de",
    title="distinct elements, deformable joints",
    solver="methods.de.soft:DeformableJoints",
    Settings=SoftSettings,
    tolerance=1e-5,
    traits=Traits(
        caption="between held and moving, deformable joints",
        brackets=True,
        colour="#2f6b3a",
        marker="*",
        line="dotted",
    ),
)
"""Distinct elements with deformable joints and rounded corners (`de-soft`)."""

DE_TIME = Listed(
    name="de-time",
    family="de",
    title="distinct elements in time",
    solver="methods.de.time.method:TimeHistories",
    Settings=TimeHistorySettings,
    tolerance=1e-3,
    traits=Traits(),
)
"""A wall on ground that accelerates, for `drystone shake`."""

DE_REACTION = Listed(
    name="de-reaction",
    family="de",
    title="distinct elements, reaction against displacement",
    solver="methods.de.support_path:CarriedSupports",
    Settings=SoftPathSettings,
    tolerance=5e-3,  # forces and mechanism are those of a wall that has moved; `de` states .5 % of its brackets
    traits=Traits(any_settlements=True),
)
"""The reaction against the displacement of supports, for `drystone reaction --path --by de-soft`."""
