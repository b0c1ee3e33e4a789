"""Requirements on measured mechanisms: in the wall's units, whatever those are, and the motion that theory gives."""

from __future__ import annotations

import copy

import numpy as np
import pytest

from harness.engine.judge import answered, judge
from harness.model.build import build
from harness.model.method import Method
from harness.model.method_registry import load_method, prepared
from harness.model.wall import Wall
from reports.findings.agreement import measure_of, velocity_cosine
from tests.walls import assembly, running_bond, stack, wall_data

MEASURED = ["de", "de-mujoco", "de-soft", "de-tilt"]
SIZES = ("width", "height", "block_length", "block_height")


def ready(name: str) -> Method:
    """The method, with all that it needs."""
    if name == "de-mujoco":
        pytest.importorskip("mujoco", reason="it is large; `.ci/extras` runs this test")
    return prepared(load_method(name))


def rocking_stack(wall, courses, width, height):
    """Rotation, as one, of the blocks of a stack from a course up about the right end of its base."""
    motion = np.zeros((wall.n_blocks, 3))
    base = np.array([wall.centroid[:, 0].mean() + 0.5 * width, wall.centroid[wall.free, 1].min() - 0.5 * height])
    arm = wall.centroid - base
    motion[:, 0], motion[:, 1], motion[:, 2] = arm[:, 1], -arm[:, 0], -1.0
    motion[wall.fixed] = 0.0
    return motion


@pytest.mark.parametrize("method", MEASURED)
@pytest.mark.parametrize(("courses", "width", "height"), [(1, 0.2, 0.5), (3, 0.3, 0.2), (4, 30.0, 20.0)])
def test_a_stack_rocks_about_the_end_of_its_base(method, courses, width, height):
    wall = assembly(stack(courses, width, height), 0.9)
    result, judged = answered(ready(method), wall)
    assert judged.accepted, judged.sentence
    # Closed form: a stack tips as one at width / height.
    assert result.multiplier == pytest.approx(width / (courses * height), rel=3e-3)  # accuracy stated for brackets
    expected = rocking_stack(wall, courses, width, height)
    cosine = velocity_cosine(measure_of(wall), np.array(result.mechanism), expected)
    assert cosine is not None
    assert cosine > 0.999


def test_a_wall_moves_as_finite_elements_say():
    """Friction so high that no joint slides: one mechanism, of which the multiplier leaves no choice."""
    wall = assembly(running_bond(4, 2), 1.5)
    measured, _ = answered(prepared(load_method("de")), wall)
    other, _ = answered(prepared(load_method("fe")), wall)
    cosine = velocity_cosine(measure_of(wall), np.array(measured.mechanism), np.array(other.mechanism))
    assert cosine is not None
    assert cosine > 0.999


def scaled(data, factor):
    """A wall of a pattern in another unit of length."""
    other = copy.deepcopy(data)
    for name in SIZES:
        if name in other["pattern"]:
            other["pattern"][name] *= factor
    return build(Wall.model_validate(other)).assembly


@pytest.mark.parametrize(
    ("method", "pattern"),
    [*((name, stack(3)) for name in MEASURED), ("de", running_bond(3, 2))],
    ids=[*MEASURED, "bond"],
)
def test_the_unit_of_length_changes_rotations_alone(method, pattern):
    data, solver = wall_data(pattern), ready(method)
    mean, _ = answered(solver, scaled(data, 1.0))
    for factor in (0.1, 10.0):
        wall = scaled(data, factor)
        other, judged = answered(solver, wall)
        assert judged.accepted, judged.sentence
        # Within rounding the same search; displacements of `de-soft` and contacts of MuJoCo differ by their creep.
        assert np.array(other.mechanism) * [1.0, 1.0, factor] == pytest.approx(np.array(mean.mechanism), abs=1e-3)
        if method == "de-tilt":
            frames = np.array(other.details["release"]["frames"]) / [factor, factor, 1.0]
            assert frames == pytest.approx(np.array(mean.details["release"]["frames"]), abs=1e-5)
        if method in ("de", "de-mujoco"):
            wrong = np.array(other.mechanism) * [1.0, 1.0, wall.length_scale]
            off = other.model_copy(update={"mechanism": wrong.tolist()})
            assert judge(wall, off, solver.tolerance).accepted is False


@pytest.mark.parametrize("method", ["de", "de-mujoco"])
def test_a_fall_is_measured_with_its_forces(method):
    wall = assembly(stack(3) | {"offsets": [0.0, 0.0, 0.2]}, 0.7)
    result, judged = answered(ready(method), wall)
    assert judged.accepted, judged.sentence
    assert judged.residuals["motion_opening"] < 1e-3  # MuJoCo's contacts give way a little
    wrong = np.array(result.mechanism) * [1.0, 1.0, wall.length_scale]
    assert judge(wall, result.model_copy(update={"mechanism": wrong.tolist()}), 1e-4).accepted is False
