"""What the gap-spring methods are, without what solves them: naming them loads no library."""

from __future__ import annotations

from typing import ClassVar

from harness.model.method import Declared, Settings, Traits
from methods.fe.path_settings import ConvexSettings, GapSpringsSettings, NewtonSettings


class DeclaredFiniteElements(Declared):
    """A method of finite elements with gap springs."""

    family: ClassVar[str] = "fe"


class DeclaredGapSprings(DeclaredFiniteElements):
    """Gap-spring finite elements with the path traced exactly, kink by kink (`fe`)."""

    solver: ClassVar[str] = "methods.fe.gap_spring_adapter:GapSprings"
    name: ClassVar[str] = "fe"
    title: ClassVar[str] = "FE, exact continuation"
    tolerance: ClassVar[float] = 1e-8
    traits: ClassVar[Traits] = Traits(
        caption="plateau of the traced path",
        elastic=True,
        colour="#1f4e79",
        marker="o",
    )
    Settings: ClassVar[type[Settings]] = GapSpringsSettings


class DeclaredNewton(DeclaredFiniteElements):
    """Ordinary incremental Newton: load control, then displacement control (`fe-newton`)."""

    solver: ClassVar[str] = "methods.fe.gap_spring_adapter:IncrementalNewton"
    name: ClassVar[str] = "fe-newton"
    title: ClassVar[str] = "FE, incremental Newton"
    tolerance: ClassVar[float] = 1e-8
    traits: ClassVar[Traits] = Traits(
        caption="plateau, where it arrives",
        elastic=True,
        colour="#1f4e79",
        marker="x",
        line="dashed",
    )
    Settings: ClassVar[type[Settings]] = NewtonSettings


class DeclaredConvex(DeclaredFiniteElements):
    """Each step as convex quadratic programmes with frozen friction limits (`fe-qp`)."""

    solver: ClassVar[str] = "methods.fe.gap_spring_adapter:ConvexSteps"
    name: ClassVar[str] = "fe-qp"
    title: ClassVar[str] = "FE, convex steps"
    tolerance: ClassVar[float] = 1e-3
    traits: ClassVar[Traits] = Traits(
        caption="plateau, by convex steps",
        elastic=True,
        colour="#1f4e79",
        marker="+",
        line="dotted",
    )
    Settings: ClassVar[type[Settings]] = ConvexSettings
