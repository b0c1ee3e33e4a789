"""The first screen and the overview against changed data: each sentence and each mark says what the results say."""

from __future__ import annotations

import re
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

import drystone
from harness.model.comparison import CaseResults, Certified, ComparisonRun
from harness.model.live_load import both_signs, with_live_load
from harness.model.load_cases import load_cases_of
from harness.model.method import Finding, Status
from harness.model.result import Result
from reports.charts import curves, dots
from reports.charts.overview import overview_plot, wall_plot
from reports.drawing.display_list import Text
from reports.drawing.force_drawing import force_drawing
from reports.findings.agreement import agreement
from reports.labels import numbers
from reports.page.glance import glance, headline, largest_walls, mechanisms_compared, pictures
from reports.page.governing import governing
from reports.page.summary import summary
from tests.reports import samples
from tests.walls import stack, wall_data

CASE = samples.bond("wall-21")


def measured(low: float, high: float, **more: Any) -> Result:
    return samples.solved(CASE, "de", 0.5 * (low + high), bracket=(low, high), flow="approximate", **more)


def run_of(*items: CaseResults) -> ComparisonRun:
    return ComparisonRun("suite", "drystone compare mine.json", "", list(items))


def test_the_headline_says_what_was_compared():
    walls = [CaseResults(samples.bond(f"wall-{n}"), [samples.solved(CASE, "la", 0.5)]) for n in range(3)]
    walls[0].results.append(samples.solved(CASE, "fe", 0.5))
    assert headline(run_of(*walls)) == "Finite elements and limit analysis on 3 walls"
    assert headline(run_of(*walls[1:])) == "Limit analysis on 2 walls"
    assert headline(run_of(walls[0])) == "A small wall"


def test_the_headline_of_load_cases_is_the_title_of_their_wall():
    loads = {"live": {"body": [{"per_weight": [1, 0]}]}}
    title, named = "A pier, load case by load case", {"wind": loads, "quake": loads}
    data = wall_data(stack(2), 0.5, title=title, loads={}, load_cases=named)
    wall = drystone.build_wall(data, "pier")
    chosen = load_cases_of(wall.case)
    assert headline(run_of(*(CaseResults(each, []) for each in chosen))) == title
    both = [each for one in chosen for each in both_signs(one)]
    assert headline(run_of(*(CaseResults(each, []) for each in both))) == title
    assert headline(run_of(CaseResults(chosen[1], []))) == f"{title}, load case quake"
    ways = [CaseResults(each, []) for each in both_signs(samples.bond("mine"))]
    assert headline(run_of(*ways)) == "A small wall"


def test_the_most_similar_mechanisms_are_named_with_their_cosine_and_the_least_state_by_its_gap():
    fe, la, de = samples.solved(CASE, "fe", 0.56), samples.solved(CASE, "la", 0.55, turn=0.9), measured(0.56, 0.57)
    item = CaseResults(CASE, [fe, la, de])
    far = agreement(CASE.assembly, fe, la).cosine
    assert far is not None
    told = mechanisms_compared(item)
    assert told.startswith("FE and DE find the same mechanism (cosine 1.0000). LA finds another mechanism")
    assert f"(cosine {np.floor(1e4 * far) / 1e4:.4f}, other motion at 11 joints), 0.010 lower (least known)." in told
    assert told.endswith("In the paper the mechanisms of the three methods agree closely.")
    proved = replace(item, certified=Certified(0.55, "", ""))
    assert "0.010 lower (minimum, proved)." in mechanisms_compared(proved)
    above = replace(item, results=[fe, la.model_copy(update={"multiplier": 0.58}), de])
    assert "lower" not in mechanisms_compared(above)
    near = replace(item, results=[fe, la, measured(0.56, 0.57, turn=0.3)])
    assert "FE and DE find the most similar mechanisms (cosine 0.9" in mechanisms_compared(near)
    same = replace(item, results=[fe, samples.solved(CASE, "la", 0.55), de])
    assert mechanisms_compared(same).startswith("FE, LA and DE find the same mechanism.")
    other = samples.bond("other")
    assert "paper" not in mechanisms_compared(CaseResults(other, [fe, la]))


def test_a_measured_field_that_scatters_has_the_same_mechanism_and_one_block_of_many_that_moves_otherwise_not():
    """The cosine is .9998 where the mechanism is the same, and rounds to 1 where it is not."""
    fe, la = samples.solved(CASE, "fe", 0.56), samples.solved(CASE, "la", 0.56)
    scattered = measured(0.56, 0.57, turn=0.12)
    assert 0.999 < (agreement(CASE.assembly, fe, scattered).cosine or 0.0) < 0.9999
    assert mechanisms_compared(CaseResults(CASE, [fe, la, scattered])).startswith("FE, LA and DE find the same mech")
    large = samples.bond("large", courses=12, bricks=12)
    slides, other = samples.solved(large, "fe", 0.56), samples.solved(large, "la", 0.55)
    assert other.mechanism is not None
    other.mechanism[-1] = (1.0, 0.0, 0.02)
    assert (agreement(large.assembly, slides, other).cosine or 0.0) > 0.99999
    told = mechanisms_compared(CaseResults(large, [slides, other]))
    assert told == "FE and LA find the most similar mechanisms (cosine 0.9999)."


def test_pictures_of_one_wall_have_one_scale():
    item = CaseResults(CASE, [samples.solved(CASE, "fe", 0.56), samples.solved(CASE, "la", 0.55, turn=9.0)])
    drawn = pictures(item)
    assert [picture.method for picture in drawn] == ["fe", "la"]
    shifts = [
        max(float(x) for x in re.findall(r'transform="matrix\(1 \S+ \S+ 1 (-?\d+) ', str(picture.drawing)) or ["0"])
        for picture in drawn
    ]
    alone = pictures(replace(item, results=item.results[:1]))[0]
    whole = max(float(x) for x in re.findall(r'transform="matrix\(1 \S+ \S+ 1 (-?\d+) ', str(alone.drawing)))
    assert 0.0 < shifts[0] < whole, "what turns sets the scale for what slides"
    assert (drawn[0].value, drawn[1].proved) == ("0.56000", "least known")


def test_the_paper_s_values_stand_beside_ours():
    opened = glance(samples.typical())
    block, cost = opened.parts
    assert opened.case == "wall-21"
    assert "Limit analysis leaves 0.40000 to 0.54545; FE 0.47619, DE [0.41270, 0.54550]" in block.sentence
    assert "<span>0.4, 0.476, 0.545</span>" in block.plot
    assert re.findall(r"<title>(\w[^<]*)</title>", str(block.plot))[:3] == ["fe 0.476", "la 0.4", "la-associated 0.545"]
    assert "FE : LA : DE is 20 : 15 : 360 in the paper and 20 : 10 : 400 here" in cost.sentence
    assert "20 → 20" in cost.plot
    assert "15 → 10" in cost.plot
    assert "360 → 400" in cost.plot


def test_largest_walls_count_accepted_runs_only():
    small, large = samples.bond("small"), samples.bond("large", courses=6)
    count = {case.id: case.assembly.n_free for case in (small, large)}
    rejected = samples.solved(large, "de", 0.5)
    rejected.judge.accepted = False
    items = [
        CaseResults(small, [samples.solved(small, name, 0.5) for name in ("fe", "la", "de")]),
        CaseResults(large, [samples.solved(large, "fe", 0.5), rejected]),
    ]
    assert largest_walls(run_of(*items)) == (
        "Largest walls, in blocks: 440 (FE), 50 (LA), 220 (DE) in the paper, "
        f"{count['large']}, {count['small']}, {count['small']} in this comparison."
    )
    assert largest_walls(run_of(items[0])).endswith(f"in the paper, {count['small']} (all) in this comparison.")


def own(multiplier: float, name: str = "") -> CaseResults:
    case = samples.bond(f"mine{name}")
    case = replace(case, wall_id="mine", load_case=name, argument="my wall.json")
    return CaseResults(case, [samples.solved(case, "la", multiplier), samples.solved(case, "fe", multiplier * 1.02)])


def test_a_wall_of_ones_own_opens_with_the_load_case_that_governs():
    items = [own(0.4, "wind"), own(0.3, "quake")]
    opened = glance(run_of(*items))
    assert opened.governs is not None
    assert opened.governs.item is items[1]
    assert [(way.name, way.value, way.proved, way.governs) for way in opened.governs.ways] == [
        ("wind", "0.40000 (la)", "least known", False),
        ("quake", "0.30000 (la)", "least known", True),
    ]
    assert "0.30000 (la)" in opened.words
    assert 'class="moves"' in opened.drawing
    assert len(opened.governs.joints) == 8
    assert opened.governs.reactions
    assert glance(run_of(items[1], items[0])).governs.item is items[1]  # type: ignore[union-attr]
    assert all(way.governs for way in governing([own(0.3, "a"), own(0.3, "b")]).ways), "equal multipliers govern both"


def test_a_wall_that_falls_in_one_load_case_is_governed_by_it():
    falls = own(0.3, "snow")
    falls.results[:] = [
        result.model_copy(update={"finding": Finding.FALLS, "multiplier": None}) for result in falls.results
    ]
    found = governing([own(0.2, "wind"), falls])
    assert found.item is falls
    assert [way.governs for way in found.ways] == [False, True]
    assert found.ways[1].value == "falls under its dead load"


def test_no_load_case_governs_while_another_has_no_accepted_answer():
    """A number that is safe by one load case is not safe: the terminal says so, and so does the first screen."""
    lost, borne = own(0.3, "snow"), own(0.4, "floor")
    nothing = {"finding": Finding.NONE, "status": Status.NOT_CONVERGED, "multiplier": None}
    lost.results[:] = [result.model_copy(update=nothing) for result in lost.results]
    borne.results[:] = [
        result.model_copy(update={"finding": Finding.UNBOUNDED, "multiplier": None}) for result in borne.results
    ]
    found = governing([own(0.2, "wind"), lost, borne])
    assert [way.governs for way in found.ways] == [False] * 3
    assert found.unanswered == ["snow"]
    said = summary(run_of(own(0.2, "wind"), lost, borne), found.item, found.unanswered).advice
    assert said.startswith(
        "Which load case governs is not known: there is no accepted answer to snow. The least of the others is 0.20000 "
        "(la) in load case wind"
    )
    assert "For safety" not in said
    assert governing([own(0.2, "wind"), borne]).unanswered == []


def test_what_would_change_the_number_is_a_command_that_fits_the_wall():
    assert dict(glance(run_of(own(0.3))).further) == {
        "The opposite live load": "drystone compare mine.json --both-signs",
        "Friction 20 % lower to 20 % higher": "drystone sweep 'my wall.json' --vary friction=0.52:0.78:9",
        "Whether it depends on the joint tolerance": "drystone validate 'my wall.json'",
    }
    assert dict(glance(run_of(own(0.3, "wind"), own(0.4, "quake"))).further) == {
        "Friction 20 % lower to 20 % higher": "drystone sweep 'my wall.json' --vary friction=0.52:0.78:9",
        "Whether it depends on the joint tolerance": "drystone validate 'my wall.json'",
    }, "a sweep takes all load cases of the file"


def test_no_study_of_a_load_that_stands_in_no_file_is_offered():
    item = own(0.3)
    changed = replace(item, case=with_live_load(item.case, 0.0, -1.0))
    assert glance(run_of(changed)).further == []
    assert glance(samples.typical()).governs is None


def test_a_row_of_the_overview_counts_from_the_least_and_fills_what_is_proved():
    known = [
        samples.reference("others", "published", 0.505, ["la"]),
        samples.reference("ours", "regression", 0.7, ["la"]),
        samples.reference("count", "published", 21.0, ["la"], quantity="blocks"),
    ]
    case = samples.bond("known", references=known)
    rows = [
        samples.solved(case, "la", 0.5),
        samples.solved(case, "fe", 0.55),
        samples.solved(case, "la-associated", 0.6, flow="associated"),
        samples.solved(case, "de", 0.52, flow="approximate", bracket=(0.49, 0.55)),
        samples.solved(case, "fe-qp", 0.55),
    ]
    item = CaseResults(case, rows)
    (row,) = overview_plot(run_of(item)).rows
    found = {dot.name: dot for dot in row.dots}
    assert list(found) == ["fe", "la", "la-associated, upper bound", "de"], "no cross-checks"
    assert [dot.value for dot in found.values()] == pytest.approx([0.1, 0.0, 0.2, 0.04])
    assert found["de"].ends == pytest.approx((-0.02, 0.1))
    assert found["fe"].ends is None
    assert [value for value, _ in row.levels] == pytest.approx([0.01])
    assert (row.said, row.href, row.spread) == ("0.50000", "#case-0", pytest.approx(0.2))
    assert not any(dot.filled for dot in row.dots)
    (proved,) = overview_plot(run_of(replace(item, certified=Certified(0.5, "", "")))).rows
    assert [dot.name for dot in proved.dots if dot.filled] == ["la"]
    rows[1].judge.accepted = False
    (row,) = overview_plot(run_of(item)).rows
    assert "fe" not in {dot.name for dot in row.dots}, "what is rejected has no mark"


def test_a_wall_without_a_multiplier_is_a_row_in_words():
    case = samples.bond("mine")
    falls = samples.solved(case, "fe", 0.5).model_copy(update={"finding": Finding.FALLS, "multiplier": None})
    plot = overview_plot(run_of(CaseResults(case, [falls]), CaseResults(samples.unbuildable(), [])))
    assert [(row.dots, row.said) for row in plot.rows] == [([], "falls under its dead load"), ([], "cannot be built")]


def test_marks_stand_where_their_values_are():
    item = CaseResults(CASE, [samples.solved(CASE, "fe", 0.6), samples.solved(CASE, "la", 0.5), measured(0.5, 0.7)])
    plot = wall_plot(item)
    drawn = str(dots.html(plot))
    places = [float(x) for x in re.findall(r'<svg x="([0-9.]+)%"', drawn)]
    assert places == pytest.approx([plot.scale.place(value) for value in (0.6, 0.5, 0.6)], abs=0.01)
    (bar,) = re.findall(r'class="bar"[^>]* x1="([0-9.]+)%" x2="([0-9.]+)%"', drawn)
    assert [float(x) for x in bar] == pytest.approx([plot.scale.place(value) for value in (0.5, 0.7)], abs=0.01)
    assert places[1] < places[0] == places[2]


def test_the_axis_of_differences_is_level_to_a_thousandth_and_logarithmic_beyond():
    scale = dots.Above([0.0, 1.0])
    places = [scale.place(value) for value in (-0.001, 0.0, 0.001, 0.01, 0.1, 1.0)]
    assert all(place is not None for place in places)
    below, zero, *above = (place or 0.0 for place in places)
    assert above[0] - zero == pytest.approx(zero - below)
    # log10(1 + 1000 d): 0.301, 1.041, 2.004, 3.000
    assert (above[3] - zero) / (above[0] - zero) == pytest.approx(3.000434 / 0.301030, rel=1e-5)
    assert scale.place(np.inf) is None
    assert [scale.text(value) for value in (0.0, 0.01, -0.001)] == ["least", "+1 %", "−0.1 %"]


def test_labels_of_an_axis_have_room():
    item = CaseResults(CASE, [samples.solved(CASE, "fe", 10.0), samples.solved(CASE, "la", 1.0)])
    shown = re.findall(r'<span style="left:([0-9.]+)%">', str(dots.html(wall_plot(item))))
    gaps = np.diff([float(x) for x in shown])
    assert len(gaps) > 1
    assert gaps.min() >= dots.ROOM


def test_numbers_stand_at_forces_of_a_twentieth_of_the_largest_and_beside_each_other():
    case = samples.block()
    result = samples.solved(case, "la", 0.4)

    def said(*sizes: float) -> list[str]:
        result.forces = [(0.5 * size, 0.5 * size, 0.0) for size in sizes]
        drawn = force_drawing(case, result.model_copy())
        return [part.text for part in drawn.parts if isinstance(part, Text) and part.role == "said"]

    assert case.assembly.n_interfaces == 2
    assert said(1.0, 0.06) == ["1", "0.06"]
    assert said(1.0, 0.04) == ["1"]


def test_a_length_of_a_thousand_millimetres_is_written_out():
    assert numbers.quantity(1000.0, "mm") == "1000 mm"
    assert numbers.quantity(250000.0, "mm") == "250000 mm"
    assert numbers.quantity(0.5, "m") == "0.5 m"


def test_the_load_path_of_springs_begins_without_live_load():
    path = {"multiplier": [0.3, 0.5], "live_displacement": [0.001, 0.004]}
    ((_, drawn),) = curves.curves(CaseResults(CASE, [samples.solved(CASE, "fe", 0.5, path=path)]))
    (line,) = drawn.chart.series  # type: ignore[attr-defined]
    assert (line.x, line.y) == ([0.0, 0.001, 0.004], [0.0, 0.3, 0.5])
