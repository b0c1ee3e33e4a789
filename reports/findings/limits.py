"""What methods are known not to do, in prose, for the report: told of those whose traits they go with."""

from __future__ import annotations

from harness.model.comparison import ComparisonRun
from harness.model.method import Status, Traits
from harness.model.proof import least_known
from reports.labels import labels

WITHIN = 0.01
"""A range of less than a hundredth is none worth a sentence."""

LIMITS: tuple[tuple[str, str, tuple[str, ...]], ...] = (
    (
        "All methods",
        "",
        (
            "Blocks are rigid and infinitely strong, joints have no tensile strength, and friction is Coulomb's with "
            "one coefficient. Crushing, wear and cohesion are outside of the model.",
            "Displacements are small: a multiplier belongs to the wall as drawn. Second-order effects that lower it "
            "as the wall leans are seen only where a method says that it follows them.",
            "The wall is plane. Forces across its thickness, and what happens at its ends out of plane, are left out.",
        ),
    ),
    (
        "Joints of springs",
        "elastic",
        (
            "The plateau is a collapse state, but which one depends on the history of friction; the spread over "
            "histories is reported and is the uncertainty of the number.",
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
            "With friction the problem has many local minima. What is reported is the least collapse state known: a "
            "true collapse state, checked as such, which a longer search may undercut. It is called "
            "the least there is only where a proved lower bound meets it: branch and bound comes to "
            "that end on single blocks, columns, rings of up to 30 joints and most walls of up to six blocks.",
        ),
    ),
    (
        "The associated maximum",
        "bounds_above",
        (
            "The associated maximum is a bound from above for every method; it lets blocks rise as they slide and "
            "may rest on self-stress that a real wall need not have.",
        ),
    ),
    (
        "Measured between two loads",
        "brackets",
        (
            "The answer is a bracket between a load that was held and a load that moved, and a spread over the orders "
            "in which blocks were entered. The number printed as multiplier is the middle and not exact.",
            "Rigid contacts leave contact forces undetermined where several solutions exist; the engine takes one of "
            "them.",
            "Damping removes inertia: what is found is quasi-static. Walls of many courses need many steps, and holds "
            "that could not be told are counted as undecided, never as held.",
            "Joints that give, round corners and blocks that lean lower the multiplier where they are modelled; how "
            "much depends on a stiffness that drawings do not tell. The sentence of such an answer names both.",
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
    for heading, trait, sentences in LIMITS:
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
        if high <= (1.0 + WITHIN) * low:
            continue
        for result in item.results:
            if result.status is Status.OK and result.traits.brackets and result.bracket is not None:
                common = min(result.bracket[1], high) - max(result.bracket[0], low)
                shares.append((max(0.0, common) / (high - low), item.case.id, result.method))
    share, case, method = max(shares, default=(0.0, "", ""))
    if share < WITHIN:
        return ()
    return (
        f"On {case} the bracket of {method} covers {100.0 * share:.0f} % of the range from the least state known to "
        "the associated maximum, the most of all walls here.",
    )
