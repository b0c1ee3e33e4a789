"""Margins of joints and reactions of supports, held to the statics of one block and to equilibrium of whole walls."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import meshio
import numpy as np
import pytest

import drystone
from harness.formats.paraview import write_vtu
from harness.model.assembly import Assembly, FloatArray
from harness.model.build import Built, build
from harness.model.joint_margins import ANSWERED, JOINTS, JointMargins, joint_margins, joint_rows
from harness.model.result import Result
from harness.model.support_reactions import REACTIONS, out_of_balance, reactions_of, support_reactions
from harness.model.table import in_units, units
from harness.model.wall import Wall
from tests.commands import drystone as command
from tests.walls import case, stack, wall_data

WIDTH, HEIGHT, FRICTION = 0.3, 0.2, 0.65
WEIGHT = 20.0 * WIDTH * HEIGHT
PUSH = 0.6


def block(push: float = PUSH, lift: float = 0.0, friction: Any = FRICTION, **more: Any) -> Built:
    """One block on a fixed one, pushed at its centroid and lifted."""
    dead = {"body": [{"per_weight": [push / WEIGHT, lift / WEIGHT]}]}
    data = wall_data(stack(1, WIDTH, HEIGHT), friction, loads={"gravity": True, "dead": dead}, **more)
    return build(Wall.model_validate(data))


def forces_of(assembly: Assembly) -> FloatArray:
    """The forces in the one joint of one block, which equilibrium determines."""
    dead, _ = assembly.free_loads()
    return np.linalg.solve(assembly.kinematic_matrix.T.toarray(), -dead).reshape(1, 3)


def margins_of(built: Built) -> JointMargins:
    return joint_margins(built.assembly, built.joint_thickness, forces_of(built.assembly))


def test_a_pushed_block_uses_of_its_joint_what_statics_says():
    found = margins_of(block())
    eccentricity = PUSH * HEIGHT / (2.0 * WEIGHT)
    assert found.normal == pytest.approx(WEIGHT)
    assert abs(found.shear) == pytest.approx(PUSH)
    assert abs(found.eccentricity) == pytest.approx(eccentricity)
    assert found.shear_utilisation == pytest.approx(PUSH / (FRICTION * WEIGHT))
    assert found.eccentricity_utilisation == pytest.approx(2.0 * eccentricity / WIDTH)
    assert found.edge_stress == pytest.approx(WEIGHT / (1.0 * (WIDTH - 2.0 * eccentricity)))
    assert found.utilisation == pytest.approx(PUSH / (FRICTION * WEIGHT))


def test_eccentricity_is_towards_the_end_to_which_the_block_is_pushed():
    built = block()
    assembly, (e,) = built.assembly, margins_of(built).eccentricity
    middle = 0.5 * (assembly.end1[0] + assembly.end2[0])
    place = middle + e * assembly.tangent[0]
    assert place[0] - assembly.centroid[~assembly.fixed][0, 0] == pytest.approx(PUSH * HEIGHT / (2.0 * WEIGHT))


@pytest.mark.parametrize("thickness", [0.25, 2.0])
def test_edge_stress_does_not_depend_on_the_thickness_that_also_carries_the_weight(thickness: float):
    found = margins_of(block(thickness=thickness))
    assert found.thickness == pytest.approx(thickness)
    assert found.normal == pytest.approx(thickness * WEIGHT)
    assert found.edge_stress == pytest.approx(margins_of(block()).edge_stress[0])


def test_the_explicit_form_keeps_the_thickness_of_blocks():
    outlines = {"ground": [[0, 0], [1, 0], [1, 0.5], [0, 0.5]], "cap": [[0, 0.5], [1, 0.5], [1, 0.7], [0, 0.7]]}
    blocks = [{"id": name, "polygon": outline, "fixed": name == "ground"} for name, outline in outlines.items()]
    blocks[1]["thickness"] = 0.2
    wall = {"format": "wall/1", "unit_weight": 20.0, "friction": 0.5, "thickness": 0.5, "blocks": blocks}
    built = build(Wall.model_validate(wall))
    assert built.joint_thickness == pytest.approx([0.2])
    assert build(built.wall).joint_thickness == pytest.approx([0.2])


def test_contact_points_set_in_shorten_the_distance_and_not_the_face():
    found = margins_of(block(contact_inset={"length": 0.03}))
    eccentricity = PUSH * HEIGHT / (2.0 * WEIGHT)
    assert abs(found.eccentricity) == pytest.approx(eccentricity)
    assert found.eccentricity_utilisation == pytest.approx(2.0 * eccentricity / (WIDTH - 0.06))
    assert found.edge_stress == pytest.approx(WEIGHT / (WIDTH - 2.0 * eccentricity))


def test_cohesion_and_tensile_strength_leave_more():
    cohesion, tension = 4.0, 2.0
    found = margins_of(block(cohesion=cohesion, tensile_strength=tension))
    moment, strength = PUSH * HEIGHT / 2.0, tension * WIDTH
    assert found.shear_utilisation == pytest.approx(PUSH / (FRICTION * WEIGHT + cohesion * WIDTH))
    assert found.eccentricity_utilisation == pytest.approx((2.0 * moment / WIDTH) / (WEIGHT + strength))
    # The push under which an end is about to open uses all of it: n = N / 2 - M / b = -T / 2.
    limit = (WEIGHT + strength) * WIDTH / HEIGHT
    all_used = margins_of(block(push=limit, cohesion=100.0, tensile_strength=tension))
    assert all_used.eccentricity_utilisation == pytest.approx(1.0)
    assert np.isnan(all_used.edge_stress), "the resultant lies outside the joint"


def test_a_joint_that_is_crushed_evenly_has_used_all_of_its_strength():
    """A block of 4 kN that 6 kN press besides crushes its joint of 10 kN/m2 on 1 m2; it was called closed."""
    made = case(stack(1, 1.0, 0.2), 0.6, loads={"live": {"body": [{"per_weight": [0, -1]}]}}, compressive_strength=10.0)
    result = drystone.analyse(drystone.Wall(made), "la-associated")
    assert result.multiplier == pytest.approx(1.5)
    (row,) = joint_rows(made, result)
    assert (row.number("utilisation"), row.state) == (pytest.approx(1.0), "at its limit")
    assert row.number("edge_stress") == pytest.approx(10.0)


@pytest.mark.parametrize("push", [0.1, 0.3, 0.5])
def test_tension_on_the_rest_of_the_face_relieves_its_edge(push: float):
    """sigma w - f_t (L - w) = N and sigma w (L - w) / 2 + f_t w (L - w) / 2 = M; the edge stood at 7 f_c, uncrushed."""
    tension, strength = 2.0, 200.0
    joint = block(push=push, cohesion=100.0, tensile_strength=tension, compressive_strength=strength)
    found = margins_of(joint)
    stress = float(found.edge_stress[0])
    width = (WEIGHT + tension * WIDTH) / (stress + tension)
    moment = 0.5 * (stress + tension) * width * (WIDTH - width)
    assert moment == pytest.approx(push * HEIGHT / 2.0)
    assert found.crushing_utilisation == pytest.approx((stress + tension) / (strength + tension))
    assert stress < strength


@pytest.mark.parametrize("push", [0.0, 0.02, 0.05])
def test_a_joint_uses_of_its_compressive_strength_what_its_edge_stress_is(push: float):
    """Pressed evenly to nine tenths it stood last, at utilisation 0."""
    strength = WEIGHT / (0.9 * WIDTH)
    found = margins_of(block(push=push, compressive_strength=strength))
    assert found.crushing_utilisation == pytest.approx(found.edge_stress / strength)
    assert found.utilisation == pytest.approx(found.crushing_utilisation)
    dry = margins_of(block(push=push))
    assert np.isnan(dry.crushing_utilisation)


def test_broken_joints_have_no_cohesion_left(tmp_path: Path):
    """Glued by c A = 4 the block breaks loose and slides at its friction, all of which it uses then."""
    wall = drystone.build_wall(wall_data(stack(1, WIDTH, 0.2), FRICTION, cohesion=4.0 / WIDTH, after="residual"))
    result = drystone.analyse(wall, "la")
    assert (result.multiplier, result.details["broken"]) == (pytest.approx(FRICTION), [0])
    (row,) = joint_rows(wall.case, result)
    assert (row.number("shear_utilisation"), row.state) == (pytest.approx(1.0), "slips")
    write_vtu(wall.case.built, result, tmp_path / "w.vtu")
    assert np.nanmax(meshio.read(tmp_path / "w.vtu").cell_data["shear_utilisation"][-1]) == pytest.approx(1.0)


def test_a_joint_in_tension_has_neither_eccentricity_nor_stress_and_its_support_bears_it():
    built = block(push=0.0, lift=WEIGHT + 0.3, cohesion=4.0, tensile_strength=2.0)
    found = margins_of(built)
    assert found.normal == pytest.approx(-0.3)
    assert np.isnan(found.eccentricity)
    assert np.isnan(found.edge_stress)
    assert found.eccentricity_utilisation == pytest.approx(0.0, abs=1e-9)
    (reaction,) = support_reactions(built.assembly, forces_of(built.assembly))
    assert reaction.fy == pytest.approx(-0.3)
    assert out_of_balance(built.assembly, [reaction], 0.0) < 1e-12


@pytest.mark.parametrize("name", ["wall-21", "single-block", "arch-wheel-5", "opening-lintel", "couplet-shears"])
def test_sums_that_cancel_are_zero_and_not_their_rounding(name: str):
    """A moment read 3.55e-15 and an eccentricity -8.3e-17."""
    wall = drystone.library_wall(name)
    result = drystone.analyse(wall, "la-associated")
    assembly, forces = wall.assembly, np.array(result.forces)
    reactions = np.array([(r.fx, r.fy, r.moment) for r in support_reactions(assembly, forces)])
    units = assembly.force_scale * np.array([1.0, 1.0, assembly.length_scale])
    eccentricity = joint_margins(assembly, np.ones(assembly.n_interfaces), forces).eccentricity
    for value, unit in ((reactions, units), (eccentricity, assembly.length)):
        assert ((value == 0.0) | np.isnan(value) | (abs(value) > 1e-14 * unit)).all()


def test_reaction_of_a_pushed_block():
    built = block()
    assembly = built.assembly
    (reaction,) = support_reactions(assembly, forces_of(assembly))
    top, centre = assembly.end1[0, 1], assembly.centroid[~assembly.fixed][0, 0]
    (support,) = assembly.centroid[assembly.fixed]
    assert (reaction.fx, reaction.fy) == (pytest.approx(-PUSH), pytest.approx(WEIGHT))
    x = centre + PUSH * HEIGHT / (2.0 * WEIGHT)
    assert (reaction.x, reaction.y) == (pytest.approx(x), pytest.approx(top))
    assert reaction.moment == pytest.approx((x - support[0]) * WEIGHT + (top - support[1]) * PUSH)


@pytest.mark.parametrize("name", ["wall-21", "portal", "borri-arch-13"])
def test_reactions_balance_the_loads_in_force_and_moment(name: str):
    wall = drystone.library_wall(name)
    result = drystone.analyse(wall, "la-associated")
    assembly, listed = wall.assembly, reactions_of(wall.case, result)
    assert result.forces_multiplier is not None
    assert out_of_balance(assembly, listed, result.forces_multiplier) < 1e-9
    loads = (assembly.dead + result.forces_multiplier * assembly.live)[assembly.free]
    places = assembly.centroid[assembly.free]
    moment = float((loads[:, 2] + places[:, 0] * loads[:, 1] - places[:, 1] * loads[:, 0]).sum())
    at = {support: assembly.centroid[k] for k, support in enumerate(assembly.block_ids)}
    for reaction in listed:
        x, y = at[reaction.support]
        moment += reaction.moment + x * reaction.fy - y * reaction.fx
        assert reaction.x is not None
        assert reaction.y is not None
        through = (reaction.x - x) * reaction.fy - (reaction.y - y) * reaction.fx
        assert through == pytest.approx(reaction.moment, abs=1e-9 * assembly.force_scale)
    assert moment == pytest.approx(0.0, abs=1e-8 * assembly.force_scale)


def analysed(friction: float, method: str, count: int = 2) -> tuple[Any, Result]:
    wall = drystone.new_wall("stack", count=count, width=WIDTH, height=HEIGHT, friction=friction)
    return wall.case, drystone.analyse(wall, method)


@pytest.mark.parametrize("method", ["la", "la-associated"])
def test_a_stack_that_slides_slips_in_one_joint_and_uses_all_friction_in_all(method: str):
    made, result = analysed(0.3, method)
    rows = joint_rows(made, result)
    assert [row.number("shear_utilisation") for row in rows] == pytest.approx([1.0, 1.0])
    assert rows[0].state == "slips"
    assert {row.state for row in rows} <= {"slips", "at its limit"}


def test_a_stack_that_topples_opens_in_its_lowest_joint_which_stands_first():
    made, result = analysed(0.9, "la")
    first, second = joint_rows(made, result)
    assert made.assembly.fixed[made.assembly.block_a[first.interface]]
    assert (first.state, second.state) == ("opens", "closed")
    assert first.number("eccentricity_utilisation") == pytest.approx(1.0)
    assert first.number("edge_stress") is None
    assert first.relative_eccentricity == pytest.approx(np.sign(first.relative_eccentricity) * 0.5)
    # Toppling at H = b W / (2 h): the upper block alone has half the eccentricity of the stack on half its height.
    assert second.number("eccentricity_utilisation") == pytest.approx(0.5)


def test_a_measured_motion_gives_no_states():
    made, result = analysed(0.9, "la")
    assert {row.state for row in joint_rows(made, result.model_copy(update={"flow": "approximate"}))} == {
        "at its limit",
        "closed",
    }


def test_joints_that_bear_nothing_stand_last():
    made = case({"type": "running_bond", "block_length": 0.4, "block_height": 0.2, "count": 2, "bricks": 2}, 0.6)
    result = drystone.analyse(drystone.Wall(made), "la")
    forces = np.array(result.forces)
    idle = next(p for p, kind in enumerate(made.assembly.joint) if kind == "head")
    forces[idle] = 0.0
    rows = joint_rows(made, result.model_copy(update={"forces": forces.tolist(), "mechanism": None}))
    states = {row.interface: row.state for row in rows}
    assert states[idle] == "unloaded"
    loaded = [row for row in rows if row.state != "unloaded"]
    assert rows[: len(loaded)] == loaded
    values = [row.number("utilisation") or 0.0 for row in loaded]
    assert min(values) > 0.0
    assert values == pytest.approx(sorted(values, reverse=True))


def test_an_answer_without_forces_has_neither_margins_nor_reactions():
    made, result = analysed(0.9, "la")
    for forces in (None, [(1.0, 1.0, 0.0)]):
        other = result.model_copy(update={"forces": forces})
        assert joint_rows(made, other) == []
        assert reactions_of(made, other) == []


@pytest.mark.parametrize(
    ("force", "length", "moment", "stress"),
    [("kN", "m", "kN m", "kN/m2"), ("1", "1", "1", "1"), ("1", "mm", "mm", "1/mm2"), ("lbf", "1", "lbf", "lbf")],
)
def test_columns_are_in_the_units_of_the_wall(force: str, length: str, moment: str, stress: str):
    assert units(in_units(REACTIONS, force, length))["moment"] == moment
    named = units(in_units(JOINTS, force, length))
    assert (named["normal"], named["eccentricity"], named["edge_stress"]) == (force, length, stress)
    assert named["utilisation"] == "1"


def test_the_package_gives_both_as_tables():
    wall = drystone.new_wall("stack", count=2, width=WIDTH, height=HEIGHT, friction=0.9)
    result = drystone.analyse(wall, "la")
    table = result.joints_to_pandas()
    assert list(table.columns) == [column.name for column in ANSWERED]
    assert table.attrs["units"]["edge_stress"] == "kN/m2"
    assert table["state"].tolist() == ["opens", "closed"]
    assert table["normal"].tolist() == pytest.approx([2.0 * table["normal"][1], table["normal"][1]])
    reactions = result.reactions_to_pandas()
    assert reactions["fy"].sum() == pytest.approx(wall.assembly.weight[wall.assembly.free].sum())
    assert reactions.attrs["units"]["moment"] == "kN m"


def test_the_command_prints_both(tmp_path: Path):
    (tmp_path / "w.json").write_text(json.dumps(wall_data(stack(2, WIDTH, HEIGHT), 0.9)))
    done = command("run", "la", "w.json", "--joints", "--json", cwd=tmp_path)
    told = json.loads(done.stdout)
    (reaction,) = told["reactions"]
    assert reaction["fy"] == pytest.approx(2.0 * WEIGHT)
    assert reaction["fx"] == pytest.approx(-told["multiplier"] * 2.0 * WEIGHT)
    assert [list(joint) for joint in told["joints"]] == [[column.name for column in JOINTS]] * 2
    assert [joint["state"] for joint in told["joints"]] == ["opens", "closed"]
    done = command("run", "la", "w.json", "--joints", cwd=tmp_path)
    assert f"{reaction['support']}: Fx -1.8 kN, Fy 2.4 kN, moment" in done.stdout
    assert "edge stress [kN/m2]" in done.stdout


def test_paraview_gets_the_margins(tmp_path: Path):
    made, result = analysed(0.9, "la")
    write_vtu(made.built, result, tmp_path / "w.vtu")
    mesh = meshio.read(tmp_path / "w.vtu")
    lines = next(number for number, cells in enumerate(mesh.cells) if cells.type == "line")
    margins = joint_margins(made.assembly, made.built.joint_thickness, np.array(result.forces))
    for name in (
        *("eccentricity", "shear_utilisation", "eccentricity_utilisation", "crushing_utilisation"),
        "edge_stress",
    ):
        assert np.array_equal(mesh.cell_data[name][lines], getattr(margins, name), equal_nan=True), name
    write_vtu(made.built, None, tmp_path / "bare.vtu")
    bare = meshio.read(tmp_path / "bare.vtu")
    assert np.isnan(bare.cell_data["shear_utilisation"][lines]).all()
