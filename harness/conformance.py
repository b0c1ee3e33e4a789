"""The conformance suite of methods: closed forms, views of one wall, and ends that are no collapse.

A third party runs it on a method of its own: `python -m harness.conformance NAME`.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

from harness.engine.judge import answered
from harness.engine.symmetry import VIEWS
from harness.model.assembly import Assembly
from harness.model.build import build
from harness.model.method import Finding, Method, Status, load_method, method_names
from harness.model.result import Judgement, Result
from harness.model.wall import Wall

WIDEST_BRACKET = 0.01
"""Relative width of the widest bracket around a closed form with which a method conforms."""

Check = Callable[[Method], str]
"""Returns an empty string if the method conforms, else what is wrong."""


@dataclass(frozen=True)
class ClosedForm:
    """A wall whose multiplier follows from elementary statics."""

    name: str
    wall: dict[str, Any]
    multiplier: float
    formula: str


def _wall(pattern: dict[str, Any], friction: float, **more: Any) -> dict[str, Any]:
    live = {"live": {"body": [{"per_weight": [1, 0]}]}}
    return {"format": "wall/1", "unit_weight": 20.0, "friction": friction, "pattern": pattern, "loads": live} | more


def _stack(count: int, **more: Any) -> dict[str, Any]:
    return {"type": "stack", "width": 0.3, "height": 0.2, "count": count} | more


CLOSED_FORMS = (
    ClosedForm("slide", _wall(_stack(1), 0.4), 0.4, "mu"),
    ClosedForm("topple", _wall(_stack(1), 3.0), 1.5, "b / h"),
    ClosedForm("stack-topples", _wall(_stack(5), 0.7), 0.3, "b / (n h)"),
    ClosedForm("stack-slides", _wall(_stack(5), 0.25), 0.25, "mu"),
    ClosedForm(
        "bond-slides",
        _wall({"type": "running_bond", "block_length": 0.4, "block_height": 0.2, "count": 4, "bricks": 3}, 0.3),
        0.3,
        "mu",
    ),
)


def assembly_of(wall: dict[str, Any], name: str = "wall") -> Assembly:
    """The assembly of a wall given as JSON data."""
    return build(Wall.model_validate(wall), name).assembly


def slack_of(method: Method) -> float:
    """Relative error a multiplier may have: the stated one for methods that measure, rounding for the others.

    A calculating method with a bracket conforms if that holds the value within the method's tolerance.
    """
    traits = method.traits
    return traits.accuracy if traits.brackets else 1e-8


def _closed_form(form: ClosedForm) -> Check:
    def check(method: Method) -> str:
        result, judgement = answered(method, assembly_of(form.wall, form.name))
        return _fault(result, judgement, form.multiplier, slack_of(method))

    return check


def _fault(result: Result, judgement: Judgement, expected: float, slack: float) -> str:
    if result.status is not Status.OK or result.finding is not Finding.COLLAPSES:
        return f"{result.status}, {result.finding}: {result.sentence}"
    if not judgement.accepted:
        return judgement.sentence
    assert result.multiplier is not None
    if result.bracket is not None and not result.traits.brackets:
        low, high = result.bracket
        wider = judgement.tolerance * abs(expected)
        if low - wider <= expected <= high + wider and high - low <= WIDEST_BRACKET * abs(expected):
            return ""
    if abs(result.multiplier / expected - 1.0) > slack:
        return f"multiplier {result.multiplier!r} instead of {expected!r}"
    return ""


def _view(name: str) -> Check:
    def check(method: Method) -> str:
        wall = assembly_of(_wall({"type": "ring", "inner_radius": 1.0, "outer_radius": 1.3, "count": 5}, 0.6), "arch")
        plain, _ = answered(method, wall)
        seen, judgement = answered(method, VIEWS[name](wall))
        if plain.multiplier is None:
            return f"{plain.status}, {plain.finding}: {plain.sentence}"
        return _fault(seen, judgement, plain.multiplier, slack_of(method))

    return check


def _ending(wall: dict[str, Any], finding: Finding) -> Check:
    def check(method: Method) -> str:
        result, judgement = answered(method, assembly_of(wall))
        if result.finding is not finding:
            return f"says {result.finding} instead of {finding}: {result.sentence}"
        if result.multiplier is not None:
            return f"gives the multiplier {result.multiplier} to a wall that {finding}"
        return "" if judgement.accepted else judgement.sentence

    return check


def checks() -> Iterator[tuple[str, Check]]:
    """Every check of the suite with its name."""
    for form in CLOSED_FORMS:
        yield form.name, _closed_form(form)
    for name in VIEWS:
        yield f"view-{name}", _view(name)
    yield "stands", _ending(_wall(_stack(3), 0.5, loads={}), Finding.STANDS)
    yield "falls", _ending(_wall(_stack(2, offsets=[0.0, 0.2]), 0.5), Finding.FALLS)
    pressed = {"live": {"body": [{"per_weight": [0, -1]}]}}
    yield "unbounded", _ending(_wall(_stack(2), 0.5, loads=pressed), Finding.UNBOUNDED)


def main() -> None:
    """Run the suite on the methods named on the command line; exit code 1 if one does not conform, 2 if unknown."""
    names, known = sys.argv[1:], method_names()
    if not names or not set(names) <= set(known):
        print(f"usage: python -m harness.conformance METHOD...; methods: {', '.join(known)}", file=sys.stderr)
        sys.exit(2)
    bad = 0
    for name in names:
        method = load_method(name)
        for title, check in checks():
            fault = check(method)
            bad += bool(fault)
            print(f"{name:20s} {title:18s} {'conforms' if not fault else 'DOES NOT: ' + fault}")
    sys.exit(1 if bad else 0)


if __name__ == "__main__":
    main()
