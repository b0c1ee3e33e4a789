"""Numbers, charts and drawings of the report."""

from __future__ import annotations

import math

import numpy as np
import pytest

from harness.model.comparison import CaseResults, ComparisonRun
from harness.model.displaced import carried, released
from harness.model.method import Status
from harness.model.result import Verdict
from reports.charts import charts, curves, studies
from reports.drawing.display_list import Circles, DisplayList, Group, Polygons, moved
from reports.drawing.force_drawing import force_drawing, percent_used
from reports.drawing.mechanism_drawing import mechanism_drawing
from reports.findings import agreement
from reports.geometry import shapes, thrust_lines
from reports.labels import numbers
from reports.page import sections
from tests.reports import samples


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (0.47619047619047616, "0.47619"),
        (-0.5, "−0.50000"),
        (11.305555, "11.306"),
        (0.0, "0"),
        (3.2e-16, "3.20×10⁻¹⁶"),
        (1e7, "1.00×10⁷"),
        (math.nan, "not finite"),
    ],
)
def test_plain_numbers_have_sensible_digits(value: float, text: str):
    assert numbers.plain(value) == text


@pytest.mark.parametrize(
    ("text", "parts"),
    [
        ("0.47619", ("0", ".47619")),
        ("−11.306", ("−11", ".306")),
        ("12", ("12", "")),
        ("[0.41, 0.54]", None),
        ("3.20×10⁻¹⁶", None),
        ("–", None),
    ],
)
def test_plain_numbers_are_parted_at_the_point_and_nothing_else_is(text: str, parts: tuple[str, str] | None):
    assert numbers.at_point(text) == parts


@pytest.mark.parametrize(
    ("value", "text"),
    [(6.7e-5, "67 µs"), (0.057, "57 ms"), (0.9996, "1 s"), (12.34, "12.3 s"), (600.0, "10 min"), (7300.0, "2.03 h")],
)
def test_times_have_units(value: float, text: str):
    assert numbers.seconds(value) == text


def test_percentages_never_show_a_negative_zero():
    assert numbers.percent(-1e-9) == "0.00 %"
    assert numbers.percent(-0.1333) == "−13.33 %"


@pytest.mark.parametrize(("low", "high"), [(0.0, 1.0), (-3.0, 17.0), (1e-9, 2e-9), (0.564, 0.566), (0.0, 1e6)])
def test_ticks_are_round_and_inside(low: float, high: float):
    found = charts.ticks(low, high)
    assert 2 <= len(found) <= 8
    assert all(low - 1e-12 <= value <= high * (1 + 1e-12) for value in found)


def test_log_axis_leaves_out_what_has_no_logarithm():
    chart = charts.Chart(
        "t", "x", "y", [charts.Series("a", [0.0, 1.0, 10.0], [1.0, -2.0, 5.0])], log_x=True, log_y=True
    )
    assert str(charts.svg(chart)).count('class="mark s0"') == 1


def test_thinned_path_keeps_its_ends_and_its_peak():
    x = [float(k) for k in range(5000)]
    y = [math.sin(k / 700.0) for k in range(5000)]
    y[1234] = 9.0
    thin_x, thin_y = charts.thin(x, y)
    assert len(thin_x) <= 302
    assert (thin_x[0], thin_x[-1]) == (0.0, 4999.0)
    assert max(thin_y) == 9.0


def test_chart_labels_are_escaped():
    chart = charts.Chart(samples.SCRIPT, samples.SCRIPT, "y", [charts.Series(samples.CLOSING, [1.0], [2.0])])
    assert "<script" not in str(charts.svg(chart))
    assert "<img" not in str(charts.svg(chart))


def test_cosine_is_one_for_the_same_motion_at_any_scale():
    assembly = samples.bond().assembly
    motion = samples.sliding(assembly, 0.7)
    measure = agreement.measure_of(assembly)
    assert agreement.velocity_cosine(measure, motion, 3.0 * motion) == pytest.approx(1.0, abs=1e-12)
    assert agreement.velocity_cosine(measure, motion, -motion) == pytest.approx(-1.0, abs=1e-12)
    assert agreement.velocity_cosine(measure, motion, 0.0 * motion) is None


def test_cosine_equals_the_integral_over_the_blocks():
    # One rectangle b x h turning about its centroid against a translation plus the same turn: closed form.
    assembly = samples.block().assembly
    turn, both = np.zeros((3, 3)), np.zeros((3, 3))
    turn[2] = (0.0, 0.0, 1.0)
    both[2] = (1.0, 0.0, 1.0)
    area, polar = 0.5, 1.0 * 0.5 * (1.0**2 + 0.5**2) / 12.0
    expected = polar / math.sqrt(polar * (area + polar))
    assert agreement.velocity_cosine(agreement.measure_of(assembly), turn, both) == pytest.approx(expected, rel=1e-12)


def test_agreement_names_blocks_that_move_in_one_method_only():
    case = samples.bond(courses=4)
    first, second = samples.solved(case, "fe", 0.5), samples.solved(case, "la", 0.4)
    assert second.mechanism is not None
    second.mechanism = [
        (0.0, 0.0, 0.0) if name == "4.1" else row
        for name, row in zip(case.assembly.block_ids, second.mechanism, strict=True)
    ]
    found = agreement.agreement(case.assembly, first, second)
    assert found.only_first == ["4.1"]
    assert found.only_second == []
    assert found.difference == pytest.approx(-0.2)


def test_thrust_stands_at_the_centre_of_pressure():
    assembly = samples.block().assembly
    forces = np.array([[1.0, 3.0, 0.0], [0.0, 0.0, 0.0]])
    found = shapes.thrusts(assembly, forces)
    p = 0
    assert found.interface.tolist() == [p]
    assert found.point[0] == pytest.approx(0.25 * assembly.end1[p] + 0.75 * assembly.end2[p])
    assert found.size[0] == pytest.approx(4.0)


def test_load_arrow_lies_on_the_line_of_action():
    assembly = samples.block().assembly
    load = np.zeros((3, 3))
    point, force = np.array([0.9, 0.1]), np.array([2.0, -3.0])
    arm = point - assembly.centroid[2]
    load[2] = (*force, arm[0] * force[1] - arm[1] * force[0])
    (arrow,) = shapes.load_arrows(assembly, load)
    off = arrow.point - point
    assert off[0] * force[1] - off[1] * force[0] == pytest.approx(0.0, abs=1e-12)


def groups(drawn: DisplayList) -> list[Group]:
    return [part for part in drawn.parts if isinstance(part, Group)]


def test_drawn_motion_is_the_mechanism():
    case = samples.bond()
    result = samples.solved(case, "la", 0.5, turn=0.4)
    mechanism = np.array(result.mechanism)
    drawn = mechanism_drawing(case, result)
    places = shapes.displaced(case.assembly, mechanism, shapes.amplitude(case.assembly, mechanism))
    blocks = {group.block: group for group in groups(drawn) if group.block is not None}
    assert sorted(blocks) == list(range(case.assembly.n_blocks))
    for number, group in blocks.items():
        (shape,) = (moved(part, group.motion) for part in group.parts)
        assert isinstance(shape, Polygons)
        assert drawn.frame.back(shape.outlines[0]) == pytest.approx(places[number], abs=1e-12)
        assert group.values == (tuple(mechanism[number]) if group.motion is not None else ())
        assert group.motion is not None or not mechanism[number].any()


def test_drawn_forces_are_the_forces():
    case = samples.bond()
    result = samples.solved(case, "la", 0.5)
    assert result.forces is not None
    shown = {group.joint: group.values[:3] for group in groups(force_drawing(case, result))}
    assert shown == {number: tuple(force) for number, force in enumerate(result.forces)}


def test_no_shape_is_lost_where_neighbours_are_drawn_as_one():
    case = samples.bond()
    drawn = mechanism_drawing(case, samples.solved(case, "la", 0.5, turn=0.4))
    flat = list(drawn.flat())
    shown = [shape for shape in flat if isinstance(shape, Polygons) and shape.role != "crack"]
    outlines = [outline for shape in shown for outline in shape.outlines]
    moving = sum(group.motion is not None and group.block is not None for group in groups(drawn))
    assert len(outlines) == case.assembly.n_blocks + moving, "the blocks, and where those stood that move"
    assert len(flat) < len(drawn.parts)


def test_profile_does_not_count_an_unsolved_case_as_won():
    case = samples.bond()
    quick_but_wrong = samples.solved(case, "la", 0.9, cpu=0.001)
    quick_but_wrong.verdict = Verdict.OUTSIDE_TOLERANCE
    slow = samples.solved(case, "fe", 0.5, cpu=1.0)
    stopped = samples.failed(case, "de", Status.TIMEOUT, "")
    stopped.cpu_seconds = 1e-6
    nobody = CaseResults(case, [samples.failed(case, "fe", Status.CRASHED, "")])
    run = ComparisonRun("", "", "", [CaseResults(case, [quick_but_wrong, slow, stopped]), nobody])
    assert studies.profile(run, ["fe", "la", "de"]) == {"fe": [1.0], "la": [], "de": []}


def test_cost_stands_against_blocks_and_against_interfaces():
    case = samples.bond()
    small, large = samples.solved(case, "la", 0.5, cpu=0.1), samples.solved(case, "la", 0.5, cpu=0.2)
    large.blocks = 2 * small.blocks
    run = ComparisonRun("", "", "", [CaseResults(case, [small]), CaseResults(case, [large])])
    study = studies.cost_against_size(run)
    assert study is not None
    by_blocks, by_interfaces = (svg for _, svg in study.charts)
    assert "number of free blocks" in by_blocks
    assert "number of interfaces" in by_interfaces
    (line,) = studies._costs(run, lambda item, _: item.case.assembly.n_interfaces)
    assert list(line.x) == [case.assembly.n_interfaces] * 2
    assert sorted(line.y) == [0.1, 0.2]


def test_slope_of_a_power_law_is_found():
    x = [10.0, 20.0, 50.0, 100.0]
    assert studies._slope(x, [3.0 * value**1.7 for value in x]) == pytest.approx(1.7)
    assert studies._slope([10.0, 11.0, 12.0, 13.0], [1.0, 2.0, 3.0, 4.0]) is None, (
        "no slope over less than a factor of 3"
    )
    assert studies._slope([10.0, 20.0, 40.0, 40.0], [1.0, 2.0, 3.0, 4.0]) is None, "nor over three sizes"


def test_least_known_history_never_rises():
    case = samples.bond()
    path = {"cpu_seconds": [0.1, 0.2, 0.3], "multiplier": [0.5, 0.6, 0.4]}
    ((caption, chart),) = curves.curves(CaseResults(case, [samples.solved(case, "la", 0.4, path=path)]))
    assert "least collapse state known" in caption
    assert "la: 0.2, 0.5" in str(chart)


def test_worst_residual_leaves_out_what_ought_to_be_large():
    result = samples.solved(samples.bond(), "la", 0.5)
    assert result.judge.worst == ("equilibrium", 3e-16)


def test_released_blocks_turn_without_changing_their_shape():
    assembly = samples.bond().assembly
    places = np.tile([0.1, -0.2, 1.3], (assembly.n_blocks, 1))
    for before, after in zip(assembly.polygons, carried(assembly, places), strict=True):
        sides = [np.linalg.norm(polygon - np.roll(polygon, 1, axis=0), axis=1) for polygon in (before, after)]
        assert sides[0] == pytest.approx(sides[1], rel=1e-12)


def test_released_wall_is_drawn_over_time_and_at_its_end():
    case = samples.bond()
    frames = np.zeros((3, case.assembly.n_blocks, 3)).tolist()
    path = {"time": [0.0, 1.0, 2.0], "live_displacement": [0.0, 0.1, 0.3], "multiplier": [0.5, 0.5, 0.5]}
    details = {"release": {"frames": frames, "time_unit": "s"}}
    found = curves.curves(CaseResults(case, [samples.solved(case, "de-tilt", 0.5, path=path, details=details)]))
    assert [caption for caption, _ in found] == [
        "de-tilt: the wall released just above its multiplier.",
        "de-tilt: the wall at the end of the release.",
    ]


def test_frames_of_another_wall_are_not_drawn():
    case = samples.bond()
    result = samples.solved(case, "de-tilt", 0.5, details={"release": {"frames": [[[0.0, 0.0, 0.0]]] * 3}})
    assert released(result, case.assembly.n_blocks) is None


def test_the_source_of_a_search_that_found_the_state_is_told_and_nothing_where_none_is_recorded():
    found = {"source": "central path", "multiplier": 0.5, "cpu_seconds": 0.025}
    sought = samples.solved(samples.block(), "la", 0.5, details={"improvements": [{**found, "source": "other"}, found]})
    assert sections.origin(sought) == "found from “central path” after 25 ms of CPU time"
    higher = {"improvements": [{**found, "multiplier": 0.6}]}
    for details in ({}, {"improvements": []}, {"improvements": "many"}, {"improvements": [3]}, higher):
        assert sections.origin(samples.solved(samples.block(), "la", 0.5, details=details)) == ""


def test_friction_at_its_limit_is_decided_from_the_forces_and_not_from_what_is_shown_of_them():
    case = samples.bond("mine")
    result = samples.solved(case, "la", 0.5)
    forces = np.zeros((case.assembly.n_interfaces, 3))
    forces[:, 0] = 1000.0
    forces[0] = (0.037, 0.0, 0.037 * 0.65)  # at its limit; as whole steps of 0.1 it would be 0
    forces[1] = (0.16, 0.0, 0.1)  # 96 %; as whole steps 2 and 1, 77 %
    forces[2] = (100.0, 0.0, 0.998 * 65.0)
    forces[3] = (0.0, 0.0, 0.0)
    result = result.model_copy(update={"forces": [tuple(row) for row in forces.tolist()]})
    assert percent_used(case.assembly, forces)[:5] == [100, 96, 99, -1, 0]
    shown = {group.joint: group for group in groups(force_drawing(case, result))}
    assert shown[2].values[3] == 99
    for number, group in shown.items():
        circled = any(isinstance(part, Circles) for part in group.parts)
        assert circled == thrust_lines.at_friction_limit(case.assembly, forces)[number]
