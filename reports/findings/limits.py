"""What methods are known not to do, in prose, for the report: stated of those whose traits they go with."""

from __future__ import annotations

from harness.model.comparison import ComparisonRun
from harness.model.method import Status, Traits
from harness.model.proof import least_known
from reports.labels import labels

_WITHIN = 0.01
"""A range of less than a hundredth is none worth a sentence."""

_LIMITS: tuple[tuple[str, str, tuple[str, ...]], ...] = (
    (
        "All methods",
        "",
        (
            "Blocks are rigid and infinitely strong, and friction is Coulomb's with one coefficient. Joints have the "
            "cohesion, tensile and compressive strength that their wall gives, which is plastic; wear is not modelled.",
            "Displacements are small: a multiplier belongs to the wall as drawn. Second-order effects that lower it "
            "as the wall leans are included only by methods that state so.",
            "The wall is plane. Forces across its thickness, and effects at its ends out of plane are not modelled.",
        ),
    ),
    (
        "Joints of springs",
        "elastic",
        (
            "The plateau is a collapse state, but which one depends on the history of friction; the spread over "
            "histories is reported and is the uncertainty of the value.",
            "Springs are numerical: the plateau does not depend on their stiffness at a fixed ratio of tangential to "
            "normal stiffness, and on regular walls little on the ratio; on irregular ones with rough joints it may "
            "move by a third. Deformable joints tend to reach states above the least one.",
            "Large walls are followed under one friction history only.",
        ),
    ),
    (
        "The search for the least collapse state",
        "seeks_least",
        (
            "With friction the problem has many local minima. The report gives the least collapse state known: "
            "a checked collapse state, below which a longer search may find another. It is called the least "
            "only if a proved lower bound reaches it: branch and bound achieves this on single blocks, columns,"
            " rings of up to 30 joints and most walls of up to six blocks.",
        ),
    ),
    (
        "The associated maximum",
        "bounds_above",
        (
            "The associated maximum is an upper bound for every method; its blocks rise as they slide, and it "
            "may depend on self-stress that a real wall need not have.",
        ),
    ),
    (
        "Measured between two loads",
        "brackets",
        (
            "The answer is a bracket between a load that was held and a load that moved, and a spread over the "
            "sweep orders. The printed multiplier is the middle, not an exact value.",
            "Rigid contacts leave contact forces undetermined where several solutions exist; the engine finds "
            "one of them.",
            "Damping removes inertia: the result is quasi-static. Walls of many courses need many steps, and "
            "undecided load steps are never counted as held.",
            "Deformable joints, rounded corners and leaning blocks reduce the multiplier where they are "
            "modelled. The reduction depends on a stiffness that drawings do not give. The sentence of such an "
            "answer states both.",
        ),
    ),
)
"""A heading, the trait of the methods it is about (empty: all), and what is known of them."""


def known_limits(run: ComparisonRun) -> list[tuple[str, tuple[str, ...]]]:
    """Headings with the methods of this comparison they are about, and their sentences."""
    ordered = sorted((result for item in run.cases for result in item.results), key=labels.order)
    traits: dict[str, Traits] = {}
    for result in ordered:
        if result.traits != Traits():  # a run without an answer of its method tells none
            traits.setdefault(result.method, result.traits)
    found = []
    for heading, trait, sentences in _LIMITS:
        names = [name for name, said in traits.items() if trait and getattr(said, trait)]
        if names or not trait:
            more = _widest(run) if trait == "brackets" else ()
            found.append((f"{heading}: {', '.join(names)}" if names else heading, (*sentences, *more)))
    return found


def _widest(run: ComparisonRun) -> tuple[str, ...]:
    """On which wall a bracket covers most of the range from the least state known to the associated maximum."""
    shares = []
    for item in run.cases:
        least, greatest = least_known(item), item.associated
        if least is None or greatest is None:
            continue
        low, high = least.multiplier or 0.0, greatest.multiplier or 0.0
        if high <= (1.0 + _WITHIN) * low:
            continue
        for result in item.results:
            if result.status is Status.OK and result.traits.brackets and result.bracket is not None:
                common = min(result.bracket[1], high) - max(result.bracket[0], low)
                shares.append((max(0.0, common) / (high - low), item.case.id, result.method))
    share, case, method = max(shares, default=(0.0, "", ""))
    if share < _WITHIN:
        return ()
    return (
        f"On {case} the bracket of {method} covers {100.0 * share:.0f} % of the range from the least state known to "
        "the associated maximum, the most of all walls here.",
    )
