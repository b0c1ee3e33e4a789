"""Methods on frozen sets of walls: how many they answer, how many correctly, how near the least known state, the cost.

A result counts as *answered* if the method ended within its limits with a finding, and as *correct* if the judge has
accepted it and no checked reference contradicts it. Both are shares of all walls of the set: what is refused, stopped
or wrong is counted, never left out.
"""

from __future__ import annotations

import functools
import itertools
import math
import statistics
import time
import tomllib
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from importlib.resources import files
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from drystone.bench_tables import COLUMNS, check_table, refuse_contradictions
from drystone.comparing import Comparison, compare
from drystone.walls import Wall, library_wall, new_wall
from harness.engine import pipeline
from harness.engine.provenance import machine
from harness.engine.run import Limits
from harness.model.errors import InputError, of_those_there
from harness.model.method import Finding, Status
from harness.model.proof import Standing, is_collapse_state
from harness.model.result import Verdict

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.figure import Figure

SAME = 1e-6
"""Relative distance from the least known multiplier up to which two states are the same one."""
WRONG = (Verdict.OUTSIDE_TOLERANCE, Verdict.VIOLATES_BOUND)


@dataclass(frozen=True)
class WallSet:
    """A frozen set of walls.

    Attributes:
        name, title: what it is called.
        version: that of the list; tables of different versions are not compared.
        walls: in the order of the list.
    """

    name: str
    title: str
    version: int
    walls: tuple[Wall, ...]


@functools.cache
def _sets() -> dict[str, dict[str, Any]]:
    return tomllib.loads(files("cases").joinpath("bench.toml").read_text(encoding="utf-8"))


def set_names() -> list[str]:
    """Names of the sets, the smallest first."""
    return list(_sets())


def wall_set(name: str) -> WallSet:
    """A set of walls by its name.

    >>> chosen = wall_set("core")
    >>> chosen.version, len(chosen.walls)
    (1, 30)

    Raises:
        InputError: there is no such set.
    """
    if name not in _sets():
        raise InputError(f'no set of walls is called "{name}"', of_those_there(name, _sets()), "--set")
    given = _sets()[name]
    return WallSet(name, given["title"], given["version"], tuple(_walls(given)))


def _walls(given: dict[str, Any]) -> Iterator[Wall]:
    for other in given.get("include", ()):
        yield from _walls(_sets()[other])
    yield from map(library_wall, given.get("library", ()))
    for made in given.get("made", ()):
        numbers = {key: value if isinstance(value, list) else [value] for key, value in made.items() if key != "kind"}
        for chosen in itertools.product(*numbers.values()):
            varied = [f"{value:g}" for value, every in zip(chosen, numbers.values(), strict=True) if len(every) > 1]
            wall = new_wall(made["kind"], **dict(zip(numbers, chosen, strict=True)))
            yield wall.called("-".join([made["kind"], *varied]).replace(".", "_"))


@dataclass(frozen=True)
class Speed:
    """How fast a machine is: time of a fixed piece of work [s], median and half the distance of its quartiles."""

    seconds: float
    spread: float


def machine_speed(repeats: int = 9) -> Speed:
    """CPU time of a fixed piece of work: dense solutions of 300 equations and a loop of Python.

    CPU seconds of two machines are compared by dividing them by this figure; its spread says how far to trust that.
    """
    matrix = np.random.default_rng(0).random((300, 300)) + 300.0 * np.eye(300)
    times = []
    for _ in range(repeats):
        start = time.process_time()
        for _ in range(10):
            np.linalg.solve(matrix, matrix)
        sum(number * number % 7 for number in range(300_000))
        times.append(time.process_time() - start)
    low, middle, high = statistics.quantiles(times, n=4)
    return Speed(middle, (high - low) / 2.0)


@dataclass(frozen=True, eq=False)
class Bench:
    """A table of methods on a set of walls; that of others can be added.

    Attributes:
        table: a row a wall and method, with the columns of `rows_of`.
    """

    table: pd.DataFrame

    @property
    def complete(self) -> pd.DataFrame:
        """The table with `least_known` and `above_least`: over all correct states of a wall in the table."""
        table = self.table.copy()
        states = table[table["correct"] & table["exact"]]
        least = states.groupby("wall")["multiplier"].min()
        table["least_known"] = table["wall"].map(least)
        table["above_least"] = table["multiplier"] / table["least_known"] - 1.0
        return table

    def summary(self) -> pd.DataFrame:
        """One row a method: walls, shares answered, correct, at the least known state, proved; error and CPU time.

        Every share is of all walls of the table; a wall without a row of the method is one that it left out.
        CPU seconds are the sum over all walls, failures included; `cpu_of_best` is the geometric mean of the ratio to
        the quickest correct method, over walls answered correctly.
        """
        import pandas as pd

        table = self.complete
        walls = table["wall"].nunique()
        best = table[table["correct"]].groupby("wall")["cpu_seconds"].min()
        rows = []
        for method, own in table.groupby("method", sort=False):
            right = own[own["correct"]]
            ratio = right["cpu_seconds"] / right["wall"].map(best)
            rows.append(
                {
                    "method": method,
                    "walls": len(own),
                    "answered": own["answered"].sum() / walls,
                    "correct": own["correct"].sum() / walls,
                    "at_least_known": (own["correct"] & (own["above_least"].abs() <= SAME)).sum() / walls,
                    "proved": own["proved"].sum() / walls,
                    "median_above_least": right["above_least"].median(),
                    "worst_above_least": right["above_least"].max(),
                    "cpu_seconds": own["cpu_seconds"].sum(),
                    "cpu_of_best": math.exp(np.log(ratio[ratio > 0.0]).mean()) if (ratio > 0.0).any() else math.nan,
                }
            )
        return pd.DataFrame(rows)

    def profile(self) -> dict[str, tuple[list[float], list[float]]]:
        """Performance profiles (Dolan and More 2002): per method, ratios to the quickest and the share within each.

        A wall that a method does not answer correctly is within no ratio.
        """
        table = self.complete
        walls = table["wall"].nunique()
        best = table[table["correct"]].groupby("wall")["cpu_seconds"].min()
        found = {}
        for method, own in table.groupby("method", sort=False):
            right = own[own["correct"]]
            ratios = np.sort((right["cpu_seconds"] / right["wall"].map(best)).to_numpy(dtype=float))
            shares = np.arange(1, len(ratios) + 1) / walls
            found[str(method)] = (ratios.tolist(), shares.tolist())
        return found

    def joined(self, other: pd.DataFrame, name: str) -> Bench:
        """This table with the rows of another one, as others publish it.

        Raises:
            InputError: columns are missing, it is of another set, version or walls, a cell cannot be of its column, or
                rows contradict each other.
        """
        import pandas as pd

        check_table(other, name, *(set(self.table[column]) for column in ("set", "version", "wall")))
        kept = other[list(COLUMNS)].astype(self.table.dtypes.to_dict())
        joined = pd.concat([self.table, kept], ignore_index=True)
        refuse_contradictions(joined, name)
        return Bench(joined)

    def plot(self) -> Figure:
        """Performance profiles, and the height above the least known state over CPU time."""
        from reports.figures.profile import profile_figure

        return profile_figure(self.profile(), self.complete)


def rows_of(chosen: WallSet, compared: Comparison, speed: Speed) -> pd.DataFrame:
    """The table of a comparison on a set of walls.

    Its columns are `COLUMNS`: lower and upper of a measured bracket; exact: a state of the joint law that the judge
    holds closely, not a measured bracket; proved: the minimum, by a certificate or to rounding; speed_seconds and
    speed_spread of the machine.
    """
    import pandas as pd

    processor = machine()["processor"]
    rows = []
    for result in compared.results:
        accepted = result.judge.accepted is True
        lower, upper = result.bracket or (math.nan, math.nan)
        refuted = any(item.gate and item.verdict in WRONG for item in result.comparisons)
        answered = result.status is Status.OK and result.finding is not Finding.NONE
        rows.append(
            {
                "set": chosen.name,
                "version": chosen.version,
                "wall": result.case,
                "blocks": result.blocks,
                "interfaces": result.interfaces,
                "method": result.method,
                "finding": str(result.finding),
                "status": str(result.status),
                "judge": result.judge.outcome,
                "multiplier": math.nan if result.multiplier is None else result.multiplier,
                "lower": lower,
                "upper": upper,
                "answered": answered,
                "correct": answered and accepted and not refuted,
                "exact": is_collapse_state(result),
                "proved": result.proof.standing in (Standing.MINIMUM, Standing.TO_ROUNDING),
                "cpu_seconds": math.nan if result.cpu_seconds is None else result.cpu_seconds,
                "wall_seconds": math.nan if result.wall_seconds is None else result.wall_seconds,
                "peak_memory_bytes": result.peak_memory_bytes or 0,
                "speed_seconds": speed.seconds,
                "speed_spread": speed.spread,
                "processor": processor,
            }
        )
    # A checked reference may ask for other settings besides: the first row is that of the method as it is.
    return pd.DataFrame(rows, columns=list(COLUMNS)).drop_duplicates(["wall", "method"], ignore_index=True)


def bench(
    name: str = "core",
    methods: Sequence[str] | None = None,
    *,
    jobs: int = 1,
    limits: Limits | None = None,
    store: str | Path | None = None,
    fresh: bool = False,
    progress: pipeline.Progress | None = None,
) -> Bench:
    """Run methods on a set of walls, each run in a process of its own, judged.

    Args:
        name: of the set.
        methods: names of methods; None: those of the library.
        jobs: runs at a time.
        limits: of one run; None: the usual ones.
        store, fresh, progress: as of `compare`.

    Raises:
        InputError: an unknown set or method.
    """
    from harness.model.library import library

    chosen, limits = wall_set(name), limits or Limits()
    compared = compare(
        chosen.walls,
        list(library().methods.compare) if methods is None else methods,
        jobs=jobs,
        seconds=limits.seconds,
        memory_bytes=limits.memory_bytes,
        store=store,
        fresh=fresh,
        progress=progress,
        title=f'set "{chosen.name}", version {chosen.version}',
        command=f"drystone bench --set {chosen.name}",
    )
    return Bench(rows_of(chosen, compared, machine_speed()))
