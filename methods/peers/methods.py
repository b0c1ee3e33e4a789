"""The peers: solvers of other people as methods, a row each; naming them imports none of their packages."""

from __future__ import annotations

from harness.model.method import Listed, Traits
from methods.peers.settings import (
    BisectionSettings,
    CraSettings,
    DiscoptSettings,
    Lmgc90Settings,
    OpenSeesSettings,
    PounceSettings,
    ScipSettings,
)

SCIP = Listed(
    name="scip",
    family="peers",
    title="SCIP, branch and bound",
    solver="methods.peers.scip:Scip",
    Settings=ScipSettings,
    tolerance=1e-9,
    traits=Traits(
        caption="best state of SCIP",
        seeks_least=True,
        any_self_stress=True,
        colour="#555555",
        marker="8",
        line="dashed",
    ),
)
"""The programme of limit analysis by SCIP, with the bound that it claims (`scip`)."""

DISCOPT = Listed(
    name="discopt",
    family="peers",
    title="discopt, spatial branch and bound",
    solver="methods.peers.discopt:Discopt",
    Settings=DiscoptSettings,
    tolerance=1e-9,
    traits=Traits(
        caption="best state of discopt",
        seeks_least=True,
        any_self_stress=True,
        colour="#555555",
        marker="8",
        line="dotted",
    ),
)
"""The programme of limit analysis by discopt, with the bound that it claims (`discopt`)."""

POUNCE = Listed(
    name="pounce",
    family="peers",
    title="POUNCE, relaxed programme",
    solver="methods.peers.pounce:Pounce",
    Settings=PounceSettings,
    tolerance=1e-9,
    traits=Traits(
        caption="local optimum of POUNCE",
        seeks_least=True,
        any_self_stress=True,
        colour="#555555",
        marker="8",
        line="dashdot",
    ),
)
"""The relaxed programme of limit analysis in all unknowns by POUNCE, a port of Ipopt (`pounce`)."""

OPENSEES = Listed(
    name="opensees",
    family="peers",
    title="OpenSees (zero-length contact, load control)",
    solver="methods.peers.opensees:OpenSeesContacts",
    Settings=OpenSeesSettings,
    # Points that open within a load step keep the shear that they had: 2e-4 of the forces on a wall of 21 blocks.
    tolerance=1e-3,
    traits=Traits(
        caption="last load that converged in OpenSees, no proof",
        elastic=True,
        colour="#555555",
        marker="*",
        line="dashed",
    ),
)
"""Rigid blocks on zero-length contact elements of OpenSees, loaded until its path converges no more."""

RBE = Listed(
    name="rbe",
    family="peers",
    title="compas_cra, rigid-block equilibrium",
    solver="methods.peers.cra:RigidBlockEquilibrium",
    Settings=BisectionSettings,
    # Ipopt ends within 1e-6 of the constraints, in mean dead loads of a block.
    tolerance=1e-5,
    traits=Traits(
        caption="between an equilibrium without tension and none, compas_cra",
        brackets=True,
        any_self_stress=True,
        colour="#555555",
        marker="+",
        line="dashed",
    ),
)
"""Compas_cra, rigid-block equilibrium, the multiplier by bisection (`rbe`)."""

CRA = Listed(
    name="cra",
    family="peers",
    title="compas_cra, coupled rigid-block analysis",
    solver="methods.peers.cra:CoupledRigidBlockAnalysis",
    Settings=CraSettings,
    # Ipopt ends within 1e-6 of the constraints, in mean dead loads of a block.
    tolerance=1e-5,
    traits=Traits(
        caption="between a solution of CRA and none",
        brackets=True,
        any_self_stress=True,
        colour="#555555",
        marker="+",
        line="dashdot",
    ),
)
"""Compas_cra, coupled rigid-block analysis, the multiplier by bisection (`cra`)."""

LMGC90 = Listed(
    name="lmgc90",
    family="peers",
    title="LMGC90 (contact dynamics), by bisection",
    solver="methods.peers.lmgc90:ContactDynamics",
    Settings=Lmgc90Settings,
    # Gauss and Seidel's iterations of LMGC90 end within some 1e-4 of the mean contact force.
    tolerance=1e-3,
    traits=Traits(
        caption="between rest and motion in LMGC90",
        brackets=True,
        colour="#555555",
        marker="*",
        line="dashdot",
    ),
)
"""Non-smooth contact dynamics of LMGC90, the multiplier by bisection (`lmgc90`)."""
