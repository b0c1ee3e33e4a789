"""Methods that a fork server loads once, with their compiled kernels, so that no run pays for loading them."""

from __future__ import annotations

import contextlib
import os
from collections.abc import Iterable
from functools import cache

from harness.model.errors import InputError
from harness.model.foreign.register import program_named
from harness.model.method import method_points
from harness.model.method_registry import load_method, prepared

VARIABLE = "DRYSTONE_PRELOAD"
"""Environment variable with the names of the methods a fork server shall load, separated by commas."""


def shipped(names: Iterable[str]) -> list[str]:
    """Those of the methods that come with Drystone, sorted.

    Only these are known to load without starting threads, which a process that is forked must not have.
    """
    return sorted(_own().intersection(names))


@cache
def _own() -> frozenset[str]:
    """Names of the methods that Drystone's package brings; the name of a package is read from a file each time."""
    return frozenset(
        point.name for point in method_points() if point.dist is not None and point.dist.name == "drystone"
    )


def load(names: Iterable[str]) -> None:
    """Load methods; one that cannot be loaded is left to the run that needs it, which can say so.

    A program is started by the process that runs it.
    """
    for name in names:
        with contextlib.suppress(InputError, KeyError):
            if program_named(name) is None:
                prepared(load_method(name))


if os.environ.get(VARIABLE):
    load(os.environ[VARIABLE].split(","))
