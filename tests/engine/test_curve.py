"""The curve of a study: means over seeds, where they pass a level, runs without an answer."""

from __future__ import annotations

from typing import Any

import pytest

from harness.engine.sweep.curve import curve_of
from harness.engine.sweep.study import Curve, Study, read_study
from harness.model.errors import InputError
from harness.studying import shipped_studies


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
    assert "−20 % at about 0.050" in curve["sentence"]
    assert beds["y"] == pytest.approx([0.0, -10.0])
    assert "nowhere up to that (1 without an answer)" in curve["sentence"]


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
