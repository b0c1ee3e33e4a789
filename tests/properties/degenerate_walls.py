"""Degenerate mechanics: small walls in twenty kinds, each held against exact arithmetic, theory and its own twins.

Run as `python -m tests.properties.degenerate_walls [COUNT [METHOD ...]]`: so many walls of every kind (15), through
`la`, `la-associated` and `fe` unless others are named. A method may say that it did not converge, which is counted; it
may not give an answer that is wrong. Prints a line a kind and every violation; exit code 1 if there is one.
"""

from __future__ import annotations

import math
import sys
import time
from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from harness.engine.judge import answered
from harness.engine.symmetry import VIEWS
from harness.model.assembly import Assembly
from harness.model.errors import InputError
from harness.model.method import Finding, Method, Status
from harness.model.method_registry import load_method
from harness.model.result import Result
from tests.exact_programme import greatest_multiplier
from tests.properties.degenerate_kinds import KINDS, Rng

METHODS = ("la", "la-associated", "fe")
TWINS = ("mirrored", "rotated", "renumbered", "scaled")
SAME = 1e-7
"""Relative difference of two multipliers that are the same, on walls of condition numbers up to 1e7."""
NEAR_ZERO = 1e-9
"""Difference of two multipliers, in load units, that are the same."""


@dataclass
class Tally:
    """Results of the walls of one kind."""

    walls: int = 0
    findings: Counter[str] = field(default_factory=Counter)
    answers: Counter[str] = field(default_factory=Counter)
    unanswered: Counter[str] = field(default_factory=Counter)
    violations: list[str] = field(default_factory=list)


def made(kind: Callable[[Rng], Assembly], seed: int) -> Assembly | None:
    """The wall of a kind and seed; None where the format refuses it."""
    try:
        return kind(np.random.default_rng([seed, KINDS.index(kind)]))
    except InputError:
        return None


def violations(assembly: Assembly, methods: Sequence[str], tally: Tally, twins: Sequence[str] = TWINS) -> list[str]:
    """What is wrong about the answers of methods and of their twins, in words."""
    exact = greatest_multiplier(assembly)
    found: dict[str, Result] = {}
    wrong: list[str] = []
    for name in methods:
        method = load_method(name)
        own = _answer(method, assembly, tally, wrong, name)
        if own is None:
            continue
        found[name] = own
        for twin in twins if method.family != "de" else ():
            other = _answer(method, VIEWS[twin](assembly), tally, wrong, f"{name} {twin}")
            if other is not None and not _same(own, other, assembly.load_unit):
                wrong.append(f"{name} {twin}: {_words(other)} and not {_words(own)}")
    if "la-associated" in found:
        tally.findings[found["la-associated"].finding.value] += 1
    wrong += _against_exact(found, exact, assembly)
    wrong += _against_theory(found, assembly)
    return wrong


def _answer(method: Method, assembly: Assembly, tally: Tally, wrong: list[str], name: str) -> Result | None:
    """An accepted answer; None where there is none. What the judge does not accept is wrong."""
    result, judgement = answered(method, assembly)
    if result.status is not Status.OK:
        tally.unanswered[method.name] += 1
        if result.status not in (Status.NOT_CONVERGED, Status.REFUSED):
            wrong.append(f"{name}: {result.status.value}: {result.sentence}")
        return None
    tally.answers[method.name] += 1
    if judgement.accepted is False:
        wrong.append(f"{name}: not accepted: {judgement.sentence}")
    return result


def _value(result: Result) -> float:
    """The multiplier; -1 for a fall, infinite without end or where nothing is asked."""
    if result.finding.has_multiplier:
        assert result.multiplier is not None
        return result.multiplier
    return -1.0 if result.finding is Finding.FALLS else math.inf


def _words(result: Result) -> str:
    return f"{result.finding.value} {result.multiplier}"


def _same(one: Result, other: Result, unit: float) -> bool:
    first, second = _value(one), _value(other)
    if min(first, second) == -1.0 and max(first, second) <= NEAR_ZERO * unit:
        return True  # at the limit under the dead load: rounding decides whether it stands at zero
    return first == second or abs(first - second) <= SAME * abs(first) + NEAR_ZERO * unit


def _against_exact(found: dict[str, Result], exact: Any, assembly: Assembly) -> list[str]:
    """`la-associated` against the exact programme, and no state above it."""
    limit = -1.0 if exact is None else float(exact)
    if not assembly.has_live_load:
        limit = -1.0 if exact is None else math.inf
    unit = assembly.load_unit
    slack = SAME * abs(limit) + NEAR_ZERO * unit if math.isfinite(limit) else 0.0
    wrong = []
    for name, result in found.items():
        value = _value(result)
        at_limit = limit == -1.0 and abs(value) <= NEAR_ZERO * unit
        if value > limit + slack and not at_limit and name != "de":
            wrong.append(f"{name}: {_words(result)} above the exact maximum {limit:.12g}")
        if name == "la-associated" and value < limit - slack and value < 1e7 * unit:
            wrong.append(f"{name}: {_words(result)} below the exact maximum {limit:.12g}")
    return wrong


def _against_theory(found: dict[str, Result], assembly: Assembly) -> list[str]:
    """`la` is no higher than a plateau of `fe`; where it is proved least, nothing is lower."""
    if not {"la", "fe"} <= set(found):
        return []
    least, plateau = _value(found["la"]), _value(found["fe"])
    slack = SAME * abs(plateau) + NEAR_ZERO * assembly.load_unit if math.isfinite(plateau) else 0.0
    wrong = []
    if least > plateau + slack and plateau != -1.0:
        wrong.append(f"la {least!r} above the plateau {plateau!r} of fe")
    if found["la"].details.get("proved_least") and plateau < least - slack and plateau != -1.0:
        wrong.append(f"fe {plateau!r} below la {least!r}, which is said to be proved")
    return wrong


def main(arguments: Sequence[str] | None = None) -> int:
    """Run and print; 1 if there is a violation."""
    given = list(sys.argv[1:] if arguments is None else arguments)
    count = int(given[0]) if given else 15
    methods = given[1:] or list(METHODS)
    total, bad = 0, 0
    began = time.process_time()
    for kind in KINDS:
        tally = Tally()
        for seed in range(count):
            assembly = made(kind, seed)
            if assembly is None:
                continue
            tally.walls += 1
            tally.violations += [f"  {kind.__name__} {seed}: {each}" for each in violations(assembly, methods, tally)]
        total, bad = total + tally.walls, bad + len(tally.violations)
        said = ", ".join(f"{name} {tally.answers[name]} + {tally.unanswered[name]} without" for name in methods)
        print(
            f"{kind.__name__:18s} {tally.walls:3d} walls; answers {said}; violations {len(tally.violations)}",
            flush=True,
        )
        print("".join(f"{line}\n" for line in tally.violations), end="", flush=True)
    print(f"{total} walls, {bad} violations, {time.process_time() - began:.0f} CPU s")
    return int(bad > 0)


if __name__ == "__main__":
    sys.exit(main())
