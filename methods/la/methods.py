"""The methods of limit analysis, a row each; naming them imports no solver."""

from __future__ import annotations

from harness.model.method import Listed, Traits
from methods.la.settings import (
    AssociatedSettings,
    BoundSettings,
    CapacitySteps,
    CvxpySettings,
    FromFeSettings,
    PaperSettings,
    ReactionSettings,
    SearchSettings,
    SettlingSteps,
    TrescaSettings,
)

LA = Listed(
    name="la",
    family="la",
    title="LA, least known",
    solver="methods.la.search:LimitAnalysis",
    Settings=SearchSettings,
    tolerance=1e-10,
    follows_motions=True,
    traits=Traits(
        caption="least known collapse state",
        seeks_least=True,
        any_self_stress=True,
        any_dilatancy=True,
        any_strength=True,
        any_brittle=True,
        any_bars=True,
        any_crushing=True,
        colour="#a8431e",
        marker="s",
    ),
)
"""Least collapse state known, under zero dilatancy (`la`): the method to use."""

LA_BOUND = Listed(
    name="la-bound",
    family="la",
    title="LA, least known and lower bound",
    solver="methods.la.bounds:BoundedLimitAnalysis",
    Settings=BoundSettings,
    tolerance=1e-10,
    traits=Traits(
        caption="least known, with a lower bound", seeks_least=True, any_self_stress=True, colour="#a8431e", marker="P"
    ),
)
"""The state of `la`, and a multiplier below which there is no collapse state (`la-bound`)."""

LA_ASSOCIATED = Listed(
    name="la-associated",
    family="la",
    title="LA, associated (greatest)",
    solver="methods.la.associated:AssociatedLimitAnalysis",
    Settings=AssociatedSettings,
    tolerance=1e-9,
    traits=Traits(
        caption="associated maximum",
        bounds_above=True,
        any_self_stress=True,
        any_dilatancy=True,
        any_strength=True,
        any_brittle=True,
        any_bars=True,
        any_crushing=True,
        colour="#7a3b69",
        marker="^",
        line="dashed",
    ),
)
"""Greatest multiplier of statics, the linear programme of associated limit analysis (`la-associated`)."""

LA_ASSOCIATED_CVXPY = Listed(
    name="la-associated-cvxpy",
    family="la",
    title="LA, associated (cvxpy)",
    solver="methods.la.associated:AssociatedLimitAnalysisCvxpy",
    Settings=CvxpySettings,
    tolerance=1e-9,
    traits=Traits(
        caption="associated maximum, in cvxpy",
        bounds_above=True,
        any_self_stress=True,
        any_dilatancy=True,
        any_strength=True,
        any_brittle=True,
        any_bars=True,
        any_crushing=True,
        colour="#7a3b69",
        marker="v",
        line="dotted",
    ),
)
"""The same linear programme written in cvxpy, to be read beside the formulas (`la-associated-cvxpy`)."""

LA_PAPER = Listed(
    name="la-paper",
    family="la",
    title="LA, programme of 1995",
    solver="methods.la.literature.paper_programme:PaperProgramme",
    Settings=PaperSettings,
    tolerance=1e-9,
    traits=Traits(
        caption="local optimum of the paper's programme",
        seeks_least=True,
        any_self_stress=True,
        colour="#a8431e",
        marker="P",
        line="dotted",
    ),
)
"""The paper's own programme (8)-(11) in reduced unknowns, by Ipopt (`la-paper`)."""

LA_TRESCA = Listed(
    name="la-tresca",
    family="la",
    title="LA, friction-bound sequence",
    solver="methods.la.literature.tresca:TrescaSequence",
    Settings=TrescaSettings,
    tolerance=1e-8,
    traits=Traits(
        caption="fixed point of Tresca steps",
        seeks_least=True,
        any_self_stress=True,
        colour="#a8431e",
        marker="X",
        line="dashdot",
    ),
)
"""Sequence of programmes with the friction bound of the previous iterate: a baseline (`la-tresca`)."""

LA_FROM_FE = Listed(
    name="la-from-fe",
    family="la",
    title="LA started from FE",
    solver="methods.la.literature.cooperation:FromFiniteElements",
    Settings=FromFeSettings,
    tolerance=1e-10,
    traits=Traits(
        caption="least known, started from FE",
        seeks_least=True,
        any_self_stress=True,
        colour="#a8431e",
        marker="D",
        line="dashed",
    ),
)
"""Ray descent from the finite-element collapse state, against a cold start (`la-from-fe`)."""

LA_REACTION = Listed(
    name="la-reaction",
    family="la",
    title="LA, least or greatest reaction",
    solver="methods.la.supports:ExtremeReactions",
    Settings=ReactionSettings,
    tolerance=1e-9,
    traits=Traits(any_dilatancy=True, any_strength=True, any_bars=True, any_settlements=True),
)
"""Least or greatest reaction of supports that move, for `drystone reaction`."""

LA_SETTLING = Listed(
    name="la-settling",
    family="la",
    title="LA, supports that move far",
    solver="methods.la.supports:SettledSupports",
    Settings=SettlingSteps,
    tolerance=1e-9,
    traits=Traits(any_dilatancy=True, any_settlements=True),
)
"""How far supports can move, on updated geometry, for `drystone reaction --until-collapse`."""

LA_CAPACITY = Listed(
    name="la-capacity",
    family="la",
    title="LA, collapse that goes on",
    solver="methods.la.supports:FollowedCollapse",
    Settings=CapacitySteps,
    tolerance=1e-9,
    traits=Traits(any_dilatancy=True),
)
"""The multiplier on updated geometry, for `drystone capacity`."""
