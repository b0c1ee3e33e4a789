"""The steps of a load path: dots where joints first open or slide, listed by name, each with the line of its joint."""

from __future__ import annotations

import re

import numpy as np
import pytest

from harness.model.case import Case
from harness.model.comparison import CaseResults
from reports.charts.curves import curves, first_changes
from reports.drawing.display_list import Frame
from reports.page.build import page_style
from tests.reports import samples
from tests.reports.read_chart import Read
from tests.walls import case as wall_case
from tests.walls import stack

LOADS, MOVED = [0.1, 0.20041, 0.3, 0.35, 0.38, 0.38], [1.0, 2.0, 4.0, 8.0, 16.0, 32.0]
JOINTS, CHANGES = [0.0, 2.0, 0.0, 0.0, -1.0, 1.0], [2.0, 0.0, 2.0, 0.0, -1.0, 1.0]
"""Joint 0 slides twice and opens, joint 2 opens, nothing changes, joint 1 closes."""


def results() -> tuple[Case, CaseResults]:
    case = wall_case(stack(3))
    path = {"multiplier": LOADS, "live_displacement": MOVED, "changing_joint": JOINTS, "change": CHANGES}
    return case, CaseResults(case, [samples.solved(case, "fe", 0.38).model_copy(update={"path": path})])


def test_steps_are_the_first_opening_and_the_first_sliding_of_each_joint():
    case, item = results()
    found = first_changes(item.results[0], case.assembly, 6)
    assert [(step.place, step.joint, step.change) for step in found] == [
        (0, 0, "slides"),
        (1, 2, "opens"),
        (3, 0, "opens"),
    ]
    assert len(first_changes(item.results[0], case.assembly, 3)) == 2, "only what the chart shows"


def test_each_step_is_named_and_stands_where_the_path_has_it_and_on_the_line_of_its_joint():
    case, item = results()
    ((caption, chart),) = curves(item)
    wall = case.assembly
    steps = re.findall(r'<li data-at="([\d.]+) ([\d.]+)" data-line="M([^"]*)">([^<]*)</li>', str(caption))
    assert len(steps) == 3
    read = Read(str(chart))
    dots = re.findall(r"M([\d.]+) ([\d.]+)h0", str(chart))
    for (x, y, line, text), dot, place, joint, change in zip(
        steps, dots, (0, 1, 3), (0, 2, 0), ("slides", "opens", "opens"), strict=True
    ):
        assert (x, y) == dot
        assert read.at(float(x), float(y)) == pytest.approx((MOVED[place], LOADS[place]), abs=0.05)
        names = [wall.block_ids[side[joint]] for side in (wall.block_a, wall.block_b)]
        assert text == f"{LOADS[place]:.3g}: {names[0]} | {names[1]} {change}"
        ends = Frame.of(wall).place(np.array([wall.end1[joint], wall.end2[joint]])).ravel()
        np.testing.assert_allclose([float(value) for value in line.split()], ends, atol=0.5)


def test_path_without_breakpoints_has_no_dots_and_no_list():
    case, item = results()
    plain = {name: item.results[0].path[name] for name in ("multiplier", "live_displacement")}
    ((caption, chart),) = curves(CaseResults(case, [item.results[0].model_copy(update={"path": plain})]))
    assert "dots-on" not in chart
    assert "<ol" not in caption


def test_every_class_of_the_steps_has_a_look():
    assert all(f".{name}" in page_style() for name in ("dots-on", "here", "spot", "lit", "steps"))
