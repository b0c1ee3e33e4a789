"""Compile the loops of every shipped method, whose code numba keeps; the set-up runs `python -m drystone.kernels`."""

from __future__ import annotations

import sys

from drystone.walls import Wall, new_wall
from harness.engine.preload import shipped
from harness.model.errors import InputError, MissingPackage
from harness.model.library import library
from harness.model.method import Method
from harness.model.method_registry import listed_methods, load_method, prepared

FEW, MANY = {"count": 3, "friction": 0.25}, {"length": 8.0, "height": 3.0}
"""Bricks for every method; and more than the 200 blocks above which the quick one takes other loops too."""


def main() -> None:
    """Run every shipped method on a small wall and the quick one on a larger one; what could not be run is printed."""
    small, large = new_wall("stack", **FEW), new_wall("running-bond", **MANY)
    for name in shipped(listed_methods()):
        method = _ready(name)
        if method is not None:
            for wall in (small, large) if name == library().methods.quick else (small,):
                _run(method, wall)


def _ready(name: str) -> Method | None:
    """The method with all that it needs; None if that is not there. A package that an extra brings may be missing."""
    try:
        return prepared(load_method(name))
    except MissingPackage:
        return None
    except InputError as error:
        print(error, file=sys.stderr)
        return None


def _run(method: Method, wall: Wall) -> None:
    try:
        method.solve(wall.assembly, method.Settings())
    except MissingPackage:
        return
    except Exception as error:
        print(f"{method.name} cannot be prepared: {error}", file=sys.stderr)


if __name__ == "__main__":
    main()
