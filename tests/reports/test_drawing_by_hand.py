"""Drawings of the paper's block against coordinates worked out by hand, in units of which its length has 4000.

The block is 1 long and .5 high on two supports .2 high that meet in its middle: 4000 x 2800 units with the corner
(0, 0) at the upper left, so that the block reaches down to y = 2000. Its size, the root of its area, is 2828 units.
"""

from __future__ import annotations

from typing import TypeVar

import numpy as np
import pytest

from drystone.walls import build_wall
from harness.model.case import Case
from harness.model.result import Result
from reports.drawing.display_list import Arrows, Circles, DisplayList, Group, Lines, Polygons, Shape, Text
from reports.drawing.force_drawing import force_drawing
from reports.drawing.mechanism_drawing import loaded_mechanism, mechanism_drawing, overlay_drawing
from reports.drawing.wall_drawing import displaced_drawing, wall_drawing
from tests.reports import samples
from tests.walls import case as wall_case
from tests.walls import stack

Kind = TypeVar("Kind", bound=Shape)
SIZE = 4000 * 0.5**0.5
BLOCK = [[0, 2000], [4000, 2000], [4000, 0], [0, 0]]
LEFT, RIGHT = (
    [[0, 2800], [2000, 2800], [2000, 2000], [0, 2000]],
    [[2000, 2800], [4000, 2800], [4000, 2000], [2000, 2000]],
)
REAR, FRONT = [[2000, 2000], [0, 2000]], [[4000, 2000], [2000, 2000]]


def shapes_of(drawn: DisplayList, kind: type[Kind], role: str = "") -> list[Kind]:
    """Shapes of a kind and role, also those in groups, before their motion."""
    every = [shape for part in drawn.parts for shape in (part.parts if isinstance(part, Group) else (part,))]
    return [shape for shape in every if isinstance(shape, kind) and (not role or shape.role == role)]


def close(found: object, expected: object, within: float = 1e-6) -> None:
    np.testing.assert_allclose(np.array(found, dtype=float), np.array(expected, dtype=float), atol=within)


def answered(mechanism: list[float], forces: list[tuple[float, float, float]], **more: object) -> tuple[Case, Result]:
    """The block with a motion of its own and the forces (n1, n2, s) of its two joints; ends 1 are the right ones."""
    case = samples.block()
    field = [(0.0, 0.0, 0.0), (0.0, 0.0, 0.0), tuple(mechanism)]
    return case, samples.solved(case, "la", 0.4).model_copy(update={"mechanism": field, "forces": forces, **more})


def test_the_wall_is_drawn_as_it_stands_with_names_load_and_scale():
    drawn = wall_drawing(samples.block())
    assert drawn.frame.box == (-560, -560, 4000 + 2 * 560, 2800 + 560 + 240)
    held, stone = shapes_of(drawn, Polygons)
    assert (held.role, stone.role) == ("held", "stone")
    close(held.outlines, [LEFT, RIGHT])
    close(stone.outlines, [BLOCK])
    joints, contacts, scale = shapes_of(drawn, Lines)
    close(joints.points, [REAR, FRONT])
    close(contacts.points, [[[x, 2000]] * 2 for x in (0, 2000, 4000)])
    left, right, block, length = shapes_of(drawn, Text)
    assert [text.text for text in (left, right, block)] == ["left", "right", "block"]
    assert [text.size for text in (left, right, block)] == [170.0] * 3
    close([left.at, right.at], [(1000, 2400 + 0.35 * 170), (3000, 2400 + 0.35 * 170)])
    close(block.at, (2000, 1000 - 0.22 * 170))  # above the arrow
    (load,) = shapes_of(drawn, Arrows)
    close([load.tails[0], load.tips[0]], [(2000, 1000), (2420, 1000)])
    assert (load.role, load.heads.tolist()) == ("live", [90.0])
    # A fifth of a metre is the roundest length below three tenths of the wall's.
    close(scale.points[0], [[0, 2920], [800, 2920]])
    close(scale.points[1:], [[[x, 2880], [x, 2960]] for x in (0, 800)])
    assert (length.text, length.anchor) == ("0.2 m", "start")
    close(length.at, (860, 2920 + 0.35 * 150))


def test_a_slender_wall_has_its_scales_one_above_the_other_and_smaller_letters():
    """Blocks of .5 x .1 on their ends. A letter is .55 of its size wide, and a name fits into the slender block."""
    case = wall_case(stack(9, width=0.1, height=0.5))
    drawn = wall_drawing(case)
    extent = drawn.frame.extent
    assert drawn.frame.scale == pytest.approx(4000 / extent.height)
    assert drawn.frame.box[3] == pytest.approx(4000 + 560 + 480)
    free = next(k for k, fixed in enumerate(case.assembly.fixed) if not fixed)
    name = case.assembly.block_ids[free]
    (text,) = (text for text in shapes_of(drawn, Text) if text.title == f"block {name}")
    wide, high = 0.1 * drawn.frame.scale, 0.5 * drawn.frame.scale
    slender = 2 * wide * high / (2 * (wide + high))
    assert text.size == pytest.approx(1.2 * slender / max(1.0, 0.55 * len(text.text)))
    assert text.role == "fine", "too small to read on a page"


def test_loads_are_drawn_by_the_root_of_their_size_where_they_act():
    """4 units of dead load to the right at the top of a block, one unit of live load down on it and 4 on the other."""
    loads = {
        "dead": {"points": [{"block": "1", "at": [0.3, 0.4], "force": [4.0, 0.0]}]},
        "live": {
            "points": [
                {"block": "1", "at": [0.15, 0.3], "force": [0.0, -1.0]},
                {"block": "2", "at": [0.15, 0.5], "force": [0.0, -4.0]},
            ]
        },
    }
    case = wall_case(stack(2), loads=loads)
    frame, block = wall_drawing(case).frame, 4000 * case.assembly.length_scale / 0.6
    dead, live = shapes_of(wall_drawing(case), Arrows)
    longest = min(420.0, max(90.0, 0.8 * block))
    assert frame.block == pytest.approx(block)
    (tail,), (tip,) = frame.back(dead.tails), frame.back(dead.tips)
    assert dead.role == "dead"
    assert tail[1] == tip[1] == pytest.approx(0.4), "in its line of action"
    close(np.linalg.norm(dead.tips - dead.tails, axis=1), [longest])
    close(np.linalg.norm(live.tips - live.tails, axis=1), [longest * (0.35 + 0.65 * 0.5), longest])
    close((live.tips - live.tails)[:, 0], [0.0, 0.0])
    assert ((live.tips - live.tails)[:, 1] > 0.0).all(), "down"
    close(frame.back(live.tails)[:, 0], [0.15, 0.15])


def test_forces_are_arrows_at_their_centres_of_pressure_with_scale_number_and_ring():
    """Rear: 1 kN straight down, a quarter of the joint from its left end. Front: .5 kN in the middle, at the limit."""
    case, result = answered([1.0, 0.0, 0.0], [(0.25, 0.75, 0.0), (0.25, 0.25, 0.2)])
    drawn = force_drawing(case, result, ("forces",))
    rear, front = (part for part in drawn.parts if isinstance(part, Group))
    (arrow,) = rear.parts
    assert isinstance(arrow, Polygons)
    assert (arrow.role, rear.joint, rear.values) == ("force", 0, (0.25, 0.75, 0.0, 0))
    long, width = 2 * 0.36 * SIZE, 0.16 * SIZE
    head = min(1.7 * width, 0.5 * long)
    x, top, neck = 500.0, 2000.0 - long, 2000.0 - head
    outline = [
        (x, 2000.0), (x - 0.4 * head, neck), (x - 0.5 * width, neck), (x - 0.5 * width, top),
        (x + 0.5 * width, top), (x + 0.5 * width, neck), (x + 0.4 * head, neck),
    ]  # fmt: skip
    close(arrow.outlines[0], outline, 0.1)
    second, ring = front.parts
    assert isinstance(second, Polygons)
    assert isinstance(ring, Circles)
    assert (second.role, front.joint, front.values) == ("full", 1, (0.25, 0.25, 0.2, 100))
    share = np.hypot(0.5, 0.2)
    close(ring.centres, [[3000, 2000]])
    assert ring.radius == pytest.approx(max(0.05 * SIZE, 0.5 * 0.16 * share * SIZE + 9))
    close(second.outlines[0][0], (3000, 2000))
    tail = 0.5 * (second.outlines[0][3] + second.outlines[0][4])
    close(np.abs(tail - [3000, 2000]), np.array([0.2, 0.5]) / share * long, 0.1)
    one, other = shapes_of(drawn, Text, "said")
    assert (one.text, other.text, one.size) == ("1", numbers_of(share), 150.0)
    # Beside the upper part of its arrow, as the head reaches up to its middle: half of its width, twice the least
    # distance and half of its letters off.
    beside = 0.5 * width + 24.0 + 0.3 * 150
    close(one.at, (x + beside, 2000 - 0.8 * long + 0.4 * 150), 0.1)
    # The line of the scale is no wider than there is room, .6 of 240 units: of 1 kN it would be 452 wide.
    (line,) = shapes_of(drawn, Lines, "force-scale")
    assert line.width == pytest.approx(0.2 * width)
    close(line.points, [[[3670, 2920], [4000, 2920]]])
    said = shapes_of(drawn, Text)[-1]
    assert said.text == "0.2 kN"
    close(said.at, (4060, 2920 + 0.35 * 150))


def numbers_of(value: float) -> str:
    return f"{value:.3g}"


def test_the_flow_of_forces_runs_from_the_supports_to_where_the_forces_of_a_block_meet():
    case, result = answered([1.0, 0.0, 0.0], [(0.25, 0.75, 0.0), (0.25, 0.25, 0.0)])
    drawn = force_drawing(case, result, ("thrust",))
    rear, front = shapes_of(drawn, Lines, "thrust")
    middle = (0.5 * (500 + 3000), 2000)
    close(rear.points, [[(500, 2000), (500, 2000), middle]])
    close(front.points, [[(3000, 2000), (3000, 2000), middle]])
    assert (rear.width, front.width) == pytest.approx((0.16 * SIZE, 0.08 * SIZE))
    assert shapes_of(drawn, Text, "said") == []


def test_small_forces_are_thin_unnumbered_or_left_out():
    case, result = answered([1.0, 0.0, 0.0], [(0.5, 0.5, 0.0), (0.02, 0.02, 0.0)])
    drawn = force_drawing(case, result)
    assert [text.text for text in shapes_of(drawn, Text, "said")] == ["1"]
    assert [line.width for line in shapes_of(drawn, Lines, "thrust")] == pytest.approx([0.16 * SIZE, 0.02 * SIZE])
    case, result = answered([1.0, 0.0, 0.0], [(0.5, 0.5, 0.0), (9e-4, 9e-4, 0.0)])
    assert len(shapes_of(force_drawing(case, result), Polygons, "force")) == 1


def test_friction_used_is_told_in_whole_percent_of_the_shear_strength():
    case, result = answered([1.0, 0.0, 0.0], [(0.5, 0.5, 0.15), (0.25, 0.25, -0.1999)])
    rear, front = (part for part in force_drawing(case, result).parts if isinstance(part, Group))
    assert (rear.values[-1], front.values[-1]) == (25, 100)
    case, result = answered([1.0, 0.0, 0.0], [(0.5, 0.5, 0.15), (0.25, 0.25, -0.1997)])
    assert [part.values[-1] for part in force_drawing(case, result).parts if isinstance(part, Group)] == [25, 99]


def test_a_mechanism_is_drawn_an_eighth_of_the_wall_large_with_its_cracks_and_hinges():
    """A turn by -1 (clockwise) about the lower right corner (1, 0): the middle (.5, .25) moves by (.25, .5).

    It is drawn a quarter radian large, or an eighth of the length: .125. The rear half opens by 1 at its left end and
    by half of that in the middle; the front half from there to the hinge.
    """
    case, result = answered([0.25, 0.5, -1.0], [(0.5, 0.0, 0.1), (0.5, 0.0, 0.1)])
    drawn = mechanism_drawing(case, result)
    block = next(part for part in drawn.parts if isinstance(part, Group) and part.block == 2)
    assert block.values == (0.25, 0.5, -1.0)
    assert block.motion is not None
    turn, x, y = block.motion
    moved = [(px - turn * py + x, py + turn * px + y) for px, py in BLOCK]
    close(moved, [(0, 1500), (4000, 2000), (4250, 0), (250, -500)])
    (ghost,) = shapes_of(drawn, Polygons, "ghost")
    close(ghost.outlines, [BLOCK])
    (crack,) = shapes_of(drawn, Polygons, "crack")
    close(crack.rest, [REAR, FRONT])
    close(crack.outlines[0], [(2000, 2000), (0, 2000), (0, 1500), (2000, 1750)])
    close(crack.outlines[1], [(4000, 2000), (2000, 2000), (2000, 1750), (4000, 2000)])
    joints = [part for part in drawn.parts if isinstance(part, Group) and part.joint is not None]
    assert [(part.joint, part.values[0]) for part in joints] == [(0, "open"), (1, "rock")]
    close([part.values[1:] for part in joints], [(0.5, 1.0, 0.0), (0.0, 0.5, 0.0)])
    size = 46.0
    (parted,), (opened, hinge) = joints[0].parts, joints[1].parts
    assert isinstance(parted, Lines)
    assert isinstance(opened, Lines)
    assert isinstance(hinge, Circles)
    assert (parted.role, parted.width, parted.dash) == ("open", 0.6 * size, 0.9 * size)
    assert (opened.role, opened.width, opened.dash) == ("rock", 0.6 * size, None)
    close(hinge.centres, [(4000, 2000)])
    assert hinge.radius == pytest.approx(1.1 * size)
    still = loaded_mechanism(case, result)
    (moves,) = shapes_of(still, Polygons, "moves")
    close(moves.outlines, [moved])
    close(shapes_of(still, Polygons, "crack")[0].outlines, crack.outlines)
    assert len(shapes_of(still, Arrows, "live")) == 1


def test_what_slides_is_drawn_heavier_and_dilatant_slip_with_a_core():
    case, result = answered([1.0, 0.0, 0.0], [(0.5, 0.5, 0.1), (0.5, 0.5, 0.1)])
    marks = [line for line in shapes_of(mechanism_drawing(case, result), Lines) if line.role != "scale"]
    assert [(line.role, line.width, line.dash) for line in marks] == [("slide", 46.0, None)] * 2
    case, result = answered([1.0, 0.5, 0.0], [(0.5, 0.5, 0.1), (0.5, 0.5, 0.1)], flow="associated")
    first, core, second = (line for line in shapes_of(mechanism_drawing(case, result), Lines) if line.role != "scale")
    assert (first.role, core.role, core.width, second.role) == ("dilatant", "core", 0.4 * 46.0, "open")
    case, result = answered([1.0, 0.25, -0.5], [(0.5, 0.5, 0.1), (0.5, 0.5, 0.1)])
    (hinge,) = shapes_of(mechanism_drawing(case, result), Circles)
    close(hinge.centres, [(4000, 2000)])
    case, result = answered([1.0, 0.25, 0.5], [(0.5, 0.5, 0.1), (0.5, 0.5, 0.1)])
    (hinge,) = shapes_of(mechanism_drawing(case, result), Circles)
    close(hinge.centres, [(0, 2000)])


def test_two_mechanisms_lie_over_each_other_as_large_with_the_joints_of_one_of_them():
    """A slide to the right, and the turn about the lower right corner: |v|^2 over the block is A (.0625 + .25) + J.

    With A = .5 and J = .5 (1 + .25) / 12 it is .208333, that of the slide .5: the second is drawn .125 (.5/.208333)^.5.
    """
    case, slide = answered([1.0, 0.0, 0.0], [(0.5, 0.5, 0.1), (0.5, 0.5, 0.1)])
    turn = slide.model_copy(update={"mechanism": [(0.0, 0.0, 0.0), (0.0, 0.0, 0.0), (0.25, 0.5, -1.0)], "method": "fe"})
    drawn = overlay_drawing(case, slide, turn)
    (moves,), (other,) = shapes_of(drawn, Polygons, "moves"), shapes_of(drawn, Polygons, "other")
    close(moves.outlines, [BLOCK + np.array([500, 0])])
    scale = 4000 * 0.125 * (0.5 / (0.5 * 0.3125 + 0.5 * 1.25 / 12)) ** 0.5
    close(other.outlines, [[(0, 2000 - scale), (4000, 2000), (4000 + 0.5 * scale, 0), (0.5 * scale, -scale)]])
    lines = {(line.role, line.dash): line for line in shapes_of(drawn, Lines) if line.role != "scale" and line.points}
    assert set(lines) == {("slide", None), ("open", 0.9 * 46.0)}
    close(lines["slide", None].points, [REAR, FRONT])
    assert lines["open", 0.9 * 46.0].width == pytest.approx(0.6 * 46.0)
    assert lines["slide", None].width == 46.0


def test_a_block_of_the_second_mechanism_is_drawn_only_where_it_stands_elsewhere():
    """It differs by .004 of the wall's length, which is half the width of a line; both are drawn an eighth large."""
    case, first = answered([1.0, 0.0, 0.0], [(0.5, 0.5, 0.1), (0.5, 0.5, 0.1)])
    for up, drawn in ((0.03, 0), (0.034, 1)):
        field = [(0.0, 0.0, 0.0), (0.0, 0.0, 0.0), ((1.0 - up**2) ** 0.5, up, 0.0)]
        (other,) = shapes_of(
            overlay_drawing(case, first, first.model_copy(update={"mechanism": field})), Polygons, "other"
        )
        assert len(other.outlines) == drawn


def test_displaced_blocks_are_drawn_where_they_are():
    case = samples.block()
    moved = [polygon + np.array([0.25, -0.5]) for polygon in case.assembly.polygons]
    held, moves = shapes_of(displaced_drawing(case.assembly, "the block", moved), Polygons)
    close(held.outlines, np.array([LEFT, RIGHT]) + np.array([1000, 2000]))
    close(moves.outlines, np.array([BLOCK]) + np.array([1000, 2000]))


def test_a_number_never_stands_beside_ids_where_it_would_be_taken_for_one():
    """The base of a stack is its first block: numbered, the block "1" was drawn as 2 as soon as another id was long."""
    stack = {"type": "stack", "width": 1, "height": 0.5, "count": 2}
    building = {"id": "building", "polygon": [[-2, 0], [-1, 0], [-1, 1], [-2, 1]], "fixed": True}
    wall = build_wall({"format": "wall/1", "unit_weight": 20, "friction": 0.5, "pattern": stack, "blocks": [building]})
    told = {item.title: item.text for item in shapes_of(wall_drawing(wall.case), Text) if item.title}
    assert told == {"block base": "base", "block 1": "1", "block 2": "2"}
