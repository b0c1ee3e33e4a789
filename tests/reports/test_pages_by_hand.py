"""Parts of pages against what they have to say of data made by hand: dot plots, rows, sums, heads."""

from __future__ import annotations

import re
from dataclasses import replace
from typing import Any

import pandas as pd
import pytest

from harness.model.comparison import CaseResults, ComparisonRun
from harness.model.method import Finding, Status
from harness.model.result import Verdict
from reports import appendix
from reports.charts import curves, dots, families, studies
from reports.charts.dots import Dot, DotPlot, DotRow
from reports.charts.styles import SHAPES, Mark
from reports.drawing.wall_drawing import wall_drawing
from reports.page import build, glance, study_page, summary, tables, vectors
from reports.page.governing import governing
from tests.reports import samples
from tests.walls import case as wall_case
from tests.walls import running_bond, stack


def run_of(*items: CaseResults) -> ComparisonRun:
    return ComparisonRun("t", "drystone compare", "2026-01-02T03:04:05Z", list(items))


def test_marks_of_a_dot_plot_stand_in_the_lanes_of_their_methods():
    """Three methods take three lines of 8 px, from 8 px on; an axis of 0 to 1 ends .06 beyond both, at 3 and 97 %."""
    a, b = Mark("#111111", "s", "solid"), Mark("#222222", "o", "solid")
    rows = [
        DotRow("one", [Dot("a", 0.0, a, "a 0"), Dot("b", 1.0, b, "b 1", ends=(0.5, 1.0), filled=True)], "said", "#x"),
        DotRow("two", [Dot("c", 0.25, a, "c 0.25")], levels=[(0.75, "reference")]),
        DotRow("three", [], "nothing"),
    ]
    plot = DotPlot("title", dots.plain_scale([0.0, 1.0]), rows, band=(0.0, 0.5))
    text = str(dots.html(plot))

    def at(value: float) -> str:
        return f"{3.0 + 94.0 * (value + 0.06) / 1.12:.2f}%"

    lines = re.findall(r"<li .*?</li>", text)
    assert [re.findall(r'data-place="(\d)" data-spread="([^"]*)"', line)[0] for line in lines] == [
        ("0", "1"),
        ("1", "0"),
        ("2", "0"),
    ]
    assert [re.findall(r'class="track" height="(\d+)"', line) for line in lines] == [["32"]] * 3
    assert re.findall(r'<svg x="([^"]*)" y="(\d+)">', lines[0]) == [(at(0.0), "8"), (at(1.0), "16")]
    assert re.findall(r'<svg x="([^"]*)" y="(\d+)">', lines[1]) == [(at(0.25), "24")]
    bar = f'class="bar" style="stroke:#222222" x1="{at(0.5)}" x2="{at(1.0)}" y1="16" y2="16"'
    assert bar in lines[0]
    assert re.findall(r"fill:([^\"]*)\" d=", lines[0]) == ["var(--paper)", "#222222"]
    assert f'<line class="level" x1="{at(0.75)}" x2="{at(0.75)}" y1="0" y2="100%"><title>reference</title>' in lines[1]
    assert [re.findall(r'aria-label="([^"]*)"', line)[0] for line in lines] == [
        "a 0; b 1",
        "c 0.25; reference",
        "nothing",
    ]
    assert lines[0].startswith('<li data-place="0" data-spread="1"><a href="#x">one</a>')
    assert lines[2].startswith('<li data-place="2" data-spread="0"><b>three</b>')
    band = re.findall(r'class="within" x="([\d.]+)%" width="([\d.]+)%" height="100%"', text)
    assert [float(x) for x in band[0]] == pytest.approx([3.0 + 94.0 * 0.06 / 1.12, 94.0 * 0.5 / 1.12], abs=0.01)
    ticks = re.findall(r'<line class="tick" x1="([^"]*)"', text)
    assert ticks == [at(value) for value in (0.0, 0.25, 0.5, 0.75, 1.0)]
    few = DotPlot("t", dots.plain_scale([0.0]), [DotRow("one", [Dot("a", 0.0, a, "")]), DotRow("two", [])])
    assert re.findall(r'class="track" height="(\d+)"', str(dots.html(few))) == ["16", "16"], "one lane"
    assert f'd="{SHAPES["s"]}"' in dots.legend(plot)


def test_what_differences_are_counted_from_always_has_its_label():
    """On a wide axis there is room for it or for the thousandth beside it, and not for both."""
    scale = dots.Above([-0.0005, 2.2])
    shown = re.findall(r'left:[\d.]+%">([^<]+)<', str(dots.html(DotPlot("t", scale, []))))
    assert "least" in shown
    assert "−0.1 %" not in shown
    assert shown[-1] == "+100 %"


def test_a_run_is_trouble_where_it_failed_was_rejected_or_missed_a_reference():
    case = samples.bond()

    def row(**more: Any) -> tables.RunRow:
        return tables.run_row(0, 0, CaseResults(case, [samples.solved(case, "la", 0.5).model_copy(update=more)]))

    found = {verdict: row(verdict=verdict).trouble for verdict in Verdict}
    assert {verdict for verdict, trouble in found.items() if trouble} == {
        Verdict.OUTSIDE_TOLERANCE,
        Verdict.VIOLATES_BOUND,
    }
    assert row(status=Status.TIMEOUT).trouble
    assert (row(status=Status.TIMEOUT).failed, row().failed) == (True, False)
    unjudged = samples.solved(case, "la", 0.5).judge.model_copy(update={"accepted": None})
    assert row(judge=unjudged).trouble
    assert row(multiplier=None, finding=Finding.STANDS).cell("multiplier").text == "stands"
    assert row(multiplier=None, status=Status.TIMEOUT).cell("multiplier").text == "timeout"
    kept = row(flow="approximate", bracket=(0.45, 0.55))
    assert kept.cell("multiplier").text.startswith("[0.45000, 0.55000]")
    assert (kept.cell("bracket").text, kept.cell("bracket").sort) == ("[0.45000, 0.55000]", 0.45)
    assert (row().cell("bracket").text, row().cell("reference").text) == ("–", "–")
    residual = row().cell("judge_worst_residual")
    assert (residual.text, residual.title, residual.sort) == ("3×10⁻¹⁶", "equilibrium 3e-16", 3e-16)
    assert row().command == "drystone run la wall-21"


def test_the_appendix_lists_blocks_and_sums_of_loads_in_four_digits():
    """Bricks of 1/3 x 1/7 m and 20 kN a cubic metre weigh .95238 kN."""
    case = wall_case(stack(2, width=1 / 3, height=1 / 7))
    text = appendix.render(
        replace(
            run_of(CaseResults(case, [samples.solved(case, "la", 0.5)])),
            provenance={"versions": {"drystone": "0.1", "commit": "abc"}},
        )
    )
    cells = re.findall(r"<tr><th scope=\"row\">2</th>(.*?)</tr>", text)
    assert re.findall(r'<td class="num">([^<]*)</td>', cells[0]) == [
        "0.1667",
        "0.3571" if "0.3571" in cells[0] else "0.2143",
        "0.9524",
        "0, −0.9524",
        "0.9524, 0",
    ]
    sums = dict(re.findall(r'<tr><th scope="row">(D[^<]*|Live load[^<]*)</th>(.*?)</tr>', text))
    assert re.findall(r">([^<]+)</td>", sums["Dead load, with the weights"]) == ["0", "−1.905"]
    assert re.findall(r">([^<]+)</td>", sums["Live load at multiplier 1"]) == ["1.905", "0"]
    assert re.search(r"<code>[0-9a-f]{16}</code>", text)
    assert "Crushing, loss of strength" in text
    many = wall_case(running_bond(9, 4))
    assert many.assembly.n_free == 41 > 36
    assert "<h2>6 Blocks</h2>" in text
    assert "6 Blocks" not in appendix.render(
        replace(
            run_of(CaseResults(many, [samples.solved(many, "la", 0.5)])),
            provenance={"versions": {"drystone": "0.1"}},
        )
    )


def test_the_appendix_says_that_crushing_is_left_out_of_walls_that_do_not_crush():
    case = wall_case(stack(2), 0.5, compressive_strength=500.0)
    assert case.assembly.crushes
    text = appendix.render(
        replace(
            run_of(CaseResults(case, [samples.solved(case, "la", 0.5)])), provenance={"versions": {"drystone": "0.1"}}
        )
    )
    assert "joints crush by a rectangular stress block" in text
    assert "<li>Loss of strength, settlement, dynamics" in text
    assert "Crushing, loss" not in text


def test_a_profile_counts_the_cases_that_no_method_solved():
    def said(*items: CaseResults) -> str:
        study = studies.performance_profile(run_of(*items))
        assert study is not None
        return study.sentence

    case = samples.bond()
    solved = CaseResults(case, [samples.solved(case, "fe", 0.5, cpu=1.0), samples.solved(case, "la", 0.5, cpu=2.0)])
    failed = CaseResults(case, [samples.failed(case, "fe", Status.TIMEOUT, "")])
    head = "How much of the 2 cases each method solved within a multiple of the fastest method's time"
    assert said(solved, solved) == f"{head}."
    assert said(solved, failed) == f"{head}; 1 case no method solved."
    ((_, drawn),) = studies.performance_profile(run_of(solved, failed)).charts  # type: ignore[union-attr]
    fe, la = drawn.chart.series  # type: ignore[attr-defined]
    assert (fe.x, fe.y) == ([1.0, 10.0], [0.5, 0.5])
    assert (la.x, la.y) == ([2.0, 10.0], [0.5, 0.5])


def test_the_head_of_a_page_counts_where_its_runs_were_made_and_hashes_their_keys():
    rows = tables.run_rows(samples.typical())
    ((machine, versions, number),) = build._origins(rows)
    assert number == 12
    assert "a processor" in machine
    assert "commit = abcdef123456" in versions
    assert re.fullmatch("[0-9a-f]{12}", build._digest(rows))
    assert build._date("2026-01-02T03:04:05Z") == "2026-01-02 03:04 UTC"
    assert build._date("2026-01-02T03:04:05") == "2026-01-02 03:04"
    assert build._date("yesterday") == "yesterday"
    told = tables.machine_text({"processor": "p", "memory_bytes": 8_000_000_000})
    assert told == "processor p, memory 8 GB"


def test_a_file_has_its_title_friction_and_contents_in_lines_above_the_drawing():
    case = samples.block()
    drawing = wall_drawing(case)
    text = vectors.headed(case, drawing, "said")
    left, top, width, height = drawing.frame.box
    lines = re.findall(r'<text x="(-?\d+)" y="(-?\d+)" font-size="120" style="text-anchor:start">([^<]*)</text>', text)
    assert lines == [
        (str(left + 60), str(top - 3 * 170 + 170 * k), line)
        for k, line in enumerate(("The paper&#39;s block", "tan φ = 0.4, 0.6, live load to the right", "said"), start=1)
    ]
    assert f'viewBox="{left:.0f} {top - 510:.0f} {width:.0f} {height + 510:.0f}"' in text


def test_a_chosen_number_of_friction_is_a_fifth_lower_and_higher_in_three_digits():
    case = replace(samples.bond("mine", friction=1 / 3), wall_id="mine", argument="mine.json")
    own = CaseResults(case, [samples.solved(case, "la", 0.3)])
    further = dict(glance.glance(run_of(own)).further)
    assert further["Friction 20 % lower to 20 % higher"].endswith("--vary friction=0.267:0.4:9")


def test_the_number_to_use_names_its_load_case():
    case = replace(samples.bond("mine-wind"), load_case="wind")
    item = CaseResults(case, [samples.solved(case, "la", 0.3)])
    assert summary.which_number(item).startswith("For safety use 0.30000 (la) in load case wind, least known: ")


@pytest.mark.parametrize(
    ("other", "said"),
    [
        (0.500049, "The methods agree."),
        (0.5003, "They lie within 0.06 % of each other."),
        (0.5049, "They lie within 0.98 % of each other."),
        (0.51, "They differ by 2.0 %: the mechanism of LA and FE is the same"),
    ],
)
def test_how_far_families_lie_from_each_other_is_told(other: float, said: str):
    case = samples.bond("mine")
    told = summary.wall_findings(
        CaseResults(case, [samples.solved(case, "la", 0.5), samples.solved(case, "fe", other)])
    )
    assert said in told


def test_what_springs_and_the_associated_maximum_give_is_told_where_it_differs():
    case = samples.bond("mine")

    def told(springs: float, associated: float) -> str:
        rows = [
            samples.solved(case, "la", 0.5),
            samples.solved(case, "fe", springs),
            samples.solved(case, "la-associated", associated, flow="associated"),
        ]
        return summary.which_number(CaseResults(case, rows))

    assert "Elastic joints without self-stress would give the same (fe)." in told(0.500001, 0.5)
    assert "would give 0.51000 (fe)." in told(0.51, 0.5)
    assert "Do not rely on" not in told(0.5, 0.5 * (1.0 + 0.9e-6))
    assert "Do not rely on 0.60000, which is 20 % above the least multiplier (la-associated): " in told(0.5, 0.6)


def test_an_agreement_map_is_cut_to_what_is_seen_at_a_glance():
    rows = [
        {"case": "a", "friction": 0.1 * k, "course": f"c{n}", "agree": "yes", "least_percent": 0.0, "most_percent": 0.5}
        for n in range(42)
        for k in range(17)
    ]
    frame = pd.DataFrame({"status": ["ok"], "cpu_seconds": [1.0]})
    page = study_page.StudyPage("t", "", "c", "now", frame, ["friction", "course"], {"agreement": pd.DataFrame(rows)})
    found = study_page._agreement_map(page)
    assert found is not None
    assert (found.axis, len(found.columns), len(found.rows)) == ("friction", 16, 40)
    assert found.left == "2 rows and 1 column more are in agreement.csv."
    assert {len(cells) for _, cells in found.rows} == {16}
    assert found.rows[0] == ("course c0", [("agree", "")] * 16)


def test_a_history_of_a_search_never_rises_and_has_the_associated_maximum_as_its_level():
    case = samples.bond()
    path = {"cpu_seconds": [0.1, 0.2, 0.4], "multiplier": [0.6, 0.65, 0.5]}
    rows = [
        samples.solved(case, "la", 0.5, path=path),
        samples.solved(case, "la-associated", 0.7, flow="associated"),
    ]
    ((_, drawn),) = curves.curves(CaseResults(case, rows))
    chart = drawn.chart  # type: ignore[attr-defined]
    (line,) = chart.series
    assert (line.x, line.y, line.step, line.marks) == ([0.1, 0.2, 0.4], [0.6, 0.6, 0.5], True, True)
    assert chart.levels == [("associated upper bound 0.70000", 0.7)]
    long = {"cpu_seconds": [0.1 * k for k in range(41)], "multiplier": [0.5] * 41}
    ((_, drawn),) = curves.curves(CaseResults(case, [samples.solved(case, "la", 0.5, path=long)]))
    assert not drawn.chart.series[0].marks  # type: ignore[attr-defined]


def test_the_most_critical_joints_are_listed_by_their_blocks_and_what_limits_them():
    case = samples.bond("mine")
    found = governing([CaseResults(case, [samples.solved(case, "la", 0.3)])])
    assert [column.head for column in found.joint_columns] == [
        "block a",
        "block b",
        "state",
        "shear",
        "eccentricity",
        "N [kN]",
        "s [kN]",
        "e / L",
        "edge stress [kN/m2]",
    ]


def test_a_cell_of_words_has_them_and_a_dash_where_there_are_none():
    case = samples.bond()
    result = samples.solved(case, "la", 0.5).model_copy(update={"sentence": "said"})
    row = tables.run_row(0, 0, CaseResults(case, [result]))
    assert (row.cell("method").text, row.cell("sentence").text) == ("la", "said")
    empty = tables.run_row(0, 0, CaseResults(case, [result.model_copy(update={"sentence": ""})]))
    assert empty.cell("sentence").text == "–"


def test_rows_of_a_long_table_of_a_study_that_are_left_out_are_counted():
    heads, rows, left = study_page._cells(pd.DataFrame({"a": range(403), "b_low": 1.0, "b_high": 1.5}))
    assert (heads, len(rows), left) == (["a", "b"], 400, 3)
    assert rows[399] == ["399", "1 to 1.5"]


def test_families_of_two_walls_stand_side_by_side_with_a_caption_each():
    items = []
    for length in (0.4, 0.6):
        for friction in (0.4, 0.6, 0.8):
            case = samples.bond(f"wall-{len(items)}", title=f"Bricks of {length}", length=length, friction=friction)
            items.append(CaseResults(case, [samples.solved(case, "la", friction, turn=0.3 * (friction > 0.7))]))
    (study,) = families.families(run_of(*items))
    assert study.sentence == ("The same wall with 3 values of friction, all methods in one plot; 2 walls side by side.")
    changes = "The mechanism changes between 0.6 and 0.8."
    assert [caption for caption, _ in study.charts] == [
        f"Bricks of {length}, and the same with other friction. {changes}" for length in (0.4, 0.6)
    ]


def test_differences_of_ten_thousand_percent_have_a_tick():
    ticks = dots.Above([0.0, 150.0]).ticks
    assert ticks == [-0.001, 0.0, 0.001, 0.01, 0.1, 1.0, 10.0, 100.0]
