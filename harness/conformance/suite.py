"""The conformance suite of methods: closed forms, views of one wall, ends that are no collapse, limits, manners.

A third party runs it on a method of its own: `drystone conformance NAME`, or `python -m harness.conformance NAME`.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, fields
from enum import StrEnum
from typing import Any

import numpy as np

from harness.conformance.walls import (
    CLOSED_FORMS,
    FALLING,
    LARGE,
    PRESSED,
    STANDING,
    VIEWED,
    WITH_FEATURES,
    ClosedForm,
    odd_names,
)
from harness.engine.isolate import run_isolated
from harness.engine.judge import answered
from harness.engine.processes import cpu_seconds
from harness.engine.symmetry import VIEWS
from harness.engine.worker import Task
from harness.model.answer_check import AnswerFault
from harness.model.assembly import Assembly
from harness.model.build import build
from harness.model.errors import InputError
from harness.model.foreign.program_method import ProgramMethod
from harness.model.method import Finding, Method, Status
from harness.model.method_registry import method_names
from harness.model.result import Judgement, Result
from harness.model.wall import Wall

_WIDEST_BRACKET = 0.01
"""Relative width of the widest bracket around a closed form with which a method conforms."""


class Outcome(StrEnum):
    """What a check found."""

    CONFORMS = "conforms"
    REFUSED = "refused"
    """The method says that it does not take such a wall, which is no fault."""
    FAILS = "fails"
    NOT_TESTED = "not tested"


class _Refused(Exception):
    """The method refuses the wall of a check."""


class _NotTested(Exception):
    """The check cannot be made of this method."""


@dataclass(frozen=True)
class CheckFound:
    """What one check of one method found.

    Attributes:
        group, check: of the suite.
        requirement: what is asked, in a sentence.
        outcome: what was found.
        sentence: what is wrong, or why the method refuses; empty where it conforms.
        cpu_seconds: that the check took, programs that it started included [s].
    """

    group: str
    check: str
    requirement: str
    outcome: Outcome
    sentence: str
    cpu_seconds: float

    def as_json(self) -> dict[str, Any]:
        """As JSON values."""
        return {item.name: getattr(self, item.name) for item in fields(self)} | {"outcome": str(self.outcome)}


@dataclass(frozen=True)
class ConformanceCheck:
    """One check of the suite. Called with a method, it returns an empty string or what is wrong.

    Attributes:
        group: closed forms, features, views, endings, limits, manners.
        name: of the check.
        requirement: what is asked, in a sentence.
        examine: what is wrong, empty if nothing is; raises where the method refuses.
    """

    group: str
    name: str
    requirement: str
    examine: Callable[[Method], str]

    def __call__(self, method: Method) -> str:
        """An empty string if the method conforms, else what is wrong; a refusal counts as wrong here."""
        row = self.row(method)
        return "" if row.outcome in (Outcome.CONFORMS, Outcome.NOT_TESTED) else f"{row.outcome}: {row.sentence}"

    def row(self, method: Method) -> CheckFound:
        """What the check finds of a method, whatever the method does."""
        before = cpu_seconds(method.processes_kept())
        try:
            sentence = self.examine(method)
            outcome = Outcome.FAILS if sentence else Outcome.CONFORMS
        except _NotTested as reason:
            outcome, sentence = Outcome.NOT_TESTED, str(reason)
        except AnswerFault as error:
            outcome, sentence = Outcome.FAILS, f"{error.problem}."
        except (_Refused, InputError) as error:
            outcome, sentence = Outcome.REFUSED, str(error)
        except Exception as error:
            outcome, sentence = Outcome.FAILS, f"it raised {type(error).__name__}: {error}"
        seconds = cpu_seconds(method.processes_kept()) - before
        return CheckFound(self.group, self.name, self.requirement, outcome, sentence, max(seconds, 0.0))


def _slack_of(method: Method) -> float:
    """Relative error a multiplier may have: the stated one for methods that measure, rounding for the others.

    A calculating method with a bracket conforms if that holds the value within the method's tolerance.
    """
    traits = method.traits
    return traits.accuracy if traits.brackets else 1e-8


def _answer(method: Method, wall: Assembly) -> tuple[Result, Judgement]:
    """What a method answers, judged.

    Raises:
        _Refused: it refuses.
    """
    result, judgement = answered(method, wall)
    if result.status is Status.REFUSED:
        raise _Refused(result.sentence)
    return result, judgement


def _closed_form(form: ClosedForm) -> Callable[[Method], str]:
    def check(method: Method) -> str:
        return _fault(*_answer(method, _assembly_of(form.wall, form.name)), form.multiplier, _slack_of(method))

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
        if low - wider <= expected <= high + wider and high - low <= _WIDEST_BRACKET * abs(expected):
            return ""
    if abs(result.multiplier / expected - 1.0) > slack:
        return f"multiplier {result.multiplier!r} instead of {expected!r}"
    return ""


def _taken(method: Method) -> tuple[Assembly, Result]:
    """The first of the walls to be seen otherwise that a method takes, and its answer.

    Raises:
        _Refused: it takes none of them.
    """
    for name, wall in VIEWED.items():
        try:
            return _assembly_of(wall, name), _answer(method, _assembly_of(wall, name))[0]
        except _Refused as error:
            reason = str(error)
    raise _Refused(reason)


def _view(name: str) -> Callable[[Method], str]:
    def check(method: Method) -> str:
        wall, plain = _taken(method)
        if plain.multiplier is None:
            return f"{plain.status}, {plain.finding}: {plain.sentence}"
        return _fault(*_answer(method, VIEWS[name](wall)), plain.multiplier, _slack_of(method))

    return check


def _ending(wall: dict[str, Any], finding: Finding) -> Callable[[Method], str]:
    def check(method: Method) -> str:
        result, judgement = _answer(method, _assembly_of(wall))
        if result.finding is not finding:
            return f"says {result.finding} instead of {finding}: {result.sentence}"
        if result.multiplier is not None:
            return f"gives the multiplier {result.multiplier} to a wall that {finding}"
        return "" if judgement.accepted else judgement.sentence

    return check


def _repeats(method: Method) -> str:
    wall, first = _taken(method)
    second, _ = _answer(method, wall)
    if (first.multiplier, first.forces, first.mechanism) == (second.multiplier, second.forces, second.mechanism):
        return ""
    return f"answers {first.multiplier!r} first and {second.multiplier!r} the second time, or with other fields"


def _leaves_the_wall(method: Method) -> str:
    wall = _assembly_of(CLOSED_FORMS[0].wall)
    given = wall.copied()
    method.solve(given, method.Settings())
    arrays = [name for name, value in vars(wall).items() if isinstance(value, np.ndarray)]
    changed = [name for name in arrays if not np.array_equal(getattr(given, name), getattr(wall, name))]
    return f"it changes {', '.join(changed)} of the wall that it is given" if changed else ""


def _takes_odd_names(method: Method) -> str:
    return _fault(*_answer(method, _assembly_of(odd_names())), 0.3, _slack_of(method))


def _isolated(method: Method, wall: dict[str, Any], seconds: float, mebibytes: int) -> Result:
    """The result of a run in a process of its own.

    Raises:
        _NotTested: the method is an object, which no other process can load.
    """
    program = method.program if isinstance(method, ProgramMethod) else None
    if program is None and method.name not in method_names():
        raise _NotTested("an object runs in this process only; give the method an entry point")
    task = Task(method.name, _assembly_of(wall), {}, seconds, mebibytes * 2**20, program=program)
    return run_isolated(task, "conformance").result


def _keeps_to_limits(seconds: float, mebibytes: int, allowed: Sequence[Status]) -> Callable[[Method], str]:
    def check(method: Method) -> str:
        for wall in LARGE:
            result = _isolated(method, wall, seconds, mebibytes)
            if result.status is not Status.REFUSED:
                break
        else:
            raise _Refused(result.sentence)
        used = result.wall_seconds or 0.0
        if used > 1.5 * seconds + 1.0:  # the engine looks 20 times a second; the rest is a busy machine
            return f"it ran for {used:.1f} s under a limit of {seconds:g} s"
        return "" if result.status in allowed else f"{result.status}: {result.sentence}"

    return check


def _same_in_a_process_of_its_own(method: Method) -> str:
    form = CLOSED_FORMS[0]
    here, _ = _answer(method, _assembly_of(form.wall))
    apart = _isolated(method, form.wall, 60.0, 4096)
    if apart.status is Status.OK and apart.multiplier == here.multiplier:
        return ""
    return (
        f"{apart.status}, {apart.multiplier!r} in a process of its own and {here.multiplier!r} here: {apart.sentence}"
    )


_ENDED = (Status.OK, Status.NOT_CONVERGED, Status.TIMEOUT)


def suite() -> Iterator[ConformanceCheck]:
    """Every check, in the order of the table."""
    for form in CLOSED_FORMS:
        yield ConformanceCheck("closed forms", form.name, f"The multiplier is {form.formula}.", _closed_form(form))
    for form in WITH_FEATURES:
        asked = f"The multiplier is {form.formula}; or the method refuses {form.name}."
        yield ConformanceCheck("features", form.name, asked, _closed_form(form))
    for name in VIEWS:
        yield ConformanceCheck("views", f"view-{name}", f"A wall that is {name} has the same multiplier.", _view(name))
    for name, wall, finding in (
        ("stands", STANDING, Finding.STANDS),
        ("falls", FALLING, Finding.FALLS),
        ("unbounded", PRESSED, Finding.UNBOUNDED),
    ):
        yield ConformanceCheck("endings", name, f'A wall is found "{finding}", with a proof.', _ending(wall, finding))
    yield ConformanceCheck(
        "limits",
        "time",
        "A run of over 90 blocks ends within 2 s or is stopped.",
        _keeps_to_limits(2.0, 4096, _ENDED),
    )
    yield ConformanceCheck(
        "limits",
        "memory",
        "A run under a limit of 256 MiB answers, or is ended as one without memory.",
        _keeps_to_limits(5.0, 256, (*_ENDED, Status.OUT_OF_MEMORY)),
    )
    yield ConformanceCheck("manners", "repeats", "The same wall has the same answer to the last bit.", _repeats)
    yield ConformanceCheck("manners", "leaves-the-wall", "The arrays of the wall are not changed.", _leaves_the_wall)
    yield ConformanceCheck("manners", "odd-names", "Names of blocks may have any letters.", _takes_odd_names)
    yield ConformanceCheck(
        "manners", "own-process", "A process of its own gives the same answer.", _same_in_a_process_of_its_own
    )


def checks() -> Iterator[tuple[str, ConformanceCheck]]:
    """Every check with its name; a check called with a method returns an empty string, or what is wrong."""
    for check in suite():
        yield check.name, check


def conforms(rows: Sequence[CheckFound]) -> bool:
    """Whether a method conforms: nothing fails, and it answers at least one wall of which the value is known."""
    return all(row.outcome is not Outcome.FAILS for row in rows) and any(
        row.outcome is Outcome.CONFORMS and row.group == "closed forms" for row in rows
    )


def _assembly_of(wall: dict[str, Any], name: str = "wall") -> Assembly:
    """The assembly of a wall given as JSON data."""
    return build(Wall.model_validate(wall), name).assembly
