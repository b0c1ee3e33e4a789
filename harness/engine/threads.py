"""One thread a run: set before any library is loaded that would start more."""

from __future__ import annotations

import os

_ONE_THREAD = {f"{library}_NUM_THREADS": "1" for library in ("OMP", "OPENBLAS", "MKL", "NUMEXPR", "NUMBA")}
"""Environment of every run: one thread, so that CPU time means the same for all methods; runs are what is parallel."""


def pin() -> None:
    """Put `_ONE_THREAD` in the environment of this process and of those it starts."""
    os.environ.update(_ONE_THREAD)
