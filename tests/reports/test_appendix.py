"""The engineer's appendix: what it holds, that supports take the loads, and that it prints."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from harness import printing
from reports.appendix import render, write_appendix
from reports.reactions import out_of_balance, reactions
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
    (reaction,) = reactions(wall, np.array(forces))
    assert abs(reaction.force[0]) == pytest.approx(push * 3.6)
    assert reaction.force[1] == pytest.approx(-3.6)
    centre = float(wall.centroid[wall.free, 0].mean())
    assert abs((reaction.x or 0.0) - centre) == pytest.approx(push * 0.3)
    assert out_of_balance(wall, [reaction], np.sign(reaction.force[0]) * push) < 1e-12
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
    for word in ("Supports", "Friction", "Units", "Forces on the supports", "Computed by", "Repeat it"):
        assert word in text
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
