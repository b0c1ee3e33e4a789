"""Imports without the garbage collector: what they make stays, and looking through it takes a sixth of a command."""

from __future__ import annotations

import gc
from collections.abc import Iterator
from contextlib import contextmanager


@contextmanager
def paused() -> Iterator[None]:
    """Let nothing be collected inside."""
    running = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if running:
            gc.enable()


def keep() -> None:
    """Look no more at what there is: for processes of our own, once they are loaded."""
    gc.freeze()
