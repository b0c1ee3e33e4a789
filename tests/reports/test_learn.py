"""The page for teaching: its closed forms are what the methods answer, and it works offline and without scripts."""

from __future__ import annotations

import re
from dataclasses import replace

import pytest

from harness.model.assembly import Assembly
from harness.model.build import build
from harness.model.comparison import CaseResults
from harness.model.method_registry import load_method
from harness.model.wall import Wall
from reports.page.learn import BlockAnswers, block_answers, render
from tests.reports import samples
from tests.reports.read_chart import Read


def block(rear: float, front: float) -> Assembly:
    wall = samples.block().wall
    rules = [{"value": rear, "between": ("left", "block")}, {"value": front, "between": ("right", "block")}]
    data = wall.model_dump(by_alias=True) | {"friction": {"default": rear, "rules": rules}}
    return build(Wall.model_validate(data)).assembly


@pytest.mark.parametrize(("rear", "front"), [(0.6, 0.4), (0.8, 0.2), (0.3, 0.7), (0.5, 0.5)])
def test_closed_forms_are_what_the_methods_answer(rear: float, front: float):
    found, wall = block_answers(rear, front), block(rear, front)
    for method, expected in (("la", found.least), ("fe", found.springs), ("la-associated", found.greatest)):
        solver = load_method(method)
        assert solver.solve(wall, solver.Settings()).multiplier == pytest.approx(expected, abs=1e-7), method


def test_springs_balance_the_block():
    found = block_answers(0.6, 0.4)
    assert sum(found.shares) == pytest.approx(1.0)
    moment = 0.5 * (found.shares[3] - found.shares[0])  # about the middle of a base of length 1
    assert moment == pytest.approx(found.springs * 0.25)
    assert isinstance(found, BlockAnswers)


def page() -> str:
    """The page of a made-up run; tests/browser opens it."""
    run = samples.typical()
    names = {"single-block", "wall-21"}
    cases = [item for item in run.cases if item.case.id in names]
    assert {item.case.id for item in cases} == names
    return render(replace(run, cases=cases))


def test_page_works_offline_and_its_drawings_stand_without_a_script():
    text = page()
    assert not re.search(r'(src|href)="http', text)
    body = text.split("<script")[0]
    assert "0.4762" in body
    assert "0.5455" in body
    assert body.count('class="wall"') >= 1


def test_the_chart_over_friction_shows_each_answer_of_the_walls():
    run = samples.typical()
    block = next(item for item in run.cases if item.case.id == "single-block")
    known = {0.4: 0.41, 0.6: 0.52, 0.8: 0.55}
    walls = []
    for friction, value in known.items():
        case = samples.bond(f"wall-{len(walls)}", friction=friction)
        walls.append(CaseResults(case, [samples.solved(case, "la", value)]))
    text = render(replace(run, cases=[block, *walls]))
    assert Read(text).marks == [pytest.approx(point, abs=0.01) for point in known.items()]
