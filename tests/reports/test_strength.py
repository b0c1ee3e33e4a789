"""Report, terminal and tables show the strength of joints, and plastic and residual multipliers side by side."""

from __future__ import annotations

import csv
import json
from pathlib import Path

import pytest

import drystone
from harness.formats.exporting import matrices
from harness.model.build import build
from harness.model.wall import Wall
from reports.appendix import assumptions, render
from reports.findings.strength import strength_text
from tests.commands import drystone as command
from tests.walls import assembly, case, stack, wall_data

DATA = wall_data(stack(1, 1.0, 0.2), 0.5, cohesion=1.0, tensile_strength=2.0)


@pytest.fixture(scope="module")
def written(tmp_path_factory: pytest.TempPathFactory) -> tuple[str, list[dict[str, str]]]:
    folder = tmp_path_factory.mktemp("strength")
    compared = drystone.compare(drystone.library_wall("bonded-block-slides"), isolated=False)
    page = compared.report(folder / "report.html").read_text(encoding="utf-8")
    with (folder / "report-data" / "results.csv").open(encoding="utf-8") as file:
        return page, list(csv.DictReader(file))


def test_report_shows_plastic_and_residual_side_by_side(written: tuple[str, list[dict[str, str]]]):
    page, _ = written
    assert "With and without the strength of the joints" in page
    assert "For safety use 0.50000 (" in page, "dry, the block slides at its friction, by every method"
    assert "the residual multiplier: mortar is brittle" in page
    assert "For safety use 0.75000" not in page
    assert '<th scope="row">la</th><td class="num">0.75000</td><td class="num">0.50000</td>' in page
    assert '<th scope="row">la-associated</th><td class="num">0.75000 (upper bound)</td>' in page
    assert "associated maximum, an upper bound" in page, "the head of its column"
    assert "<dt>Strength of joints</dt><dd>cohesion c A 1 kN, tension T 0 kN; all interfaces</dd>" in page


def test_appendix_assumes_the_strength_that_joints_have_and_no_other():
    strong, dry = assumptions(drystone.library_wall("bonded-block-slides").case), assumptions(case(stack(1)))
    assert "cohesion c A 1 kN" in strong[1]
    assert "brittle" in strong[1]
    assert dry[1].startswith("Joints are dry")


def test_the_appendix_is_headed_by_the_number_to_use():
    """The multiplier with the strength of the joints, .75, stood above the residual one, .5, in larger letters."""
    compared = drystone.compare(drystone.library_wall("bonded-block-slides"), ["la"], isolated=False)
    text = render(compared.run)
    head = text[text.index('<p class="result">') :]
    assert head.startswith('<p class="result">For safety use 0.50000 (la), the residual multiplier')
    assert "collapses at 0.75000 under the live load to the right with the strength of its joints (LA, " in head


def test_results_have_the_residual_multiplier(written: tuple[str, list[dict[str, str]]]):
    _, rows = written
    found = {row["method"]: (float(row["multiplier"]), float(row["residual_multiplier"])) for row in rows}
    exact = (pytest.approx(0.75), pytest.approx(0.5))
    measured = (pytest.approx(0.75, rel=5e-3), pytest.approx(0.5, rel=5e-3))  # the accuracy that `de` states
    assert found == {"fe": exact, "la": exact, "la-associated": exact, "de": measured}
    assert {row["residual_finding"] for row in rows} == {"collapses"}


def test_a_dry_wall_has_no_such_table_and_empty_columns(tmp_path: Path):
    compared = drystone.compare(drystone.library_wall("slide"), ["la-associated"], isolated=False)
    page = compared.report(tmp_path / "report.html").read_text(encoding="utf-8")
    assert "strength of the joints" not in page
    assert "Strength of joints" not in page
    with (tmp_path / "report-data" / "results.csv").open(encoding="utf-8") as file:
        assert [row["residual_multiplier"] for row in csv.DictReader(file)] == [""]


def test_terminal_says_both_and_which_is_safe_and_who_refuses(tmp_path: Path):
    path = tmp_path / "glued.json"
    path.write_text(json.dumps(DATA), encoding="utf-8")
    done = command("compare", path, "--methods", "la-associated,fe,de-tilt", cwd=tmp_path)
    said = " ".join(done.stdout.split())
    assert "la-associated 0.7500000 (upper bound) plastic, 0.5000000 (upper bound) residual" in said
    assert "rely on the residual value of a method that is not an upper bound" in said
    assert "fe 0.7500000 plastic, 0.5000000 residual" in said
    assert "de-tilt takes dry joints only" in said
    assert "Take a method that follows the strength of joints (de, fe, fe-newton, fe-qp, la, la-associated, " in said
    alone = command("run", "la-associated", path, cwd=tmp_path)
    assert "0.5000000 (upper bound), without cohesion and tensile strength" in " ".join(alone.stdout.split())


def test_exports_hold_the_strength_of_joints_that_have_any():
    built = build(Wall.model_validate(DATA))
    assert matrices(built, None)["constant"].tolist() == [[1.0, 1.0, 1.0, 1.0]]
    assert "constant" not in matrices(build(Wall.model_validate(wall_data(stack(1), 0.5))), None)


def test_strength_of_some_joints_is_told_with_their_number():
    rules = {"default": 0.5, "rules": [{"joint": "bed", "value": 0.5, "cohesion": 2.0}]}
    bond = {"type": "running_bond", "block_length": 1.0, "block_height": 0.5, "count": 2, "bricks": 2}
    wall = assembly(bond, rules)
    beds = sum(name == "bed" for name in wall.joint)
    assert strength_text(wall, "kN") == (
        f"cohesion c A 0 to 2 kN, tension T 0 kN; {beds} of {wall.n_interfaces} interfaces"
    )
    assert strength_text(assembly(bond), "kN") == ""
    strong = assembly(stack(1, 0.5, 0.2), 0.5, cohesion=2.0, tensile_strength=3.0, compressive_strength=100.0)
    assert strength_text(strong, "kN") == (
        "cohesion c A 1 kN, tension T 1.5 kN; all interfaces; crushing force f_c A 50 kN; all interfaces"
    )
