"""How a wall is drawn: lines, arrows of forces and loads, names of blocks and captions."""

from __future__ import annotations

from typing import Any

import numpy as np

from harness.model.case import Case
from harness.model.method import Traits
from reports.charts.styles import SHAPES, Mark, mark_named
from reports.drawing.display_list import Text
from reports.drawing.looks import LOOKS
from reports.drawing.wall_drawing import wall_drawing
from reports.findings.joints import joint_states, open_with_force
from reports.geometry import shapes, thrust_lines
from reports.page import page_drawings, sections
from tests.reports import samples
from tests.walls import case as wall_case
from tests.walls import running_bond, stack


def block_with(**more: Any) -> tuple[Case, Any]:
    case = samples.block()
    return case, samples.solved(case, "la", 0.4).model_copy(update=more)


def test_the_caption_of_a_wall_says_which_loads_are_drawn():
    assert sections._loads_drawn(samples.bond()) == "The wall with its loads; dots are contact points."
    many = wall_case(running_bond(14, 4))
    assert 60 < many.assembly.n_free <= 120
    assert sections._loads_drawn(many) == "The wall with its loads, drawn on one block in 2; dots are contact points."
    still = wall_case(running_bond(2, 2), loads={})
    assert sections._loads_drawn(still) == "The wall with its supports; dots are contact points."


def test_captions_of_forces_say_at_which_multiplier_they_are():
    case = samples.block()
    result = samples.solved(case, "fe", 0.4)
    assert sections._forces_are(result) == "contact forces at collapse"
    assert sections._forces_are(result.model_copy(update={"forces_multiplier": 0.4})) == "contact forces at collapse"
    lower = result.model_copy(update={"forces_multiplier": 0.35})
    assert sections._forces_are(lower) == "contact forces at 0.35000"
    held = result.model_copy(update={"flow": "approximate"})
    assert sections._forces_are(held) == (
        "contact forces of the last held state; the mechanism above belongs to the moving state"
    )
    assert sections._forces_are(held.model_copy(update={"mechanism": None})) == (
        "contact forces of the last held state"
    )


def test_joints_drawn_as_open_that_carry_force_are_counted():
    """The block lifts off: both joints open. A force counts from 2e-3 of the largest on."""
    up = [(0.0, 0.0, 0.0), (0.0, 0.0, 0.0), (0.0, 1.0, 0.0)]
    for forces, number in (
        ([(0.5, 0.5, 0.0), (0.0, 0.0, 0.0)], 1),
        ([(0.5, 0.5, 0.0), (9e-4, 9e-4, 0.0)], 1),
        ([(0.5, 0.5, 0.0), (1.2e-3, 1.2e-3, 0.0)], 2),
        ([(0.5, 0.0, 0.3), (0.0, 0.3, -0.2)], 2),
        ([(-0.5, 0.0, 0.3), (0.0, 0.0, 0.0)], 0),
    ):
        case, result = block_with(mechanism=up, forces=forces)
        assert joint_states(case.assembly, result) == ["open", "open"]
        assert open_with_force(case.assembly, result) == number
    case, result = block_with(mechanism=up, forces=[(0.5, 0.5, 0.0), (0.0, 0.0, 0.0)])
    assert sections._forces_beside(case, result) == "1 joint drawn as open carries force below"
    measured = result.model_copy(update={"flow": "approximate"})
    assert sections._forces_beside(case, measured) == (
        "1 joint drawn as open carries force below: the forces belong to the held state, the mechanism to the "
        "moving one"
    )
    both = result.model_copy(update={"forces": [(0.5, 0.5, 0.0)] * 2})
    assert sections._forces_beside(case, both) == "2 joints drawn as open carry force below"


def test_bytes_of_packed_drawings_are_about_as_counted():
    run = samples.large(12, 3)
    drawn = page_drawings.PageDrawings(0)
    counted = 0
    for item in run.cases:
        counted += sum(page_drawings.drawing_bytes(item))
        for result in item.results:
            drawn.put(sections.mechanism_drawing(item.case, result))
            drawn.put(sections.force_drawing(item.case, result))
    assert 0.6 < len(drawn.packed()) / counted < 1.4


def test_lines_of_drawings_are_the_heavier_the_more_they_matter():
    """What stands by is thinner than edges of blocks, these than joints, joints than contact points and bars."""
    wide = {role: look.width for role, look in LOOKS.items()}
    assert wide["ghost"] == wide["outline"] == wide["ground"] < wide["stone"]
    assert wide["held"] == wide["still"] == wide["moves"] == wide["stone"] < wide["dead"] < wide["joint"]
    assert all(wide[f"{kind}{held}"] == wide["stone"] for kind in ("sound", "fault", "doubt") for held in ("", "-held"))
    assert wide["size"] < wide["stone"] < wide["ring"] < wide["dead"] < wide["other"] == wide["scale"] < wide["joint"]
    assert wide["idle"] == wide["ring"]
    assert wide["live"] == wide["joint"] < wide["tie"] < wide["prop"] < wide["contact"] < wide["fill"]
    assert wide["prop"] == 2 * wide["tie"] == 4 * wide["idle"]
    for role, look in LOOKS.items():
        if look.dash is not None:
            assert look.dash[0] >= look.dash[1] > look.width, f"{role}: dashes are longer than their line is wide"
            assert look.dash[0] < 5 * look.width


def test_a_method_without_a_look_of_its_own_has_always_the_same_one():
    looks = [mark_named(f"method-{k}", Traits()) for k in range(200)]
    assert looks == [mark_named(f"method-{k}", Traits()) for k in range(200)]
    assert len({look.marker for look in looks}) == len(SHAPES)
    assert {look.line for look in looks} == {"solid", "dashed", "dotted", "dashdot"}
    assert len({look.colour for look in looks}) == 6
    own = mark_named("method-1", Traits(colour="#123456", marker="s", line="dashed"))
    assert own == Mark("#123456", "s", "dashed")


def test_resultants_point_down_or_right_and_stand_half_on_either_side_of_joints_between_free_blocks():
    wall = wall_case(stack(2)).assembly
    joint = int(np.flatnonzero(~wall.fixed[wall.block_a] & ~wall.fixed[wall.block_b])[0])
    reach = 0.36 * wall.length_scale
    for force, way in (((0.0, 2.0), (0.0, -1.0)), ((0.0, -2.0), (0.0, -1.0)), ((-2.0, 0.0), (1.0, 0.0))):
        found = shapes.Thrusts(np.array([joint]), np.array([[0.1, 0.2]]), np.array([force]), np.array([2.0]))
        ((tail, tip),) = thrust_lines.drawn_ends(wall, found)
        np.testing.assert_allclose(tip - tail, 2 * reach * np.array(way), atol=1e-12)
        np.testing.assert_allclose(0.5 * (tip + tail), [0.1, 0.2], atol=1e-12)


def test_the_force_of_a_support_on_the_wall_is_drawn_on_the_free_block_alone():
    wall = samples.block().assembly
    long = 2 * 0.36 * wall.length_scale
    for force, tail, tip in (((0.0, 2.0), (0.25, long), (0.25, 0.0)), ((-0.0, 2.0), (0.25, long), (0.25, 0.0))):
        found = shapes.Thrusts(np.array([0]), np.array([[0.25, 0.0]]), np.array([force]), np.array([2.0]))
        (ends,) = thrust_lines.drawn_ends(wall, found)
        np.testing.assert_allclose(ends, [tail, tip], atol=1e-12)


def test_loads_beyond_the_weights_alone_are_drawn_as_dead():
    loads = {"dead": {"points": [{"block": "1", "at": [0.15, 0.4], "force": [3.0, -4.0]}]}}
    wall = wall_case(stack(2), loads=loads).assembly
    extra = shapes.extra_dead_load(wall)
    block = wall.block_ids.index("1")
    np.testing.assert_allclose(extra[block, :2], [3.0, -4.0])
    assert not np.delete(extra, block, axis=0).any()
    assert extra.shape == (wall.n_blocks, 3)
    (arrow,) = shapes.load_arrows(wall, extra)
    assert (arrow.block, arrow.force.tolist()) == (block, [3.0, -4.0])


def test_names_of_blocks_are_their_ids_where_these_are_short_and_numbers_elsewhere():
    def shown(prefix: str) -> set[str]:
        return {text.text for text in wall_parts(samples.bond(prefix=prefix))}

    def wall_parts(case: Case) -> list[Text]:
        return [part for part in wall_drawing(case).parts if isinstance(part, Text) and part.title]

    assert "1.1" in shown("")
    assert "a1.1" in shown("a"), "the ground is called abase, in five letters"
    assert "ab1.1" in shown("ab")
    assert not {"abbase", "1"} & shown("ab"), "the ground has no name where others have their ids"
    assert "abc1.1" not in shown("abc")
    assert "2" in shown("abc")
    assert wall_parts(wall_case(running_bond(13, 11))) != []
    large = wall_case(running_bond(14, 11))
    assert large.assembly.n_blocks > 160
    assert wall_parts(large) == []
