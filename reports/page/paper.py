"""The comparison of Baggio & Trovalusci (1995) beside ours: multipliers of the single block, ratios of CPU time."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

from harness.model.comparison import CaseResults, ComparisonRun
from harness.model.fields import Strict
from harness.model.library import shipped_words
from harness.model.method import Status
from harness.model.ranges import range_of
from harness.model.result import Result
from reports.labels import numbers
from reports.page.tables import Cell, anchor_of


class _PrintedRow(Strict):
    """One multiplier of the block as the paper prints it, and in closed form."""

    method: str
    what: str
    printed: str
    closed_form: str
    exact: float | None = None


class _PrintedBlock(Strict):
    """What the paper says of its block: the case, and a row a method."""

    case: str
    rows: list[_PrintedRow]


class _PrintedCost(Strict):
    """CPU minutes of a method on the paper's wall, blocks of its largest wall, and the work it asks of the user."""

    method: str
    minutes: float
    largest: int
    work: str


class _PrintedWall(Strict):
    """What the paper says of its wall; ratios are taken to the first row."""

    case: str
    experiment: float
    mechanisms: str
    study: str
    rows: list[_PrintedCost]


class _PrintedApplicationRow(Strict):
    """What the paper's text says that one of its walls carries."""

    case: str
    printed: str


class _PrintedApplication(Strict):
    """The paper's application: methods to set beside it, and what of the load our cases count as dead."""

    dead: float
    methods: list[str]
    rows: list[_PrintedApplicationRow]


class _Printed(Strict):
    """The content of `cases/paper.toml`."""

    block: _PrintedBlock
    wall: _PrintedWall
    application: _PrintedApplication

    @property
    def cases(self) -> tuple[str, str]:
        """Ids of the paper's two walls."""
        return self.block.case, self.wall.case


@cache
def printed() -> _Printed:
    """What the paper prints, read once."""
    return shipped_words(_Printed, "paper.toml")


@dataclass(frozen=True)
class _BlockRow:
    """One multiplier of the paper's single block beside ours."""

    what: str
    paper: str
    closed_form: str
    ours: Cell
    anchor: str
    difference: str


@dataclass(frozen=True)
class _CostRow:
    """CPU time of one method as a ratio, beside the paper's; `until_value` [s]: when a search first had its value."""

    method: str
    paper_ratio: str
    ratio: str
    cpu: Cell
    anchor: str
    until_value: float | None
    paper_work: str
    settings: int
    changed: str


@dataclass(frozen=True)
class Paper:
    """What the report shows of the paper."""

    block: list[_BlockRow]
    cost: list[_CostRow]
    names: str
    ratio_paper: str
    ratio_ours: str
    ratio_to_value: str
    experiment: str
    imperfection: str
    applied: list[str]
    applications: list[_ApplicationRow]


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
    earlier = {row.method: row.until_value for row in cost if row.until_value is not None}
    return Paper(
        block=[] if block is None else _block(*block),
        cost=cost,
        names=" : ".join(row.method.upper() for row in said.wall.rows),
        ratio_paper=" : ".join(numbers.given(row.minutes, 3) for row in said.wall.rows),
        ratio_ours=_ratio(times),
        ratio_to_value=_ratio(times | earlier) if earlier else "",
        experiment="" if wall is None else _experiment(wall[1]),
        imperfection=_imperfection(run),
        applied=printed().application.methods,
        applications=applications(run),
    )


def _ratio(times: dict[str, float]) -> str:
    """CPU times by method, with the first set to the paper's figure; empty where one of them is missing."""
    rows = printed().wall.rows
    if len(times) < len(rows) or not times[rows[0].method]:
        return ""
    per_second = rows[0].minutes / times[rows[0].method]
    return " : ".join(numbers.plain(times[row.method] * per_second, 2) for row in rows)


def _block(number: int, item: CaseResults) -> list[_BlockRow]:
    rows = []
    for row in printed().block.rows:
        what, known, form, exact = row.what, row.printed, row.closed_form, row.exact
        found = _result(item, row.method)
        if found is None:
            rows.append(_BlockRow(what, known, form, Cell("not run"), "", ""))
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
        rows.append(_BlockRow(what, known, form, cell, anchor_of(number, found[0]), difference))
    return rows


def _cost(number: int, item: CaseResults) -> list[_CostRow]:
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
            _CostRow(
                method=method,
                paper_ratio=numbers.plain(paper[method].minutes, 3),
                ratio=numbers.NOTHING if not cpu or not base else numbers.plain(paper[first].minutes * cpu / base, 3),
                cpu=Cell(numbers.seconds(cpu), "" if cpu is None else f"{cpu!r} s", cpu),
                anchor=anchor_of(number, entry[0]),
                until_value=_to_value(item, method),
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
    lowered = [
        f"{_lowered(ends, 1.0 + said.experiment)} ({row.method.upper()})"
        for row in said.rows
        if (entry := _result(item, row.method)) is not None and (ends := range_of(entry[1])) is not None
    ]
    if not lowered:
        return ""
    return f"A wall that fails {-100.0 * said.experiment:.0f} % earlier than ours would fail at {', '.join(lowered)}."


def _lowered(ends: tuple[float, float], left: float) -> str:
    """A value, or the ends of a bracket, as far below as the experiment of the paper was."""
    low, high = (numbers.plain(left * end, 3) for end in ends)
    return low if low == high else f"{low} to {high}"


def _to_value(item: CaseResults, method: str) -> float | None:
    """CPU time after which a search first reached its value [s], of a method that recorded when it found what."""
    found = _result(item, method)
    if found is None or found[1].multiplier is None:
        return None
    result = found[1]
    values, times = result.path.get("multiplier", []), result.path.get("cpu_seconds", [])
    if len(values) != len(times):
        return None
    reached = found[1].multiplier * (1.0 + 1e-9)
    return next((time for value, time in zip(values, times, strict=True) if value <= reached), None)


@dataclass(frozen=True)
class _ApplicationRow:
    """What a wall of the paper's application carries: the paper's text, and ours by method."""

    number: int
    case: str
    printed: str
    ours: list[Cell]


def applications(run: ComparisonRun) -> list[_ApplicationRow]:
    """The walls of the paper's application that were run, in its unit: the dead part and the multiplier."""
    said = printed().application
    rows = []
    for row in said.rows:
        found = _find(run, row.case)
        if found is None:
            continue
        number, item = found
        ours = [_carried(_result(item, method), said.dead) for method in said.methods]
        rows.append(_ApplicationRow(number, item.case.file.title, row.printed, ours))
    return rows


def _carried(found: tuple[int, Result] | None, dead: float) -> Cell:
    ends = None if found is None else range_of(found[1])
    if ends is None:
        return Cell(numbers.NOTHING)
    low, high = (numbers.plain(dead + end, 3) for end in ends)
    return Cell(low if low == high else f"{low} to {high}", f"{dead} dead and {numbers.every_digit(ends)} live")
