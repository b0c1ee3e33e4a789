"""Run a benchmark or a study of random walls: `python -m benchmarks NAME [ARGUMENTS]`; alone, it lists them.

All run in one thread, whatever the environment says: their figures are CPU seconds.
"""

from __future__ import annotations

import ast
import sys
from collections.abc import Sequence
from importlib import import_module
from pathlib import Path
from pkgutil import iter_modules

from drystone.cli.options import catching, say
from harness.engine.threads import pin

FOLDER = Path(__file__).parent
NOT_RUN = {"__main__", "walls"}
"""Modules of this folder that are no benchmarks."""


def benchmarks() -> list[str]:
    """Names of the benchmarks."""
    return sorted({module.name for module in iter_modules([str(FOLDER)])} - NOT_RUN)


def measures(name: str) -> str:
    """What a benchmark measures: the first line of its docstring, without importing all that it runs."""
    module = ast.parse((FOLDER / f"{name}.py").read_text(encoding="utf-8"))
    return (ast.get_docstring(module) or "").splitlines()[0]


@catching
def main(arguments: Sequence[str] | None = None) -> int:
    """Run the benchmark named first with the arguments that follow; 2 if there is none of that name."""
    given = list(sys.argv[1:] if arguments is None else arguments)
    pin()
    if given and given[0] in benchmarks():
        code = int(import_module(f"benchmarks.{given[0]}").main(given[1:]) or 0)
        sys.stdout.flush()  # so that a reader who left is noticed here, and reported as the commands do
        return code
    for name in benchmarks():
        say(f"{name:<20} {measures(name)}")
    return 2 if given else 0


if __name__ == "__main__":
    sys.exit(main())
