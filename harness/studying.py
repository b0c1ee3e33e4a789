"""Studies for the commands: those that come with Drystone, their runs with progress, their curve for a report."""

from __future__ import annotations

import sys
import time
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from contextlib import closing, contextmanager
from pathlib import Path
from typing import Any

from harness.engine.executors import Executor, LocalExecutor
from harness.engine.store import Store, open_store
from harness.engine.sweep.curve import curve_of
from harness.engine.sweep.expand import SweepRun, expand, sources_of
from harness.engine.sweep.running import Row, sweep
from harness.engine.sweep.study import Whole, read_study
from harness.model.case import shipped_cases
from harness.model.errors import InputError
from harness.model.reading import validate

LINE_SECONDS = 10.0
"""How often progress is told where there is no terminal."""


def shipped_studies() -> dict[str, Path]:
    """The studies that come with Drystone, by name."""
    return {path.stem: path for path in sorted((shipped_cases() / "studies").glob("*.toml"))}


def curve_of_shipped(words: str, jobs: int, store: Path, *, fresh: bool, quiet: bool) -> dict[str, Any]:
    """Make a shipped study and give its curve; `words` are its name, or NAME:SEEDS for another number of seeds.

    Raises:
        InputError: no such study, one without a curve or, where SEEDS are given, without seeds.
    """
    name, _, seeds = words.partition(":")
    if name not in shipped_studies():
        raise InputError(f'no study is called "{name}"', f"There are: {', '.join(shipped_studies())}", "--study")
    path = shipped_studies()[name]
    study = read_study(path)
    if study.curve is None:
        raise InputError(f'"{name}" has no curve', "Give it a table [curve], or use `drystone sweep`", "--study")
    if seeds:
        if "seed" not in study.vary or not seeds.isdecimal():
            raise InputError(f'"{words}" names no number of seeds', "Give NAME or NAME:SEEDS", "--study")
        fewer = validate(Whole, {"seeds": int(seeds)}, "--study")
        study = study.model_copy(update={"vary": study.vary | {"seed": fewer}})
    runs = expand(study, sources_of(study, (), path.parent))
    with open_store(store) as opened:
        return curve_of(study, made(runs, opened, LocalExecutor(jobs), fresh=fresh, quiet=quiet))


def made(runs: Sequence[SweepRun], store: Store, executor: Executor, *, fresh: bool, quiet: bool) -> list[Row]:
    """The rows of all runs, made or from the store, with progress told."""
    rows = []
    with _progress(len(runs), quiet=quiet) as told, closing(sweep(runs, store, executor, fresh=fresh)) as ended:
        for _, row, stored in ended:
            rows.append(row)
            told(stored)
    return rows


@contextmanager
def _progress(total: int, *, quiet: bool) -> Iterator[Callable[[bool], None]]:
    """Something to call after each run: a bar with rate and time left, or a line now and then."""
    from rich.console import Console
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn

    begun = last = time.monotonic()
    counts = Counter[str]()

    def words() -> str:
        spent = max(time.monotonic() - begun, 1e-9)
        rate = counts["made"] / spent
        left = (total - counts["made"] - counts["stored"]) / rate if rate > 0.0 else float("nan")
        return f"{counts['stored']:,} from the store, {rate:.3g} runs a second" + (
            f", {duration(left)} left" if left == left else "")  # fmt: skip

    console = Console(stderr=True)
    if quiet or not console.is_terminal:

        def tell(stored: bool) -> None:
            nonlocal last
            counts["stored" if stored else "made"] += 1
            if not quiet and time.monotonic() - last > LINE_SECONDS:
                last = time.monotonic()
                done = counts["stored"] + counts["made"]
                print(f"{done:,} of {total:,} runs, {words()}", file=sys.stderr, flush=True)

        yield tell
        return
    columns = TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn(), TimeRemainingColumn()
    with Progress(*columns, console=console, transient=True) as bar:
        task = bar.add_task("", total=total)

        def advance(stored: bool) -> None:
            counts["stored" if stored else "made"] += 1
            bar.update(task, advance=1, description=words())

        yield advance


def duration(seconds: float) -> str:
    """A time in words: seconds, minutes or hours."""
    if seconds < 90.0:
        return f"{seconds:.0f} s"
    return f"{seconds / 60.0:.0f} min" if seconds < 5400.0 else f"{seconds / 3600.0:.1f} h"
