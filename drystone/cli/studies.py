"""Studies for the commands: those that come with Drystone, their runs with progress, their curve for a report."""

from __future__ import annotations

import sys
import time
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

from drystone.studies import Counted, rows_of, shipped_study
from harness.engine.executors import LocalExecutor
from harness.engine.store import open_store
from harness.engine.sweep.curve import curve_of
from harness.engine.sweep.expand import SweepRun, expand, sources_of
from harness.engine.sweep.running import Row
from harness.engine.sweep.study import Whole, read_study
from harness.model.errors import InputError
from harness.model.reading import validate

_LINE_SECONDS = 10.0
"""How often progress is printed where there is no terminal."""


@dataclass(frozen=True)
class Amount:
    """How much of a study with seeds is made.

    Attributes:
        seeds: so many walls of each kind; None: those of the study.
        seconds: as many of them as fit in this time; None: all.
        least: walls made even where they take longer: one alone has no scatter.
    """

    seeds: int | None = None
    seconds: float | None = None
    least: int = 2


def amount_of(words: str) -> Amount:
    """How much NAME:AMOUNT asks for: nothing, a number of seeds, or seconds as "60s".

    Raises:
        InputError: anything else.
    """
    if not words:
        return Amount()
    number = words.removesuffix("s")
    if not number.isdecimal() or int(number) < 1:
        raise InputError(f'"{words}" is no amount', "Give NAME, NAME:12 (seeds) or NAME:60s (seconds)", "--study")
    return Amount(seconds=float(number)) if words.endswith("s") else Amount(seeds=int(number))


def curve_of_shipped(words: str, jobs: int, store: Path, *, fresh: bool, quiet: bool) -> dict[str, Any]:
    """Make a shipped study and give its curve; `words` are its name, or NAME:AMOUNT as `amount_of` reads it.

    Raises:
        InputError: no such study, one without a curve or, where an amount is given, without seeds.
    """
    name, _, rest = words.partition(":")
    path, amount = shipped_study(name, "--study"), amount_of(rest)
    study = read_study(path)
    if study.curve is None:
        raise InputError(f'"{name}" has no curve', "Give it a table [curve], or use `drystone sweep`", "--study")
    if rest and "seed" not in study.vary:
        raise InputError(f'"{name}" has no seeds', "Give its name alone", "--study")
    if amount.seeds is not None:
        fewer = validate(Whole, {"seeds": amount.seeds}, "--study")
        study = study.model_copy(update={"vary": study.vary | {"seed": fewer}})
    runs = expand(study, sources_of(study, (), path.parent))
    with open_store(store) as opened:

        def make(some: Sequence[SweepRun]) -> list[Row]:
            counting = partial(progress_bar, quiet=quiet)
            return rows_of(study, some, opened, LocalExecutor(jobs), fresh=fresh, counting=counting)

        if amount.seconds is None:
            return curve_of(study, make(runs))
        return curve_of(study, in_time(runs, make, amount.seconds * jobs, amount.least))


def in_time(
    runs: Sequence[SweepRun], make: Callable[[Sequence[SweepRun]], list[Row]], seconds: float, least: int
) -> list[Row]:
    """The rows of as many seeds as fit in a time, by the clock of the runs, so that the store gives the same.

    Args:
        runs: of a study with seeds.
        make: makes runs or finds them in the store.
        seconds: of all runs together.
        least: seeds made in any case.
    """
    by_seed: dict[Any, list[SweepRun]] = {}
    for run in runs:
        by_seed.setdefault(run.varied["seed"], []).append(run)
    rows: list[Row] = []
    spent = longest = 0.0
    for number, same in enumerate(by_seed.values()):
        if number >= least and spent + longest > seconds:
            break
        found = make(same)
        took = sum(float(row.get("wall_seconds") or 0.0) for row in found)
        spent, longest = spent + took, max(longest, took)
        rows += found
    return rows


@contextmanager
def progress_bar(total: int, *, quiet: bool) -> Iterator[Counted]:
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
            if not quiet and time.monotonic() - last > _LINE_SECONDS:
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
