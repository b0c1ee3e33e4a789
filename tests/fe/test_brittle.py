"""`fe` on walls whose joints lose their strength once they have opened or slipped, held by the judge.

Closed forms: a block on one brittle joint falls to its residual value at the plastic one; two joints side by side share
a load by their stiffness until the brittle one breaks.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

import drystone
from drystone.reactions import reactions
from harness.engine.judge import answered
from harness.engine.symmetry import VIEWS
from harness.model.assembly import Assembly
from harness.model.build import build
from harness.model.errors import InputError
from harness.model.method import Finding
from harness.model.method_registry import load_method
from harness.model.result import Result, plastic_and_residual_of
from harness.model.wall import Wall
from tests.walls import assembly, beside, running_bond, stack

ROUND_OFF = 1e-9
BOND = {"type": "running_bond", "block_length": 1.0, "block_height": 0.5, "count": 6, "bricks": 3}


def found(wall: Assembly, name: str = "fe", **settings: Any) -> Result:
    """The answer of a method, which the judge accepts."""
    result, judgement = answered(load_method(name), wall, **settings)
    assert judgement.accepted, judgement.sentence
    return result


def side_by_side(cohesion: float, tension: float = 0.0, weight: float = 2.0, at: float = 1.0) -> Assembly:
    """A block of 1 m on a smooth brittle joint (left half) and a plain one of friction 1 (right half).

    A dead force of 10 - weight presses it down at x = `at`, a live force of 10 pushes along the joints, so that the
    block does not tilt.
    """
    left = {"between": ["left", "block"], "value": 0.0, "cohesion": cohesion, "tensile_strength": tension}
    blocks = [
        {"id": "left", "polygon": [[-0.5, -1], [0.5, -1], [0.5, 0], [-0.5, 0]], "fixed": True},
        {"id": "right", "polygon": [[0.5, -1], [1.5, -1], [1.5, 0], [0.5, 0]], "fixed": True},
        {"id": "block", "polygon": [[0, 0], [1, 0], [1, 0.5], [0, 0.5]], "weight": weight},
    ]
    dead = {"points": [{"block": "block", "at": [at, 0.5], "force": [0, weight - 10]}]}
    live = {"points": [{"block": "block", "at": [0, 0], "force": [10, 0]}]}
    return build(
        Wall.model_validate(
            {
                "format": "wall/1",
                "friction": {"default": 1.0, "rules": [left | {"after": "residual"}]},
                "blocks": blocks,
                "loads": {"dead": dead, "live": live},
            }
        )
    ).assembly


@pytest.mark.parametrize(
    ("width", "height", "friction", "cohesion", "tension", "peak", "residual"),
    [
        (1.0, 0.2, 0.5, 1.0, 0.0, 0.75, 0.5),
        (1.0, 0.2, 0.0, 1.0, 0.0, 0.25, 0.0),
        (0.4, 2.0, 1.0, 8.0, 4.0, 0.22, 0.2),
        (0.4, 2.0, 1.0, 4.0, 4.0, 0.22, 0.2),
    ],
)
def test_one_block_bears_its_plastic_multiplier_and_breaks_there(
    width: float, height: float, friction: float, cohesion: float, tension: float, peak: float, residual: float
):
    """It slides at mu + c A / W or topples at (b / h)(1 + T / W); nothing bears that once the joint has broken."""
    wall = assembly(stack(1, width, height), friction, cohesion=cohesion, tensile_strength=tension, after="residual")
    result = found(wall)
    assert result.multiplier == pytest.approx(peak, rel=ROUND_OFF)
    assert (result.details["broken"], result.details["breaking"]) == ([], [0])
    least = found(wall, "la")
    assert least.multiplier == pytest.approx(residual, abs=ROUND_OFF)
    pair = plastic_and_residual_of(least)
    assert pair is not None
    assert pair[0].multiplier == pytest.approx(peak, rel=ROUND_OFF)
    assert pair[1] is least
    greatest = found(wall, "la-associated")
    assert greatest.multiplier == pytest.approx(peak, rel=ROUND_OFF)
    for sentence in (least.sentence, greatest.sentence):
        assert "brittle" in sentence
        assert "lies between" in sentence


@pytest.mark.parametrize("settings", [{}, {"stiffness_ratio": 0.05}, {"normal_stiffness": 7.0}])
def test_brittle_joint_beside_a_plain_one_breaks_between_plastic_and_residual(settings: dict[str, Any]):
    """The brittle joint bears c A = 7 when each end of the plain one, as stiff, bears 3.5, or what friction allows.

    The springs under a weight of 10 at x = .9 bear -1.5, 2.5 | 2.5, 6.5 at the ends of the two joints, so the plain one
    bears 2.5 + 3.5 of its 9. Plastic they would bear 7 + 9 = 16, and at most 10 without the left one.
    """
    wall = side_by_side(14.0, tension=10.0)
    result = found(wall, **settings)
    assert result.multiplier == pytest.approx(1.3, rel=ROUND_OFF)
    assert result.details["breaking"] == [0]
    assert result.sentence.startswith("the wall collapses at 1.3 times the live load, the greatest multiplier reached")
    plastic = replace(wall, brittle=np.zeros(2, dtype=bool))
    assert found(plastic, **settings).multiplier == pytest.approx(1.6, rel=ROUND_OFF)
    assert found(wall.with_broken(wall.brittle), **settings).multiplier == pytest.approx(0.9, rel=ROUND_OFF)


def test_brittle_joint_that_breaks_early_leaves_the_plateau_of_the_plain_one():
    """A weight of 10 in the middle: c A = 2 goes at 4, and the plain joint takes 5 = mu W / 2 thereafter."""
    result = found(side_by_side(4.0, weight=10.0))
    assert result.multiplier == pytest.approx(0.5, rel=ROUND_OFF)
    assert result.details["broken"] == [0]
    assert result.details["broken_at"] == [pytest.approx(0.4, rel=ROUND_OFF)]
    assert "breaking" not in result.details


def test_collapse_that_statics_does_not_show_is_not_judged():
    """c A = 4 goes at .8; springs bear .5 then, and statics mu W / 10 = 1, by another share of the weight."""
    result, judgement = answered(load_method("fe"), side_by_side(8.0, weight=10.0))
    assert result.multiplier == pytest.approx(0.8, rel=ROUND_OFF)
    assert result.mechanism is None
    assert judgement.accepted is None
    assert "statics alone would find one" in result.sentence


@pytest.mark.parametrize(("cohesion", "tension"), [(0.05, 0.0), (0.25, 0.125), (1.0, 0.5)])
def test_wall_of_21_bricks_ends_between_the_least_residual_and_the_associated_maximum(cohesion: float, tension: float):
    wall = assembly(BOND, 0.65, unit_weight=1.0, cohesion=cohesion, tensile_strength=tension, after="residual")
    result = found(wall)
    greatest = found(wall, "la-associated").multiplier
    assert greatest is not None
    assert result.multiplier is not None
    assert 0.5579977 < result.multiplier <= greatest
    at = result.details["broken_at"]
    assert at == sorted(at)
    assert len(set(result.details["broken"])) == len(at)


def test_joint_glued_under_a_lintel_lets_go_at_its_tensile_strength():
    """Weight W = 4 on T = f_t A = 6: it bears half its weight more; of twice the weight it never hung."""
    panel = {"type": "panel", "cell_length": 1.0, "cell_height": 0.2, "layout": ["L", "B"], "fixed": "L"}
    loads = {"live": {"body": [{"per_weight": [0, -1]}]}}
    glue = {"cohesion": 10.0, "tensile_strength": 6.0, "after": "residual"}
    assert found(assembly(panel, 0.5, loads=loads, **glue)).multiplier == pytest.approx(0.5, rel=ROUND_OFF)
    heavy, judgement = answered(load_method("fe"), assembly(panel, 0.5, unit_weight=40.0, loads=loads, **glue))
    assert heavy.finding is Finding.FALLS
    assert judgement.accepted is not False
    stands = found(assembly(panel, 0.5, loads={}, **glue))
    assert stands.finding is Finding.STANDS
    assert stands.details["broken"] == []


def test_joints_that_gravity_leaves_without_compression_are_broken_from_the_start_if_they_bear_no_tension():
    """The head joints of a bond carry nothing: without tensile strength they are open, and their cohesion is gone."""
    wall = assembly(running_bond(2, 2), 0.65, cohesion=2.0, after="residual")
    result = found(wall)
    heads = np.flatnonzero(np.array(wall.joint) == "head").tolist()
    unloaded = [p for p, at in zip(result.details["broken"], result.details["broken_at"], strict=True) if at == 0.0]
    assert sorted(unloaded) == heads


def test_plastic_wall_is_untouched_by_the_word_plastic():
    fields = {"cohesion": 1.0, "tensile_strength": 0.5}
    plain = found(assembly(stack(2, 1.0, 0.2), 0.5, **fields))
    named = found(assembly(stack(2, 1.0, 0.2), 0.5, after="plastic", **fields))
    assert (plain.multiplier, plain.forces) == (named.multiplier, named.forces)


@pytest.mark.parametrize("name", ["fe-newton", "fe-qp", "de"])
def test_methods_that_do_not_follow_breaking_refuse_the_wall_by_name(name: str):
    wall = assembly(stack(1, 1.0, 0.2), 0.5, cohesion=1.0, after="residual")
    with pytest.raises(InputError, match=rf"{name} takes joints that keep their strength.*brittle"):
        answered(load_method(name), wall)


def test_reactions_of_brittle_joints_are_refused():
    wall = drystone.build_wall(
        {
            "format": "wall/1",
            "unit_weight": 20,
            "friction": 0.5,
            "cohesion": 1,
            "after": "residual",
            "pattern": {"type": "stack", "width": 1, "height": 0.5, "count": 1},
            "settlements": [{"blocks": ["base"], "translation": [0, -1]}],
        }
    )
    with pytest.raises(InputError, match="some joints are brittle"):
        reactions(wall)


@pytest.mark.parametrize("view", [*VIEWS.values(), lambda wall: beside(wall, 3.0)], ids=[*VIEWS, "beside"])
def test_no_view_of_a_wall_changes_how_it_breaks(view: Callable[[Assembly], Assembly]):
    """Nor does an independent block beside it, whose weight is no part of the wall."""
    wall = assembly(BOND, 0.65, unit_weight=1.0, cohesion=1.0, tensile_strength=0.5, after="residual")
    own, seen = found(wall), found(view(wall))
    assert own.multiplier is not None
    assert seen.multiplier == pytest.approx(own.multiplier, rel=ROUND_OFF)
    assert seen.details["broken_at"] == pytest.approx(own.details["broken_at"], rel=1e-8)
    assert len(seen.details["breaking"]) == len(own.details["breaking"])


def test_joints_of_every_component_are_listed_as_they_are_at_its_collapse():
    """Three blocks of 4: a plain one that slides at 2, brittle ones that break at .5 + 1/4 and .5 + 2/4."""
    names = ("weak", "middle", "strong")
    blocks: list[dict[str, Any]] = []
    rules = []
    for k, (name, cohesion) in enumerate(zip(names, (0.0, 1.0, 2.0), strict=True)):
        x = 3.0 * k
        square = [[x, 0], [x + 1, 0], [x + 1, 0.2], [x, 0.2]]
        below = [[x, -1], [x + 1, -1], [x + 1, 0], [x, 0]]
        blocks += [{"id": name, "polygon": square}, {"id": f"under {name}", "polygon": below, "fixed": True}]
        if cohesion:
            pair = {"between": [name, f"under {name}"], "value": 0.5, "cohesion": cohesion}
            rules.append(pair | {"after": "residual"})
    rules.append({"between": ["weak", "under weak"], "value": 2.0})
    wall = {"format": "wall/1", "unit_weight": 20, "friction": {"default": 0.5, "rules": rules}, "blocks": blocks}
    built = build(Wall.model_validate(wall | {"loads": {"live": {"body": [{"per_weight": [1, 0]}]}}})).assembly
    result = found(built)
    assert result.multiplier == pytest.approx(0.75, rel=ROUND_OFF)
    assert result.details["broken"] == []
    joint = result.details["breaking"][0]
    assert {built.block_ids[built.block_a[joint]], built.block_ids[built.block_b[joint]]} == {"middle", "under middle"}
