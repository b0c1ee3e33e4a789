"""From a study to its runs: every wall with every assignment of the grid and every draw, by every method."""

from __future__ import annotations

import hashlib
import itertools
import json
from collections import OrderedDict
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np

from harness.engine.plan import check_methods, find_cases
from harness.engine.provenance import code_version, judge_version, run_key
from harness.engine.run import Limits
from harness.engine.sweep.paths import setting_of, with_values
from harness.engine.sweep.study import MOST_RUNS, Distribution, Study
from harness.engine.worker import Task
from harness.model.assembly import Assembly, FloatArray
from harness.model.build import build
from harness.model.errors import InputError
from harness.model.method import load_method
from harness.model.reading import parse_wall, validate, wall_json

KEPT_WALLS = 64
"""Walls of a study that are held in memory: runs on one wall follow each other."""


@dataclass(frozen=True)
class Source:
    """A wall that a study starts from."""

    name: str
    data: Mapping[str, Any]


@dataclass(frozen=True)
class Variant:
    """One wall of a study: where it comes from and what was changed.

    Attributes:
        source: the wall before.
        values: quantities of the wall by name.
        draw: number of the draw, or None.
    """

    source: Source
    values: Mapping[str, Any]
    draw: int | None

    @property
    def data(self) -> dict[str, Any]:
        """The wall as data, format wall/1."""
        return with_values(self.source.data, self.values)


@dataclass(frozen=True, eq=False)
class Motion:
    """How the joints of a neighbouring wall move in the mechanism that was found there.

    Attributes:
        found_by: key of the run that found it.
        joints: (m, 3) openings at both ends and slip.
    """

    found_by: str
    joints: FloatArray

    @cached_property
    def key(self) -> str:
        """Content hash of the motion."""
        return hashlib.sha256(np.ascontiguousarray(self.joints).tobytes()).hexdigest()[:16]


@dataclass(frozen=True)
class SweepRun:
    """One run of a study.

    Attributes:
        number: its place in the study.
        variant: the wall.
        method, settings: what is asked.
        varied: every quantity that the study varies and that this run depends on, by name.
        limits: of the run.
        given: motions found on neighbouring walls, which it takes up in place of a search of its own.
    """

    number: int
    variant: Variant
    method: str
    settings: Mapping[str, Any]
    varied: Mapping[str, Any]
    limits: Limits
    given: tuple[Motion, ...] = ()

    @cached_property
    def key(self) -> str:
        """Content hash: wall, method, settings, limits, motions, and the code that expands, solves and judges it."""
        text = json.dumps(self.variant.data, sort_keys=True, allow_nan=False)
        code = f"{code_version(self.method)}-{judge_version()}"
        return run_key(
            text, self.method, dict(self.settings), self.limits.as_dict(), code, *(item.key for item in self.given)
        )

    def task(self, assembly: Assembly) -> Task:
        """What a child process is given."""
        motions = tuple(item.joints for item in self.given)
        return Task(self.method, assembly, dict(self.settings), self.limits.seconds, self.limits.memory_bytes, motions)


class Walls:
    """Assemblies of variants, the last few kept."""

    def __init__(self) -> None:
        self._kept: OrderedDict[int, tuple[Variant, Assembly]] = OrderedDict()

    def assembly(self, variant: Variant) -> Assembly:
        """The assembly of a variant.

        Raises:
            InputError: its data are no wall.
        """
        found = self._kept.get(id(variant))
        if found is None:
            name = variant.source.name
            found = variant, build(parse_wall(variant.data, name), name).assembly
            self._kept[id(variant)] = found
            if len(self._kept) > KEPT_WALLS:
                self._kept.popitem(last=False)
        return found[1]


def sources_of(study: Study, folders: Sequence[Path] = (), place: Path | None = None) -> list[Source]:
    """The walls a study starts from; wall files are looked for beside the study's file.

    Raises:
        InputError: an unknown case, or a file that is no wall.
    """
    if study.wall is not None:
        wall = parse_wall({"format": "wall/1"} | study.wall, f"wall of study {study.name}")
        return [Source(study.name, json.loads(wall_json(wall)))]
    words = [str(place / word) if place is not None and (place / word).exists() else word for word in study.cases]
    return [Source(case.id, json.loads(wall_json(case.wall))) for case in find_cases(words, None, folders)]


def expand(study: Study, sources: Sequence[Source]) -> list[SweepRun]:
    """Every run of a study. The order depends on the study alone: cases, grid (last axis fastest), draws, methods.

    Raises:
        InputError: a method, a setting or a quantity that does not exist, a value it cannot have, or too many runs.
    """
    check_methods(study.methods, "methods")
    unknown = sorted(set(study.settings) - set(study.methods))
    if unknown:
        raise InputError(f'"{unknown[0]}" is no method of the study', "Name it in methods", "settings")
    axes = list(study.axes())
    draws = _draws(study)
    count = len(sources) * len(draws) * len(study.methods) * int(np.prod([len(axis) for axis in axes], dtype=float))
    if count > MOST_RUNS:
        raise InputError(f"it expands to {count:,} runs", f"A study makes at most {MOST_RUNS:,}", study.name)
    limits = Limits(study.limits.seconds, study.limits.memory * 2**20)
    runs: list[SweepRun] = []
    for source in sources:
        for assignment in itertools.product(*axes):
            grid = {name: value for part in assignment for name, value in part.items()}
            for draw, drawn in draws:
                runs += _runs(study, source, grid | drawn, draw, limits, len(runs))
    _check(study, runs)
    return runs


def _runs(
    study: Study, source: Source, values: dict[str, Any], draw: int | None, limits: Limits, first: int
) -> Iterator[SweepRun]:
    """The runs on one wall. A method whose settings vary is run for each of them, the others once."""
    settings = {name: where for name in values if (where := setting_of(name)) is not None}
    of_wall = {name: value for name, value in values.items() if name not in settings}
    variant = Variant(source, of_wall, draw)
    number = first
    for method in study.methods:
        mine = {name: values[name] for name, (owner, _) in settings.items() if owner == method}
        chosen = dict(study.settings.get(method, {})) | {settings[name][1]: value for name, value in mine.items()}
        yield SweepRun(number, variant, method, chosen, of_wall | mine, limits)
        number += 1


def _check(study: Study, runs: Sequence[SweepRun]) -> None:
    """Refuse walls and settings that cannot be, before anything is run; each distinct one is looked at once."""
    owners = {name: where[0] for group in study.axes() for name in group[0] if (where := setting_of(name)) is not None}
    for name, owner in owners.items():
        if owner not in study.methods:
            raise InputError(f'"{name}" is a setting of {owner}, which the study does not run', "Name it in methods")
    seen: set[str] = set()
    looked_at: Variant | None = None
    classes = {name: load_method(name).Settings for name in study.methods if _has_settings(study, name, owners)}
    for run in runs:
        if run.method in classes:
            text = json.dumps([run.method, dict(run.settings)], sort_keys=True)
            if text not in seen:
                validate(classes[run.method], dict(run.settings), f"settings of {run.method}")
                seen.add(text)
        if run.variant is not looked_at:
            parse_wall(run.variant.data, f"study {study.name}, {_said(run.variant)}")
            looked_at = run.variant


def _has_settings(study: Study, method: str, owners: Mapping[str, str]) -> bool:
    return method in study.settings or method in owners.values()


def _said(variant: Variant) -> str:
    return f"{variant.source.name} with {', '.join(f'{name} = {value}' for name, value in variant.values.items())}"


def _draws(study: Study) -> list[tuple[int | None, dict[str, float]]]:
    """Values of the quantities drawn, a Latin hypercube of so many samples (McKay, Beckman and Conover 1979)."""
    if not study.draw:
        return [(None, {})]
    from scipy.stats import qmc

    unit = qmc.LatinHypercube(d=len(study.draw), rng=study.seed).random(study.samples)
    columns = [_quantile(item, unit[:, k]) for k, item in enumerate(study.draw.values())]
    return [
        (number, {name: float(f"{column[number]:.12g}") for name, column in zip(study.draw, columns, strict=True)})
        for number in range(study.samples)
    ]


def _quantile(item: Distribution, share: np.ndarray[Any, np.dtype[np.float64]]) -> Any:
    """Values of a distribution, cut off at `low` and `high`, at shares of its probability."""
    from scipy import stats

    low = -np.inf if item.low is None else item.low
    high = np.inf if item.high is None else item.high
    if item.distribution == "uniform":
        return low + share * (high - low)
    if item.distribution == "triangular":
        assert item.mode is not None
        return stats.triang((item.mode - low) / (high - low), loc=low, scale=high - low).ppf(share)
    assert item.mean is not None
    assert item.deviation is not None
    if item.distribution == "normal":
        whole = stats.norm(item.mean, item.deviation)
    else:
        variance = np.log1p((item.deviation / item.mean) ** 2)
        whole = stats.lognorm(np.sqrt(variance), scale=item.mean / np.exp(0.5 * variance))
    below, above = whole.cdf(low), whole.cdf(high)
    return whole.ppf(below + share * (above - below))
