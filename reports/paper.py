"""The comparison of Baggio & Trovalusci (1995) beside ours: multipliers of the single block, ratios of CPU time."""

from __future__ import annotations

from dataclasses import dataclass

from harness.model.comparison import CaseResults, ComparisonRun
from harness.model.method import Status
from harness.model.result import Result
from reports import numbers
from reports.tables import Cell, anchor_of

BLOCK, WALL = "single-block", "wall-21"
PAPER_MINUTES = {"fe": 20.0, "la": 15.0, "de": 360.0}
PAPER_WORK = {"fe": "low", "la": "medium", "de": "high"}
EXPERIMENT = -0.20


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
    block, wall = _find(run, BLOCK), _find(run, WALL)
    if block is None and wall is None:
        return None
    cost = [] if wall is None else _cost(*wall)
    times = {row.method: row.cpu.sort for row in cost if row.cpu.sort}
    ratio = ""
    if len(times) == 3 and times["fe"]:
        ratio = " : ".join(
            numbers.plain((times[method] or 0.0) / times["fe"] * 20.0, 2) for method in ("fe", "la", "de")
        )
    return Paper(
        block=[] if block is None else _block(*block),
        cost=cost,
        ratio_ours=ratio,
        experiment="" if wall is None else _experiment(wall[1]),
        imperfection=_imperfection(run),
        block_case=None if block is None else block[0],
        wall_case=None if wall is None else wall[0],
    )


def _block(number: int, item: CaseResults) -> list[BlockRow]:
    rows = []
    for method, what, printed, form, exact in (
        ("fe", "Finite elements", "0.476", "0.5/1.05", 0.5 / 1.05),
        ("la", "Limit analysis, least", "0.4", "0.4", 0.4),
        ("la-associated", "Limit analysis, greatest", "0.545", "0.6/1.1", 0.6 / 1.1),
        ("de", "Distinct elements", "not given", "in [0.4, 0.6/1.1]", None),
    ):
        found = _result(item, method)
        if found is None:
            rows.append(BlockRow(what, printed, form, Cell("not run"), "", ""))
            continue
        result = found[1]
        if method == "de" and result.bracket is not None:
            cell = Cell(numbers.interval(result.bracket), numbers.every_digit(result.bracket))
        elif result.multiplier is None:
            cell = Cell(str(result.status))
        else:
            cell = Cell(numbers.multiplier(result.multiplier), repr(result.multiplier))
        difference = ""
        if exact is not None and result.multiplier is not None:
            gap = abs(result.multiplier - exact)
            difference = "0" if gap == 0.0 else numbers.power(gap)
        rows.append(BlockRow(what, printed, form, cell, anchor_of(number, found[0]), difference))
    return rows


def _cost(number: int, item: CaseResults) -> list[CostRow]:
    found = {method: _result(item, method) for method in PAPER_MINUTES}
    base = found["fe"][1].cpu_seconds if found["fe"] is not None and found["fe"][1].status is Status.OK else None
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
        cpu = result.cpu_seconds if result.status is Status.OK else None
        rows.append(
            CostRow(
                method=method,
                paper_ratio=numbers.plain(PAPER_MINUTES[method], 3),
                ratio=numbers.NOTHING if not cpu or not base else numbers.plain(20.0 * cpu / base, 3),
                cpu=Cell(numbers.seconds(cpu), "" if cpu is None else f"{cpu!r} s", cpu),
                anchor=anchor_of(number, entry[0]),
                paper_work=PAPER_WORK[method],
                settings=len(result.settings),
                changed=", ".join(asked) or "none",
            )
        )
    return rows


def _imperfection(run: ComparisonRun) -> str:
    """What the study of uneven blocks found, if the comparison brought it."""
    studies = run.provenance.get("studies", [])
    return next((str(study["sentence"]) for study in studies if "unevenness" in str(study.get("title", ""))), "")


def _experiment(item: CaseResults) -> str:
    values = [
        (method.upper(), entry[1].multiplier)
        for method in PAPER_MINUTES
        if (entry := _result(item, method)) is not None and entry[1].multiplier is not None
    ]
    if not values:
        return ""
    lowered = ", ".join(f"{numbers.plain((1.0 + EXPERIMENT) * (value or 0.0), 3)} ({name})" for name, value in values)
    return f"A wall that fails 20 % earlier than ours would fail at {lowered}."
