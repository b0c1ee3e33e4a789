"""Many methods on many walls, each run in a process of its own, judged and held together."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from drystone.analysis import Result
from drystone.certificates import with_certificates
from drystone.walls import Wall, checked_walls
from harness.engine import compare as engine
from harness.engine import pipeline
from harness.engine.executors import Executor, InProcess, LocalExecutor
from harness.engine.load_case_search import made_together
from harness.engine.plan import check_methods, plan_case
from harness.engine.run import Limits, Run
from harness.engine.store import Store, open_store
from harness.engine.verdict import violations
from harness.model.case import Case
from harness.model.comparison import ComparisonRun
from harness.model.errors import InputError
from harness.model.load_cases import load_cases_of
from harness.model.result import Result as Record

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.figure import Figure


@dataclass(frozen=True)
class Comparison:
    """What methods found on walls. In a notebook it shows its table.

    Attributes:
        walls: the walls, in the order given.
        results: one for each wall and method.
        run: what the report is made of, statements of theory included.
    """

    walls: list[Wall]
    results: list[Result]
    run: ComparisonRun

    @property
    def violations(self) -> list[str]:
        """Sentences about checked references and statements of theory that are not met, and about rejected answers."""
        return violations(self.run)

    def to_pandas(self) -> pd.DataFrame:
        """One row a wall and method, the columns of results.csv; `attrs["units"]` names the units."""
        from reports.page.export import result_frame

        return result_frame(result.row for result in self.results)

    def multipliers(self) -> pd.DataFrame:
        """Multipliers by wall (rows) and method (columns), in the order given."""
        import pandas as pd

        table = pd.DataFrame([(item.case, item.method, item.multiplier) for item in self.results])
        table.columns = pd.Index(["wall", "method", "multiplier"])
        wide = table.pivot(index="wall", columns="method", values="multiplier")
        rows = list(dict.fromkeys(table["wall"]))
        return wide.reindex(index=rows, columns=list(dict.fromkeys(table["method"])))

    def report(self, path: str | Path) -> Path:
        """Write the HTML report, with its data folder beside it."""
        from reports.page.build import write_report

        target = Path(path)
        target.parent.mkdir(parents=True, exist_ok=True)
        write_report(self.run, target)
        return target

    def plot(self) -> Figure:
        """Multipliers of all methods, one group of points a wall, in the colours and marks that the methods name."""
        from reports.figures.multipliers import multipliers_figure

        return multipliers_figure(self.run)

    def _repr_html_(self) -> str:
        from reports.drawing.svg import html

        return html(self.run.title, table=str(self.multipliers().to_html(na_rep="-", float_format="{:.6g}".format)))


def compare(
    walls: Wall | Iterable[Wall],
    methods: Sequence[str] | None = None,
    *,
    isolated: bool = True,
    jobs: int = 1,
    seconds: float = Limits().seconds,
    memory_bytes: int = Limits().memory_bytes,
    store: str | Path | None = None,
    settings: Mapping[str, dict[str, Any]] | None = None,
    fresh: bool = False,
    progress: pipeline.Progress | None = None,
    title: str = "",
    command: str = "drystone.compare",
    studies: Sequence[dict[str, Any]] = (),
    proof_seconds: float = 60.0,
) -> Comparison:
    """Run methods on walls, judge every answer, and compare them with references and theory.

    Args:
        walls: one wall or several; one with load cases stands for all of them.
        methods: names of methods; None: those of each case, else those of the library.
        isolated: each run in a process of its own, so that one that hangs or crashes costs its row only; False: in this
            process, one after the other, without limits.
        jobs: isolated runs at a time.
        seconds: wall-clock limit of an isolated run [s].
        memory_bytes: memory limit of an isolated run [bytes].
        store: file in which results and what the comparison consisted of are kept and looked for; None: nowhere.
        settings: of methods, by name, where not the defaults.
        fresh: run again what is in the store.
        progress: called after each run with the run, its result and whether it was stored.
        title, command: what the report says was compared, and how to repeat it.
        studies: for the report to draw, as `reports.charts.studies` describes them.
        proof_seconds: of CPU time, by wall, for checking certificates that methods hand on [s].

    Raises:
        InputError: an unknown method, two walls of one name, or a store that is damaged.
    """
    chosen = [Wall(each) for wall in checked_walls(walls) for each in load_cases_of(wall.case)]
    names = [wall.name for wall in chosen]
    if len(set(names)) < len(names):
        twice = next(name for name in names if names.count(name) > 1)
        raise InputError(f'two walls are called "{twice}"', 'Give one another name: wall.called("...")', "walls")
    if methods is not None:
        check_methods(methods, "methods")
    limits = Limits(seconds, memory_bytes) if isolated else None
    runs = [run for wall in chosen for run in plan_case(wall.case, methods, limits, settings=settings)]
    executor = LocalExecutor(jobs) if isolated else InProcess()
    cases = [wall.case for wall in chosen]
    with pipeline.opened_at(store) as opened:
        run = compared(
            title or ", ".join(names),
            command,
            cases,
            runs,
            opened,
            executor,
            fresh=fresh,
            progress=progress,
            studies=studies,
            proof_seconds=proof_seconds,
            remembered=True,
        )
    by_name = {wall.name: wall for wall in chosen}
    rows = [Result.on(by_name[item.case.id], each, item) for item in run.cases for each in item.results]
    return Comparison(chosen, rows, run)


def compared(
    title: str,
    command: str,
    cases: Sequence[Case],
    runs: Sequence[Run],
    store: Store | None,
    executor: Executor,
    *,
    fresh: bool = False,
    progress: pipeline.Progress | None = None,
    studies: Sequence[dict[str, Any]] = (),
    certified: bool = True,
    proof_seconds: float = 60.0,
    remembered: bool = False,
) -> ComparisonRun:
    """The comparison that runs make, found or made, and judged, with what the certificates of their walls prove.

    Load cases of one wall are searched together (`harness.engine.load_case_search`).

    Args:
        title, command: what the report says was compared, and how to repeat it.
        cases: in the order of the report.
        runs: of these cases.
        store: where results are looked for and kept; None: nowhere.
        executor: where runs are made.
        fresh: as of `compare`.
        progress: called once for every run planned, when it first has a result.
        studies: for the report to draw.
        certified: whether certificates are looked at; a page that shows nothing of them can leave it.
        proof_seconds: as of `compare`.
        remembered: whether the store keeps what it consisted of, as its last comparison.
    """
    wall_ids, told = {case.id: case.wall_id for case in cases}, set[tuple[str, str, str]]()

    def tell(run: Run, result: Record, stored: bool) -> None:
        planned = run.case.id, run.method, str(run.settings)
        if progress is not None and planned not in told and not (run.given and result.multiplier is None):
            told.add(planned)
            progress(run, result, stored)

    def make(asked: Sequence[Run]) -> list[Record]:
        return pipeline.execute(asked, store, 1, fresh=fresh, progress=tell, executor=executor)

    runs, results = made_together(runs, lambda run: wall_ids[run.case.id], make)
    run = engine.comparison_run(title, command, cases, runs, results)
    if studies:
        run.provenance["studies"] = list(studies)
    run = with_certificates(run, proof_seconds) if certified else run
    if remembered and store is not None:
        engine.remember(store, run, runs)
    return run


def recalled(store: str | Path) -> ComparisonRun:
    """The comparison that a store remembers last, judged and with certificates checked anew; nothing is run.

    Raises:
        InputError: there is no such store, none in it, or it is damaged.
    """
    with open_store(Path(store), read_only=True) as opened:
        found = engine.recall(opened)
    if found is None:
        raise InputError("no comparison is in the store", "Run `drystone compare` first", source=str(store))
    return with_certificates(found)
