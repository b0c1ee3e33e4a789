"""From a study to its runs: every wall with every assignment of the grid and every draw, by every method."""

from __future__ import annotations

import hashlib
import itertools
import json
import math
import pickle
from collections import OrderedDict
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np

from harness.engine.plan import check_methods, find_cases
from harness.engine.run import Limits, Run
from harness.engine.sweep.paths import setting_of, with_values
from harness.engine.sweep.study import MOST_RUNS, Distribution, Study
from harness.model.assembly import Assembly
from harness.model.build import Built, build
from harness.model.content import hash_of
from harness.model.errors import InputError, did_you_mean, without_numbers
from harness.model.load_cases import load_cases_of
from harness.model.method_registry import load_method
from harness.model.reading import parse_wall, validate, wall_json
from harness.model.wall import Wall

_MOST_DRAWN = 10_000_000
"""Values that a study draws: each takes some 100 bytes."""
_MOST_TOLD = 200
"""Characters of an error in which a wall of a study is named by its values."""


def _shown(count: int) -> str:
    """A count in words, rounded where it has more digits than a reader needs."""
    return f"{count:,}" if count < 10**12 else f"more than 10^{len(str(count)) - 1}"


@dataclass(frozen=True)
class WallSource:
    """A wall that a study starts from.

    Attributes:
        name: of its case and load case.
        data: as it is described, format wall/1.
        notes: what a person should hear about how it was found.
    """

    name: str
    data: Mapping[str, Any]
    notes: tuple[str, ...] = ()

    @property
    def warnings(self) -> tuple[str, ...]:
        """What a person should hear about the wall as it is described; where it cannot be built, its runs say why."""
        try:
            return (*self.notes, *build(parse_wall(dict(self.data), self.name), self.name).warnings)
        except InputError:  # what varies may mend it
            return self.notes


def warnings_of(sources: Iterable[WallSource], runs: Sequence[SweepRun]) -> dict[str, str]:
    """The warnings of the walls of a study as they are described and as they vary, with the name of the first each.

    Of sentences that differ in their numbers alone the first is given, with the number of other walls as they vary.
    """
    told: dict[str, str] = {}
    for source in sources:
        for sentence in source.warnings:
            told.setdefault(sentence, source.name)
    kinds = {without_numbers(sentence) for sentence in told}
    varied: dict[str, tuple[str, str, int]] = {}
    for variant in {run.variant.content: run.variant for run in runs}.values():
        for sentence in variant.doubts:
            kind = without_numbers(sentence)
            if kind not in kinds:
                first, name, count = varied.get(kind, (sentence, variant.called, 0))
                varied[kind] = (first, name, count + 1)
    for sentence, name, count in varied.values():
        told[f"{sentence} (and {count - 1:,} more walls)" if count > 1 else sentence] = name
    return told | _in_vain([run.variant for run in runs])


def _in_vain(variants: Iterable[_WallVariant]) -> dict[str, str]:
    """A sentence on each quantity that varies and that no block, joint or load depends on, with the name of the wall.

    Walls whose other quantities are equal tell; there is nothing to tell of those that cannot be built.
    """
    alike: dict[tuple[str, str], dict[str, dict[str, str]]] = {}
    for variant in {variant.content: variant for variant in variants}.values():
        try:
            numbers = pickle.dumps(replace(variant.assembly, name=""))
        except InputError:
            continue
        for name, value in variant.values.items():
            others = json.dumps([sorted((k, v) for k, v in variant.values.items() if k != name), variant.draw])
            walls = alike.setdefault((variant.id, name), {}).setdefault(others, {})
            walls[json.dumps(value)] = hashlib.sha256(numbers).hexdigest()
    return {
        f"{name} varies, and no block, joint or load depends on it: joints may have values of their own": wall
        for (wall, name), walls in alike.items()
        if max(map(len, walls.values())) > 1 and all(len(set(each.values())) == 1 for each in walls.values())
    }


@dataclass(frozen=True, eq=False)
class _WallVariant:
    """One wall of a study: where it comes from and what was changed.

    Attributes:
        source: the wall before.
        values: quantities of the wall by name.
        draw: number of the draw, or None.
        study: its name.
        walls: those of the study that are held in memory.
    """

    source: WallSource
    values: Mapping[str, Any]
    draw: int | None
    study: str
    walls: _Walls = field(repr=False)

    @property
    def id(self) -> str:
        """The name of the wall it comes from."""
        return self.source.name

    @property
    def data(self) -> dict[str, Any]:
        """The wall as data, format wall/1."""
        return with_values(self.source.data, self.values)

    @property
    def wall(self) -> Wall:
        """The wall.

        Raises:
            InputError: its data are no wall.
        """
        return parse_wall(self.data, f"study {self.study}, {self.called}")

    @property
    def called(self) -> str:
        """The name of the wall it comes from, with what was changed."""
        changed = ", ".join(f"{name} = {value}" for name, value in self.values.items())[:_MOST_TOLD]
        return f"{self.id} with {changed}"

    @cached_property
    def content(self) -> str:
        """Hash of what decides an answer about it; raises as `wall`."""
        return hash_of(self.wall)

    @property
    def assembly(self) -> Assembly:
        """Its numeric view.

        Raises:
            InputError: its data are no wall, or one that cannot be built.
        """
        return self.walls.built(self).assembly

    @property
    def doubts(self) -> tuple[str, ...]:
        """What a person should hear about it; none of one that cannot be built, of which its runs say why."""
        try:
            return self.walls.built(self).warnings
        except InputError:
            return ()

    @property
    def warnings(self) -> tuple[str, ...]:
        """None: `warnings_of` tells those of all walls once, not for each of thousands of runs."""
        return ()


class _Walls:
    """The walls of a study as they are built, the last few kept: runs on one wall follow each other."""

    def __init__(self, most: int = 64) -> None:
        self._most = most
        self._kept: OrderedDict[_WallVariant, Built] = OrderedDict()

    def built(self, variant: _WallVariant) -> Built:
        """A variant as it is built; raises as `WallVariant.assembly`."""
        found = self._kept.get(variant)
        if found is None:
            found = self._kept[variant] = build(variant.wall, variant.id)
            if len(self._kept) > self._most:
                self._kept.popitem(last=False)
        return found


@dataclass(frozen=True)
class SweepRun(Run):
    """A run with its place in a study.

    Attributes:
        number: its place.
        variant: the wall.
        varied: every quantity that the study varies and that this run depends on, by name.
    """

    case: _WallVariant
    number: int = field(kw_only=True)
    varied: Mapping[str, Any] = field(kw_only=True)

    @property
    def variant(self) -> _WallVariant:
        """The wall."""
        return self.case


def sources_of(study: Study, folders: Sequence[Path] = (), place: Path | None = None) -> list[WallSource]:
    """The walls a study starts from, one a load case; wall files are looked for beside the study's file.

    Raises:
        InputError: an unknown case, or a file that is no wall.
    """
    if study.wall is not None:
        wall = parse_wall({"format": "wall/1"} | study.wall, f"wall of study {study.name}")
        return [WallSource(study.name, json.loads(wall_json(wall)))]
    words = [str(place / word) if place is not None and (place / word).exists() else word for word in study.cases]
    cases = [each for case in find_cases(words, None, folders) for each in load_cases_of(case)]
    return [WallSource(case.id, json.loads(wall_json(case.wall)), case.notes) for case in cases]


def expand(study: Study, sources: Sequence[WallSource]) -> list[SweepRun]:
    """Every run of a study. The order depends on the study alone: cases, grid (last axis fastest), draws, methods.

    Raises:
        InputError: a method, a setting or a quantity that does not exist, a value it cannot have, or too many runs.
    """
    check_methods(study.methods, "methods")
    unknown = sorted(set(study.settings) - set(study.methods))
    if unknown:
        raise InputError(f'"{unknown[0]}" is no method of the study', "Name it in methods", "settings")
    samples = study.samples if study.draw else 1
    count = len(sources) * samples * len(study.methods) * math.prod(study.lengths())  # before any value is made
    if count > MOST_RUNS:
        raise InputError(f"it expands to {_shown(count)} runs", f"A study makes at most {MOST_RUNS:,}", study.name)
    if samples * len(study.draw) > _MOST_DRAWN:
        problem = f"{samples:,} samples of {len(study.draw):,} quantities are drawn"
        raise InputError(problem, f"A study draws at most {_MOST_DRAWN:,} values", study.name)
    axes, draws = list(study.axes()), _draws(study)
    limits = Limits(study.limits.seconds, study.limits.memory * 2**20)
    runs, walls = list[SweepRun](), _Walls()
    for source in sources:
        for assignment in itertools.product(*axes):
            grid = {name: value for part in assignment for name, value in part.items()}
            for draw, drawn in draws:
                runs += _runs(study, _WallVariant(source, {}, draw, study.name, walls), grid | drawn, limits, len(runs))
    _check(study, runs)
    return runs


def _runs(study: Study, wall: _WallVariant, values: dict[str, Any], limits: Limits, first: int) -> Iterator[SweepRun]:
    """The runs on one wall. A method whose settings vary is run for each of them, the others once."""
    settings = {name: where for name in values if (where := setting_of(name)) is not None}
    of_wall = {name: value for name, value in values.items() if name not in settings}
    variant = replace(wall, values=of_wall)
    number = first
    for method in study.methods:
        mine = {name: values[name] for name, (owner, _) in settings.items() if owner == method}
        chosen = dict(study.settings.get(method, {})) | {settings[name][1]: value for name, value in mine.items()}
        yield SweepRun(variant, method, chosen, limits, number=number, varied=of_wall | mine)
        number += 1


def _check(study: Study, runs: Sequence[SweepRun]) -> None:
    """Refuse walls and settings that cannot be, before anything is run; each distinct one is looked at once."""
    owners = {name: where[0] for group in study.axes() for name in group[0] if (where := setting_of(name)) is not None}
    for name, owner in owners.items():
        if owner not in study.methods:
            remedy = did_you_mean(owner, study.methods) or "Name it in methods"
            raise InputError(f'"{name}" is a setting of {owner}, which the study does not run', remedy)
    seen: set[str] = set()
    looked_at: _WallVariant | None = None
    classes = {name: load_method(name).Settings for name in study.methods if _has_settings(study, name, owners)}
    for run in runs:
        if run.method in classes:
            text = json.dumps([run.method, dict(run.settings)], sort_keys=True)
            if text not in seen:
                validate(classes[run.method], dict(run.settings), f"settings of {run.method}")
                seen.add(text)
        if run.variant is not looked_at:
            looked_at = run.variant
            _ = run.variant.content


def _has_settings(study: Study, method: str, owners: Mapping[str, str]) -> bool:
    return method in study.settings or method in owners.values()


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
