"""Walls of one kind over proportion and friction: where the families agree within 1 %, where they part, and why."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from markupsafe import Markup

from harness.model.comparison import CaseResults, ComparisonRun
from harness.model.method import Traits
from reports import flow, numbers, shapes, words
from reports.environment import environment
from reports.families import Study, friction_of, proportion_of, same_but_both, solved

WITHIN = 0.01
"""The paper found its three methods to agree within about 1 % on the wall (Baggio & Trovalusci 1995)."""

CAUSES = (
    (-1, "seeks_least", "its search found a lower collapse state than the one that a history of loading leads to."),
    (1, "seeks_least", "its search missed a collapse state that another method reached; the least known is that one."),
    (
        1,
        "brackets",
        "its contacts slip and settle into thrust through the head joints, which unloaded ones do not carry.",
    ),
    (-1, "brackets", "it moved under a load that the others carry."),
    (1, "elastic", "its history leads past collapse states that the others found."),
    (-1, "elastic", "its history leads to a collapse that the others did not find."),
)
"""What is known of a method of some trait that stands apart from the others: above them (1) or below (-1)."""


@dataclass(frozen=True)
class Cell:
    """One wall of the grid.

    Attributes:
        number: of its case in the report.
        proportion, friction: of the wall.
        values: multipliers by main method; None where a run was not solved.
        traits: of these methods.
        associated: the associated maximum, or None.
        above: the method that found it.
        head_thrust: by method, the sum of the normal forces in head joints over the weight of the free blocks.
    """

    number: int
    proportion: float
    friction: float
    values: dict[str, float | None]
    traits: dict[str, Traits]
    associated: float | None
    above: str | None
    head_thrust: dict[str, float]

    @property
    def spread(self) -> float | None:
        """Largest multiplier over the least, less one; None if one is missing or they are all zero."""
        known = [value for value in self.values.values() if value is not None]
        return max(known) / min(known) - 1.0 if len(known) == len(self.values) > 1 and min(known) > 0.0 else None

    @property
    def agree(self) -> bool:
        """Whether all answered and lie within 1 %."""
        return self.spread is not None and self.spread <= WITHIN

    @property
    def text(self) -> str:
        """What the table prints."""
        if self.spread is None:
            missing = [name.upper() for name, value in self.values.items() if value is None]
            return f"no {', '.join(missing)}"
        if self.agree:
            return "agree"
        name, apart = self.odd_one_out
        return f"{name.upper()} {'high' if apart > 0.0 else 'low'} {100.0 * abs(apart):.0f} %"

    @property
    def odd_one_out(self) -> tuple[str, float]:
        """The method furthest from the middle one, and how far it lies from it."""
        known = {name: value for name, value in self.values.items() if value is not None}
        middle = float(np.median(list(known.values())))
        name = max(known, key=lambda name: abs(known[name] - middle))
        return name, known[name] / middle - 1.0

    def by(self, trait: str) -> tuple[str, float] | None:
        """The first method of a trait that answered, and its multiplier."""
        found = ((name, value) for name, value in self.values.items() if value is not None)
        return next((pair for pair in found if getattr(self.traits[pair[0]], trait)), None)

    @property
    def least(self) -> str:
        """The least known collapse multiplier, for the table."""
        found = self.by("seeks_least")
        return "" if found is None else f"{found[0].upper()} {numbers.multiplier(found[1])}"

    @property
    def hover(self) -> str:
        """All values."""
        found = [f"{name} {numbers.multiplier(value)}" for name, value in self.values.items() if value is not None]
        if self.associated is not None:
            found.append(f"associated maximum {numbers.multiplier(self.associated)}")
        return ", ".join(found)


def grids(run: ComparisonRun) -> list[Study]:
    """A study for every kind of wall of which at least two proportions, frictions and methods are in the comparison."""
    groups: dict[str, list[Cell]] = defaultdict(list)
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


def _is_grid(cells: list[Cell]) -> bool:
    """Whether most places of a table of at least two rows and columns are filled, by at least two methods."""
    rows, across = {cell.proportion for cell in cells}, {cell.friction for cell in cells}
    filled = min(len(rows), len(across)) > 1 and 2 * len(cells) > len(rows) * len(across)
    return filled and len({name for cell in cells for name in cell.values}) > 1


def _cell(number: int, item: CaseResults) -> Cell | None:
    assembly = item.case.assembly
    proportion, friction = proportion_of(assembly), friction_of(assembly)
    if proportion is None or friction is None:
        return None
    mains, above = item.mains, item.associated
    thrust = {
        result.method: found
        for result in (*mains, *([above] if above is not None else []))
        if solved(result) and (found := flow.head_thrust(assembly, result.forces)) is not None
    }
    return Cell(
        number=number,
        proportion=proportion,
        friction=friction,
        values={result.method: result.multiplier if solved(result) else None for result in mains},
        traits={result.method: result.traits for result in mains},
        associated=above.multiplier if above is not None and solved(above) else None,
        above=None if above is None else above.method,
        head_thrust=thrust,
    )


def _study(kind: str, cells: list[Cell]) -> Study:
    proportions = sorted({cell.proportion for cell in cells})
    frictions = sorted({cell.friction for cell in cells})
    at = {(cell.proportion, cell.friction): cell for cell in cells}
    who = words.all_of(dict.fromkeys(name for cell in cells for name in cell.values))
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
        )
    )
    return Study(
        f"Where {who} agree: {kind}, by proportion and friction",
        " ".join(sentence for sentence in (_where(cells), *_why(cells)) if sentence),
        "A row is a proportion of the brick (width over height), a column a friction. “agree” means that all "
        "multipliers lie within 1 %; otherwise the cell names the one furthest from the middle one, and how far. "
        "Every value is behind the link. The least known collapse state is exact and judged, so a lower value there "
        "is no error: it is a collapse that methods which follow one history of loading do not reach.",
        table=Markup(table),
    )


def _where(cells: list[Cell]) -> str:
    agree = [cell for cell in cells if cell.agree]
    if len(agree) == len(cells):
        return f"They agree within 1 % on all {len(cells)} walls."
    first = f"They agree within 1 % on {len(agree)} of {len(cells)} walls."
    bounds = []
    for proportion in sorted({cell.proportion for cell in cells}):
        parted = [cell.friction for cell in cells if cell.proportion == proportion and not cell.agree]
        if parted:
            bounds.append(f"{numbers.given(proportion, 3)}:1 from {numbers.given(min(parted), 3)} on")
    return f"{first} They first part, by proportion and friction, at {', '.join(bounds)}."


def _why(cells: list[Cell]) -> Iterable[str]:
    """What the numbers say of the causes; a sentence only where its own figures bear it out."""
    parted = [cell for cell in cells if cell.spread is not None and not cell.agree]
    if not parted:
        return
    for sign, trait, cause in CAUSES:
        odd = [cell.odd_one_out for cell in parted if getattr(cell.traits[cell.odd_one_out[0]], trait)]
        names = [name for name, apart in odd if sign * apart > 0.0]
        if names:
            where = f"{len(names)} of the {len(parted)}" if len(parted) > 1 else "the one wall"
            who = words.all_of(dict.fromkeys(names))
            yield f"In {where} where they part, {who} is {'high' if sign > 0 else 'low'}: {cause}"
    yield from _falling(cells)
    yield from _self_stress(parted)


def _falling(cells: list[Cell]) -> Iterable[str]:
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


def _self_stress(parted: list[Cell]) -> Iterable[str]:
    """The associated maximum far above, carried by thrust through head joints that loading does not build up."""
    above = [
        (cell.associated / elastic[1] - 1.0, elastic[0])
        for cell in parted
        if cell.associated is not None and (elastic := cell.by("elastic")) is not None and elastic[1] > 0.0
    ]
    if not above:
        return
    most, springs = max(above)
    sentence = f"The associated maximum lies up to {100.0 * most:.0f} % above {springs.upper()} there"
    names = dict.fromkeys(name for cell in parted for name in cell.head_thrust)
    medians = {
        name: float(np.median([cell.head_thrust[name] for cell in parted if name in cell.head_thrust]))
        for name in names
    }
    bound = next((cell.above for cell in parted if cell.above in medians), None)
    others = [f"{name.upper()}'s with {value:.2g}" for name, value in medians.items() if name != bound]
    if bound is not None and others:
        sentence += (
            f": its forces press on the head joints with {medians[bound]:.2g} of the wall's weight in the median, "
            f"{', '.join(others)}; loading from the dead load does not build up such self-stress"
        )
    yield sentence + "."
