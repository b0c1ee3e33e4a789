"""A study as a file: cases or a wall, what varies over a grid, what is drawn at random, methods and settings."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from typing import Annotated, Any, Literal

import numpy as np
from pydantic import Discriminator, Field, StrictBool, Tag, model_validator

from harness.engine.run import LONGEST, MOST_MEMORY
from harness.model.fields import NO_TEXT, Strict
from harness.model.json_text import read_toml
from harness.model.reading import validate

MOST_RUNS = 1_000_000
"""Runs a study may expand to."""
Value = float | int | str | bool | list[Any] | dict[str, Any]


class Range(Strict):
    """Equally spaced values from one to another, both included; with `log` equally spaced by ratio."""

    start: float = Field(alias="from")
    stop: float = Field(alias="to")
    count: Annotated[int, Field(ge=1, le=MOST_RUNS), NO_TEXT]
    log: StrictBool = False

    @model_validator(mode="after")
    def _positive_logs(self) -> Range:
        if self.log and not (self.start > 0.0 and self.stop > 0.0):
            raise ValueError("a logarithmic range goes between positive values")
        return self

    def values(self) -> list[float]:
        """The values, without the noise of binary fractions."""
        space = np.geomspace if self.log else np.linspace
        return [float(f"{value:.12g}") for value in space(self.start, self.stop, self.count)]


class Whole(Strict):
    """Whole numbers from zero: seeds."""

    seeds: Annotated[int, Field(ge=1, le=MOST_RUNS), NO_TEXT]

    def values(self) -> list[int]:
        """0, 1, 2, ..."""
        return list(range(self.seeds))


def _axis_kind(value: Any) -> str:
    if isinstance(value, dict | Strict):
        return "(seeds)" if (value.get("seeds") if isinstance(value, dict) else isinstance(value, Whole)) else "(range)"
    return "(list)"


Axis = Annotated[
    Annotated[list[Value], Tag("(list)"), Field(min_length=1)]
    | Annotated[Range, Tag("(range)")]
    | Annotated[Whole, Tag("(seeds)")],
    Discriminator(_axis_kind),
]


class Distribution(Strict):
    """How a quantity scatters. `low` and `high` cut a normal or lognormal distribution off; a uniform one has both."""

    distribution: Literal["uniform", "normal", "lognormal", "triangular"]
    mean: float | None = None
    deviation: Annotated[float, Field(gt=0.0)] | None = Field(None, description="standard deviation, same unit")
    low: float | None = None
    high: float | None = None
    mode: float | None = None

    @model_validator(mode="after")
    def _complete(self) -> Distribution:
        needed = {
            "uniform": ("low", "high"),
            "normal": ("mean", "deviation"),
            "lognormal": ("mean", "deviation"),
            "triangular": ("low", "mode", "high"),
        }[self.distribution]
        missing = [name for name in needed if getattr(self, name) is None]
        if missing:
            raise ValueError(f"a {self.distribution} distribution needs {', '.join(missing)}")
        if self.low is not None and self.high is not None and not self.low < self.high:
            raise ValueError("low is less than high")
        if self.distribution == "lognormal" and not (self.mean or 0.0) > 0.0:
            raise ValueError("a lognormal distribution has a positive mean")
        return self


class _StudyLimits(Strict):
    """What one run may use."""

    seconds: Annotated[float, Field(gt=0.0, le=LONGEST)] = 120.0
    memory: Annotated[int, Field(ge=16, le=MOST_MEMORY, description="[MiB]"), NO_TEXT] = 4096


class Curve(Strict):
    """How a study is drawn in the report of a comparison."""

    across: Annotated[str, Field(min_length=1, description="quantity on the axis; means are over all others")]
    apart: str = Field("", description="quantity each of whose values has a line of its own; methods otherwise")
    labels: dict[str, str] = Field(default_factory=dict, description="names of these lines, by value")
    relative: StrictBool = Field(False, description="percent of change from the first value, instead of multipliers")
    level: float | None = Field(None, description="located on each line")
    x_label: str = ""
    read: str = Field("", description="how to read it")


class Study(Strict):
    """The content of a study file, TOML.

    Quantities are named by their path in the wall (`pattern.block_length`, `loads.live.body[0].per_weight`), by a short
    name (`friction`, `proportion`, `inset`, `direction`, `imperfection`, `seed`), or as a setting (`settings.de.seed`).
    """

    name: Annotated[str, Field(pattern=r"^[a-z0-9][a-z0-9-]*$")]
    title: Annotated[str, Field(min_length=1)]
    question: str = ""
    cases: list[str] = Field(default_factory=list, description="ids of cases, case folders or wall files")
    wall: dict[str, Any] | None = Field(None, description="a wall of the study's own, format wall/1")
    methods: Annotated[list[str], Field(min_length=1)]
    vary: dict[str, Axis] = Field(default_factory=dict, description="a grid: every value with every other")
    together: list[dict[str, Axis]] = Field(default_factory=list, description="axes of equal length that vary as one")
    draw: dict[str, Distribution] = Field(default_factory=dict, description="drawn at random, `samples` times")
    samples: Annotated[int, Field(ge=1, le=MOST_RUNS), NO_TEXT] = 100
    seed: Annotated[int, Field(ge=0, description="of the draws"), NO_TEXT] = 0
    settings: dict[str, dict[str, Any]] = Field(default_factory=dict, description="of methods, if not the defaults")
    neighbours: StrictBool = Field(
        False, description="runs use the mechanisms found on walls with the same joints, if the method supports it"
    )
    limits: _StudyLimits = Field(default_factory=_StudyLimits)
    multipliers: list[float] = Field(default_factory=list, description="for the probability of failure")
    curve: Curve | None = Field(None, description="how `drystone compare --study` draws it")

    @model_validator(mode="after")
    def _one_source(self) -> Study:
        if bool(self.cases) == (self.wall is not None):
            raise ValueError("a study names either cases or a wall of its own")
        for group in self.together:
            if len({_length_of(axis) for axis in group.values()}) != 1:
                raise ValueError(f"axes that vary together have equal length: {', '.join(group)}")
        names = [*self.vary, *self.draw, *(name for group in self.together for name in group)]
        twice = sorted(name for name, count in Counter(names).items() if count > 1)
        if twice:
            raise ValueError(f'"{twice[0]}" varies twice')
        return self

    def lengths(self) -> list[int]:
        """The number of values of each axis of the grid."""
        together = [_length_of(next(iter(group.values()))) for group in self.together]
        return [*map(_length_of, self.vary.values()), *together]

    def axes(self) -> Iterator[list[dict[str, Any]]]:
        """Each axis of the grid as a list of assignments, one of which holds at a time."""
        for name, axis in self.vary.items():
            yield [{name: value} for value in _values_of(axis)]
        for group in self.together:
            columns = [_values_of(axis) for axis in group.values()]
            yield [dict(zip(group, values, strict=True)) for values in zip(*columns, strict=True)]


def _length_of(axis: list[Any] | Range | Whole) -> int:
    """The number of values of an axis."""
    if isinstance(axis, Range):
        return axis.count
    return axis.seeds if isinstance(axis, Whole) else len(axis)


def _values_of(axis: list[Any] | Range | Whole) -> list[Any]:
    """The values of an axis in order."""
    return axis if isinstance(axis, list) else list(axis.values())


def read_study(path: Path) -> Study:
    """The study of a file.

    Raises:
        InputError: naming the file and the element.
    """
    return validate(Study, read_toml(path), str(path))
