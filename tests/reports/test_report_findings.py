"""What the page opens with: findings of one wall, of the paper's and of a suite, and all that went wrong by name."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from harness.model.comparison import CaseResults, Certified, ComparisonRun, Gate
from harness.model.method import Status
from harness.model.result import Verdict
from reports.drawing.svg import inline
from reports.findings import joints, reasons
from reports.labels import labels
from reports.page import build, summary, tables
from tests.reports import samples
from tests.reports.findings import of_one_wall


def test_one_wall_opens_with_its_multipliers_and_the_number_to_use():
    opened = summary.summary(ComparisonRun("mine", "", "", [of_one_wall()]))
    told = summary.wall_findings(of_one_wall())
    assert told.startswith("mine collapses at 0.55800 under the live load to the right (LA, least known); FE 0.56520")
    assert "; FE 0.56520, DE [0.45000, 0.61000] (26 % wide)." in told
    assert "They differ by 1.3 to 25.6 %: the mechanisms of LA and FE differ." in told, "a bracket has two ends"
    assert "For safety use 0.55800 (la), least known: a lower collapse state is not excluded." in opened.advice
    assert "Do not rely on 0.58400, which is 4.7 % above the least multiplier (la-associated)" in opened.advice
    assert (opened.red, opened.findings) == ([], []), "the number to use comes first"
    drawn, caption = summary.figure_of(of_one_wall())
    assert drawn is not None
    assert 'class="other"' in inline(drawn)
    assert "0.2 m</text>" in inline(drawn)
    assert "tan φ 0.65" in caption


def test_least_is_the_minimum_only_where_it_is_proved():
    proved = summary.which_number(of_one_wall(proved_least=True))
    assert "(la), least, to rounding: la finds in floating point that no collapse state lies below it." in proved
    assert "minimum" not in summary.wall_findings(of_one_wall())
    assert "(LA, least, to rounding)" in summary.wall_findings(of_one_wall(proved_least=True))


@pytest.mark.parametrize(("bound", "said"), [(0.557999, True), (0.5579, False), (0.558001, False)])
def test_the_minimum_is_called_proved_only_where_a_certificate_meets_it(bound: float, said: bool):
    item = replace(of_one_wall(proved_least=True), certified=Certified(bound, "", ""))
    assert ("minimum, proved" in summary.wall_findings(item)) is said
    assert ("an exact certificate proves that" in summary.which_number(item)) is said


def test_rejected_state_is_never_the_number_to_use():
    item = of_one_wall()
    item.results[0].judge.accepted = False
    assert reasons.least_known(item) is item.results[1]


def test_suite_names_every_red_row_and_broken_theory_comes_first():
    run = samples.typical()
    opened = summary.summary(run)
    assert opened.findings[0].startswith("Theory is violated on wall-21")
    assert {row.name for row in opened.red} == {
        "wall-21, theory",
        "wall-21, de",
        "wall-21, la-paper",
        "wall-21, fe-qp",
        "hostile, de",
    }
    block = summary.wall_findings(next(item for item in run.cases if item.case.id == "single-block"))
    assert block.startswith("single-block collapses at 0.40000")
    assert "is the same, but equilibrium does not determine the forces" in block


def test_search_that_missed_a_state_is_told_as_such_and_no_method_is_called_wrong():
    item = of_one_wall()
    missed = Gate(name="la-below-fe", statement="s", passed=False, sentence="la 0.6, fe 0.5", of_search=True)
    item.gates.append(missed)
    opened = summary.summary(ComparisonRun("", "", "", [item]))
    assert opened.findings[-1].startswith("The search for the least state missed one")
    assert "la 0.6, fe 0.5" in opened.findings[-1]
    assert not any("wrong" in sentence for sentence in opened.findings)


def test_case_that_only_failed_has_findings():
    case = samples.bond("mine")
    item = CaseResults(case, [samples.failed(case, "fe", Status.TIMEOUT, "late")])
    opened = summary.summary(ComparisonRun("mine", "", "", [item]))
    assert "no method gave an answer" in opened.findings[0]
    assert opened.advice == ""


def test_one_body_that_turns_is_told_with_its_centre():
    assembly = samples.bond().assembly
    centre, mechanism = np.array([0.8, 0.0]), np.zeros((assembly.n_blocks, 3))
    for block in assembly.free:
        arm = assembly.centroid[block] - centre
        mechanism[block] = (arm[1], -arm[0], -1.0)
    told = reasons.mechanism_in_words(assembly, mechanism, "m")
    everything = f"{assembly.n_free} of {assembly.n_free} blocks move"
    assert told == f"{everything}, turning as one body clockwise about the toe at (0.800, 0) m"
    sliding = samples.sliding(assembly)
    assert "sliding as one body" in reasons.mechanism_in_words(assembly, sliding, "m")


def test_crack_that_steps_through_beds_and_heads_is_told():
    assembly = samples.bond(courses=6, bricks=3).assembly
    mechanism = np.zeros((assembly.n_blocks, 3))
    mechanism[assembly.centroid[:, 0] + assembly.centroid[:, 1] > 1.2] = (1.0, 0.0, 0.0)
    told = reasons.mechanism_in_words(assembly, mechanism, "m")
    assert told.endswith("sliding as one body, along a stepped crack")
    mechanism[:] = 0.0
    mechanism[assembly.centroid[:, 1] > 0.4] = (1.0, 0.0, 0.0)
    assert "stepped" not in reasons.mechanism_in_words(assembly, mechanism, "m"), "a bed alone is no step"


def test_self_stress_that_loading_does_not_build_up_is_told_with_its_size():
    item = of_one_wall()
    wall = item.case.assembly
    head = np.abs(wall.normal[:, 0]) > 0.5
    weight = float(wall.weight[wall.free].sum())
    for result, share in ((item.results[0], 0.2), (item.results[1], 0.1), (item.results[2], 0.5)):
        forces = np.zeros((wall.n_interfaces, 3))
        forces[head, 0] = share * weight / head.sum()
        result.forces = forces.tolist()
    told = reasons.reasons(item)
    (associated,) = (sentence for sentence in told if "la-associated" in sentence)
    assert "Head joints carry 0.20 of the wall’s weight in la and 0.50 in la-associated" in associated
    assert "the load path does not produce: fe ends with 0.10" in associated


def test_own_walls_come_first_then_the_papers_then_those_that_part():
    known = [samples.reference("known", "published", 0.5, ["la"])]
    calm, torn = samples.bond("calm", references=known), samples.bond("torn", references=known)
    items = [
        CaseResults(calm, [samples.solved(calm, "la", 0.5), samples.solved(calm, "fe", 0.5)]),
        CaseResults(torn, [samples.solved(torn, "la", 0.5), samples.solved(torn, "fe", 0.6)]),
        CaseResults(paper := samples.bond("wall-21", references=known), [samples.solved(paper, "la", 0.5)]),
        of_one_wall(),
    ]
    assert [item.case.id for item in summary.in_order(items)] == ["mine", "wall-21", "torn", "calm"]


def test_measured_value_is_its_bracket_in_every_table():
    rows = tables.run_rows(ComparisonRun("mine", "", "", [of_one_wall()]))[0]
    assert [row.cell("multiplier").text for row in rows if row.result.method == "de"] == [
        "[0.45000, 0.61000] (26 % wide)"
    ]


def test_methods_run_on_few_cases_take_no_column():
    cases = [samples.bond(f"wall-{n}") for n in range(4)]
    items = [CaseResults(case, [samples.solved(case, "la", 0.5)]) for case in cases]
    items[0].results.append(samples.solved(cases[0], "fe-newton", 0.5))
    run = ComparisonRun("four", "", "", items)
    assert [column.method for column in tables.overview_columns(run)] == ["la"]
    page = build.render(run, data_folder="x")
    assert "Methods run on a few walls only" in page
    assert "drystone run fe-newton wall-0" in page


def test_joints_are_told_by_what_they_do_and_forces_by_the_state_they_are_of():
    item = of_one_wall()
    page = build.render(ComparisonRun("mine", "", "", [item]), data_folder="x")
    assert "mechanism without dilatancy; 7 joints slide, 2 rock and slide and 2 open along their whole length" in page
    assert page.count("contact forces of the last held state; the mechanism above belongs to the moving state") == 1
    assert page.count("contact forces at collapse") == 3
    assert "No result of this comparison has a value of others" in page


def test_joint_that_rocks_and_slides_counts_as_both():
    slides, opens = np.array([True, True, False, False]), np.array([False, True, True, True])
    moves = joints.JointMotion(slides, opens, np.array([False, False, False, True]), np.zeros(4, dtype=bool))
    assert joints.joints_in_words(moves) == (
        "1 joint slides, 1 rocks, 1 rocks and slides and 1 opens along its whole length"
    )
    opened = joints.JointMotion(slides[1:], opens[1:], np.array([False, True, True]), np.zeros(3, dtype=bool))
    assert joints.joints_in_words(opened) == "1 joint rocks and slides and 2 open along their whole length"
    still = joints.JointMotion(*(np.zeros(2, dtype=bool) for _ in range(4)))
    assert joints.joints_in_words(still) == ""


def test_long_table_in_which_all_agree_is_folded_with_its_count():
    known = [samples.reference(f"known-{n}", "published", 0.5, ["la"]) for n in range(8)]
    case = samples.bond("known", references=known)
    result = samples.solved(case, "la", 0.5)
    for n in range(8):
        samples.held_against(case, result, f"known-{n}", Verdict.AGREES)
    page = build.render(ComparisonRun("known", "", "", [CaseResults(case, [result])]), data_folder="x")
    assert "8 of 8 values agree</summary>" in page
    result.comparisons[3].verdict = Verdict.OUTSIDE_TOLERANCE
    page = build.render(ComparisonRun("known", "", "", [CaseResults(case, [result])]), data_folder="x")
    head, folded = page.split("7 of 8 values agree</summary>")
    assert "requirement of known-3" in head.split('id="references"')[1], "what differs is not folded"
    assert "requirement of known-4" in folded


def test_a_reference_that_is_a_range_is_printed_with_both_ends():
    known = [samples.reference("known", "published", 0.5, ["la"]) | {"value": [0.45, 0.61], "relation": "inside"}]
    case = samples.bond("known", references=known)
    result = samples.solved(case, "la", 0.5)
    samples.held_against(case, result, "known", Verdict.AGREES)
    ((row,),) = tables.run_rows(ComparisonRun("known", "", "", [CaseResults(case, [result])]))
    assert row.cell("reference").text == "in [0.45, 0.61]"


def test_the_reference_that_stands_in_the_row_is_the_one_that_matters_most():
    known = [
        samples.reference("width", "published", 0.2, ["la"], quantity="details.width"),
        samples.reference("close", "published", 0.5, ["la"]),
        samples.reference("gate", "exact", 0.51, ["la"], gate=True),
        samples.reference("missed", "published", 0.7, ["la"], quantity="details.peak"),
    ]
    case = samples.bond("known", references=known)
    result = samples.solved(case, "la", 0.5)

    def told() -> str:
        ((row,),) = tables.run_rows(ComparisonRun("known", "", "", [CaseResults(case, [result])]))
        return row.cell("reference").text

    samples.held_against(case, result, "width", Verdict.AGREES)
    assert told() == "width 0.2"
    samples.held_against(case, result, "close", Verdict.AGREES)
    assert told() == "0.5 +1", "the multiplier before what else is known"
    samples.held_against(case, result, "gate", Verdict.AGREES)
    assert told() == "0.51 +2", "what a gate holds before what it does not"
    samples.held_against(case, result, "missed", Verdict.OUTSIDE_TOLERANCE)
    assert told() == "peak 0.7 +3", "what is missed before what agrees"


def test_names_are_listed_as_in_a_sentence():
    listed = [labels.all_of(["fe", "la", "de"][:count]) for count in (1, 2, 3)]
    assert listed == ["FE", "FE and LA", "FE, LA and DE"]
