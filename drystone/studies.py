"""Studies: many walls that differ in a few quantities, each by the methods asked for, as tables and a page."""

from __future__ import annotations

import json
import tempfile
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import AbstractContextManager, closing, contextmanager, nullcontext
from dataclasses import dataclass, field
from datetime import UTC, datetime
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

from drystone.walls import Wall
from harness.engine.executors import Executor, LocalExecutor
from harness.engine.run import Limits
from harness.engine.store import Store, open_store
from harness.engine.sweep.expand import SweepRun, WallSource, expand, sources_of, warnings_of
from harness.engine.sweep.neighbours import handed_on
from harness.engine.sweep.quick import varied
from harness.engine.sweep.running import Row
from harness.engine.sweep.running import sweep as running
from harness.engine.sweep.study import Study, read_study
from harness.model.case import shipped_cases
from harness.model.errors import InputError, of_those_there
from harness.model.method_registry import load_method
from harness.model.reading import wall_json
from harness.model.writing import write_whole
from reports.page.study_page import StudyPage, render

if TYPE_CHECKING:
    import pandas as pd

    from harness.engine.sweep.summary import GridSummary

Counted = Callable[[bool], None]
"""Called after each run, with whether it came from the store."""


@dataclass(frozen=True, eq=False)
class Sweep:
    """A study and what it found. In a notebook it shows its quantiles.

    Attributes:
        study: what was asked.
        rows: one a run, in the order of the study, whatever order they ended in.
        warnings: sentences about what is doubtful in the walls as they are described and as they vary, each with the
            name of the first wall it is of.
    """

    study: Study
    rows: list[Row]
    warnings: Mapping[str, str] = field(default_factory=dict)

    def to_pandas(self) -> pd.DataFrame:
        """One row a run: case, method, what varied, and the answer; `attrs["units"]` names the units."""
        return self._table.copy()

    @cached_property
    def _table(self) -> pd.DataFrame:
        from harness.engine.sweep.frame import tidy
        from harness.engine.sweep.summary import varied_of

        return tidy(self.rows, varied_of(self.study))

    @cached_property
    def summary(self) -> GridSummary:
        """Statistics that the rows allow, and sentences that a reader should see."""
        from harness.engine.sweep.summary import summarise

        return summarise(self.study, self._table)

    @property
    def tables(self) -> dict[str, pd.DataFrame]:
        """Tables by name: quantiles; fragility, failure and sensitivity where seeds or draws allow them."""
        return self.summary.tables

    @property
    def rejected(self) -> int:
        """How many answers the judge rejects."""
        return sum(row.get("judge_accepted") is False for row in self.rows)

    def save(self, folder: str | Path) -> list[Path]:
        """Write the rows and every table as CSV, and as Parquet where pyarrow is installed; the files."""
        from harness.engine.sweep.frame import write

        files = write(self._table, Path(folder), "runs")
        for name, table in self.tables.items():
            files += write(table, Path(folder), name)
        return files

    def report(self, path: str | Path, command: str = "drystone.sweep", data: Sequence[str] = ()) -> Path:
        """Write the page of the study.

        Args:
            path: of the page.
            command: how to repeat it, shown on the page.
            data: paths of files, from the folder of the page, to which it has links.
        """
        from harness.engine.sweep.summary import grid_of
        from reports.charts.styles import mark_named
        from reports.page.study_page import StudyPage

        created = datetime.now(UTC).isoformat(timespec="seconds")
        study, summary = self.study, self.summary
        about = (study.title, study.question, command, created, self._table, grid_of(study))
        target = Path(path)
        target.parent.mkdir(parents=True, exist_ok=True)
        marks = {name: mark_named(name, load_method(name).traits) for name in study.methods}
        remarks = [*summary.remarks, *(f"{name}: {sentence}" for sentence, name in self.warnings.items())]
        _write_page(StudyPage(*about, summary.tables, remarks, list(data), marks), target)
        return target

    def _repr_html_(self) -> str:
        from reports.drawing.svg import html

        return html(self.study.title, table=str(self.tables["quantiles"].to_html(float_format="{:.6g}".format)))


def sweep(
    what: Wall | Study | str | Path,
    vary: Mapping[str, Any] | None = None,
    methods: Sequence[str] | None = None,
    *,
    settings: Mapping[str, dict[str, Any]] | None = None,
    multipliers: Sequence[float] = (),
    neighbours: bool | None = None,
    jobs: int = 1,
    seconds: float = Limits().seconds,
    memory_bytes: int = Limits().memory_bytes,
    store: str | Path | None = None,
    executor: Executor | None = None,
    fresh: bool = False,
    progress: Counted | None = None,
    folders: Sequence[Path] = (),
) -> Sweep:
    """Make every run of a study, each in a process of its own, and judge every answer.

    Args:
        what: a wall of which something varies; or a study: read, its file, or the name of one that comes with Drystone.
        vary: values by the name of a quantity (`friction`, `proportion`, `imperfection`, a path in the wall, or
            `settings.METHOD.NAME`): a list, or a mapping as in a study file; every one with every other.
        methods: names; None: those of the study, or of the library.
        settings: of methods, by name, where not the defaults.
        multipliers: for the probability of failure.
        neighbours: whether runs take up the motions that their neighbours found; None: as the study says, else not.
        jobs: runs at a time.
        seconds, memory_bytes: limits of a run of a wall; a study has its own.
        store: file in which results are kept and looked for; None: nowhere.
        executor: where runs are made instead, as on a cluster.
        fresh: run again what is in the store.
        progress: called after each run with whether it came from the store.
        folders: more places where cases of a study are looked for.

    Raises:
        InputError: a study that cannot be read, a quantity, method or setting that does not exist, a value it cannot
            have, or a wall of which nothing varies.

    >>> import drystone
    >>> wall = drystone.new_wall("stack", count=3, width=0.3, height=0.2, friction=0.8)
    >>> done = drystone.sweep(wall, {"friction": [0.3, 0.8]}, ["la-associated"])
    >>> [round(multiplier, 6) for multiplier in done.to_pandas()["multiplier"]]
    [0.3, 0.5]
    """
    study, sources = _asked(what, vary, methods, settings, multipliers, Limits(seconds, memory_bytes), folders)
    study = changed(study, neighbours=neighbours)
    runs = expand(study, sources)
    with _opened(store) as opened:
        where = executor or LocalExecutor(jobs)
        counting = nullcontext(progress or _silent)
        rows = rows_of(study, runs, opened, where, fresh=fresh, counting=lambda _: counting)
    return Sweep(study, rows, warnings_of(sources, runs))


def rows_of(
    study: Study,
    runs: Sequence[SweepRun],
    store: Store,
    executor: Executor,
    *,
    fresh: bool = False,
    counting: Callable[[int], AbstractContextManager[Counted]] = lambda _: nullcontext(_silent),
) -> list[Row]:
    """The rows of all runs of a study, made or from the store; neighbours share what they found, if it says so.

    Args:
        study: what was asked.
        runs: of `expand`.
        store: where results are looked for and kept.
        executor: where runs are made.
        fresh: make again what is in the store.
        counting: opened with the number of runs of each round, gives what is called after each.

    Returns:
        One row a run, in the order of the study.
    """

    def make(some: Sequence[SweepRun]) -> list[Row]:
        rows: dict[int, Row] = {}
        with counting(len(some)) as progress, closing(running(some, store, executor, fresh=fresh)) as ended:
            for run, row, stored in ended:
                rows[run.number] = row
                progress(stored)
        return [rows[number] for number in sorted(rows)]

    rows = make(runs)
    return handed_on(runs, rows, store, make) if study.neighbours else rows


def _silent(stored: bool) -> None:
    """Tell nobody."""


def shipped_study(name: str, element: str) -> Path:
    """The file of a study that comes with Drystone.

    Raises:
        InputError: there is none of this name; `element` is what asked for it.
    """
    known = shipped_studies()
    if name not in known:
        raise InputError(f'no study is called "{name}"', of_those_there(name, known), element)
    return known[name]


def shipped_studies() -> dict[str, Path]:
    """The studies that come with Drystone, by name."""
    return {path.stem: path for path in sorted((shipped_cases() / "studies").glob("*.toml"))}


def study_file(what: str | Path) -> Path | None:
    """The file of that path, or of the study of that name that comes with Drystone; None if neither is there."""
    return Path(what) if Path(what).exists() else shipped_studies().get(str(what))


def _asked(
    what: Wall | Study | str | Path,
    vary: Mapping[str, Any] | None,
    methods: Sequence[str] | None,
    settings: Mapping[str, dict[str, Any]] | None,
    multipliers: Sequence[float],
    limits: Limits,
    folders: Sequence[Path],
) -> tuple[Study, list[WallSource]]:
    if isinstance(what, Wall):
        if not vary:
            raise InputError(f'nothing of "{what.name}" varies', 'Give vary={"friction": [0.4, 0.6]}', "vary")
        study = varied(what.name, dict(vary), methods, dict(settings or {}), limits, list(multipliers))
        return study, [WallSource(what.name, json.loads(wall_json(what.case.wall)), what.case.notes)]
    if vary:
        raise InputError("a study defines what varies", "Leave vary out, or give a wall", "vary")
    study, place = (what, None) if isinstance(what, Study) else _read(what)
    study = changed(study, methods, settings or {}, multipliers)
    return study, sources_of(study, folders, place)


def _read(what: str | Path) -> tuple[Study, Path]:
    path = study_file(what)
    if path is None:
        remedy = f"{of_those_there(str(what), shipped_studies())}; or give a file, or a wall and what varies"
        raise InputError(f'no study is called "{what}"', remedy, "sweep")
    return read_study(path), path.parent


def changed(
    study: Study,
    methods: Sequence[str] | None = None,
    settings: Mapping[str, dict[str, Any]] | None = None,
    multipliers: Sequence[float] = (),
    neighbours: bool | None = None,
) -> Study:
    """A study with other methods, further settings, other multipliers or another word on neighbours, where given."""
    changes: dict[str, Any] = {"methods": list(methods)} if methods else {}
    if settings:
        own = study.settings
        changes["settings"] = {name: own.get(name, {}) | settings.get(name, {}) for name in {**own, **settings}}
    if multipliers:
        changes["multipliers"] = list(multipliers)
    if neighbours is not None:
        changes["neighbours"] = neighbours
    return study.model_copy(update=changes)


@contextmanager
def _opened(store: str | Path | None) -> Iterator[Store]:
    """The store, or one that is gone afterwards."""
    with tempfile.TemporaryDirectory() as folder, open_store(Path(store or Path(folder) / "runs.sqlite")) as opened:
        yield opened


def _write_page(page: StudyPage, path: Path) -> None:
    """Write the page of a study as one HTML file that works offline."""
    write_whole(path, render(page))
