"""What the methods of limit analysis are, without what solves them: naming them loads no library."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, ClassVar

from harness.model.assembly import Assembly, FloatArray
from harness.model.method import Answer, Declared, Settings, Traits
from methods.la.core.search_settings import (
    AssociatedSettings,
    BoundSettings,
    CvxpySettings,
    FromFeSettings,
    PaperSettings,
    SearchSettings,
    TrescaSettings,
)


class DeclaredLimitAnalysis(Declared):
    """A method of limit analysis."""

    family: ClassVar[str] = "la"


class DeclaredSearch(DeclaredLimitAnalysis):
    """Least collapse state known, under zero dilatancy (`la`): the method to use."""

    solver: ClassVar[str] = "methods.la.search_adapter:LimitAnalysis"
    name: ClassVar[str] = "la"
    title: ClassVar[str] = "LA, least known"
    tolerance: ClassVar[float] = 1e-10
    traits: ClassVar[Traits] = Traits(
        caption="least known collapse state",
        seeks_least=True,
        any_self_stress=True,
        any_dilatancy=True,
        colour="#a8431e",
        marker="s",
    )
    Settings: ClassVar[type[Settings]] = SearchSettings

    def solve_from(self, assembly: Assembly, settings: Any, motions: Sequence[FloatArray]) -> Answer:
        """What the solver makes of mechanisms that are given; see `harness.model.method.FollowsMotions`."""
        answer: Answer = self._solver().solve_from(assembly, settings, motions)
        return answer


class DeclaredBound(DeclaredLimitAnalysis):
    """The state of `la`, and a multiplier below which there is no collapse state (`la-bound`)."""

    solver: ClassVar[str] = "methods.la.bound_adapter:BoundedLimitAnalysis"
    name: ClassVar[str] = "la-bound"
    title: ClassVar[str] = "LA, least known and lower bound"
    tolerance: ClassVar[float] = 1e-10
    Settings: ClassVar[type[Settings]] = BoundSettings
    traits: ClassVar[Traits] = Traits(
        caption="least known, with a lower bound", seeks_least=True, any_self_stress=True, colour="#a8431e", marker="P"
    )


class DeclaredAssociated(DeclaredLimitAnalysis):
    """Greatest multiplier of statics, the linear programme of associated limit analysis (`la-associated`)."""

    solver: ClassVar[str] = "methods.la.associated_adapter:AssociatedLimitAnalysis"
    name: ClassVar[str] = "la-associated"
    title: ClassVar[str] = "LA, associated (greatest)"
    tolerance: ClassVar[float] = 1e-9
    traits: ClassVar[Traits] = Traits(
        caption="associated maximum",
        bounds_above=True,
        any_self_stress=True,
        any_dilatancy=True,
        colour="#7a3b69",
        marker="^",
        line="dashed",
    )
    Settings: ClassVar[type[Settings]] = AssociatedSettings


class DeclaredCvxpy(DeclaredLimitAnalysis):
    """The same linear programme written in cvxpy, to be read beside the formulas (`la-associated-cvxpy`)."""

    solver: ClassVar[str] = "methods.la.associated_adapter:AssociatedLimitAnalysisCvxpy"
    name: ClassVar[str] = "la-associated-cvxpy"
    title: ClassVar[str] = "LA, associated (cvxpy)"
    tolerance: ClassVar[float] = 1e-9
    traits: ClassVar[Traits] = Traits(
        caption="associated maximum, in cvxpy",
        bounds_above=True,
        any_self_stress=True,
        any_dilatancy=True,
        colour="#7a3b69",
        marker="v",
        line="dotted",
    )
    Settings: ClassVar[type[Settings]] = CvxpySettings


class DeclaredPaper(DeclaredLimitAnalysis):
    """The paper's own programme (8)-(11) in reduced unknowns, by Ipopt (`la-paper`)."""

    solver: ClassVar[str] = "methods.la.literature.literature_adapters:PaperProgramme"
    name: ClassVar[str] = "la-paper"
    title: ClassVar[str] = "LA, programme of 1995"
    tolerance: ClassVar[float] = 1e-9
    traits: ClassVar[Traits] = Traits(
        caption="local optimum of the paper's programme",
        seeks_least=True,
        any_self_stress=True,
        colour="#a8431e",
        marker="P",
        line="dotted",
    )
    Settings: ClassVar[type[Settings]] = PaperSettings


class DeclaredTresca(DeclaredLimitAnalysis):
    """Sequence of programmes with the friction bound of the previous iterate: a baseline (`la-tresca`)."""

    solver: ClassVar[str] = "methods.la.literature.literature_adapters:TrescaSequence"
    name: ClassVar[str] = "la-tresca"
    title: ClassVar[str] = "LA, friction-bound sequence"
    tolerance: ClassVar[float] = 1e-8
    traits: ClassVar[Traits] = Traits(
        caption="fixed point of Tresca steps",
        seeks_least=True,
        any_self_stress=True,
        colour="#a8431e",
        marker="X",
        line="dashdot",
    )
    Settings: ClassVar[type[Settings]] = TrescaSettings


class DeclaredFromFe(DeclaredLimitAnalysis):
    """Ray descent from the finite-element collapse state, against a cold start (`la-from-fe`)."""

    solver: ClassVar[str] = "methods.la.literature.literature_adapters:FromFiniteElements"
    name: ClassVar[str] = "la-from-fe"
    title: ClassVar[str] = "LA started from FE"
    tolerance: ClassVar[float] = 1e-10
    traits: ClassVar[Traits] = Traits(
        caption="least known, started from FE",
        seeks_least=True,
        any_self_stress=True,
        colour="#a8431e",
        marker="D",
        line="dashed",
    )
    Settings: ClassVar[type[Settings]] = FromFeSettings
