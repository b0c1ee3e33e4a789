"""The generators: the same bytes each time, formulas that agree with each other, parameters that do what they say."""

import dataclasses
import json
from pathlib import Path

import numpy as np
import pytest
from scipy.optimize import linprog

from cases import closed_forms, families, joint_strength, matera, useful
from cases.generate import ROOT, generated_files, main, stale_files
from cases.sources import FILE, sources_text
from cases.writing import wall_text, write_files
from harness.engine.judge import answered
from harness.model.assembly import Assembly
from harness.model.build import build
from harness.model.case import read_case
from harness.model.method_registry import load_method
from harness.model.reading import parse_wall


def associated_maximum(assembly: Assembly) -> float | None:
    """The static linear programme, written here once more so that cases are not tested by the methods they test."""
    count = assembly.n_interfaces
    dead, live = assembly.free_loads()
    scale = assembly.force_scale
    equality = np.hstack([assembly.kinematic_matrix.toarray().T, live[:, None] / scale])
    slack, limit = np.zeros((2 * count, 3 * count + 1)), np.zeros(2 * count)
    bounds: list[tuple[float | None, float | None]] = []
    for p in range(count):
        first, second, backward, forward = assembly.constant[p] / scale
        bounds += [(-first, None), (-second, None), (None, None)]
        limit[2 * p : 2 * p + 2] = forward, backward
        slack[2 * p, 3 * p : 3 * p + 3] = [-assembly.friction[p], -assembly.friction[p], 1.0]
        slack[2 * p + 1, 3 * p : 3 * p + 3] = [-assembly.friction[p], -assembly.friction[p], -1.0]
    bounds.append((0, None if assembly.has_live_load else 0))
    cost = np.zeros(3 * count + 1)
    cost[-1] = -1.0
    found = linprog(cost, slack, limit, equality, -dead / scale, bounds, method="highs")
    return float(found.x[-1]) if found.status == 0 else None


def test_shipped_files_are_what_the_generator_writes() -> None:
    assert stale_files() == []


def test_generating_twice_gives_the_same_bytes(tmp_path: Path) -> None:
    first, second = generated_files(), generated_files()
    assert first == second
    assert sorted(write_files(first, tmp_path)) == sorted(first)
    assert write_files(second, tmp_path) == []


def test_check_finds_a_file_that_was_changed(tmp_path: Path) -> None:
    write_files(generated_files(), tmp_path)
    (tmp_path / "slide" / "wall.json").write_text("{}", encoding="utf-8")
    (tmp_path / "slide" / "case.toml").unlink()
    write_files({"slide/case.toml": generated_files()["slide/case.toml"].replace("0.3", "0.31")}, tmp_path)
    write_files({"slide/wall.json": (ROOT / "slide" / "wall.json").read_text(encoding="utf-8")}, tmp_path)
    assert "slide/case.toml" in stale_files(tmp_path)


def test_command_checks_without_writing(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["--check"]) == 0
    assert "up to date" in capsys.readouterr().out


def test_sources_are_those_of_the_cases() -> None:
    assert (ROOT / FILE).read_text(encoding="utf-8") == sources_text(ROOT)


@pytest.mark.parametrize(
    "recipe", [*closed_forms.recipes(), *joint_strength.recipes()], ids=lambda recipe: recipe.file.id
)
def test_closed_form_is_the_associated_maximum(recipe: closed_forms.Recipe) -> None:
    wall = build(recipe.wall).assembly
    if (
        wall.crushes
    ):  # no linear programme: the cones of Clarabel, which share nothing with the chords of `la-associated`
        value = answered(load_method("la-associated-cvxpy"), wall)[0].multiplier
    else:
        value = associated_maximum(wall)
    (expected,) = [
        item.value for item in recipe.file.references if "la-associated" in item.applies_to and item.relation == "equal"
    ]
    if expected == "falls":
        assert value is None
    elif expected == "stands":
        assert value == 0.0
    else:
        assert value == pytest.approx(expected, abs=1e-6 if wall.crushes else 1e-8)  # 1e-6: the judge's on such walls


def test_least_thickness_agrees_with_the_literature() -> None:
    # Whiting et al. 2009: 0.10746 for 100 voussoirs; Milankovitch 1907: 0.1075 for the continuous arch.
    assert closed_forms.minimum_thickness(100) == pytest.approx(0.10746, abs=5e-6)
    assert closed_forms.minimum_thickness(2000) == pytest.approx(0.107478, abs=1e-6)


def test_least_thickness_converges_as_voussoirs_grow() -> None:
    errors = [abs(closed_forms.minimum_thickness(count) - 0.107478) for count in (10, 40, 160, 640)]
    assert errors == sorted(errors, reverse=True)


def test_least_thickness_needs_a_joint_at_the_crown() -> None:
    with pytest.raises(ValueError, match="crown"):
        closed_forms.minimum_thickness(27)


def test_family_covers_proportions_frictions_and_starts() -> None:
    members = list(families.family())
    assert len(members) == 6 * 11 * 2
    assert {member.proportion for member in members} == set(families.PROPORTIONS)
    assert min(member.friction for member in members) == 0.2
    assert max(member.friction for member in members) == 1.2


@pytest.mark.parametrize("start", families.STARTS)
@pytest.mark.parametrize("proportion", families.PROPORTIONS)
def test_every_member_has_21_bricks(proportion: float, start: families.Start) -> None:
    assembly = build(families.wall_21(proportion, 0.65, start)).assembly
    assert assembly.n_free == 21
    # Three bricks on the ground instead of four halves and wholes: one bed and one head fewer, or more, per course.
    assert assembly.n_interfaces == (49 if start == "half" else 48)


def test_wall_21_is_a_member_of_its_family() -> None:
    shipped = read_case(ROOT / "wall-21").assembly
    member = build(families.wall_21()).assembly
    assert np.array_equal(shipped.end1, member.end1)
    assert np.array_equal(shipped.live, member.live)


def test_family_refuses_a_brick_without_length() -> None:
    with pytest.raises(ValueError, match="greater than zero"):
        families.wall_21(0.0)


def test_matera_arrangement_of_bonding_stones_multiplies_the_capacity() -> None:
    poor, loaded, good = (
        associated_maximum(build(matera.matera_wall(masonry, "")).assembly)
        for masonry in (matera.POOR, matera.LOADED, matera.GOOD)
    )
    assert poor is not None
    assert loaded is not None
    assert good is not None
    assert len(matera.POOR.bonds) == len(matera.GOOD.bonds)
    assert loaded > 3.0 * poor
    assert good > 4.0 * poor


def test_matera_vault_is_partly_dead_and_partly_live() -> None:
    built = build(matera.matera_wall(matera.POOR, ""))
    assembly = built.assembly
    vault = np.array(["vault" in block.groups for block in built.wall.blocks])
    wall = np.array(["wall" in block.groups for block in built.wall.blocks])
    assert np.allclose(assembly.dead[vault, 1], -matera.DEAD_PART * assembly.weight[vault])
    assert np.allclose(assembly.live[vault, 1], -assembly.weight[vault])
    assert np.allclose(assembly.dead[wall & ~assembly.fixed, 1], -assembly.weight[wall & ~assembly.fixed])
    assert not assembly.live[wall].any()


def test_matera_half_vault_is_half_of_the_full_one() -> None:
    half = associated_maximum(build(matera.matera_wall(matera.GOOD, "")).assembly)
    full = associated_maximum(build(matera.matera_wall(matera.GOOD, "", full=True)).assembly)
    assert half == pytest.approx(full, rel=1e-7)


def test_matera_full_vault_is_symmetric() -> None:
    assembly = build(matera.matera_wall(matera.GOOD, "", full=True)).assembly
    middle = 0.5 * matera.SPAN + matera.GOOD.thickness
    mirrored = np.sort(2 * middle - assembly.centroid[assembly.free, 0])
    assert np.allclose(np.sort(assembly.centroid[assembly.free, 0]), mirrored)


def test_matera_span_and_thickness_are_those_of_the_paper() -> None:
    assembly = build(matera.matera_wall(matera.GOOD, "", full=True)).assembly
    first, last = (assembly.block_ids.index(name) for name in ("vault-v1", "vault-v24"))
    left, right = (assembly.polygons[k] for k in (first, last))
    # The innermost points of the two springings.
    assert right[np.argmin(right[:, 1]), 0] - left[np.argmin(left[:, 1]), 0] == pytest.approx(6.0, abs=1e-9)
    assert matera.VAULT_THICKNESS == 0.25


def test_matera_short_bonding_stones_reach_in_from_both_faces_by_turns() -> None:
    masonry = dataclasses.replace(matera.GOOD, bond_length=0.71)
    first, second = (matera.course_widths(masonry, masonry.bonds[k]) for k in (0, 1))
    assert first[0] == 0.71
    assert second == first[::-1]
    assert sum(abs(width) for width in first) == pytest.approx(masonry.thickness)
    build(matera.matera_wall(masonry, ""))


@pytest.mark.parametrize("seed", range(5))
def test_irregular_wall_builds_for_any_seed(seed: int) -> None:
    first, second = (useful.irregular_stones(seed=seed) for _ in range(2))
    assert first == second
    assert build(first).warnings == ()


def test_written_wall_reads_back_as_the_same_wall() -> None:
    for recipe in useful.recipes():
        assert parse_wall(json.loads(wall_text(recipe.wall)), recipe.file.id) == recipe.wall
