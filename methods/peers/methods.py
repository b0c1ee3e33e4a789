"""The peers: solvers of other people as methods, a row each; naming them imports none of their packages."""

from __future__ import annotations

from harness.model.method import Listed, Traits
from methods.peers.settings import DiscoptSettings, PounceSettings, ScipSettings

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
        marker="1",
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
        marker="2",
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
        marker="3",
        line="dashdot",
    ),
)
"""The relaxed programme of limit analysis in all unknowns by POUNCE, a port of Ipopt (`pounce`)."""
