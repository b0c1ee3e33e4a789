"""What keeps a process from outliving the one that started it."""

from __future__ import annotations

import contextlib
import ctypes
import signal

_AT_END_OF_PARENT = 1
"""PR_SET_PDEATHSIG of prctl(2)."""


def end_with_parent() -> None:
    """Have the kernel kill this process when the one that started it ends, however that ends (Linux; elsewhere not)."""
    with contextlib.suppress(OSError, AttributeError):
        ctypes.CDLL(None).prctl(_AT_END_OF_PARENT, int(signal.SIGKILL), 0, 0, 0)
