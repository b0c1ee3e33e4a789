"""Compile the kernels of every shipped method: `python -m harness.kernels`, which `make` runs when it installs."""

from __future__ import annotations

import importlib
import sys

from harness.conformance import CLOSED_FORMS, assembly_of
from harness.engine.preload import shipped
from harness.model.method import load_method, method_names

LEFT_TO_NUMBA = "the kernels are left to numba, which takes half a second longer to load them"


def main() -> None:
    """Run every shipped method on two small walls, which compiles what it uses, and build the library of all that.

    Print what could not be run, and why no library could be built where that is so: methods work without.
    """
    for name in shipped(method_names()):
        try:
            method = load_method(name)
            for form in CLOSED_FORMS[-2:]:
                method.solve(assembly_of(form.wall, form.name), method.Settings())
        except Exception as error:
            print(f"{name} cannot be prepared: {error}", file=sys.stderr)
    jit = sys.modules.get("methods.numerics.jit")
    if jit is None or not jit.KERNELS:
        return  # the library is there
    try:
        ahead = importlib.import_module("methods.numerics.ahead")
    except ImportError as error:  # no setuptools, or a numba without its compiler of extension modules
        print(f"{LEFT_TO_NUMBA}: {error}", file=sys.stderr)
        return
    try:
        ahead.build(jit.KERNELS)
    except ahead.CannotBuild as error:
        print(f"{LEFT_TO_NUMBA}: {error}", file=sys.stderr)


if __name__ == "__main__":
    main()
