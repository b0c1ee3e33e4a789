"""Walls of one kind over proportion and friction: where FE, LA and DE agree within 1 %, where they part, and why."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from markupsafe import Markup

from harness.model.comparison import CaseResults, ComparisonRun
from harness.model.result import Result
from reports import numbers, shapes
from reports.environment import environment
from reports.families import Study, friction_of, proportion_of, same_but_both, solved

WITHIN = 0.01
"""The paper found its three methods to agree within about 1 % on the wall (Baggio & Trovalusci 1995)."""

MAIN = ("fe", "la", "de")
CAUSES = (
    (-1, "la", "its search found a lower collapse state than the one that the history of loading leads FE and DE to."),
    (1, "la", "its search missed a collapse state that another method reached; the least known is then that one's."),
    (
        1,
        "de",
        "its contacts slip and settle into thrust through the head joints, which FE's unloaded ones do not carry.",
    ),
    (-1, "de", "it moved under a load that the other two carry."),
    (1, "fe", "its history leads past collapse states that the other two found."),
    (-1, "fe", "its history leads to a collapse that the other two did not find."),
)
"""What is known of a method that stands apart from the other two: above them (1) or below (-1)."""

HEAD_JOINT = 0.5
"""An interface whose normal has a horizontal part above this (60 degrees from the vertical or more) is a head joint."""


@dataclass(frozen=True)
class Cell:
    """One wall of the grid.

    Attributes:
        number: of its case in the report.
        proportion, friction: of the wall.
        values: multipliers of FE, LA and DE; None where a run was not solved.
        associated: the associated maximum, or None.
        head_thrust: by method, the sum of the normal forces in head joints over the weight of the free blocks.
    """

    number: int
    proportion: float
    friction: float
    values: dict[str, float | None]
    associated: float | None
    head_thrust: dict[str, float]

    @property
    def spread(self) -> float | None:
        """Largest multiplier over the least, less one; None if one of the three is missing or they are all zero."""
        known = [value for value in self.values.values() if value is not None]
        return max(known) / min(known) - 1.0 if len(known) == len(MAIN) and min(known) > 0.0 else None

    @property
    def agree(self) -> bool:
        """Whether all three answered and lie within 1 %."""
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
        """The method furthest from the middle one of the three, and how far it lies from it."""
        known = {name: value for name, value in self.values.items() if value is not None}
        middle = float(np.median(list(known.values())))
        name = max(known, key=lambda name: abs(known[name] - middle))
        return name, known[name] / middle - 1.0

    @property
    def least(self) -> str:
        """The least known collapse multiplier, for the table."""
        value = self.values["la"]
        return "" if value is None else f"LA {numbers.multiplier(value)}"

    @property
    def hover(self) -> str:
        """All values."""
        found = [f"{name} {numbers.multiplier(value)}" for name, value in self.values.items() if value is not None]
        if self.associated is not None:
            found.append(f"associated maximum {numbers.multiplier(self.associated)}")
        return ", ".join(found)


def grids(run: ComparisonRun) -> list[Study]:
    """A study for every kind of wall of which at least two proportions and two frictions are in the comparison."""
    groups: dict[str, list[Cell]] = defaultdict(list)
    titles: dict[str, str] = {}
    for number, item in enumerate(run.cases):
        if shapes.problem(item.case):
            continue
        cell = _cell(number, item)
        if cell is not None:
            key = same_but_both(item.case.assembly)
            groups[key].append(cell)
            titles.setdefault(key, item.case.file.title)
    return [_study(titles[key], cells) for key, cells in groups.items() if _is_grid(cells)]


def _is_grid(cells: list[Cell]) -> bool:
    return len({cell.proportion for cell in cells}) > 1 and len({cell.friction for cell in cells}) > 1


def _cell(number: int, item: CaseResults) -> Cell | None:
    assembly = item.case.assembly
    proportion, friction = proportion_of(assembly), friction_of(assembly)
    if proportion is None or friction is None:
        return None
    results = {name: item.of(name) for name in (*MAIN, "la-associated")}
    values = {name: _value(result) for name, result in results.items()}
    weight = float(assembly.weight[assembly.free].sum())
    head = np.abs(assembly.normal[:, 0]) > HEAD_JOINT
    thrust = {
        name: float(np.asarray(result.forces, float)[head, :2].sum()) / weight
        for name, result in results.items()
        if result is not None and result.forces is not None and solved(result) and weight > 0.0
    }
    return Cell(number, proportion, friction, {name: values[name] for name in MAIN}, values["la-associated"], thrust)


def _value(result: Result | None) -> float | None:
    return result.multiplier if result is not None and solved(result) else None


def _study(title: str, cells: list[Cell]) -> Study:
    proportions = sorted({cell.proportion for cell in cells})
    frictions = sorted({cell.friction for cell in cells})
    at = {(cell.proportion, cell.friction): cell for cell in cells}
    table = (
        environment()
        .get_template("_grid.html.j2")
        .render(
            caption=f"Agreement of FE, LA and DE over proportion and friction, {title} and its kin",
            frictions=[numbers.given(friction, 3) for friction in frictions],
            rows=[
                (numbers.given(proportion, 3), [at.get((proportion, friction)) for friction in frictions])
                for proportion in proportions
            ],
        )
    )
    return Study(
        f"Where FE, LA and DE agree: {title} and its kin",
        " ".join(sentence for sentence in (_where(cells), *_why(cells)) if sentence),
        "A row is a proportion of the brick (width over height), a column a friction. “agree” means that the three "
        "multipliers lie within 1 %; otherwise the cell names the one furthest from the middle one, and how far. "
        "Every value is behind the link. LA's least known collapse state is exact and judged, so a lower value of LA "
        "is no error: it is a collapse that the other two, which follow one history of loading, do not reach.",
        table=Markup(table),
    )


def _where(cells: list[Cell]) -> str:
    agree = [cell for cell in cells if cell.agree]
    if len(agree) == len(cells):
        return f"The three agree within 1 % on all {len(cells)} walls."
    first = f"The three agree within 1 % on {len(agree)} of {len(cells)} walls."
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
    for sign, name, cause in CAUSES:
        count = sum(cell.odd_one_out[0] == name and sign * cell.odd_one_out[1] > 0.0 for cell in parted)
        if count:
            where = f"{count} of the {len(parted)}" if len(parted) > 1 else "the one wall"
            yield f"In {where} where they part, {name.upper()} is {'high' if sign > 0 else 'low'}: {cause}"
    yield from _falling(cells)
    yield from _self_stress(parted)


def _falling(cells: list[Cell]) -> Iterable[str]:
    """The least known multiplier that falls while friction grows."""
    found = []
    for proportion in sorted({cell.proportion for cell in cells}):
        line = sorted((cell for cell in cells if cell.proportion == proportion), key=lambda cell: cell.friction)
        known = [(cell.friction, value) for cell in line if (value := cell.values["la"]) is not None]
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
        cell.associated / fe - 1.0
        for cell in parted
        if cell.associated is not None and (fe := cell.values["fe"]) is not None and fe > 0.0
    ]
    if not above:
        return
    sentence = f"The associated maximum lies up to {100.0 * max(above):.0f} % above FE there"
    medians = {
        name: float(np.median([cell.head_thrust[name] for cell in parted if name in cell.head_thrust]))
        for name in ("la-associated", "fe", "la", "de")
        if any(name in cell.head_thrust for cell in parted)
    }
    if len(medians) == 4:
        sentence += (
            f": its forces press on the head joints with {medians['la-associated']:.2g} of the wall's weight in the "
            f"median, FE's with {medians['fe']:.2g}, the least known state's with {medians['la']:.2g} and the state "
            f"that DE held with {medians['de']:.2g}; loading from the dead load does not build up such self-stress"
        )
    yield sentence + "."
