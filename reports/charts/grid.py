"""Walls of one kind over proportion and friction: where the families agree within 1 %, where they differ, and how."""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from markupsafe import Markup

from harness.model.comparison import CaseResults, ComparisonRun
from harness.model.method import Traits
from harness.model.ranges import Range, differences, range_of
from reports.charts.families import StudyCurves, friction_of, proportion_of, same_but_both, solved
from reports.environment import environment
from reports.geometry import shapes, thrust_lines
from reports.labels import labels, numbers

WITHIN = 0.01
"""Methods whose multipliers lie within a hundredth of the lowest agree, as in the other sentences of the report."""
_STEPS = (0.05, 0.2)
"""Least differences at which the shade changes: readers see three shades apart, not more."""
_WORDS = {
    "agree": "agree within 1 %",
    "open": "brackets do not decide",
    "differ-1": "differ by more than 1 %",
    "differ-2": "by more than 5 %",
    "differ-3": "by more than 20 %",
    "lost": "an answer is missing",
}
"""What each shade means, in the order of the legend."""


def shade(least: float, most: float) -> str:
    """The shade of a wall on which families differ by a share between two; NaN where an answer is missing."""
    if math.isnan(least) or math.isnan(most):
        return "lost"
    if most <= WITHIN:
        return "agree"
    if least <= WITHIN:
        return "open"
    return f"differ-{1 + sum(least > step for step in _STEPS)}"


def legend(used: set[str]) -> Markup:
    """The shades that a map has, in words."""
    items = Markup("").join(
        Markup('<li><span class="shade {}"></span>{}</li>').format(name, words)
        for name, words in _WORDS.items()
        if name in used
    )
    return Markup('<ul class="legend">{}</ul>').format(items)


@dataclass(frozen=True)
class GridCell:
    """One wall of the grid.

    Attributes:
        number: of its case in the report.
        proportion, friction: of the wall.
        ranges: where the multiplier lies by main method, as each vouches for it; None where a run was not solved.
        traits: of these methods.
        associated: the associated maximum, or None.
        above: the method that found it.
        head_thrust: by method, the sum of the normal forces in head joints over the weight of the free blocks.
    """

    number: int
    proportion: float
    friction: float
    ranges: dict[str, Range | None]
    traits: dict[str, Traits]
    associated: float | None
    above: str | None
    head_thrust: dict[str, float]

    @property
    def spread(self) -> Range | None:
        """Highest multiplier over the lowest, less one, at least and at most; None if a method has none."""
        known = [ends for ends in self.ranges.values() if ends is not None]
        return differences(known) if len(known) == len(self.ranges) > 1 else None

    @property
    def agree(self) -> bool:
        """Whether all answered and lie within 1 %, wherever in its bracket each of them lies."""
        return self.spread is not None and self.spread[1] <= WITHIN

    @property
    def differ(self) -> bool:
        """Whether all answered and two of them are more than 1 % apart, wherever in its bracket each of them lies."""
        return self.spread is not None and self.spread[0] > WITHIN

    @property
    def shade(self) -> str:
        """The name of its shade."""
        return shade(*(self.spread or (math.nan, math.nan)))

    @property
    def text(self) -> str:
        """What the table prints."""
        if self.spread is None:
            missing = [name.upper() for name, ends in self.ranges.items() if ends is None]
            return f"no {', '.join(missing)}"
        if self.agree:
            return "agree"
        name, apart = self.odd_one_out
        if not self.differ:
            wide = max(self.ranges, key=lambda name: _width(self.ranges[name]))
            return f"{wide.upper()} open"
        return f"{name.upper()} {'high' if apart > 0.0 else 'low'} {100.0 * abs(apart):.0f} %"

    @property
    def odd_one_out(self) -> tuple[str, float]:
        """The method whose range is furthest from the middle of all, and how far its nearest end lies from that."""
        known = {name: ends for name, ends in self.ranges.items() if ends is not None}
        middle = float(np.median([0.5 * (low + high) for low, high in known.values()]))
        gaps = {name: low - middle if low > middle else min(high - middle, 0.0) for name, (low, high) in known.items()}
        name = max(gaps, key=lambda name: abs(gaps[name]))
        return name, gaps[name] / middle if middle > 0.0 else math.inf

    def by(self, trait: str) -> tuple[str, float] | None:
        """The first method of a trait that answered with one value, and this multiplier."""
        found = ((name, ends) for name, ends in self.ranges.items() if ends is not None and ends[0] == ends[1])
        return next(((name, ends[0]) for name, ends in found if getattr(self.traits[name], trait)), None)

    @property
    def least(self) -> str:
        """The least known collapse multiplier, for the table."""
        found = self.by("seeks_least")
        return "" if found is None else f"{found[0].upper()} {numbers.multiplier(found[1])}"

    @property
    def hover(self) -> str:
        """All values."""
        found = [
            f"{name} {numbers.multiplier(ends[0]) if ends[0] == ends[1] else numbers.interval(ends)}"
            for name, ends in self.ranges.items()
            if ends is not None
        ]
        if self.associated is not None:
            found.append(f"associated maximum {numbers.multiplier(self.associated)} (upper bound)")
        return ", ".join(found)


def _width(ends: Range | None) -> float:
    return 0.0 if ends is None else ends[1] - ends[0]


def grids(run: ComparisonRun) -> list[StudyCurves]:
    """A study for every kind of wall of which at least two proportions, frictions and methods are in the comparison."""
    groups: dict[str, list[GridCell]] = defaultdict(list)
    kinds: dict[str, str] = {}
    for number, item in enumerate(run.cases):
        if shapes.problem(item.case):
            continue
        cell = _cell(number, item)
        if cell is not None:
            key = same_but_both(item.case.assembly)
            groups[key].append(cell)
            kinds.setdefault(key, f"walls of {numbers.count(item.case.assembly.n_free, 'block')} in one bond")
    return [_study(kinds[key], cells) for key, cells in groups.items() if _is_grid(cells)]


def _is_grid(cells: list[GridCell]) -> bool:
    """Whether most places of a table of at least two rows and columns are filled, by at least two methods."""
    rows, across = {cell.proportion for cell in cells}, {cell.friction for cell in cells}
    filled = min(len(rows), len(across)) > 1 and 2 * len(cells) > len(rows) * len(across)
    return filled and len({name for cell in cells for name in cell.ranges}) > 1


def _cell(number: int, item: CaseResults) -> GridCell | None:
    assembly = item.case.assembly
    proportion, friction = proportion_of(assembly), friction_of(assembly)
    if proportion is None or friction is None:
        return None
    mains, above = item.mains, item.associated
    thrust = {
        result.method: found
        for result in (*mains, *([above] if above is not None else []))
        if solved(result) and (found := thrust_lines.head_thrust(assembly, result.forces)) is not None
    }
    return GridCell(
        number=number,
        proportion=proportion,
        friction=friction,
        ranges={result.method: range_of(result) if solved(result) else None for result in mains},
        traits={result.method: result.traits for result in mains},
        associated=above.multiplier if above is not None and solved(above) else None,
        above=None if above is None else above.method,
        head_thrust=thrust,
    )


def _study(kind: str, cells: list[GridCell]) -> StudyCurves:
    proportions = sorted({cell.proportion for cell in cells})
    frictions = sorted({cell.friction for cell in cells})
    at = {(cell.proportion, cell.friction): cell for cell in cells}
    who = labels.all_of(dict.fromkeys(name for cell in cells for name in cell.ranges))
    table = (
        environment()
        .get_template("_grid.html.j2")
        .render(
            caption=f"Agreement of {who} over proportion and friction, {kind}",
            frictions=[numbers.given(friction, 3) for friction in frictions],
            rows=[
                (numbers.given(proportion, 3), [at.get((proportion, friction)) for friction in frictions])
                for proportion in proportions
            ],
            legend=legend({cell.shade for cell in cells}),
        )
    )
    return StudyCurves(
        f"Where {who} agree: {kind}, by proportion and friction",
        " ".join(sentence for sentence in (_where(cells), *_why(cells)) if sentence),
        "A row is a proportion of the brick (width over height), a column a friction. “agree” means that all "
        "multipliers lie within 1 %; “open” that a measured bracket does not decide; otherwise the cell names "
        "the method that differs most from the middle one, and the difference of its nearest end. The links "
        "lead to all values.",
        table=Markup(table),
    )


def _where(cells: list[GridCell]) -> str:
    agree, differ = [cell for cell in cells if cell.agree], [cell for cell in cells if cell.differ]
    missing = [cell for cell in cells if cell.spread is None]
    open_ = len(cells) - len(agree) - len(differ) - len(missing)
    if len(agree) == len(cells):
        return f"They agree within 1 % on all {len(cells)} walls."
    said = f"They agree within 1 % on {len(agree)} of {len(cells)} walls"
    said += f"; on {open_} a measured bracket does not decide" if open_ else ""
    said += f"; on {len(missing)} a method gave no answer" if missing else ""
    bounds = []
    for proportion in sorted({cell.proportion for cell in differ}):
        frictions = [cell.friction for cell in differ if cell.proportion == proportion]
        bounds.append(f"{numbers.given(proportion, 3)}:1 at {numbers.given(min(frictions), 3)}")
    return (
        f"{said}. The least friction at which they differ is, by proportion, {', '.join(bounds)}."
        if bounds
        else f"{said}."
    )


def _why(cells: list[GridCell]) -> Iterable[str]:
    """What the numbers say of the differences; a sentence only where its own figures bear it out."""
    differ = [cell for cell in cells if cell.differ]
    for sign, where in ((-1.0, "lowest"), (1.0, "highest")):
        for name in dict.fromkeys(cell.odd_one_out[0] for cell in differ):
            odd = [cell for cell in differ if cell.odd_one_out[0] == name and sign * cell.odd_one_out[1] > 0.0]
            if odd:
                yield _odd(name, odd, len(differ), where)
    yield from _falling(cells)
    yield from _self_stress(differ)


def _odd(name: str, odd: list[GridCell], number: int, where: str) -> str:
    """On how many walls a method stands apart, how far at most, and what its head joints carry there beside others'."""
    most = max(100.0 * abs(cell.odd_one_out[1]) for cell in odd)
    walls = (
        f"On {len(odd)} of the {number} walls where they differ" if number > 1 else "On the one wall where they differ"
    )
    said = f"{walls}, {name.upper()} is {where}, by {'up to ' if len(odd) > 1 else ''}{most:.0f} % from the middle one"
    thrust = {
        each: float(np.median([cell.head_thrust[each] for cell in odd if each in cell.head_thrust]))
        for each in odd[0].ranges
        if any(each in cell.head_thrust for cell in odd)
    }
    if name in thrust and len(thrust) > 1:
        others = [f"{value:.2g} in {each.upper()}" for each, value in thrust.items() if each != name]
        said += (
            f"; its head joints carry {thrust[name]:.2g} of the wall's weight there"
            f"{' in the median' if len(odd) > 1 else ''}, with {labels.and_(others)}"
        )
    return f"{said}."


def _falling(cells: list[GridCell]) -> Iterable[str]:
    """The least known multiplier that falls while friction grows."""
    found = []
    for proportion in sorted({cell.proportion for cell in cells}):
        line = sorted((cell for cell in cells if cell.proportion == proportion), key=lambda cell: cell.friction)
        known = [(cell.friction, pair[1]) for cell in line if (pair := cell.by("seeks_least")) is not None]
        if not known:
            continue
        peak = max(known, key=lambda pair: pair[1])
        after = [pair for pair in known if pair[0] > peak[0]]
        least = min(after, key=lambda pair: pair[1], default=None)
        if least is not None and least[1] < peak[1] * (1.0 - 1e-6):
            found.append(
                f"{numbers.given(proportion, 3)}:1 from {numbers.multiplier(peak[1])} at {numbers.given(peak[0], 3)} "
                f"to {numbers.multiplier(least[1])} at {numbers.given(least[0], 3)}"
            )
    if found:
        yield f"The least known multiplier is not monotone in friction: it falls at {'; '.join(found)}."


def _self_stress(differ: list[GridCell]) -> Iterable[str]:
    """How far the associated maximum lies above springs, and what its head joints carry beside those of others."""
    above = [
        (cell.associated / elastic[1] - 1.0, elastic[0])
        for cell in differ
        if cell.associated is not None and (elastic := cell.by("elastic")) is not None and elastic[1] > 0.0
    ]
    if not above:
        return
    most, springs = max(above)
    sentence = f"The associated maximum lies up to {100.0 * most:.0f} % above {springs.upper()} where they differ"
    names = dict.fromkeys(name for cell in differ for name in cell.head_thrust)
    medians = {
        name: float(np.median([cell.head_thrust[name] for cell in differ if name in cell.head_thrust]))
        for name in names
    }
    bound = next((cell.above for cell in differ if cell.above in medians), None)
    others = [f"{name.upper()}'s with {value:.2g}" for name, value in medians.items() if name != bound]
    if bound is not None and others:
        sentence += (
            f": its forces press on the head joints with {medians[bound]:.2g} of the wall's weight in the median, "
            f"{', '.join(others)}"
        )
    yield sentence + "."
