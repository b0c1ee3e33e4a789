"""A method of a user that does on order what a method must not; run as a script, it makes every such run by the engine.

The test copies this file to where an installed package would lie, so that the engine finds it as it finds any other.
"""

from __future__ import annotations

import json
import os
import signal
import sys
import threading
import time
from typing import Any

import numpy as np

from harness.model.assembly import Assembly
from harness.model.method import Answer, Finding, Method, Settings, Status


class UnrulySettings(Settings):
    """What it shall do."""

    does: str = "answer"


def nested(depth: int) -> list[Any]:
    found: list[Any] = []
    for _ in range(depth):
        found = [found]
    return found


ANSWERS: dict[str, dict[str, Any]] = {
    "half a character": {"sentence": "\ud800"},
    "half a character in details": {"details": {"x": ["\udfff"]}},
    "no text": {"sentence": 3},
    "complex": {"forces": np.zeros((1, 3)) + 1j},
    "objects": {"forces": np.array([[None] * 3], dtype=object)},
    "ragged": {"forces": [[1.0, 2.0], [3.0]]},
    "many forces": {"forces": np.zeros((10**7, 3))},
    "transposed": {"mechanism": np.zeros((3, 2))},
    "text for a number": {"multiplier": "1.0"},
    "truth for a number": {"multiplier": np.bool_(True)},
    "no multiplier": {"multiplier": None},
    "infinite": {"multiplier": float("inf")},
    "finding": {"finding": "banana"},
    "status": {"status": 7},
    "flow": {"flow": "sideways"},
    "bracket": {"bracket": (2.0, 1.0)},
    "iterations": {"iterations": 1.5},
    "text path": {"path": {"multiplier": ["a"]}},
    "uneven path": {"path": {"a": [1.0, 2.0], "b": [1.0]}},
    "path": {"path": [1.0]},
    "deep details": {"details": {"x": nested(100_000)}},
    "huge whole number": {"details": {"x": 10**5000}},
    "unknowns": {"details": {"unknowns": "many"}},
    "live forces": {"details": {"live_forces": "abc"}},
    "displaced": {"details": {"displaced_state": {"places": [[0.0, 0.0]]}}},
    "bound": {"details": {"certified_bound": "low"}},
    "start values": {"details": {"start_values": [1.0, "b"]}},
}
"""Answers with one thing wrong."""


class Unruly(Method):
    """Answers as ordered."""

    name = family = "unruly"
    title = "does what a method must not"
    tolerance = 1e-9
    Settings = UnrulySettings

    def solve(self, assembly: Assembly, settings: UnrulySettings) -> Any:
        good = {
            "status": Status.OK,
            "finding": Finding.COLLAPSES,
            "sentence": "made up",
            "multiplier": 1.0,
            "forces": np.zeros((assembly.n_interfaces, 3)),
            "mechanism": np.zeros((assembly.n_blocks, 3)),
        }
        act = ACTS.get(settings.does)
        if act is not None:
            act()
        if settings.does == "nothing":
            return None
        return Answer(**good | ANSWERS.get(settings.does, {}))


def write_everywhere() -> None:
    for number in range(3, 64):
        try:
            os.write(number, b"\x80\x04garbage" * 50)
        except OSError:
            continue


def announce_a_record() -> None:
    """The begin of a message that never ends, as a length of two gigabytes."""
    for number in range(3, 64):
        try:
            os.write(number, b"\x7f\xff\xff\xff")
        except OSError:
            continue


def say_loaded_again() -> None:
    for number in range(3, 64):
        try:
            os.write(number, b"loaded\n")
        except OSError:
            continue


def print_without_end() -> None:
    while True:
        os.write(1, b"noise \xff\x1b[2J\n" * 100_000)


def close_all() -> None:
    os.closerange(0, 256)


def leave() -> None:
    os._exit(0)


def ignore_signals() -> None:
    for number in (signal.SIGTERM, signal.SIGALRM, signal.SIGINT):
        signal.signal(number, signal.SIG_IGN)
    while True:
        time.sleep(1.0)


def change_folder() -> None:
    os.chdir("/")


def leave_a_thread() -> None:
    threading.Thread(target=time.sleep, args=(600,)).start()


def leave_a_patch() -> None:
    json.dumps = lambda *_, **__: "{}"  # type: ignore[assignment]


def raise_what_is_no_exception() -> None:
    raise SystemExit("enough")


ACTS = {act.__name__: act for act in (
    write_everywhere, announce_a_record, say_loaded_again, print_without_end, close_all, leave, ignore_signals,
    change_folder, leave_a_thread, leave_a_patch, raise_what_is_no_exception,
)}  # fmt: skip
"""What it does before it answers."""


def main() -> None:
    """Every kind by the engine, a sound method after each, in one comparison; rows as JSON."""
    from drystone import library_wall
    from harness.engine.pipeline import execute
    from harness.engine.run import Limits, Run

    case, limits, little = library_wall("slide").case, Limits(4.0, 600 * 2**20), Limits(60.0, 150 * 2**20)
    kinds = [*ANSWERS, *ACTS, "nothing", "answer"]
    runs = [
        run
        for kind in kinds
        for run in (
            Run(case, "unruly", {"does": kind}, little if kind.startswith("print") else limits),
            Run(case, "la-associated", {}, limits),
        )
    ]
    rows = [[str(result.status), result.sentence] for result in execute(runs, None, 1)]
    json.dump(dict(zip(kinds, zip(rows[::2], rows[1::2], strict=True), strict=True)), sys.stdout)


if __name__ == "__main__":
    main()
