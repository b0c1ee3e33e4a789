"""The gap-spring methods, a row each; naming them imports no solver."""

from __future__ import annotations

from harness.model.method import Listed, Traits
from methods.fe.settings import ConvexSettings, GapSpringsSettings, NewtonSettings, SupportPathSettings

FE = Listed(
    name="fe",
    family="fe",
    title="FE, exact continuation",
    solver="methods.fe.gap_springs:GapSprings",
    Settings=GapSpringsSettings,
    tolerance=1e-8,
    traits=Traits(
        caption="plateau of the traced path",
        elastic=True,
        any_dilatancy=True,
        any_strength=True,
        any_bars=True,
        any_brittle=True,
        brittle_alone=True,
        any_crushing=True,
        colour="#1f4e79",
        marker="o",
    ),
)
"""Gap-spring finite elements with the path traced exactly, breakpoint by breakpoint (`fe`)."""

FE_NEWTON = Listed(
    name="fe-newton",
    family="fe",
    title="FE, incremental Newton",
    solver="methods.fe.gap_springs:IncrementalNewton",
    Settings=NewtonSettings,
    tolerance=1e-8,
    traits=Traits(
        caption="plateau, where it arrives",
        elastic=True,
        any_dilatancy=True,
        any_strength=True,
        any_bars=True,
        colour="#1f4e79",
        marker="x",
        line="dashed",
    ),
)
"""Ordinary incremental Newton: load control, then displacement control (`fe-newton`)."""

FE_QP = Listed(
    name="fe-qp",
    family="fe",
    title="FE, convex steps",
    solver="methods.fe.gap_springs:ConvexSteps",
    Settings=ConvexSettings,
    tolerance=1e-3,
    traits=Traits(
        caption="plateau, by convex steps",
        elastic=True,
        any_dilatancy=True,
        any_strength=True,
        any_bars=True,
        colour="#1f4e79",
        marker="+",
        line="dotted",
    ),
)
"""Each step as convex quadratic programmes with frozen friction limits (`fe-qp`)."""

FE_REACTION = Listed(
    name="fe-reaction",
    family="fe",
    title="FE, reaction against displacement",
    solver="methods.fe.support_path:ReactionPaths",
    Settings=SupportPathSettings,
    tolerance=FE.tolerance,
    traits=Traits(elastic=True, any_dilatancy=True, any_strength=True, any_settlements=True),
)
"""The reaction against the displacement of supports, for `drystone reaction --path`."""
