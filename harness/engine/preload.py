"""Methods that a fork server loads once, with their compiled kernels, so that no run pays for loading them.

`python -m harness.engine.preload` compiles the kernels of every shipped method; `make` does so when it installs.
"""

from __future__ import annotations

import contextlib
import os
import sys
from collections.abc import Iterable

from harness.model.method import load_method, method_names, method_points

VARIABLE = "DRYSTONE_PRELOAD"
"""Environment variable with the names of the methods a fork server shall load, separated by commas."""


def shipped(names: Iterable[str]) -> list[str]:
    """Those of the methods that come with Drystone, sorted.

    Only these are known to load without starting threads, which a process that is forked must not have.
    """
    own = {point.name for point in method_points() if point.dist is not None and point.dist.name == "drystone"}
    return sorted(own.intersection(names))


def load(names: Iterable[str]) -> None:
    """Load methods; one that cannot be loaded is left to the run that needs it, which can say so."""
    for name in names:
        with contextlib.suppress(Exception):
            load_method(name)


def main() -> None:
    """Compile the kernels of every shipped method by running each on a small wall; print what could not be run."""
    from harness.conformance import CLOSED_FORMS, assembly_of

    for name in shipped(method_names()):
        if name == "dummy":
            continue
        try:
            method = load_method(name)
            for form in CLOSED_FORMS[-2:]:
                method.solve(assembly_of(form.wall, form.name), method.Settings())
        except Exception as error:
            print(f"{name} cannot be prepared: {error}", file=sys.stderr)


if __name__ == "__main__":
    main()
elif os.environ.get(VARIABLE):
    load(os.environ[VARIABLE].split(","))
