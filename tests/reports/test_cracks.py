"""The crack pattern of a mechanism: the area between the faces of joints that open, and of no other."""

from __future__ import annotations

import numpy as np
import pytest
import shapely

from harness.model.case import Case
from harness.model.result import Result, relative_velocities
from reports.drawing.display_list import DisplayList, Frame, Polygons
from reports.drawing.mechanism_drawing import loaded_mechanism, moved_wall
from reports.findings.joints import ROCK, SLIDE, joint_states
from reports.geometry import shapes
from tests.reports import samples
from tests.walls import case as wall_case
from tests.walls import running_bond, stack


def cracks_of(drawn: DisplayList) -> tuple[list[shapely.Polygon], list[np.ndarray]]:
    parts = [part for part in drawn.parts if isinstance(part, Polygons) and part.role == "crack"]
    assert len(parts) <= 1
    outlines = [shapely.Polygon(outline) for part in parts for outline in part.outlines]
    return outlines, [line for part in parts for line in part.rest]


def moved(pattern: dict[str, object], motion: dict[int, tuple[float, float, float]]) -> tuple[Case, Result]:
    """A case with a result in which some of its blocks move."""
    case = wall_case(pattern)
    velocities = np.zeros((case.assembly.n_blocks, 3))
    for block, velocity in motion.items():
        velocities[int(case.assembly.free[block])] = velocity
    result = samples.solved(case, "la", 0.5).model_copy(update={"mechanism": [tuple(v) for v in velocities.tolist()]})
    return case, result


def test_block_that_rocks_opens_a_triangle_as_large_as_its_rotation_says():
    case, result = moved(stack(1), {})
    assembly = case.assembly
    p = 0
    free = int(assembly.free[0])
    arm = assembly.centroid[free] - assembly.end2[p]
    turn = -1.0 if assembly.end2[p, 0] > assembly.end1[p, 0] else 1.0
    velocities = np.zeros((assembly.n_blocks, 3))
    velocities[free] = (-turn * arm[1], turn * arm[0], turn)
    result = result.model_copy(update={"mechanism": [tuple(v) for v in velocities.tolist()]})
    assert joint_states(assembly, result) == [ROCK]
    scale = 0.1
    (crack,), (rest,) = cracks_of(moved_wall(assembly, result, scale))
    length = float(np.linalg.norm(assembly.end2[p] - assembly.end1[p]))
    frame = Frame.of(assembly)
    assert crack.area == pytest.approx(0.5 * length * scale * length * frame.scale**2, rel=1e-9)
    np.testing.assert_allclose(rest, frame.place(np.array([assembly.end1[p], assembly.end2[p]])))


def test_block_that_slides_opens_no_crack():
    case, result = moved(stack(1), {0: (1.0, 0.0, 0.0)})
    assert joint_states(case.assembly, result) == [SLIDE]
    assert cracks_of(moved_wall(case.assembly, result)) == ([], [])


def test_cracks_lie_between_the_blocks_and_are_as_wide_as_their_joints_open():
    case, result = moved(running_bond(3, 3), {k: (0.3 + 0.1 * k, 0.2 * k, 0.0) for k in range(9)})
    assembly, scale = case.assembly, 0.05
    opening, _ = relative_velocities(assembly, np.asarray(result.mechanism))
    cracks, rest = cracks_of(moved_wall(assembly, result, scale))
    states = np.array(joint_states(assembly, result))
    opened = np.flatnonzero(~np.isin(states, ("stick", "slide")))
    assert len(cracks) == len(rest) == len(opened) > 3
    frame = Frame.of(assembly)
    blocks = [shapely.Polygon(frame.place(p)) for p in shapes.displaced(assembly, np.asarray(result.mechanism), scale)]
    for crack, p in zip(cracks, opened, strict=True):
        length = float(np.linalg.norm(assembly.end2[p] - assembly.end1[p]))
        assert crack.area == pytest.approx(opening[p].mean() * scale * length * frame.scale**2, rel=1e-6)
        for block in (assembly.block_a[p], assembly.block_b[p]):
            assert crack.intersection(blocks[block]).area < 1e-6 * crack.area
    still, _ = cracks_of(loaded_mechanism(case, result))
    assert len(still) == len(cracks)
