"""Compile the kernels of every shipped method: `python -m harness.kernels`, which `make` runs when it installs."""

from __future__ import annotations

import importlib
import sys
from typing import Any

from drystone.walls import Wall, new_wall
from harness.engine.preload import shipped
from harness.model.errors import InputError
from harness.model.library import library
from harness.model.method import Method, load_method, method_names, prepared

LEFT_TO_NUMBA = "the kernels are left to numba, which takes half a second longer to load them"

FEW, MANY = {"count": 3, "friction": 0.25}, {"length": 8.0, "height": 3.0}
"""Bricks for every method; and more than the 200 blocks above which the quick one takes kernels too."""


def main() -> None:
    """Run every shipped method on a small wall and the quick one on a larger one; build the library of what they use.

    A library of the present sources stays. What could not be run is printed, and why no library could be built where
    that is so: methods work without.
    """
    methods = [method for name in shipped(method_names()) if (method := _ready(name)) is not None]
    if not _compiling():
        return
    small, large = new_wall("stack", **FEW), new_wall("running-bond", **MANY)
    for method in methods:
        for wall in (small, large) if method.name == library().methods.quick else (small,):
            _run(method, wall)
    try:
        ahead = importlib.import_module("methods.numerics.ahead")
    except ImportError as error:  # no setuptools, or a numba without its compiler of extension modules
        print(f"{LEFT_TO_NUMBA}: {error}", file=sys.stderr)
        return
    try:
        ahead.build(_compiling())
    except ahead.CannotBuild as error:
        print(f"{LEFT_TO_NUMBA}: {error}", file=sys.stderr)


def _ready(name: str) -> Method | None:
    """The method, with all that it compiles in place; None if that is not there."""
    try:
        return prepared(load_method(name))
    except InputError as error:
        print(error, file=sys.stderr)
        return None


def _run(method: Method, wall: Wall) -> None:
    try:
        method.solve(wall.assembly, method.Settings())
    except Exception as error:
        print(f"{method.name} cannot be prepared: {error}", file=sys.stderr)


def _compiling() -> list[Any]:
    """What numba compiles in this process; nothing where the library has it."""
    jit = sys.modules.get("methods.numerics.jit")
    return [] if jit is None else list(jit.KERNELS)


if __name__ == "__main__":
    main()
