"""Why two methods part: joints, friction and what moves, told and drawn, and how far brackets decide."""

from __future__ import annotations

import re
from dataclasses import replace

import numpy as np
import pytest

from harness.model.case import Case
from harness.model.comparison import CaseResults, ComparisonRun
from harness.model.method import Finding
from harness.model.result import Result
from reports.drawing.mechanism_drawing import overlay_drawing
from reports.drawing.svg import inline
from reports.findings import reasons
from reports.findings.limits import known_limits
from reports.page import summary
from tests.reports import samples
from tests.reports.findings import of_one_wall


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
    half = samples.solved(case, "fe", 0.41)
    half.mechanism, half.forces = result.mechanism, [(a, b, 0.5 * shear) for a, b, shear in result.forces]
    told = " ".join(reasons.reasons(CaseResults(case, [result, half])))
    assert "Friction takes 100 % of the live load’s work in la and 49 % in fe." in told


def test_reason_names_what_moves_in_one_only():
    item = of_one_wall()
    told = reasons.reasons(item)
    assert told[0] == "At the multiplier of la: de."
    assert told[1].startswith("la and fe (+1.29 %): mechanisms differ")
    assert "in la only" in told[1]


def overlay_svg(case: Case, first: Result, second: Result) -> str:
    return inline(overlay_drawing(case, first, second))


def test_overlay_draws_both_mechanisms():
    item = of_one_wall()
    drawn = overlay_svg(item.case, item.results[0], item.results[1])
    assert 'class="other"' in drawn
    assert drawn != overlay_svg(item.case, item.results[1], item.results[0])


def test_overlay_of_one_motion_at_two_scales_draws_nothing_twice():
    item = of_one_wall()
    first = item.results[0]
    assert first.mechanism is not None
    faster = first.model_copy(update={"mechanism": [tuple(3.0 * x for x in row) for row in first.mechanism]})
    drawn = overlay_svg(item.case, first, faster)
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
    drawn = overlay_svg(case, slides, turns)
    assert drawn.count('class="slide"') == 1
    assert 'class="slide" stroke-width="46" d=' in drawn, "the first one's are whole lines"
    assert re.search('class="open" stroke-width="28" stroke-dasharray="41 41" d=', drawn), "the second one's are dashed"


def suite(*families: dict[str, float | tuple[float, float]]) -> str:
    """The sentences on walls of which the families give these multipliers, or brackets of DE."""
    items = []
    for number, values in enumerate(families):
        case = samples.bond(f"mine-{number}")
        rows = []
        for name, value in values.items():
            low, high = value if isinstance(value, tuple) else (value, value)
            bracket = {"flow": "approximate", "bracket": (low, high)} if low < high else {}
            rows.append(samples.solved(case, name, 0.5 * (low + high), **bracket))
        items.append(CaseResults(case, rows))
    return " ".join(summary.summary(ComparisonRun("", "", "", items)).findings)


def test_families_are_counted_where_two_give_a_multiplier_and_a_bracket_that_does_not_decide_is_told():
    agreeing, apart = {"fe": 0.5, "la": 0.5}, {"fe": 0.6, "la": 0.5}
    said = suite(agreeing, apart, {"fe": 0.5, "la": 0.5, "de": (0.48, 0.52)}, {"fe": 0.5})
    assert "At least two families give a collapse multiplier of 3 walls; on 1 of them all lie within 1 %" in said
    assert "on 1 a measured bracket does not decide (mine-2)" in said
    assert "they differ on mine-1 (20.0 %)" in said
    said = suite(agreeing, {"fe": 0.5, "la": 0.5, "de": (0.499, 0.501)})
    assert "of 2 walls; on 2 of them all lie within 1 % of each other." in said
    assert "they differ on mine-0 (20.0 to 40.0 %)" in suite({"la": 0.5, "de": (0.6, 0.7)}, agreeing)


def test_walls_that_fall_for_one_family_and_stand_for_another_are_told_and_not_counted_as_agreeing():
    case = samples.bond("mine")
    falls = samples.solved(case, "fe", 0.5).model_copy(update={"finding": Finding.FALLS, "multiplier": None})
    item = CaseResults(case, [falls, samples.solved(case, "la", 0.5)])
    other = CaseResults(samples.bond("other"), [])
    said = " ".join(summary.summary(ComparisonRun("", "", "", [item, other])).findings)
    assert "The families find different things on 1 wall: mine." in said
    assert "within 1 %" not in said


def test_what_differs_is_said_of_the_least_and_the_highest_state():
    case = samples.bond("mine")
    same = CaseResults(case, [samples.solved(case, "fe", 0.6), samples.solved(case, "la", 0.5)])
    assert "They differ by 20.0 %: the mechanism of LA and FE is the same, but" in summary.wall_findings(same)
    other = replace(same, results=[samples.solved(case, "fe", 0.6, turn=0.5), same.results[1]])
    assert "They differ by 20.0 %: the mechanisms of LA and FE differ." in summary.wall_findings(other)
    unmoved = [same.results[0].model_copy(update={"mechanism": None}), same.results[1]]
    assert "They differ by 20.0 %." in summary.wall_findings(replace(same, results=unmoved))


def test_the_share_of_the_range_that_a_bracket_covers_is_computed():
    case = samples.bond("mine")

    def limits_of(low: float, high: float) -> str:
        rows = [
            samples.solved(case, "la", 0.4),
            samples.solved(case, "la-associated", 0.6, flow="associated"),
            samples.solved(case, "de", 0.5 * (low + high), flow="approximate", bracket=(low, high)),
        ]
        found = known_limits(ComparisonRun("", "", "", [CaseResults(case, rows)]))
        return " ".join(sentence for _, sentences in found for sentence in sentences)

    assert "On mine the bracket of de covers 91 % of the range" in limits_of(0.4, 0.582)
    assert "On mine the bracket of de covers 50 % of the range" in limits_of(0.5, 0.7)
    assert "covers" not in limits_of(0.5, 0.501)


def test_what_moves_is_counted_and_told_alike_at_any_speed():
    assembly = samples.bond(courses=4).assembly
    mechanism = np.zeros((assembly.n_blocks, 3))
    top = np.argsort(assembly.centroid[:, 1])[-2:]
    mechanism[top[0]] = (1.0, 0.0, 0.0)
    assert reasons.mechanism_in_words(assembly, mechanism, "m") == f"1 of {assembly.n_free} blocks moves, sliding"
    mechanism[top[1]] = (1.0, 0.0, 0.0)
    told = reasons.mechanism_in_words(assembly, mechanism, "m")
    assert told == f"2 of {assembly.n_free} blocks move, sliding as one body"
    mechanism[top[1]] = (1.6, 0.0, 0.0)  # of 1 and 1.6 the mean, 1.3, leaves 2 * .3 ** 2 / (1 + 1.6 ** 2) = 5 %
    parted = np.zeros_like(mechanism)
    parted[top] = [(1.0, 0.0, 0.0), (-1.0, 0.0, 0.0)]
    for speed in (1e-3, 1.0, 1e3):
        told = reasons.mechanism_in_words(assembly, speed * mechanism, "m")
        assert told.startswith(f"2 of {assembly.n_free} blocks move, mainly ")
        moves = speed * samples.sliding(assembly)
        assert ", sliding as one body" in reasons.mechanism_in_words(assembly, moves, "m")


def test_how_far_a_measured_value_is_from_the_least_is_told_of_both_its_ends():
    item = of_one_wall()
    item.results[3] = samples.solved(item.case, "de", 0.65, turn=0.2, flow="approximate", bracket=(0.6138, 0.6696))
    told = reasons.reasons(item)
    assert any(sentence.startswith("la and de (+10.00 % to +20.00 %): mechanisms differ") for sentence in told)
    assert not any(sentence.startswith("la and la ") for sentence in told), "the least differs from no other of itself"
    assert len([sentence for sentence in told if sentence.startswith("la and ")]) == 3
