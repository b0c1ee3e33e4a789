"""A share of the degenerate walls (`tests.properties.degenerate_walls`), and blocks of any weight within and beside."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from benchmarks.walls import drawn
from harness.engine.judge import answered
from harness.engine.symmetry import renumbered
from harness.model.assembly import Assembly
from harness.model.method import Status
from harness.model.method_registry import load_method
from tests.exact_programme import greatest_multiplier
from tests.properties.degenerate_kinds import KINDS, Rng, any_base, wall
from tests.properties.degenerate_walls import METHODS, Tally, made, violations
from tests.walls import beside

LOST = 0.1
"""Share of walls of weight ratios up to 1e12 that may go without an answer."""


@pytest.mark.parametrize("kind", KINDS, ids=lambda kind: kind.__name__)
def test_degenerate_wall_is_answered_as_exact_arithmetic_and_theory_have_it(kind: Callable[[Rng], Assembly]):
    assembly = made(kind, 2)
    assert assembly is not None
    assert violations(assembly, METHODS, Tally(), twins=()) == []


@pytest.mark.slow
@pytest.mark.parametrize("kind", KINDS, ids=lambda kind: kind.__name__)
def test_more_degenerate_walls(kind: Callable[[Rng], Assembly]):
    walls = [assembly for seed in range(3, 8) if (assembly := made(kind, seed)) is not None]
    assert [fault for each in walls for fault in violations(each, METHODS, Tally())] == []


def uneven_wall(seed: int) -> Assembly:
    """A small wall half of whose blocks weigh 1e6, 1e9 or 1e12 times as much as the others."""
    rng = np.random.default_rng([seed, 77])
    blocks = any_base(rng)
    ratio = 10.0 ** float(rng.choice([6.0, 9.0, 12.0]))
    for each in blocks[1:]:
        each["weight"] = float(rng.uniform(0.5, 2.0)) * (ratio if rng.random() < 0.5 else 1.0)
    return wall(blocks, float(rng.choice([0.3, 0.6, 0.9])))


def hold_to_exact(seeds: range) -> None:
    lost = 0
    for seed in seeds:
        assembly = uneven_wall(seed)
        exact = greatest_multiplier(assembly)
        greatest, judgement = answered(load_method("la-associated"), assembly)
        least, accepted = answered(load_method("la"), assembly)
        assert judgement.accepted is not False, seed
        assert accepted.accepted is not False, seed
        lost += greatest.status is Status.NOT_CONVERGED
        if greatest.multiplier is not None:
            assert greatest.multiplier == pytest.approx(float(exact), rel=1e-9, abs=1e-12), seed
        if least.multiplier is not None:
            assert least.multiplier <= float(exact) * (1.0 + 1e-9) + 1e-12, seed
    assert lost <= max(1, LOST * len(seeds))


def test_weights_that_differ_by_up_to_1e12_within_a_wall_are_held_to_exact_arithmetic():
    hold_to_exact(range(5))


@pytest.mark.slow
def test_two_hundred_walls_of_weights_that_differ_by_up_to_1e12():
    hold_to_exact(range(200))


@pytest.mark.parametrize("seed", [7, 27])
def test_light_block_that_moves_is_not_judged_by_the_load_of_heavy_ones_at_rest(seed: int):
    # Rounding of its speed, 1e-16, was multiplied by the ratio of their live loads to its own, 1e9 and 1e12.
    result, judgement = answered(load_method("la-associated"), uneven_wall(seed))
    assert judgement.accepted, judgement.sentence
    assert judgement.residuals["interpenetration"] < 1e-12
    assert result.multiplier is not None


def beside_any_weight(assembly: Assembly, method: str) -> None:
    alone, _ = answered(load_method(method), assembly)
    for share in (1e-12, 1.0, 1e12):
        result, judgement = answered(load_method(method), renumbered(beside(assembly, share)))
        assert judgement.accepted is not False, share
        assert result.status is alone.status, share
        assert result.finding is alone.finding, share
        if alone.multiplier is not None:
            assert result.multiplier == pytest.approx(alone.multiplier, rel=1e-9), share


@pytest.mark.parametrize("method", ["la-associated", "fe"])
@pytest.mark.parametrize("seed", range(2))
def test_block_of_any_weight_beside_an_irregular_wall_changes_nothing(method: str, seed: int):
    beside_any_weight(drawn(seed, 3, 4), method)


@pytest.mark.slow
@pytest.mark.parametrize("method", ["la", "la-associated", "fe"])
def test_block_of_any_weight_beside_two_hundred_irregular_walls_changes_nothing(method: str):
    for seed in range(200):
        beside_any_weight(drawn(seed, 3, 4), method)
