"""Whole sentences and tables of the report against what they have to say of data made by hand."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from harness.model.case import Case
from harness.model.comparison import CaseResults
from harness.model.method import Finding
from reports.charts import curves, families
from reports.findings import agreement, reasons
from reports.geometry import shapes, thrust_lines
from reports.labels import numbers
from reports.labels.wall_summary import friction_text, value_in_words, wall_summary
from reports.page import tables
from tests.reports import samples
from tests.walls import case as wall_case
from tests.walls import running_bond


def block_that(multiplier: float, method: str, motion: tuple[float, float, float], shear: float) -> tuple[Case, Any]:
    """The paper's block with a motion, and a shear in its rear joint, which bears all of its weight."""
    case = samples.block()
    field = [(0.0, 0.0, 0.0), (0.0, 0.0, 0.0), motion]
    forces = [(0.25, 0.25, shear), (0.0, 0.0, 0.0)]
    more = {"mechanism": field, "forces": forces, "states": None}
    return case, samples.solved(case, method, multiplier).model_copy(update=more)


def test_why_two_states_part_is_told_in_joints_cosine_and_the_work_of_friction():
    """A slide, and a turn by -1 about the toe with |v|^2 = A (.0625 + .25) + J, A = .5, J = .5 * 1.25 / 12.

    Their product is .25 A: the cosine is .387. The slide spends .1 of the .4 * .5 that the live load does.
    """
    case, slides = block_that(0.4, "la", (1.0, 0.0, 0.0), 0.1)
    _, turns = block_that(0.44, "fe", (0.25, 0.5, -1.0), 0.1)
    assert reasons.reasons(CaseResults(case, [slides, turns])) == [
        "la and fe (+10.00 %): mechanisms differ (cosine 0.3872): 2 joints slide in la only; 2 joints open in fe only. "
        "Friction takes 50 % of the live load’s work in la and 0 % in fe."
    ]
    pair = agreement.agreement(case.assembly, slides, turns)
    assert pair.cosine == pytest.approx(0.125 / math.sqrt(0.5 * (0.5 * 0.3125 + 0.5 * 1.25 / 12)))
    assert pair.difference == pytest.approx(0.1)
    _, same = block_that(0.44, "fe", (2.0, 0.0, 0.0), 0.11)
    assert reasons.reasons(CaseResults(case, [slides, same])) == [
        "la and fe (+10.00 %): the same mechanism, other forces. Friction takes 50 % of the live load’s work in la and "
        "50 % in fe."
    ]
    still = turns.model_copy(update={"mechanism": [(0.0, 0.0, 0.0)] * 3, "forces": None})
    assert reasons.reasons(CaseResults(case, [slides, still])) == [
        "la and fe (+10.00 %): mechanisms differ: 2 joints slide in la only; 1 block moves in la only."
    ]


def test_a_value_is_its_bracket_only_where_it_is_measured():
    case = samples.bond()
    bounded = samples.solved(case, "la", 0.5, bracket=(0.4, 0.5))
    assert value_in_words(bounded) == "0.50000", "a lower bound beside a value leaves it one"
    measured = bounded.model_copy(update={"flow": "approximate", "bracket": (0.49, 0.51)})
    assert value_in_words(measured) == "[0.49000, 0.51000]"
    assert value_in_words(measured.model_copy(update={"bracket": None})) == "0.50000"
    assert value_in_words(bounded.model_copy(update={"finding": Finding.STANDS})) == "stands"


def test_the_polar_moment_of_a_triangle_is_that_of_the_textbook():
    """A right triangle with legs a and b has A (a^2 + b^2) / 18 about its centroid."""
    corners = np.array([[1.0, 2.0], [4.0, 2.0], [1.0, 3.0]])
    expected = 0.5 * 3.0 * 1.0 * (9.0 + 1.0) / 18.0
    for turn in (0.0, 0.7):
        way = np.array([[np.cos(turn), np.sin(turn)], [-np.sin(turn), np.cos(turn)]])
        turned = corners @ way
        assert agreement._polar_moment(turned, turned.mean(axis=0)) == pytest.approx(expected)


@pytest.mark.parametrize(
    ("motion", "said"),
    [
        ((-3.25, -1.5, 1.0), "turning anticlockwise about (2.00, −3.00) m"),  # r = (-1.5, 3.25) from the centre
        ((0.25, 0.5, -1.0), "turning clockwise about the toe at (1.00, 0) m"),
        ((0.25, 0.53, -1.0), "turning clockwise about the toe at (1.03, 0) m"),  # .05 of .7071 is .0354
        ((0.25, 0.54, -1.0), "turning clockwise about (1.04, 0) m"),
        ((0.25, -0.5, 1.0), "turning anticlockwise about (1.00, 0.500) m"),
        ((1.0, 0.0, 0.019), "sliding"),
        ((1.0, 0.0, 0.021), "turning anticlockwise about (0.500, 47.9) m"),
    ],
)
def test_how_one_block_moves_is_told_with_the_centre_of_its_rotation(motion: tuple[float, float, float], said: str):
    assembly = samples.block().assembly
    field = np.zeros((3, 3))
    field[2] = motion
    assert reasons.mechanism_in_words(assembly, field, "m") == f"1 of 1 block moves, {said}"
    assert reasons.mechanism_in_words(assembly, 0.0 * field, "m") == "no block moves"


def test_runs_references_and_statements_are_counted():
    """Twelve runs: two ended without an answer, one of the rest is rejected; one of three statements is violated."""
    run = samples.typical()
    assert tables.findings(run) == (
        "Of 12 runs on 3 cases, 10 ended with an answer; the judge accepted 9 and rejected 1. "
        "Of 2 checked reference values, 2 are met. Of 3 statements of theory that could be tested, 2 hold."
    )
    first = run.cases[0].results[0]
    first.judge = first.judge.model_copy(update={"accepted": None})
    assert "accepted 8 and rejected 1, and 1 is not judged." in tables.findings(run)
    second = run.cases[0].results[1]
    second.judge = second.judge.model_copy(update={"accepted": None})
    assert "accepted 7 and rejected 1, and 2 are not judged." in tables.findings(run)


def test_what_is_given_of_a_wall_is_told_with_its_units():
    """Three courses of .8 m of bricks .4 x .2 m, 20 kN a cubic metre and 1 m thick, on a ground as high as a course."""
    facts = dict(wall_summary(samples.bond()))
    assert facts["Blocks"] == "8 free, 1 fixed"
    assert facts["Friction tan φ"] == "0.65"
    assert facts["Size"] == "0.8 × 0.8 m"
    assert facts["Weight of free blocks"] == "9.6 kN"
    assert facts["Live load"] == "to the right"
    assert "Gravity" not in facts
    tilted = wall_case(running_bond(3, 2), loads={"gravity": [0.123456, -0.98765]})
    told = dict(wall_summary(tilted))
    assert told["Gravity"] == "(0.1235, −0.9877) times the weight"
    assert told["Live load"] == "none: only stability is analysed"


@pytest.mark.parametrize(
    ("frictions", "text"),
    [
        ([0.5, 0.7], "0.5, 0.7"),
        ([0.1, 0.2, 0.3, 0.4], "0.1, 0.2, 0.3, 0.4"),
        ([0.1, 0.2, 0.3, 0.4, 0.51234567], "0.1 to 0.5123"),
    ],
)
def test_few_frictions_are_listed_and_many_are_a_range(frictions: list[float], text: str):
    wall = samples.bond(courses=5).assembly
    values = np.resize(np.array(frictions), wall.n_interfaces)

    class Wall:
        friction = values

    assert friction_text(Wall()) == text  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("found", "text"),
    [
        (numbers.plain(0.99996, 4), "1.000"),
        (numbers.plain(9.9999996), "10.000"),
        (numbers.plain(1234567.0), "1.23×10⁶"),
        (numbers.plain(123456.0), "123456"),
        (numbers.plain(1e-4, 3), "0.000100"),
        (numbers.plain(1.5e-4, 3), "0.000150"),
        (numbers.given(1.5e-4, 3), "0.00015"),
        (numbers.given(1.5e6, 3), "1.5×10⁶"),
        (numbers.given(999999.0), "999999"),
        (numbers.plain(0.9e-4, 3), "9×10⁻⁵"),
        (numbers.plain(1.1e-15, 4, 3.0), "0"),
        (numbers.plain(1.1e-15, 4, 1e-9), "1.1×10⁻¹⁵"),
        (numbers.plain(1234567.0, 8), "1234567.0"),
        (numbers.given(1e-5), "10⁻⁵"),
        (numbers.given(1.25e-5), "1.25×10⁻⁵"),
        (numbers.given(-1.5e7), "−1.5×10⁷"),
        (numbers.given(123456.7, 3), "123000"),
        (numbers.given(0.0), "0"),
        (numbers.given(0.476190476), "0.47619"),
        (numbers.power(-1.0), "−10⁰"),
        (numbers.power(2.5e-16, 2), "2.5×10⁻¹⁶"),
        (numbers.power(math.inf), "not finite"),
        (numbers.multiplier(0.123456, 2), "0.12"),
        (numbers.multiplier(12.3456, 1), "12.3"),
        (numbers.multiplier(0.123456, 9), "0.12346"),
        (numbers.multiplier(0.00123, 1), "0.001"),
        (numbers.multiplier(None), "–"),
        (numbers.interval((0.5, 0.25)), "[0.50000, 0.25000]"),
        (numbers.memory(999_999_999), "1000 MB"),
        (numbers.memory(2_340_000_000), "2.34 GB"),
        (numbers.memory(None), "–"),
        (numbers.percent(None), "–"),
        (numbers.percent(math.nan), "–"),
        (numbers.percent(0.12345, 1), "+12.3 %"),
        (numbers.seconds(0.00099951), "1 ms"),
        (numbers.seconds(99.0), "99 s"),
        (numbers.seconds(99.6), "1.66 min"),
        (numbers.seconds(5969.0), "99.5 min"),
        (numbers.seconds(5971.0), "1.66 h"),
        (numbers.every_digit([0.1, (1, 2.5)]), "[0.1, [1, 2.5]]"),
        (numbers.count(2, "class"), "2 classes"),
        (numbers.count(0, "wall"), "0 walls"),
    ],
)
def test_numbers_are_written_as_people_read_them(found: str, text: str):
    assert found == text


def test_curves_of_a_measured_answer_show_its_steps_and_the_bracket_of_every_order():
    case = samples.bond()
    orders = [{"order": "up", "held": 0.5, "moving": 0.6}, {"order": "down", "held": 0.45, "moving": 0.62}]
    row = samples.solved(
        case,
        "de",
        0.55,
        flow="approximate",
        bracket=(0.5, 0.6),
        path={"multiplier": [0.0, 0.5, 0.7, 0.55, 0.6], "residual": [0.0] * 5},
        details={"orders": orders, "reporting_order": "up"},
    )
    (told, steps), (named, brackets) = curves.curves(CaseResults(case, [row]))
    assert told == (
        "de: the load steps of the reported sweep order narrow the bracket from both sides (2 sweep orders tried)."
    )
    shown = {line.name: list(zip(line.x, line.y, strict=True)) for line in steps.chart.series}  # type: ignore[attr-defined]
    assert shown == {
        "held": [(1.0, 0.0), (2.0, 0.5)],
        "moving": [(3.0, 0.7), (5.0, 0.6)],
        "undecided": [(4.0, 0.55)],
    }
    assert named == "de: held and moving for every sweep order (1 up, 2 down)."
    held, moving = brackets.chart.series  # type: ignore[attr-defined]
    assert (held.x, held.y) == ([1.0, 2.0], [0.5, 0.45])
    assert (moving.x, moving.y, moving.low, moving.high) == ([1.0, 2.0], [0.6, 0.62], [0.5, 0.45], [0.6, 0.62])
    one = row.model_copy(update={"details": {"orders": orders[:1], "reporting_order": "up"}})
    ((told, _),) = curves.curves(CaseResults(case, [one]))
    assert told.endswith("(1 sweep order tried).")


def test_a_load_path_has_the_levels_that_differ_and_the_place_of_every_step():
    case = samples.bond()
    path = {"multiplier": [0.2, 0.5, 0.4, 0.4], "live_displacement": [0.0, 0.001, 0.002, 0.004]}
    row = samples.solved(case, "fe", 0.4, path=path, details={"peak": 0.5, "plateau": 0.4})
    above = samples.solved(case, "la-associated", 0.5002, flow="associated")
    ((_, drawn),) = curves.curves(CaseResults(case, [row, above]))
    chart = drawn.chart  # type: ignore[attr-defined]
    level = ("associated upper bound 0.50020", 0.5002)
    assert chart.levels == [level, ("plateau 0.40000", 0.4)], "the peak is as high"
    assert chart.series[0].x == [0.0, *path["live_displacement"]]
    assert chart.series[0].y == [0.0, *path["multiplier"]]
    assert (chart.x_label, chart.zero_y) == ("displacement of the live load [m]", True)


def test_proportions_are_those_of_most_bricks():
    assert families.proportion_of(samples.bond(length=0.5).assembly) == pytest.approx(2.5)
    arch = wall_case({"type": "ring", "inner_radius": 2.0, "outer_radius": 2.3, "count": 7})
    assert families.proportion_of(arch.assembly) is None


def test_head_joints_are_those_within_thirty_degrees_of_upright():
    wall = samples.bond().assembly
    forces = np.zeros((wall.n_interfaces, 3))
    heads = np.abs(wall.normal[:, 0]) > 0.9
    forces[heads, 0], forces[~heads, 0] = 0.5, 100.0
    share = 0.5 * heads.sum() / float(wall.weight[wall.free].sum())
    assert thrust_lines.head_thrust(wall, forces.tolist()) == pytest.approx(share)
    assert thrust_lines.head_thrust(samples.block().assembly, [(1.0, 1.0, 0.0)] * 2) is None


def test_one_of_many_arrows_is_drawn_so_that_sixty_are_at_most():
    assert [shapes.drawn_every(number) for number in (0, 1, 60, 61, 120, 121)] == [1, 1, 1, 2, 2, 3]
