"""The curve of a study: means over seeds, where they pass a level, runs without an answer."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from types import SimpleNamespace
from typing import Any

import pytest

from drystone.cli.studies import Amount, amount_of, in_time
from drystone.studies import shipped_studies
from harness.engine.sweep.curve import curve_of
from harness.engine.sweep.study import Curve, Study, read_study
from harness.model.errors import InputError


def rows(faces: str, found: dict[float, list[float | None]]) -> list[dict[str, Any]]:
    return [
        {"settings.x.faces": faces, "size": size, "multiplier": value, "judge_accepted": None, "method": "x"}
        for size, values in found.items()
        for value in values
    ]


def study(**curve: Any) -> Study:
    asked = Curve(across="size", apart="settings.x.faces", labels={"both": "all faces"}, **curve)
    return Study(name="s", title="t", cases=["wall-21"], methods=["x"], curve=asked)


def test_curve_interpolates_where_the_mean_passes_the_level_and_counts_lost_runs():
    found = rows("both", {0.0: [1.0], 0.1: [0.7, 0.5]}) + rows("beds", {0.0: [1.0], 0.1: [0.9, None]})
    curve = curve_of(study(relative=True, level=-20.0), found)
    both, beds = curve["series"]
    assert (both["name"], beds["name"]) == ("all faces", "beds")
    assert both["y"] == pytest.approx([0.0, -40.0])
    assert (both["low"][1], both["high"][1]) == pytest.approx((-50.0, -30.0))
    # Mean -40 and standard error 10: the level is passed where -50 x / 0.1 to -30 x / 0.1 is -20.
    assert (
        "all faces: −40 ± 10 % at 0.1 (mean of 2 walls with its standard error; single walls −50 to −30 %)"
        in (curve["sentence"])
    )
    assert "−20 % between 0.04 and 0.067" in curve["sentence"]
    assert beds["y"] == pytest.approx([0.0, -10.0])
    assert "beds: −10 % at 0.1 (one wall, scatter unknown), −20 % nowhere up to 0.1" in curve["sentence"]
    assert "1 wall gave no answer and is in no mean drawn" in curve["sentence"]


def test_walls_that_fall_unloaded_are_told_apart_from_those_without_an_answer():
    found = rows("both", {0.0: [1.0, 1.0], 0.1: [0.7, 0.72, None]})
    found[-1]["finding"] = "falls"
    sentence = curve_of(study(), found)["sentence"]
    assert "all faces: 0.71 ± 0.01 at 0.1" in sentence
    assert "1 wall fell under the dead load and is in no mean drawn" in sentence


def test_what_the_judge_rejects_is_lost():
    found = rows("both", {0.0: [1.0], 0.1: [0.7]})
    found[1]["judge_accepted"] = False
    (line,) = curve_of(study(), found)["series"]
    assert line["x"] == [0.0]


def test_a_study_without_a_curve_is_refused():
    plain = Study(name="s", title="t", cases=["wall-21"], methods=["x"])
    with pytest.raises(InputError, match="says nothing of a curve"):
        curve_of(plain, [])


def test_curves_of_shipped_studies_name_what_varies():
    drawn = [read for path in shipped_studies().values() if (read := read_study(path)).curve is not None]
    assert drawn
    for read in drawn:
        assert read.curve is not None
        assert {read.curve.across, read.curve.apart} - {""} <= set(read.vary)


@dataclass
class Made:
    """Runs of a study with seeds, each of which takes as long as its seed says."""

    seconds: list[float]
    asked: list[int] = field(default_factory=list)

    @property
    def runs(self) -> Any:
        return [SimpleNamespace(varied={"seed": seed}) for _ in range(2) for seed in range(len(self.seconds))]

    def make(self, some: Sequence[Any]) -> list[dict[str, Any]]:
        self.asked += [run.varied["seed"] for run in some]
        return [{"wall_seconds": self.seconds[run.varied["seed"]]} for run in some]


def test_a_study_takes_as_many_seeds_as_fit_in_the_time_and_never_one_alone():
    walls = Made([1.0] * 6)
    rows = in_time(walls.runs, walls.make, seconds=7.0, least=2)
    assert (len(rows), walls.asked) == (6, [0, 0, 1, 1, 2, 2])
    slow = Made([50.0] * 6)
    assert len(in_time(slow.runs, slow.make, seconds=7.0, least=2)) == 4


def test_amounts_of_a_study():
    assert (amount_of(""), amount_of("12"), amount_of("60s")) == (Amount(), Amount(seeds=12), Amount(seconds=60.0))
    for words in ("s", "0", "-3", "1.5", "60m"):
        with pytest.raises(InputError, match="is no amount"):
            amount_of(words)
