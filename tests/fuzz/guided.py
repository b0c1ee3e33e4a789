"""Fuzzing led by the code it reaches, where atheris installs: `python -m tests.fuzz.guided wall -runs=20000`."""

from __future__ import annotations

import sys
import tempfile
from pathlib import Path

import atheris

with atheris.instrument_imports(include=["harness"]):
    from tests.fuzz.targets import TARGETS, outcome


class Provided:
    """Choices from the bytes that the fuzzer sends."""

    def __init__(self, content: bytes) -> None:
        self._provider = atheris.FuzzedDataProvider(content)

    def integer(self, low: int, high: int) -> int:
        """A whole number from low to high, both included."""
        return int(self._provider.ConsumeIntInRange(low, high))


def main() -> None:
    """Fuzz the target named first; further words go to libFuzzer."""
    target, *options = sys.argv[1:] or ["wall"]
    if target not in TARGETS:
        sys.exit(f"no target is called {target!r}; there are: {', '.join(TARGETS)}")
    with tempfile.TemporaryDirectory(prefix="fuzz-") as folder:

        def one(content: bytes) -> None:
            outcome(target, Provided(content), Path(folder))

        atheris.Setup([sys.argv[0], *options], one)
        atheris.Fuzz()


if __name__ == "__main__":
    main()
