"""A run over so many documents: `python -m tests.fuzz.run 200000`. Each is repeated by its number: `--one NUMBER`."""

from __future__ import annotations

import json
import sys
import tempfile
import time
import traceback
from collections import Counter
from pathlib import Path

import click

from tests.fuzz.documents import Seeded
from tests.fuzz.targets import SHARES, outcome

DIFFERENT = 40
"""Findings of different places that are told before a run ends."""


def target_of(number: int) -> str:
    """The target of a document."""
    return SHARES[number % len(SHARES)]


def place_of(error: BaseException) -> str:
    """The kind of an error and the last line of the project that raised it, so that findings are told once each."""
    frames = [frame for frame in traceback.extract_tb(error.__traceback__) if "/fuzz/" not in frame.filename]
    last = next((frame for frame in reversed(frames) if "site-packages" not in frame.filename), None)
    where = f"{Path(last.filename).name}:{last.lineno}" if last else "?"
    return f"{type(error).__name__} at {where}"


@click.command()
@click.argument("count", type=click.IntRange(min=0), default=200_000)
@click.option("--first", type=int, default=0, show_default=True, help="Number of the first document.")
@click.option("--seconds", type=float, help="Stop after so many seconds.")
@click.option("--one", type=int, help="Only this document, with the traceback.")
@click.option("--output", type=click.Path(path_type=Path), help="A JSON file for the record.")
def main(count: int, first: int, seconds: float | None, one: int | None, output: Path | None) -> None:
    """Give COUNT documents to the readers, the builder, the judge and the store; exit code 1 if there is a finding."""
    outcomes: Counter[str] = Counter()
    findings: dict[str, list[int]] = {}
    begun = time.monotonic()
    done = 0
    with tempfile.TemporaryDirectory(prefix="fuzz-") as folder:
        if one is not None:
            print(target_of(one), outcome(target_of(one), Seeded(one), Path(folder)))
            return
        for number in range(first, first + count):
            if seconds is not None and time.monotonic() - begun > seconds:
                break
            target = target_of(number)
            try:
                outcomes[f"{target}: {outcome(target, Seeded(number), Path(folder))}"] += 1
            except Exception as error:  # whatever it is, it is a finding
                place = place_of(error)
                if place not in findings:
                    print(f"document {number} ({target}): {place}: {str(error)[:200]!r}", flush=True)
                findings.setdefault(place, []).append(number)
                if len(findings) >= DIFFERENT:
                    break
            done += 1
            if output is not None and done % 1000 == 0:
                _record(output, done, outcomes, findings, time.monotonic() - begun)
    elapsed = time.monotonic() - begun
    if output is not None:
        _record(output, done, outcomes, findings, elapsed)
    print(f"{done} documents in {elapsed:.0f} s: {dict(sorted(outcomes.items()))}")
    print(f"{len(findings)} findings: { {place: len(numbers) for place, numbers in findings.items()} }")
    sys.exit(1 if findings else 0)


def _record(path: Path, done: int, outcomes: Counter[str], findings: dict[str, list[int]], elapsed: float) -> None:
    few = {place: {"count": len(numbers), "first": numbers[:5]} for place, numbers in findings.items()}
    record = {"documents": done, "seconds": round(elapsed), "outcomes": dict(outcomes), "findings": few}
    path.write_text(json.dumps(record, indent=1), encoding="utf-8")


if __name__ == "__main__":
    main()
