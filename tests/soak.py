"""Hours of random walls through every method: `python -m tests.soak --minutes 120`.

Held to: no run crashes, no answer is rejected by the judge, no gate of theory breaks, no child is left behind, and the
memory of the coordinating process stays flat. Every failure is printed with the seed of its wall, and
`python -m tests.soak --wall SEED` runs that wall again.
"""

from __future__ import annotations

import gc
import json
import statistics
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Iterator
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any

import click
import numpy as np
import psutil

from cases.useful import irregular_stones
from harness.engine import compare as comparing
from harness.engine import pipeline
from harness.engine.run import Limits, Run
from harness.engine.store import Store, open_store
from harness.model.case import Case, CaseFile
from harness.model.errors import InputError
from harness.model.method import Status
from harness.model.method_registry import method_names
from harness.model.result import Result
from harness.model.wall import Wall

FLAT = 0.05
"""Growth of the coordinator's memory that counts as none: a leak does not stop, and passes it in time."""
SETTLED = 1.0 / 6.0
"""Part of the walls after which imports, caches and the compiled code of the libraries are in memory."""
LEFT_OUT = ("dummy",)
"""Methods that misbehave on order."""


@dataclass
class Record:
    """What a soak leaves: counts, memory over walls [bytes], and the failures with their seeds."""

    first_seed: int
    seconds: float = 0.0
    walls: int = 0
    runs: int = 0
    status: dict[str, int] = field(default_factory=dict)
    failures: list[str] = field(default_factory=list)
    memory: list[int] = field(default_factory=list)

    @property
    def growth(self) -> float | None:
        """Memory at the end over memory when it had settled, less one: medians of a sixth of the walls each."""
        part = max(1, int(len(self.memory) * SETTLED))
        if len(self.memory) < 3 * part:
            return None
        return statistics.median(self.memory[-part:]) / statistics.median(self.memory[part : 2 * part]) - 1.0


def random_wall(seed: int) -> Wall:
    """The wall of a seed: a pattern of 2 to 60 blocks with friction and live load of many kinds."""
    random = np.random.default_rng(seed)
    kind = ("bond", "bond", "ring", "stack", "stones", "panel")[random.integers(6)]
    friction = float(random.choice([0.0, 0.2, 0.35, 0.5, 0.65, 0.8, 1.2, round(float(random.uniform(0.1, 1.0)), 3)]))
    if kind == "stones":
        found = irregular_stones(seed, float(random.choice([1.0, 1.5, 2.0])), int(random.integers(2, 5)))
        return found.model_copy(update={"title": f"soak {seed}: stones", "friction": friction})
    angle = random.choice([0.0, 180.0, 0.0, 30.0, -30.0])
    push = [float(np.cos(np.radians(angle))), float(np.sin(np.radians(angle)))]
    data = {
        "format": "wall/1",
        "title": f"soak {seed}: {kind}",
        "unit_weight": 20.0,
        "friction": friction,
        "pattern": _PATTERNS[kind](random),
        "loads": {"live": {"body": [{"per_weight": push}]}},
    }
    return Wall.model_validate(data)


def _bond(random: np.random.Generator) -> dict[str, Any]:
    return {
        "type": "running_bond",
        "block_length": float(random.choice([0.2, 0.4, 0.6])),
        "block_height": 0.2,
        "count": int(random.integers(1, 8)),
        "bricks": int(random.integers(2, 6)),
        "start": str(random.choice(["half", "full"])),
    }


def _ring(random: np.random.Generator) -> dict[str, Any]:
    half = float(random.uniform(30.0, 90.0))
    return {
        "type": "ring",
        "inner_radius": 2.0,
        "outer_radius": 2.0 + float(random.uniform(0.2, 0.8)),
        "count": int(random.integers(3, 22)),
        "angles": [90.0 + half, 90.0 - half],
    }


def _stack(random: np.random.Generator) -> dict[str, Any]:
    count = int(random.integers(1, 12))
    offsets = np.round(random.uniform(-0.05, 0.05, count), 3).tolist()
    return {
        "type": "stack",
        "width": 0.5,
        "height": float(random.uniform(0.1, 0.6)),
        "count": count,
        "offsets": offsets,
    }


def _panel(random: np.random.Generator) -> dict[str, Any]:
    """Rows of stones of one to three cells, shifted at random, on a row that is fixed."""
    columns, letters = int(random.integers(3, 8)), iter("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ")
    rows = []
    for _ in range(int(random.integers(1, 6))):
        row = ""
        while len(row) < columns:
            row += next(letters) * int(random.integers(1, 4))
        rows.append(row[:columns])
    return {"type": "panel", "cell_length": 0.3, "cell_height": 0.25, "layout": [*rows, "#" * columns], "fixed": "#"}


_PATTERNS = {"bond": _bond, "ring": _ring, "stack": _stack, "panel": _panel}


def wall_case(seed: int) -> Case:
    """The wall of a seed as a case without references."""
    return Case(
        CaseFile(id=f"soak-{seed}", title=f"soak {seed}", source="tests.soak"), random_wall(seed), f"seed {seed}"
    )


def failures_of(case: Case, results: list[Result], runs: list[Run]) -> Iterator[str]:
    """What went wrong with the answers for one wall, a sentence each."""
    for result in results:
        if result.status is Status.CRASHED:
            yield f"{result.method} crashed: {result.sentence}"
        elif result.judge.accepted is False:
            yield f"{result.method} rejected by the judge: {result.judge.sentence}"
    for gathered in comparing.gather([case], runs, results):
        for gate in gathered.gates:
            if gate.passed is False:
                yield f"gate {gate.name}: {gate.sentence}"


def leftovers() -> list[str]:
    """Children of this process that are dead and not waited for, or still run a method."""
    found = []
    for child in psutil.Process().children(recursive=True):
        try:
            if child.status() == psutil.STATUS_ZOMBIE:
                found.append(f"zombie {child.pid}")
        except psutil.NoSuchProcess:
            continue
    return found


def soak_wall(record: Record, seed: int, methods: list[str], limits: Limits, store: Store | None) -> None:
    """One wall through every method; what fails is added to the record and printed."""
    try:
        case = wall_case(seed)
        runs = [Run(case, method, {}, limits) for method in methods]
        results = pipeline.execute(runs, store, 1)
        failed = list(failures_of(case, results, runs))
        record.runs += len(results)
        record.status = dict(Counter(record.status) + Counter(str(result.status) for result in results))
    except InputError as error:
        failed = [f"the wall of the generator is refused: {error}"]
    failed += leftovers()
    record.walls += 1
    gc.collect()
    record.memory.append(psutil.Process().memory_info().rss)
    for sentence in failed:
        record.failures.append(f"seed {seed}: {sentence}")
        print(record.failures[-1], flush=True)


@click.command()
@click.option("--minutes", type=click.FloatRange(min=0.0), default=120.0, show_default=True)
@click.option("--seconds", type=click.FloatRange(min=0.1), default=20.0, show_default=True, help="Limit of one run.")
@click.option("--first-seed", type=int, default=0, show_default=True)
@click.option("--wall", "single", type=int, help="Only the wall of this seed.")
@click.option("--methods", help="Names, separated by commas.  [default: all installed]")
@click.option("--output", type=click.Path(path_type=Path), help="A JSON file for the record.")
def main(
    minutes: float, seconds: float, first_seed: int, single: int | None, methods: str | None, output: Path | None
) -> None:
    """Run random walls through every method for so many minutes; exit code 1 on a failure or growing memory."""
    names = methods.split(",") if methods else [name for name in method_names() if name not in LEFT_OUT]
    record, begun = Record(first_seed), time.monotonic()
    with tempfile.TemporaryDirectory(prefix="soak-") as folder, open_store(Path(folder) / "soak.sqlite") as store:
        seed = first_seed if single is None else single
        while record.walls == 0 or (single is None and time.monotonic() - begun < 60.0 * minutes):
            soak_wall(record, seed, names, Limits(seconds), store)
            seed += 1
            record.seconds = time.monotonic() - begun
            if output is not None:
                output.write_text(json.dumps(asdict(record) | {"growth": record.growth}, indent=1), encoding="utf-8")
    growth = record.growth
    told = "not measured: too few walls" if growth is None else f"{growth:+.1%}"
    print(f"{record.walls} walls, {record.runs} runs in {record.seconds / 60.0:.1f} minutes: {record.status}")
    print(f"memory of the coordinator: {record.memory[-1] / 2**20:.0f} MiB at the end, growth {told}")
    print(f"{len(record.failures)} failures")
    sys.exit(1 if record.failures or (growth is not None and growth > FLAT) else 0)


if __name__ == "__main__":
    main()
