"""What the page opens with: findings of one wall, of the paper's and of a suite, and all that went wrong by name."""

from __future__ import annotations

import re

import numpy as np
import pytest

from harness.model.comparison import CaseResults, ComparisonRun, Gate
from harness.model.method import Status
from harness.model.result import Verdict
from reports import build, joints, mechanism_drawing, opening, reasons, tables
from tests.reports import samples


def of_one_wall(**more: object) -> CaseResults:
    case = samples.bond("mine")
    least = samples.solved(case, "la", 0.558, turn=0.5)
    least.details.update(more)
    return CaseResults(
        case,
        [
            least,
            samples.solved(case, "fe", 0.5652),
            samples.solved(case, "la-associated", 0.584, flow="associated"),
            samples.solved(case, "de", 0.47, flow="approximate", bracket=(0.45, 0.61)),
        ],
    )


def test_one_wall_opens_with_its_multipliers_and_the_number_to_use():
    opened = opening.opening(ComparisonRun("mine", "", "", [of_one_wall()]))
    told = " ".join(opened.findings)
    assert told.startswith(
        "mine collapses at 0.55800 under the live load to the right (LA, least known); FE 0.56520, DE [0.45000, 0.61000]."
    )
    assert "They differ by 1.3 to 25.6 %: the mechanisms of LA and FE differ." in told, "a bracket has two ends"
    assert "For safety use 0.55800 (la), least known: a lower collapse state is not excluded." in opened.advice
    assert "Do not rely on 0.58400, which is 4.7 % above the least multiplier (la-associated)" in opened.advice
    assert opened.red == []
    assert 'class="other"' in opened.figure
    assert "0.2 m</text>" in opened.figure
    assert "tan φ 0.65" in opened.caption


def test_least_is_the_minimum_only_where_it_is_proved():
    proved = opening.which_number(of_one_wall(proved_least=True))
    assert "(la), least, to rounding: branch and bound in floating point leaves no collapse state below it." in proved
    assert "minimum" not in opening.wall_findings(of_one_wall())
    assert "(LA, least, to rounding)" in opening.wall_findings(of_one_wall(proved_least=True))


@pytest.mark.parametrize(("bound", "said"), [(0.557999, True), (0.5579, False), (0.558001, False)])
def test_the_minimum_is_called_proved_only_where_a_certificate_meets_it(bound: float, said: bool):
    item = of_one_wall(proved_least=True)
    item.results[0].details["certified_bound"] = bound
    assert ("minimum, proved" in opening.wall_findings(item)) is said
    assert ("an exact certificate proves that" in opening.which_number(item)) is said


def test_rejected_state_is_never_the_number_to_use():
    item = of_one_wall()
    item.results[0].judge.accepted = False
    assert reasons.least_known(item) is item.results[1]


def test_suite_names_every_red_row_and_broken_theory_comes_first():
    run = samples.typical()
    opened = opening.opening(run)
    assert opened.findings[0].startswith("Theory is violated on wall-21")
    assert {row.name for row in opened.red} == {
        "wall-21, theory",
        "wall-21, de",
        "wall-21, la-paper",
        "wall-21, fe-qp",
        "hostile, de",
    }
    assert any(finding.startswith("single-block collapses at 0.40000") for finding in opened.findings)
    assert any("is the same, but equilibrium does not determine the forces" in finding for finding in opened.findings)


def test_search_that_missed_a_state_is_told_as_such_and_no_method_is_called_wrong():
    item = of_one_wall()
    missed = Gate(name="la-below-fe", statement="s", passed=False, sentence="la 0.6, fe 0.5", of_search=True)
    item.gates.append(missed)
    opened = opening.opening(ComparisonRun("", "", "", [item]))
    assert opened.findings[0].startswith("mine collapses"), "the reader's wall comes first"
    assert opened.findings[-1].startswith("The search for the least state missed one")
    assert "la 0.6, fe 0.5" in opened.findings[-1]
    assert not any("wrong" in sentence for sentence in opened.findings)


def test_case_that_only_failed_has_findings():
    case = samples.bond("mine")
    item = CaseResults(case, [samples.failed(case, "fe", Status.TIMEOUT, "late")])
    opened = opening.opening(ComparisonRun("mine", "", "", [item]))
    assert "no method gave an answer" in opened.findings[0]
    assert opened.figure == ""
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
    assert "Head joints press with 0.20 of the wall’s weight in la and 0.50 in la-associated" in associated
    assert "loading does not build up: fe ends with 0.10" in associated


def test_friction_histories_that_part_are_told_and_equal_ones_in_a_word():
    item = of_one_wall()
    item.results[1].details["histories"] = [{"plateau": 0.55}, {"plateau": 0.5652}]
    assert "fe ends between 0.55000 and 0.56520 over 2 histories of friction" in " ".join(reasons.reasons(item))
    item.results[1].details["histories"] = [{"plateau": 0.5652}, {"plateau": 0.5652}]
    assert "fe ends at 0.56520 along each of 2 histories" in " ".join(reasons.reasons(item))


def test_friction_takes_all_work_of_a_block_that_slides_on_level_ground():
    case = samples.block()
    result = samples.solved(case, "la", 0.4)
    assembly = case.assembly
    result.mechanism = [(1.0, 0.0, 0.0) if not fixed else (0.0, 0.0, 0.0) for fixed in assembly.fixed]
    normal = 0.5 / assembly.n_interfaces
    result.forces = [(normal / 2, normal / 2, 0.4 * normal)] * assembly.n_interfaces
    assert reasons.friction_share(assembly, result) == pytest.approx(1.0, rel=1e-12)


def test_reason_names_what_moves_in_one_only():
    item = of_one_wall()
    told = reasons.reasons(item)
    assert told[0] == "At the multiplier of la: de."
    assert told[1].startswith("la and fe (+1.29 %): mechanisms differ")
    assert "in la only" in told[1]


def test_overlay_draws_both_mechanisms():
    item = of_one_wall()
    drawn = mechanism_drawing.overlay_svg(item.case, item.results[0], item.results[1])
    assert 'class="other"' in drawn
    assert drawn != mechanism_drawing.overlay_svg(item.case, item.results[1], item.results[0])


def test_overlay_of_one_motion_at_two_scales_draws_nothing_twice():
    item = of_one_wall()
    first = item.results[0]
    assert first.mechanism is not None
    faster = first.model_copy(update={"mechanism": [tuple(3.0 * x for x in row) for row in first.mechanism]})
    drawn = mechanism_drawing.overlay_svg(item.case, first, faster)
    assert 'class="other"' not in drawn
    assert 'class="slide"' not in drawn


def test_overlay_marks_joints_that_slide_in_one_mechanism_only():
    case = samples.block()
    free = int(case.assembly.free[0])
    toe = case.assembly.polygons[free][[1]] - case.assembly.centroid[free]  # its lower right corner
    motions = np.zeros((2, case.assembly.n_blocks, 3))
    motions[0, free] = (1.0, 0.0, 0.0)
    motions[1, free] = (-toe[0, 1], toe[0, 0], -1.0)
    slides = samples.solved(case, "la", 0.4).model_copy(update={"mechanism": motions[0].tolist()})
    turns = slides.model_copy(update={"method": "fe", "mechanism": motions[1].tolist()})
    drawn = mechanism_drawing.overlay_svg(case, slides, turns)
    assert drawn.count('class="slide"') == 1
    assert 'class="slide" stroke-width="46" d=' in drawn, "the first one's are whole lines"
    assert re.search('class="open" stroke-width="28" stroke-dasharray="41 41" d=', drawn), "the second one's are dashed"


def test_own_walls_come_first_then_the_papers_then_those_that_part():
    known = [samples.reference("known", "published", 0.5, ["la"])]
    calm, torn = samples.bond("calm", references=known), samples.bond("torn", references=known)
    items = [
        CaseResults(calm, [samples.solved(calm, "la", 0.5), samples.solved(calm, "fe", 0.5)]),
        CaseResults(torn, [samples.solved(torn, "la", 0.5), samples.solved(torn, "fe", 0.6)]),
        CaseResults(paper := samples.bond("wall-21", references=known), [samples.solved(paper, "la", 0.5)]),
        of_one_wall(),
    ]
    assert [item.case.id for item in opening.in_order(items)] == ["mine", "wall-21", "torn", "calm"]


def test_measured_value_is_its_bracket_in_every_table():
    rows = tables.run_rows(ComparisonRun("mine", "", "", [of_one_wall()]))[0]
    assert [row.multiplier.text for row in rows if row.method == "de"] == ["[0.45000, 0.61000]"]


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
    assert "of the joints" in page
    assert (
        page.count("contact forces of the last state that was held; the mechanism above is of the one that moved") == 1
    )
    assert page.count("contact forces at collapse") == 3
    assert "No result of this comparison stands beside a value of others" in page


def test_joint_that_rocks_and_slides_counts_as_both():
    slides, opens = np.array([True, True, False, False]), np.array([False, True, True, True])
    moves = joints.Motion(slides, opens, np.array([False, False, False, True]), np.zeros(4, dtype=bool))
    assert joints.joints_in_words(moves) == (
        "of the joints 1 slides, 1 rocks, 1 rocks and slides and 1 opens along its whole length"
    )


def test_long_table_in_which_all_agree_is_folded_with_its_count():
    known = [samples.reference(f"known-{n}", "published", 0.5, ["la"]) for n in range(8)]
    case = samples.bond("known", references=known)
    result = samples.solved(case, "la", 0.5)
    for n in range(8):
        samples.held_against(case, result, f"known-{n}", Verdict.AGREES)
    page = build.render(ComparisonRun("known", "", "", [CaseResults(case, [result])]), data_folder="x")
    assert "8 of 8 values agree: show them" in page
    result.comparisons[3].verdict = Verdict.OUTSIDE_TOLERANCE
    page = build.render(ComparisonRun("known", "", "", [CaseResults(case, [result])]), data_folder="x")
    head, folded = page.split("7 of 8 values agree: show them")
    assert "requirement of known-3" in head.split('id="references"')[1], "what differs is not folded"
    assert "requirement of known-4" in folded
