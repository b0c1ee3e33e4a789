"""Facts about a run, taken when it is made: versions, commit, machine; and the hash that stands for the code."""

from __future__ import annotations

import functools
import hashlib
import importlib.util
import os
import platform
import re
import subprocess
from collections.abc import Iterable, Sequence
from contextlib import suppress
from importlib.metadata import EntryPoint, PackageNotFoundError, version
from pathlib import Path
from typing import Any

from harness.model.foreign.register import program_named
from harness.model.method import method_points

_PACKAGES = (
    "drystone",
    "numpy",
    "scipy",
    "cvxpy-base",
    "clarabel",
    "osqp",
    "highspy",
    "ipyopt",
    "mujoco",
    "numba",
    "pymunk",
    "shapely",
    "pydantic",
)
"""Packages of which an answer of any of Drystone's own methods may be made."""
_REQUIREMENT = re.compile(r"""([\w.-]+)(?:.*extra == ["']([\w-]+)["'])?""")
"""The package of a requirement in the metadata of a distribution, and the extra that it belongs to."""


@functools.cache
def versions() -> dict[str, str]:
    """Versions of Python, of the packages that compute, and the commit where the code is a checkout."""
    found = {"python": platform.python_version()} | _installed(_PACKAGES)
    commit = _commit()
    if commit:
        found["commit"] = commit
    return found


def _commit() -> str:
    folder = Path(__file__).resolve().parents[2]
    if not (folder / ".git").exists():
        return ""
    try:
        words = ["git", "-C", str(folder), "describe", "--always", "--exclude=*", "--abbrev=12", "--dirty=-modified"]
        return subprocess.run(words, capture_output=True, text=True, timeout=10, check=True).stdout.strip()
    except (OSError, subprocess.SubprocessError):
        return ""


@functools.cache
def machine() -> dict[str, Any]:
    """Processor, cores, memory and system; nothing that names the machine or its owner."""
    processor = platform.processor() or platform.machine()
    try:
        for line in Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines():
            if line.startswith("model name"):
                processor = line.split(":", 1)[1].strip()
                break
    except OSError:
        pass
    return {
        "processor": processor,
        "cores": os.cpu_count() or 1,
        "memory_bytes": os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES"),
        "system": f"{platform.system()} {platform.release()}",
    }


@functools.cache
def code_version(method: str) -> str:
    """Hash over the sources a method's answer depends on: its own package and the model, and the packages beneath.

    Of a program they are the files that its command names. Versions of what else its distribution requires stand for
    what is no source in Python.

    Raises:
        KeyError: no method has this name.
    """
    points = [point for point in method_points() if point.name == method]
    program = program_named(method)
    if program is not None:
        return _sources_version("harness.model", others=[program.version])
    if not points:
        raise KeyError(method)
    packages = sorted({*(point.module.split(".")[0] for point in points), "harness.model"})
    used = {name: number for name, number in versions().items() if name not in ("commit", "drystone")}
    for point in points:
        used |= brought_with(point)
    others = [f"{name}={number}" for name, number in sorted(used.items())]
    return _sources_version(*packages, others=others)


def brought_with(point: EntryPoint) -> dict[str, str]:
    """Versions of the distribution that brings a method, and of what it requires for it.

    Of Drystone they are the packages of an extra that is named in the method, as `paper` in `la-paper`.
    """
    brings = point.dist
    if brings is None:
        return {}
    required = [(found[1], found[2]) for text in brings.requires or () if (found := _REQUIREMENT.match(text))]
    if brings.name == "drystone":
        return _installed(package for package, extra in required if extra in point.name.split("-"))
    return _installed(package for package, _ in required) | {brings.name: brings.version}


def _installed(packages: Iterable[str]) -> dict[str, str]:
    """Versions of those packages that are installed."""
    found = {}
    for package in packages:
        with suppress(PackageNotFoundError):
            found[package] = version(package)
    return found


def _sources_version(*packages: str, others: Sequence[str] = ()) -> str:
    """Hash over the sources of packages or modules, and over other texts that stand for code."""
    digest = hashlib.sha256()
    for package in packages:
        for path in _sources(package):
            digest.update(path.name.encode())
            digest.update(path.read_bytes())
    for text in others:
        digest.update(text.encode())
    return digest.hexdigest()[:16]


JUDGE = tuple(
    f"harness.engine.{name}"
    for name in (
        *("judge", "judge_dead_load", "judge_decision", "judge_law"),
        *("bar_checks", "brittle_checks", "crushing", "live_work", "measured_motion", "measures", "residuals"),
        *("motion_judge", "reaction_judge", "settled_judge"),
    )
)
"""The modules that judge, besides `harness.model`."""


@functools.cache
def judge_version() -> str:
    """Hash over the sources of the judge, for results that are kept with its word."""
    return _sources_version(*JUDGE)


def _sources(package: str) -> list[Path]:
    spec = importlib.util.find_spec(package)
    if spec is None:
        return []
    if spec.submodule_search_locations:
        return sorted(path for root in spec.submodule_search_locations for path in Path(root).rglob("*.py"))
    return [Path(spec.origin)] if spec.origin else []
