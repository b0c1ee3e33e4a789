"""The library of kernels that `python -m harness.kernels` builds: found, held to its sources, loaded without numba.

It lies where Python keeps compiled modules, with a list of what it was made of. Other sources, another numba or another
processor make it void: numba compiles the kernels then, as it does where none was built.
"""

from __future__ import annotations

import hashlib
import json
import sys
from collections.abc import Callable
from functools import cache
from importlib import metadata, util
from pathlib import Path
from types import ModuleType
from typing import Any

from numpy._core._multiarray_umath import __cpu_features__  # type: ignore[import-not-found]

NAME = "drystone_kernels"
"""Of the library as a module."""
ROOT = Path(__file__).parents[2]
FOLDER = Path(__file__).parent / "__pycache__"
LIST = FOLDER / f"{NAME}.{sys.implementation.cache_tag}.json"


def holds(function: Callable[..., Any]) -> bool:
    """Whether the library was built of the module of a function."""
    return function.__module__ in _made_of()


def entry(function: Callable[..., Any]) -> Callable[[tuple[Any, ...]], Any] | None:
    """What runs a function with a tuple of arguments; None if the library has only what is called inside others.

    It raises TypeError, before it begins, for arrays that differ in kind, dimensions or layout from those it is for.
    """
    return getattr(_library(), symbol(function), None)


def symbol(function: Callable[..., Any]) -> str:
    """Name of a function in the library."""
    return f"{function.__module__}.{function.__qualname__}".replace(".", "__")


def conditions() -> dict[str, str]:
    """What a library is good for besides its sources: the version of numba and the abilities of the processor."""
    abilities = ",".join(name for name, there in sorted(__cpu_features__.items()) if there)
    return {"numba": metadata.version("numba"), "processor": abilities}


def digest(module: str) -> str:
    """Hash of the source of a module."""
    return hashlib.sha256((ROOT / (module.replace(".", "/") + ".py")).read_bytes()).hexdigest()


@cache
def _made_of() -> frozenset[str]:
    """Modules that the library was built of; none if there is no library, or one of something else."""
    return frozenset() if _library() is None else frozenset(json.loads(LIST.read_text(encoding="utf-8"))["sources"])


@cache
def _library() -> ModuleType | None:
    try:
        told: dict[str, Any] = json.loads(LIST.read_text(encoding="utf-8"))
        if told["conditions"] != conditions() or any(digest(name) != told["sources"][name] for name in told["sources"]):
            return None
        spec = util.spec_from_file_location(NAME, FOLDER / told["file"])
        if spec is None or spec.loader is None:
            return None
        module = util.module_from_spec(spec)
        spec.loader.exec_module(module)
    except (OSError, ValueError, KeyError, ImportError):
        return None
    return module
