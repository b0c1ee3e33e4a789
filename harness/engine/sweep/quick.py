"""A study without a file: what varies on one wall, in a few words of the command line."""

from __future__ import annotations

import contextlib
import json
import math
import re
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from harness.engine.run import Limits
from harness.engine.sweep.paths import setting_of
from harness.engine.sweep.study import Range, Study
from harness.model.errors import InputError
from harness.model.library import library
from harness.model.reading import validate

_LIKE_A_RANGE = re.compile(r"\s*(\d*\.?\d+)\s*(?:-|\.\.\.?|–|to)\s*(\d*\.?\d+)\s*")
"""Two numbers with a sign between them that people write for a range."""
_LONGEST = 100
"""Characters of a word that a sentence repeats."""
_SIZES = 6
"""Sizes of defects in a range that does not say how many."""


def quick_study(
    what: str,
    methods: Sequence[str] | None,
    settings: dict[str, dict[str, Any]],
    limits: Limits,
    multipliers: list[float],
    *,
    vary: Sequence[str] = (),
    imperfection: str = "",
    seeds: int | None = None,
) -> Study:
    """The study that the words of a command line mean.

    Args:
        what: a case or a wall file.
        methods: names, or None for those of the library; with imperfections for the one whose setting they are.
        settings: of methods.
        limits: of each run.
        multipliers: for the probability of failure.
        vary: "NAME=FROM:TO:COUNT" or "NAME=A,B,C", where vectors stand in brackets: "NAME=[1,0],[0,1]".
        imperfection: "FROM:TO", "FROM:TO:COUNT" or "A,B,C".
        seeds: of the imperfections, from 0.

    Raises:
        InputError: words that mean nothing.
    """
    axes: dict[str, Any] = {}
    for words in vary:
        name, equals, values = words.partition("=")
        if not equals or not values:
            raise InputError(f'"{words}" varies nothing', "Give NAME=FROM:TO:COUNT or NAME=A,B,C", "--vary")
        if name in axes:
            raise InputError(f'"{name[:_LONGEST]}" varies twice', "Give all of its values at once", "--vary")
        axes[name] = axis_of(values, f"--vary {name}", None)
    if imperfection:
        axes["imperfection"] = axis_of(imperfection, "--imperfection", _SIZES)
    if seeds is not None:
        axes["seed"] = {"seeds": seeds}
    return varied(what, axes, methods, settings, limits, multipliers)


def varied(
    what: str,
    axes: dict[str, Any],
    methods: Sequence[str] | None,
    settings: dict[str, dict[str, Any]],
    limits: Limits,
    multipliers: list[float],
) -> Study:
    """The study of one case over a grid, named by both; methods as of `quick_study`.

    Raises:
        InputError: an axis that is none.
    """
    uneven = "imperfection" in axes or "seed" in axes
    stem = re.sub(r"[^a-z0-9]+", "-", Path(what).stem.lower()).strip("-") or "wall"
    data = {
        "name": f"{stem}-{'-'.join(re.sub('[^a-z0-9]+', '-', name.lower()).strip('-') for name in axes)}",
        "title": f"{Path(what).stem} over {', '.join(axes)}",
        "cases": [what],
        "methods": list(methods or (_whose("imperfection") if uneven else library().methods.sweep)),
        "vary": axes,
        "settings": settings,
        "multipliers": multipliers,
        "limits": {"seconds": limits.seconds, "memory": limits.memory_bytes // 2**20},
    }
    return validate(Study, data, "sweep")


def _whose(name: str) -> list[str]:
    """The method that a short name of a setting belongs to."""
    found = setting_of(name)
    return [] if found is None else [found[0]]


def axis_of(words: str, element: str, count: int | None) -> Any:
    """The values that "FROM:TO:COUNT" or "A,B,C" mean, vectors in brackets; `count` where FROM:TO says none.

    Raises:
        InputError: words that are neither.
    """
    with contextlib.suppress(ValueError, RecursionError):
        return json.loads(f"[{words}]")
    parts = words.split(":")
    if ends := _LIKE_A_RANGE.fullmatch(words):
        low, high = ends.groups()
        problem = f'"{words}" is no value'
        raise InputError(problem, f"Write a range as FROM:TO:COUNT, for example {low}:{high}:7", element)
    if len(parts) == 1:
        return [_value(word) for word in words.split(",")]
    try:
        number = int(parts[2]) if len(parts) == 3 else count
        if number is None or len(parts) > 3:
            raise ValueError
        start, stop = float(parts[0]), float(parts[1])
    except ValueError:
        raise InputError(f'"{words}" is no range', "Give FROM:TO:COUNT or A,B,C", element) from None
    return validate(Range, {"from": start, "to": stop, "count": number}, element).model_dump(by_alias=True)


def _value(word: str) -> Any:
    try:
        return json.loads(word)
    except (ValueError, RecursionError):  # .5 is no number of JSON
        with contextlib.suppress(ValueError):
            if math.isfinite(number := float(word)):
                return number
        return word
