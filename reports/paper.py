"""The comparison of Baggio & Trovalusci (1995) beside ours: multipliers of the single block, ratios of CPU time."""

from __future__ import annotations

import tomllib
from dataclasses import dataclass
from functools import cache

from harness.model.case import shipped_cases
from harness.model.comparison import CaseResults, ComparisonRun
from harness.model.method import Status
from harness.model.reading import read_text, validate
from harness.model.result import Result
from harness.model.wall import Strict
from reports import numbers
from reports.tables import Cell, anchor_of

LARGEST_FILE = 2**16
"""Bytes of paper.toml at most; it comes with Drystone."""


class PrintedRow(Strict):
    """One multiplier of the block as the paper prints it, and in closed form."""

    method: str
    what: str
    printed: str
    closed_form: str
    exact: float | None = None


class PrintedBlock(Strict):
    """What the paper says of its block: the case, and a row a method."""

    case: str
    rows: list[PrintedRow]


class PrintedCost(Strict):
    """CPU minutes of a method on the paper's wall, and the work it asks of the user."""

    method: str
    minutes: float
    work: str


class PrintedWall(Strict):
    """What the paper says of its wall; ratios are taken to the first row."""

    case: str
    experiment: float
    study: str
    rows: list[PrintedCost]


class Printed(Strict):
    """The content of `cases/paper.toml`."""

    block: PrintedBlock
    wall: PrintedWall

    @property
    def cases(self) -> tuple[str, str]:
        """Ids of the paper's two walls."""
        return self.block.case, self.wall.case


@cache
def printed() -> Printed:
    """What the paper prints, read once."""
    path = shipped_cases() / "paper.toml"
    return validate(Printed, tomllib.loads(read_text(path, LARGEST_FILE)), str(path))


@dataclass(frozen=True)
class BlockRow:
    """One multiplier of the paper's single block beside ours."""

    what: str
    paper: str
    closed_form: str
    ours: Cell
    anchor: str
    difference: str


@dataclass(frozen=True)
class CostRow:
    """CPU time of one method as a ratio, beside the paper's."""

    method: str
    paper_ratio: str
    ratio: str
    cpu: Cell
    anchor: str
    paper_work: str
    settings: int
    changed: str


@dataclass(frozen=True)
class Paper:
    """What the report shows of the paper."""

    block: list[BlockRow]
    cost: list[CostRow]
    names: str
    ratio_paper: str
    ratio_ours: str
    experiment: str
    imperfection: str
    block_case: int | None
    wall_case: int | None


def _find(run: ComparisonRun, case: str) -> tuple[int, CaseResults] | None:
    return next(((number, item) for number, item in enumerate(run.cases) if item.case.id == case), None)


def _result(item: CaseResults, method: str) -> tuple[int, Result] | None:
    return next(((number, result) for number, result in enumerate(item.results) if result.method == method), None)


def paper_comparison(run: ComparisonRun) -> Paper | None:
    """The paper's two tables beside ours, or None if neither of its cases was run."""
    said = printed()
    block, wall = _find(run, said.block.case), _find(run, said.wall.case)
    if block is None and wall is None:
        return None
    cost = [] if wall is None else _cost(*wall)
    times = {row.method: row.cpu.sort for row in cost if row.cpu.sort}
    names = [row.method for row in said.wall.rows]
    base = said.wall.rows[0]
    ratio = ""
    if len(times) == len(names):
        per_second = base.minutes / (times[base.method] or 1.0)
        ratio = " : ".join(numbers.plain((times[name] or 0.0) * per_second, 2) for name in names)
    return Paper(
        block=[] if block is None else _block(*block),
        cost=cost,
        names=" : ".join(name.upper() for name in names),
        ratio_paper=" : ".join(numbers.given(row.minutes, 3) for row in said.wall.rows),
        ratio_ours=ratio,
        experiment="" if wall is None else _experiment(wall[1]),
        imperfection=_imperfection(run),
        block_case=None if block is None else block[0],
        wall_case=None if wall is None else wall[0],
    )


def _block(number: int, item: CaseResults) -> list[BlockRow]:
    rows = []
    for row in printed().block.rows:
        what, known, form, exact = row.what, row.printed, row.closed_form, row.exact
        found = _result(item, row.method)
        if found is None:
            rows.append(BlockRow(what, known, form, Cell("not run"), "", ""))
            continue
        result = found[1]
        if result.traits.brackets and result.bracket is not None:
            cell = Cell(numbers.interval(result.bracket), numbers.every_digit(result.bracket))
        elif result.multiplier is None:
            cell = Cell(str(result.status))
        else:
            cell = Cell(numbers.multiplier(result.multiplier), repr(result.multiplier))
        difference = ""
        if exact is not None and result.multiplier is not None:
            gap = abs(result.multiplier - exact)
            difference = "0" if gap == 0.0 else numbers.power(gap)
        rows.append(BlockRow(what, known, form, cell, anchor_of(number, found[0]), difference))
    return rows


def _cost(number: int, item: CaseResults) -> list[CostRow]:
    paper = {row.method: row for row in printed().wall.rows}
    found = {method: _result(item, method) for method in paper}
    first = next(iter(paper))
    base = next((cpu for name, entry in found.items() if name == first and (cpu := _cpu(entry)) is not None), None)
    rows = []
    for method, entry in found.items():
        if entry is None:
            continue
        result = entry[1]
        asked = sorted(
            {
                name
                for reference in item.case.file.references
                if method in reference.applies_to
                for name in reference.settings
            }
        )
        cpu = _cpu(entry)
        rows.append(
            CostRow(
                method=method,
                paper_ratio=numbers.plain(paper[method].minutes, 3),
                ratio=numbers.NOTHING if not cpu or not base else numbers.plain(paper[first].minutes * cpu / base, 3),
                cpu=Cell(numbers.seconds(cpu), "" if cpu is None else f"{cpu!r} s", cpu),
                anchor=anchor_of(number, entry[0]),
                paper_work=paper[method].work,
                settings=len(result.settings),
                changed=", ".join(asked) or "none",
            )
        )
    return rows


def _cpu(entry: tuple[int, Result] | None) -> float | None:
    return entry[1].cpu_seconds if entry is not None and entry[1].status is Status.OK else None


def _imperfection(run: ComparisonRun) -> str:
    """What the study of uneven blocks found, if the comparison brought it."""
    studies = run.provenance.get("studies", [])
    return next((str(study["sentence"]) for study in studies if study.get("name") == printed().wall.study), "")


def _experiment(item: CaseResults) -> str:
    said = printed().wall
    values = [
        (row.method.upper(), entry[1].multiplier)
        for row in said.rows
        if (entry := _result(item, row.method)) is not None and entry[1].multiplier is not None
    ]
    if not values:
        return ""
    left = 1.0 + said.experiment
    lowered = ", ".join(f"{numbers.plain(left * (value or 0.0), 3)} ({name})" for name, value in values)
    return f"A wall that fails {-100.0 * said.experiment:.0f} % earlier than ours would fail at {lowered}."
