"""The load steps of `fe` as ParaView gets them: read again by meshio, and held to equilibrium and to the joint law."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import meshio
import numpy as np
import pytest
from click.testing import CliRunner

from drystone.cli.main import main
from harness.formats.registry import BY_SUFFIX
from harness.model.assembly import Assembly
from harness.model.build import build
from harness.model.load_steps import STATES, UNKNOWN, LoadSteps
from harness.model.method import Answer
from harness.model.method_registry import load_method
from harness.model.reading import parse_wall
from harness.model.result import Result, result_of
from methods.fe.settings import GapSpringsSettings
from methods.springs.path.path_record import PathRecord, PathStep
from tests.walls import beside, running_bond, wall_data

STEPS = 12
WALL = parse_wall(wall_data(running_bond(6, 3)), "bricks")


def answered(assembly: Assembly, steps: int = STEPS) -> Answer:
    return load_method("fe").solve(assembly, GapSpringsSettings(load_steps=steps))


@pytest.fixture(scope="module")
def result() -> Result:
    assembly = build(WALL).assembly
    return result_of(answered(assembly), assembly, case="bricks", method="fe", family="fe")


def series(path: Path) -> list[tuple[float, meshio.Mesh]]:
    rows = ElementTree.parse(path).getroot().findall(".//DataSet")
    return [(float(row.attrib["timestep"]), meshio.read(path.parent / row.attrib["file"])) for row in rows]


def of_joints(mesh: meshio.Mesh, name: str) -> Any:
    lines = next(number for number, block in enumerate(mesh.cells) if block.type == "line")
    return mesh.cell_data[name][lines]


def test_each_step_is_in_equilibrium_at_its_multiplier_up_to_the_plateau(result: Result, tmp_path: Path) -> None:
    built = build(WALL)
    assembly = built.assembly
    BY_SUFFIX[".pvd"].write(built, result, tmp_path / "w.pvd")
    read = series(tmp_path / "w.pvd")
    assert [time for time, _ in read] == list(range(STEPS))
    multipliers = [float(of_joints(mesh, "multiplier")[0]) for _, mesh in read]
    assert multipliers[0] == 0.0
    assert multipliers[-1] == pytest.approx(result.multiplier, rel=1e-9)
    dead, live = assembly.free_loads()
    for multiplier, (_, mesh) in zip(multipliers, read, strict=True):
        forces = np.column_stack([of_joints(mesh, name) for name in ("n1", "n2", "s")])
        left = assembly.kinematic_matrix.T @ forces.ravel() + dead + multiplier * live
        assert np.abs(left).max() < 1e-9 * assembly.force_scale


def test_states_of_joints_are_those_of_their_forces(result: Result, tmp_path: Path) -> None:
    built = build(WALL)
    BY_SUFFIX[".pvd"].write(built, result, tmp_path / "w.pvd")
    seen = set()
    small = 1e-9 * built.assembly.force_scale
    for _, mesh in series(tmp_path / "w.pvd"):
        n1, n2, s, friction = (of_joints(mesh, name) for name in ("n1", "n2", "s", "friction"))
        strength = friction * (n1 + n2)
        for k, state in enumerate(of_joints(mesh, "state").tolist()):
            name = STATES[state]
            seen.add(name)
            assert abs(s[k]) <= strength[k] + small
            if name == "open":
                assert max(abs(n1[k]), abs(n2[k]), abs(s[k])) <= small
            if name == "rock":
                assert min(abs(n1[k]), abs(n2[k])) <= small
            if name == "slip":
                assert abs(s[k]) == pytest.approx(strength[k], abs=small)
    assert {"stick", "slip", "rock", "open"} == seen


def test_blocks_move_by_what_presses_their_joints(result: Result, tmp_path: Path) -> None:
    # The springs of a joint that is pressed at both ends shorten by its forces over their stiffness, the same for all.
    built = build(WALL)
    assembly = built.assembly
    steps = LoadSteps.of(result.details, assembly)
    assert steps is not None
    stiffness = set()
    for motion, forces, states in zip(steps.displacements, steps.forces, steps.states, strict=True):
        opening = (assembly.kinematic_matrix @ motion[assembly.free].ravel()).reshape(-1, 3)[:, :2]
        pressed = np.isin(states, [STATES.index("stick"), STATES.index("slip")])
        pressed &= forces[:, :2].min(axis=1) > 1e-3 * assembly.force_scale / assembly.n_free
        stiffness |= set(np.round(np.log(-forces[pressed, :2] / opening[pressed]).ravel(), 6))
    assert len(stiffness) == 1
    BY_SUFFIX[".pvd"].write(built, result, tmp_path / "w.pvd")
    _, last = series(tmp_path / "w.pvd")[-1]
    fastest = np.linalg.norm(last.point_data["displacement"], axis=1).max()
    assert np.abs(steps.displacements[-1, :, :2]).max() < 2.0 * fastest


def test_a_component_beside_the_one_that_fails_is_in_no_known_state() -> None:
    alone = build(WALL).assembly
    assembly = beside(alone, 1.0)
    own, both = (LoadSteps.of(answered(wall).details, wall) for wall in (alone, assembly))
    assert own is not None
    assert both is not None
    assert both.blocks == assembly.block_ids
    assert np.array_equal(both.forces[:, : alone.n_interfaces], own.forces)
    assert (both.states[:, alone.n_interfaces :] == UNKNOWN).all()
    assert not both.displacements[:, alone.n_blocks :].any()


def test_steps_of_another_wall_are_not_shown(result: Result) -> None:
    assert LoadSteps.of(result.details, build(parse_wall(wall_data(running_bond(6, 4)), "w")).assembly) is None


def test_no_steps_are_kept_unasked() -> None:
    assert "load_steps" not in answered(build(WALL).assembly, 0).details


@pytest.mark.parametrize("count", [1, 7, 50, 5000])
def test_steps_are_spread_evenly_however_many_there_are(count: int) -> None:
    record, none = PathRecord(most=10), np.zeros(0)
    for k in range(count):
        record.keep(lambda k=k: PathStep(float(k), none, none, none, none))  # type: ignore[misc]
    kept = [step.multiplier for step in record.steps]
    assert min(count, 10) <= len(kept) <= 20
    assert kept[0] == 0.0
    assert len(set(np.diff(kept))) <= 1
    assert kept[-1] > 0.9 * (count - 1) - 1


def test_export_of_fe_to_a_series_asks_for_its_load_steps(tmp_path: Path) -> None:
    wall = tmp_path / "bricks.json"
    wall.write_text(json.dumps(wall_data(running_bond(4, 2))))
    out = tmp_path / "w.pvd"
    said = ["export", str(wall), "--method", "fe", "--store", str(tmp_path / "s.sqlite"), "-o", str(out)]
    done = CliRunner().invoke(main, [*said, "--set", "load_steps=5"])
    assert done.exit_code == 0, done.output
    assert len(series(out)) == 5
    done = CliRunner().invoke(main, said)
    assert done.exit_code == 0, done.output
    assert 5 < len(series(out)) <= 50
