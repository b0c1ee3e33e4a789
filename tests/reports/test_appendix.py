"""The engineer's appendix: what it holds, that supports take the loads, and that it prints."""

from __future__ import annotations

import json
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from drystone.cli import printing
from harness.model.comparison import CaseResults
from harness.model.live_load import reversed_live
from harness.model.support_reactions import out_of_balance, support_reactions
from reports.page.appendix import render, write_appendix
from tests.commands import drystone
from tests.reports import samples
from tests.walls import assembly, stack


def one_wall():
    run = samples.typical()
    return replace(run, cases=[next(item for item in run.cases if item.results and item.results[0].forces)])


def test_reaction_of_a_column_is_its_weight_and_push_where_statics_puts_it():
    wall = assembly(stack(3), 0.65)  # blocks of .3 by .2 m, 1.2 kN each, on a fixed one
    push = 0.25
    forces = []
    for height in (3, 2, 1):  # from the foot up: the blocks above, their centre half-way up
        weight = 1.2 * height
        eccentric = push * 0.1 * height
        share = 0.5 + eccentric / 0.3
        forces.append((weight * (1.0 - share), weight * share, push * weight))
    along = float(wall.tangent[0, 0])
    if along < 0.0:
        forces = [(second, first, -shear) for first, second, shear in forces]
    sign = float(wall.normal[0, 1])
    forces = [(first, second, sign * shear) for first, second, shear in forces]
    (reaction,) = support_reactions(wall, np.array(forces))
    assert abs(reaction.fx) == pytest.approx(push * 3.6)
    assert reaction.fy == pytest.approx(3.6)
    centre = float(wall.centroid[wall.free, 0].mean())
    assert abs((reaction.x or 0.0) - centre) == pytest.approx(push * 0.3)
    assert out_of_balance(wall, [reaction], -np.sign(reaction.fx) * push) < 1e-12
    assert out_of_balance(wall, [reaction], 0.3) > 0.01


def test_appendix_holds_what_an_engineer_signs_for():
    run = one_wall()
    (item,) = run.cases
    text = render(run)
    for heading in ("Result", "Given", "Assumptions", "Drawing", "Mechanism and forces", "Blocks", "Limits"):
        assert re.search(rf"<h2>\d {heading}", text), heading
    for free in item.case.assembly.free:
        name = item.case.assembly.block_ids[free]
        assert f'<th scope="row">{name}</th>' in text
    for word in ("Supports", "Friction", "Units", "Reactions of the supports", "Computed by", "Repeat it"):
        assert word in text
    joints = item.case.assembly.n_interfaces
    assert f"<b>Most critical joints</b> ({min(joints, 8)} of {joints}) in this state" in text
    assert text.count("<svg") == 3
    assert not re.search(r'(src|href)="http', text)


def test_a_machine_without_a_browser_is_told_what_to_do(tmp_path: Path):
    with pytest.raises(printing.PrintError, match="install chromium, or open"):
        printing.print_pdf(tmp_path / "a.html", tmp_path / "a.pdf", printing.Browsers(names=("no-such-browser",)))
    assert not list(tmp_path.iterdir())


@pytest.mark.browser
def test_appendix_prints_on_two_to_four_sheets(tmp_path: Path):
    page = tmp_path / "wall-appendix.html"
    write_appendix(one_wall(), page)
    try:
        printing.print_pdf(page, page.with_suffix(".pdf"))
    except printing.PrintError as error:
        pytest.skip(str(error))
    sheets = len(re.findall(rb"/Type /Page\b", page.with_suffix(".pdf").read_bytes()))
    assert 2 <= sheets <= 4


def both_ways(right: float, left: float) -> str:
    case = samples.bond("mine")
    turned = reversed_live(case)
    items = [
        CaseResults(case, [samples.solved(case, "la", right)]),
        CaseResults(turned, [samples.solved(turned, "la", left)]),
    ]
    return re.sub(r"\s+", " ", render(replace(samples.typical(), cases=items)))


def test_the_lower_of_two_directions_governs_the_appendix():
    text = both_ways(0.38236, 0.29947)
    assert "mine collapses at 0.29947 under the live load to the left" in text
    assert "For safety use 0.29947" in text
    assert '<th scope="row">to the right</th><td>0.38236 (la)</td><td>least known</td><td></td>' in text
    assert '<th scope="row">to the left</th><td>0.29947 (la)</td><td>least known</td><td>yes</td>' in text
    assert "For safety use 0.29947" in both_ways(0.29947, 0.38236)
    assert "under the live load to the right" in both_ways(0.29947, 0.38236)


def test_one_direction_alone_is_named():
    case = samples.bond("mine")
    text = render(replace(samples.typical(), cases=[CaseResults(case, [samples.solved(case, "la", 0.5)])]))
    assert "Live load: to the right. No other direction was analysed." in text


def test_the_command_analyses_a_horizontal_load_both_ways(tmp_path: Path):
    stones = {"g": [-1, -0.2, 2, 0], "a": [0, 0, 0.5, 0.5], "b": [0.2, 0.5, 0.6, 1.0]}
    blocks = [
        {"id": name, "fixed": name == "g", "polygon": [[x0, y0], [x1, y0], [x1, y1], [x0, y1]]}
        for name, (x0, y0, x1, y1) in stones.items()
    ]
    loads = {"live": {"body": [{"per_weight": [-1, 0]}]}}
    wall = {"format": "wall/1", "unit_weight": 20, "friction": 0.9, "blocks": blocks, "loads": loads}
    (tmp_path / "lean.json").write_text(json.dumps(wall))
    done = drystone("report", "--appendix", "lean.json", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    text = (tmp_path / "out" / "lean-appendix.html").read_text()
    # About the right toe at (.5, 0): (5 kN * .25 m + 4 kN * .1 m) over (5 kN * .25 m + 4 kN * .75 m); about the left
    # one: (5 * .25 + 4 * .4) over the same.
    assert "collapses at 0.38824 under the live load to the right" in text
    assert "<td>0.67059 (la)</td>" in text
