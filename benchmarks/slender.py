"""Thin arches and slender walls whose one multiplier is known: `python -m benchmarks slender [--methods de,de-soft]`.

The associated maximum, a linear programme, is the only multiplier, because nothing slides in its mechanism; limit
analysis finds nothing below it (of arches it is asked with `--least`, because that takes most of the time). Forces pass
through such long chains of blocks slowly. A measured answer is right within 0.5 %, or says that it does not know;
anything else is wrong.
"""

from __future__ import annotations

import argparse
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from harness.engine.pipeline import execute
from harness.engine.run import Limits, Run
from harness.engine.threads import pin
from harness.model.assembly import Assembly, FloatArray
from harness.model.case import Case, CaseFile
from harness.model.method import Answer, Finding, Status
from harness.model.method_registry import load_method
from harness.model.result import Result
from harness.model.wall import Wall

STILL = 1e-7
"""Largest slip of a joint, over the largest opening, of a mechanism in which nothing slides; and relative difference of
multipliers that are the same."""

PUSH = {"live": {"body": [{"per_weight": [1, 0]}]}}


@dataclass(frozen=True)
class Known:
    """A wall and what is known of it.

    Attributes:
        case: the wall.
        multiplier: the only one at which it collapses; None where it falls under its dead load.
    """

    case: Case
    multiplier: float | None


def thin_arch(generator: np.random.Generator) -> dict[str, Any]:
    """The pattern of an arch of 11 to 101 voussoirs, a twentieth to a fifth of its radius thick."""
    half = float(generator.uniform(45.0, 90.0))
    thickness = float(generator.uniform(0.05, 0.2))
    return {
        "type": "ring",
        "inner_radius": 1.0,
        "outer_radius": round(1.0 + thickness, 3),
        "count": int(2 * generator.integers(5, 51) + 1),
        "angles": [round(90.0 + half, 1), round(90.0 - half, 1)],
    }


def slender_wall(generator: np.random.Generator) -> dict[str, Any]:
    """The pattern of a stack of 3 to 30 blocks, or of a running bond of 4 to 16 courses, a brick long."""
    if generator.random() < 0.5:
        width, height = (round(float(generator.uniform(low, 0.4)), 3) for low in (0.2, 0.1))
        return {"type": "stack", "width": width, "height": height, "count": int(generator.integers(3, 31))}
    return {
        "type": "running_bond",
        "block_length": round(float(generator.uniform(0.3, 0.5)), 3),
        "block_height": round(float(generator.uniform(0.1, 0.2)), 3),
        "count": int(generator.integers(4, 17)),
        "bricks": 1,
    }


KINDS = {"arch": thin_arch, "wall": slender_wall}


def known_walls(kind: str, count: int, seed: int = 0, least: bool = True) -> Iterator[Known]:
    """Walls of a kind in which nothing slides, with their multipliers; others of the seed are passed over.

    Args:
        kind: "arch" or "wall".
        count: how many.
        seed: of the generator.
        least: whether limit analysis is asked for a lower multiplier, as it always is of bond.
    """
    generator, made = np.random.default_rng(seed), 0
    for number in range(100 * count):
        friction = round(float(generator.uniform(0.7, 1.2)), 2)
        pattern = KINDS[kind](generator)
        both = least or pattern["type"] == "running_bond"
        found = _only_multiplier(_case(f"{kind}-{number}", pattern, friction), both)
        if found is not None:
            yield found
            made += 1
        if made == count:
            return


def _case(name: str, pattern: dict[str, Any], friction: float) -> Case:
    wall = {"format": "wall/1", "unit_weight": 20.0, "friction": friction, "pattern": pattern, "loads": PUSH}
    return Case(CaseFile(id=name, title=name, source="benchmarks.slender"), Wall.model_validate(wall), "wall.json")


def _only_multiplier(case: Case, least: bool) -> Known | None:
    """The associated maximum, where nothing slides and no lower state is found; None elsewhere.

    Bond of two bricks is no such wall: it slides at a lower multiplier, though the associated mechanism only turns.
    """
    multipliers: list[float | None] = []
    for name in ("la-associated", "la") if least else ("la-associated",):
        method = load_method(name)
        answer: Answer = method.solve(case.assembly, method.Settings())
        if answer.status is not Status.OK or answer.mechanism is None or _slides(case.assembly, answer.mechanism):
            return None
        multipliers.append(answer.multiplier if answer.finding is Finding.COLLAPSES else None)
    greatest, lowest = multipliers[0], multipliers[-1]
    if greatest is None or lowest is None:
        return Known(case, None) if greatest is lowest else None
    return Known(case, greatest) if abs(greatest - lowest) <= STILL * greatest else None


def _slides(wall: Assembly, motion: FloatArray) -> bool:
    rates = np.abs(wall.kinematic_matrix @ motion[wall.free].ravel()).reshape(-1, 3)
    return bool(rates[:, 2].max() > STILL * rates.max())


def verdict(known: Known, result: Result, accuracy: float) -> str:
    """ "right", "undecided", "soft" (a low answer that says its joints are soft), or "wrong".

    A bracket that the time limit left wide is undecided where it holds the multiplier, and wrong where it does not.
    """
    if result.status is not Status.OK or result.finding is Finding.NONE:
        return "undecided"
    if known.multiplier is None or result.multiplier is None:
        falls = known.multiplier is None and result.finding is Finding.FALLS
        right = falls or (known.multiplier is not None and known.multiplier <= 0.0 and result.finding is Finding.FALLS)
    else:
        right = abs(result.multiplier - known.multiplier) <= accuracy * known.multiplier
    if right:
        return "right"
    if result.details.get("stopped_by_limit") and known.multiplier is not None and result.bracket is not None:
        slack = accuracy * known.multiplier
        if result.bracket[0] - slack <= known.multiplier <= result.bracket[1] + slack:
            return "undecided"
    low = known.multiplier is not None and result.multiplier is not None and result.multiplier < known.multiplier
    return "soft" if low and result.details.get("soft_joints") else "wrong"


def main(arguments: Sequence[str] | None = None) -> int:
    """Print every answer that is not right, and how many there are of each; 1 if one is wrong."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--methods", default="de,de-soft,de-mujoco")
    parser.add_argument("--kinds", default="arch,wall")
    parser.add_argument("--count", type=int, default=60)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--seconds", type=float, default=60.0, help="limit of a run")
    parser.add_argument("--least", action="store_true", help="ask limit analysis of arches too")
    parser.add_argument("--orders", type=int, help="sweep orders of methods that have them")
    parser.add_argument("--jobs", type=int, default=1)
    given = parser.parse_args(arguments)
    pin()
    wrong = 0
    for kind in given.kinds.split(","):
        walls = list(known_walls(kind, given.count, given.seed, given.least))
        for name in given.methods.split(","):
            accuracy = load_method(name).traits.accuracy
            ordered = given.orders and "orders" in load_method(name).Settings.model_fields
            settings = {"orders": given.orders} if ordered else {}
            runs = [Run(known.case, name, settings, Limits(given.seconds)) for known in walls]
            said: Counter[str] = Counter()
            errors, seconds = [0.0], 0.0
            for known, result in zip(walls, execute(runs, None, given.jobs), strict=True):
                word = verdict(known, result, accuracy)
                said[word] += 1
                seconds += result.cpu_seconds or 0.0
                if word == "right" and known.multiplier and result.multiplier:
                    errors.append(abs(result.multiplier / known.multiplier - 1.0))
                elif word != "right":
                    print(f"  {kind} {known.case.id} {name}: {word}; {known.multiplier}: {result.sentence}")
            wrong += said["wrong"]
            print(f"{kind} {name}: {dict(said)}, errors up to {100 * max(errors):.3f} %, {seconds:.0f} s", flush=True)
    return int(wrong > 0)


if __name__ == "__main__":
    raise SystemExit(main())
