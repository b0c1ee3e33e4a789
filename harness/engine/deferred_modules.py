"""Modules that are imported by name only, loaded when something in them is used (`importlib.util.LazyLoader`).

SciPy takes over every public name of NumPy, and so imports its Fortran interface and its test tools, which no run uses:
a quarter of the time that `scipy.sparse` takes to load (75 of 310 ms CPU).
"""

from __future__ import annotations

import importlib.util
import sys

UNUSED = ("numpy.f2py", "numpy.testing")
"""Parts of NumPy that SciPy imports and no run uses."""


def defer(names: tuple[str, ...] = UNUSED) -> None:
    """Put modules that are not loaded yet in place, to be loaded at the first use of what is in them."""
    for name in names:
        if name in sys.modules:
            continue
        spec = importlib.util.find_spec(name)
        if spec is None or spec.loader is None:
            continue
        spec.loader = importlib.util.LazyLoader(spec.loader)
        module = importlib.util.module_from_spec(spec)
        sys.modules[name] = module
        spec.loader.exec_module(module)
        parent, _, own = name.rpartition(".")
        setattr(sys.modules[parent], own, module)
