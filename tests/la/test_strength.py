"""`la` and `la-associated` on walls whose joints have cohesion and tensile strength, held by the judge.

Closed forms: a block slides at mu + c A / W and topples at (b/h) (1 + T/W), T = f_t A (Orduna and Lourenco 2003). The
associated values of the wall of 21 bricks are by linear programmes of other code, the least ones by enumeration.
"""

from __future__ import annotations

import itertools
import json
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from harness.engine.judge import answered, judge
from harness.model.assembly import Assembly
from harness.model.build import build
from harness.model.method import Finding
from harness.model.method_registry import load_method
from harness.model.result import Judgement, Result, residual_of
from harness.model.wall import Wall
from methods.la.core.exact import close_tight
from methods.la.core.problem import make_problem
from methods.la.sources import SOURCES
from tests.bonded_walls import ASSOCIATED, BOND, PRINTED, bonded
from tests.commands import drystone
from tests.enumeration import least_by_enumeration
from tests.walls import assembly, running_bond, stack, wall_data

PAIR = {"type": "panel", "cell_length": 0.4, "cell_height": 0.5, "layout": ["AB", "GG"], "fixed": "G"}
"""Two blocks side by side on the ground: two beds and a head joint."""
TAKE = ("la", "la-associated", "la-associated-cvxpy")


def found(name: str, wall: Assembly, **settings: Any) -> Result:
    """The answer of a method, which the judge accepts."""
    result, judgement = answered(load_method(name), wall, **settings)
    assert judgement.accepted, judgement.sentence
    return result


def said(name: str, wall: Assembly) -> tuple[Result, Judgement]:
    return answered(load_method(name), wall)


@pytest.mark.parametrize("name", TAKE)
def test_block_slides_at_friction_and_cohesion_over_weight(name: str):
    wall = assembly(stack(1, 1.0, 0.2), 0.5, cohesion=1.0)
    assert found(name, wall).multiplier == pytest.approx(0.75, rel=1e-9)


@pytest.mark.parametrize("name", TAKE)
def test_block_topples_at_its_slope_and_the_tension_over_weight(name: str):
    wall = assembly(stack(1, 0.4, 2.0), 1.0, cohesion=8.0, tensile_strength=4.0)
    assert found(name, wall).multiplier == pytest.approx(0.22, rel=1e-9)


@pytest.mark.parametrize(("cohesion", "tension", "value"), ASSOCIATED)
def test_wall_of_21_bricks(cohesion: float, tension: float, value: float):
    """None of its states lies above the associated maximum, nor below the least state of the dry wall."""
    wall = bonded(cohesion, tension)
    for name in ("la-associated", "la-associated-cvxpy"):
        assert found(name, wall).multiplier == pytest.approx(value, rel=PRINTED)
    least = found("la", wall, effort="quick").multiplier
    assert least is not None
    assert 0.5579977 <= least <= value * (1.0 + PRINTED)


@pytest.mark.parametrize(("cohesion", "tension", "value"), ASSOCIATED)
def test_wall_of_21_bricks_that_lifts_by_its_friction(cohesion: float, tension: float, value: float):
    assert found("la", bonded(cohesion, tension, 0.65), effort="quick").multiplier == pytest.approx(value, rel=PRINTED)


SMALL = [
    pytest.param(stack(2, 0.3, 0.4), 0.9, 1.0, 0.5, id="stack that topples"),
    pytest.param(stack(2, 0.6, 0.2), 0.3, 1.0, 2.0, id="stack that slides"),
    pytest.param(PAIR, 0.7, 1.5, 0.0, id="two bricks, cohesion alone"),
    pytest.param(PAIR, 0.7, 2.0, 1.0, id="two bricks, both strengths"),
]


@pytest.mark.parametrize(("pattern", "friction", "cohesion", "tension"), SMALL)
def test_least_states_are_those_of_enumeration(
    pattern: dict[str, Any], friction: float, cohesion: float, tension: float
):
    wall = assembly(pattern, friction, cohesion=cohesion, tensile_strength=tension)
    dry = assembly(pattern, friction)
    least = least_by_enumeration(wall)
    assert found("la", wall).multiplier == pytest.approx(least, rel=1e-7)
    assert least > least_by_enumeration(dry) + 1e-3


@pytest.mark.parametrize("seed", range(4))
def test_least_states_of_random_joints_are_those_of_enumeration(seed: int):
    """Each joint its own friction and strength; two beds and a head joint."""
    generator = np.random.default_rng(seed)
    blocks = assembly(PAIR).block_ids
    rules = []
    for pair in itertools.combinations(blocks, 2):
        friction, cohesion = generator.uniform(0.3, 0.9), generator.uniform(0.0, 3.0)
        tension = generator.uniform(0.0, 1.0) * cohesion / friction
        rules.append({"between": pair, "value": friction, "cohesion": cohesion, "tensile_strength": tension})
    wall = assembly(PAIR, {"default": 0.5, "rules": rules})
    assert wall.constant[:, 2].min() > 0.0
    assert found("la", wall).multiplier == pytest.approx(least_by_enumeration(wall), rel=1e-7)


@pytest.mark.parametrize("name", TAKE)
@pytest.mark.parametrize("live", [True, False])
def test_bracket_of_one_block_glued_to_a_pier_stands_by_its_strength(name: str, live: bool):
    """Weight W at the arm b/2 on a joint of height h: T h / 2 bears it from f_t h^2 / 2 = W b / 2 on."""
    weight, width, height = 0.5 * 0.2 * 20.0, 0.5, 0.2
    needed = weight * width / height**2

    def wall(share: float) -> Assembly:
        pier = {"id": "pier", "polygon": [[-1, 0], [0, 0], [0, height], [-1, height]], "fixed": True}
        bracket = {"id": "bracket", "polygon": [[0, 0], [width, 0], [width, height], [0, height]]}
        loads = {"loads": {"live": {"body": [{"per_weight": [0, -1]}]}} if live else {}}
        data = wall_data({}, 0.5, blocks=[pier, bracket], cohesion=1e3, tensile_strength=share * needed)
        del data["pattern"]
        return build(Wall.model_validate(data | loads)).assembly

    falls, stands = said(name, wall(0.999)), said(name, wall(1.001))
    assert (falls[0].finding, falls[1].accepted) == (Finding.FALLS, True)
    assert stands[1].accepted
    assert stands[0].finding is (Finding.COLLAPSES if live else Finding.STANDS)
    if live:
        assert found(name, wall(1.5)).multiplier == pytest.approx(0.5, rel=1e-9)


@pytest.mark.parametrize("name", TAKE)
def test_a_load_that_friction_bears_at_any_size_is_unbounded_with_strength_too(name: str):
    wall = assembly(stack(1, 1.0, 0.2), 0.5, cohesion=1.0, loads={"live": {"body": [{"per_weight": [0, -1]}]}})
    assert found(name, wall).finding is Finding.UNBOUNDED


@pytest.mark.parametrize("name", TAKE)
def test_a_load_that_lifts_is_bounded_by_weight_and_tension(name: str):
    loads = {"live": {"body": [{"per_weight": [0, 1]}]}}
    wall = assembly(stack(1, 1.0, 0.2), 0.5, cohesion=2.0, tensile_strength=2.0, loads=loads)
    assert found(name, wall).multiplier == pytest.approx(1.5, rel=1e-9)


def test_cohesion_of_a_smooth_wall_bears_alone():
    wall = assembly(stack(1, 1.0, 0.2), 0.0, cohesion=1.0)
    for name in TAKE:
        assert found(name, wall).multiplier == pytest.approx(0.25, rel=1e-9)


def test_strength_never_lowers_the_associated_maximum_nor_leads_below_the_dry_least():
    pattern = running_bond(3, 3)
    dry = found("la-associated", assembly(pattern, 0.5)).multiplier
    before = dry
    for cohesion in (0.0, 0.5, 1.0, 2.0, 4.0):
        value = found("la-associated", assembly(pattern, 0.5, cohesion=cohesion, tensile_strength=cohesion)).multiplier
        assert value is not None
        assert before is not None
        assert value >= before * (1.0 - 1e-9)
        before = value


def test_springs_start_from_gravity_alone_where_yield_is_no_cone():
    problem = make_problem(assembly(BOND, 0.65, cohesion=1.0))
    assert not problem.law.is_cone
    dry = make_problem(assembly(BOND, 0.65))
    left_out = [type(source).__name__ for source in SOURCES if source.applies(dry) and not source.applies(problem)]
    assert left_out == ["ShiftedAssociated", "AnalyticCentre"]
    assert not close_tight(problem).any()


def test_no_bound_and_no_confirmation_of_dry_joints_is_claimed():
    result = found("la", assembly(stack(2, 0.3, 0.4), 0.9, cohesion=1.0, tensile_strength=0.5), bound_seconds=5.0)
    assert not {"certificate", "certified_bound", "rational_confirmation"} & result.details.keys()


def test_commands_refuse_or_answer_walls_with_strength(tmp_path: Path):
    path = tmp_path / "wall.json"
    path.write_text(json.dumps(wall_data(stack(1, 1.0, 0.2), 0.5, cohesion=1.0)))
    done = drystone("run", "la-associated", path)
    assert done.returncode == 0, done.stderr
    assert "0.75" in done.stdout
    refused = drystone("bound", path, "-o", tmp_path / "bound.json")
    assert refused.returncode == 2
    assert "cohesion or tensile strength" in refused.stderr


@cache
def of_weak_mortar(name: str) -> tuple[Assembly, Result]:
    """A wall whose answer tells that of the dry wall too, and its answer by a method."""
    wall = assembly(BOND, 0.65, unit_weight=1.0, cohesion=0.05)
    return wall, found(name, wall)


@pytest.mark.parametrize("name", TAKE)
def test_residual_answer_is_that_of_the_wall_without_strength(name: str):
    (_, result), dry = of_weak_mortar(name), found(name, assembly(BOND, 0.65, unit_weight=1.0))
    residual = residual_of(result)
    assert residual is not None
    assert residual.multiplier == dry.multiplier
    assert residual.forces == dry.forces
    assert f"without cohesion and tensile strength it is {dry.multiplier:.7g}" in result.sentence
    assert ("Both are upper bounds" in result.sentence) == (name != "la")
    assert "without_strength" not in dry.details


def test_residual_answer_of_a_wall_that_strength_alone_holds_up_is_that_it_falls():
    panel = {"type": "panel", "cell_length": 1.0, "cell_height": 0.2, "layout": ["L", "B"], "fixed": "L"}
    loads = {"live": {"body": [{"per_weight": [0, -1]}]}}
    result = found("la", assembly(panel, 0.5, cohesion=10.0, tensile_strength=6.0, loads=loads))
    assert result.multiplier == pytest.approx(0.5, rel=1e-9)
    residual = residual_of(result)
    assert residual is not None
    assert residual.finding is Finding.FALLS
    assert "without cohesion and tensile strength the answer is: falls" in result.sentence


@pytest.mark.parametrize(
    "change",
    [
        {"multiplier": 0.57},
        {"multiplier": 0.6022028, "forces_multiplier": 0.6022028},
        {"forces": None},
        {"forces": [[1.0, 1.0, 0.0]]},
        {"mechanism": [[1.0, 1.0, 0.0]]},
        {"status": "nonsense"},
        {"finding": "unbounded"},
    ],
)
def test_a_residual_answer_that_is_wrong_is_rejected_with_the_whole(change: dict[str, Any]):
    wall, result = of_weak_mortar("la")
    changed = {**result.details, "without_strength": result.details["without_strength"] | change}
    said = judge(wall, result.model_copy(update={"details": changed}), 1e-10)
    assert said.accepted is (None if change == {"forces": None} else False)  # what is not shown is not judged
