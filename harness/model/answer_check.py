"""What an answer must be before anything is made of it: one check for every method, ours or a user's.

A method may hand over anything. What passes here can be judged, stored, written as UTF-8 and drawn: plain numbers of
the right shape, finite where they must be, text without half characters, and details of the kinds that others read.
"""

from __future__ import annotations

import math
import sys
from enum import StrEnum
from typing import Any, TypeVar

import numpy as np
from pydantic import BaseModel, ConfigDict, Field, ValidationError

from harness.model.assembly import Assembly
from harness.model.errors import InputError
from harness.model.fields import MOST_COUNTED, Counted
from harness.model.followed import check_followed
from harness.model.method import Answer, Finding, Status

DEEPEST = 33
"""Depth to which details may be nested. One that holds a result may have `json_text.MOST_NESTED` levels in all."""
_FLOWS = ("non-associated", "associated", "approximate")
"""Flow rules that an answer may name."""
_NUMBERS = "iuf"
"""Kinds of NumPy's types that are real numbers."""

_Member = TypeVar("_Member", bound=StrEnum)
_Triple = tuple[float, float, float]


class AnswerFault(InputError):
    """An answer that cannot be used; the problem says what the method did."""

    def __init__(self, problem: str) -> None:
        super().__init__(problem.removesuffix("."), "`Answer` in harness/model/method.py says what an answer holds")


class _Displaced(BaseModel, defer_build=True):
    model_config = ConfigDict(extra="forbid")
    places: list[_Triple]
    interface: list[int]
    onto: list[int]
    point: list[tuple[float, float]]
    normal: list[tuple[float, float]]
    force: list[tuple[float, float]]


class _Steps(BaseModel, defer_build=True):
    model_config = ConfigDict(extra="forbid")
    blocks: list[str]
    multiplier: list[float]
    displacements: list[list[_Triple]]
    forces: list[list[_Triple]]
    states: list[list[int]]


class _Release(BaseModel, defer_build=True):
    time_unit: str = ""
    frames: list[list[_Triple]] | None = None


class _Order(BaseModel, defer_build=True):
    held: float | None = None
    moving: float | None = None


class _Residual(BaseModel, defer_build=True):
    """The answer for the wall without cohesion and tensile strength, or with it, as `Answer` has it."""

    model_config = ConfigDict(extra="forbid")
    status: Status
    finding: Finding
    sentence: str
    multiplier: float | None = None
    bracket: tuple[float, float] | None = None
    bracket_meaning: str = ""
    forces: list[_Triple] | None = None
    forces_multiplier: float | None = None
    mechanism: list[_Triple] | None = None
    flow: str = _FLOWS[0]
    details: dict[str, Any] = Field(default_factory=dict)


class _KnownDetails(BaseModel, defer_build=True):
    """Details that others than their method read: the judge, the verdict, the report. Any further name is free."""

    unknowns: Counted | None = None
    stopped_by_limit: bool = False
    proved_least: bool = False
    certified_bound: float = 0.0
    cap: float | None = None
    lowest_moving: float | None = None
    start_values: list[float] | None = None
    histories: list[dict[str, Any]] | None = None
    improvements: list[dict[str, Any]] | None = None
    orders: list[_Order] | None = None
    live_forces: list[_Triple] | None = None
    dilatant_mechanism: list[_Triple] | None = None
    displaced_state: _Displaced | None = None
    load_steps: _Steps | None = None
    release: _Release | None = None
    without_strength: _Residual | None = None
    with_strength: _Residual | None = None
    broken: list[int] | None = None
    breaking: list[int] | None = None
    bar_forces: list[float] | None = None
    dead_bar_forces: list[float] | None = None


def checked(answer: Any, assembly: Assembly) -> Answer:
    """The answer with plain values: arrays of floats, lists, numbers and text.

    Args:
        answer: what a method returned.
        assembly: the wall it is about.

    Raises:
        AnswerFault: it is no answer; the message says what the method did.
    """
    if not isinstance(answer, Answer):
        raise AnswerFault(f"The method returned {type(answer).__name__} instead of an Answer.")
    n, m = assembly.n_blocks, assembly.n_interfaces
    found = Answer(
        status=_member(Status, answer.status, "status"),
        finding=_member(Finding, answer.finding, "finding"),
        sentence=_text(answer.sentence, "sentence"),
        multiplier=_number(answer.multiplier, "a multiplier"),
        bracket=_bracket(answer.bracket),
        bracket_meaning=_text(answer.bracket_meaning, "meaning of its bracket"),
        forces=_array(answer.forces, (m, 3), "forces"),
        forces_multiplier=_number(answer.forces_multiplier, "a multiplier of its forces"),
        mechanism=_array(answer.mechanism, (n, 3), "a mechanism"),
        flow=_text(answer.flow, "flow rule"),
        iterations=_count(answer.iterations),
        path=_path(answer.path),
        details=_details(answer.details, assembly),
    )
    if found.flow not in _FLOWS:
        raise AnswerFault(
            f'The method answers with the flow rule "{found.flow}", which is none of {", ".join(_FLOWS)}.'
        )
    if found.finding.has_multiplier and found.status is Status.OK and found.multiplier is None:
        raise AnswerFault("The method reports a collapse without a multiplier.")
    return found


def encodable(text: str, what: str) -> str:
    """Text that a file in UTF-8 can hold.

    Raises:
        AnswerFault: it has half a character.
    """
    try:
        text.encode()
    except UnicodeEncodeError as error:
        half = text[error.start].encode("unicode_escape").decode()
        raise AnswerFault(f"The method's {what} has half a character, {half}.") from None
    return text


def _text(value: Any, what: str) -> str:
    if not isinstance(value, str):
        raise AnswerFault(f"The method's {what} is no text but {type(value).__name__}.")
    return encodable(str(value), what)


def _member(kind: type[_Member], value: Any, what: str) -> _Member:
    try:
        return kind(value)
    except ValueError:
        shown = _text(value, what) if isinstance(value, str) else type(value).__name__
        raise AnswerFault(f'The method\'s {what} is "{shown}", which is none of {", ".join(kind)}.') from None


def _array(value: Any, shape: tuple[int, ...], what: str) -> Any:
    """The value as an array of finite floats of a shape; None stays None."""
    if value is None:
        return None
    try:
        array = np.asarray(value)
    except Exception as error:
        raise AnswerFault(f"The method answers with {what} that cannot be read ({type(error).__name__}).") from None
    if array.shape != shape and not (array.size == 0 and math.prod(shape) == 0):
        raise AnswerFault(f"The method answers with {what} of shape {array.shape} instead of {shape}.")
    if array.size and array.dtype.kind not in _NUMBERS:
        raise AnswerFault(f"The method answers with {what} of type {array.dtype}, not of real numbers.")
    with np.errstate(over="ignore"):  # of numbers that only an extended type can hold: they are not finite here
        array = array.astype(float).reshape(shape)
    if not np.isfinite(array).all():
        raise AnswerFault(f"The method answers with {what} not finite.")
    return array


def _number(value: Any, what: str) -> float | None:
    return None if value is None else float(_array(value, (), what)) + 0.0  # zero without a sign


def _bracket(value: Any) -> tuple[float, float] | None:
    ends = _array(value, (2,), "a bracket")
    if ends is None:
        return None
    lower, upper = float(ends[0]), float(ends[1])
    if lower > upper:
        raise AnswerFault(f"The method answers with a bracket that begins at {lower:g} and ends below, at {upper:g}.")
    return lower, upper


def _count(value: Any) -> int:
    count = _number(value, "a number of iterations")
    if count is None or not 0.0 <= count <= MOST_COUNTED or count != int(count):
        said = "None" if count is None else f"{count:g}"
        raise AnswerFault(f"The method answers with a number of iterations of {said}.")
    return int(count)


def _path(value: Any) -> dict[str, list[float]]:
    if not isinstance(value, dict):
        raise AnswerFault(f"The method's path is {type(value).__name__}, not columns by name.")
    columns = {}
    for name, column in value.items():
        title = f"a column {_text(name, 'name of a column of its path')!r} of its path"
        listed = isinstance(column, list | tuple) or (isinstance(column, np.ndarray) and column.ndim > 0)
        size = (len(column),) if listed else (0,)
        columns[str(name)] = _array(column, size, title).tolist()
    if len({len(column) for column in columns.values()}) > 1:
        raise AnswerFault("The method's path has columns of different lengths.")
    return columns


def _details(value: Any, assembly: Assembly) -> dict[str, Any]:
    if not isinstance(value, dict):
        raise AnswerFault(f"The method's details are {type(value).__name__}, not values by name.")
    details: dict[str, Any] = _plain(value, 0)
    try:
        known = _KnownDetails.model_validate(details)
    except ValidationError as error:
        fault = error.errors()[0]
        place = ".".join(map(str, fault["loc"]))
        raise AnswerFault(f'The method\'s details have no "{place}" that can be used: {fault["msg"]}.') from None
    if known.displaced_state is not None and not _fits(known.displaced_state, assembly):
        raise AnswerFault("The method's displaced state does not fit the blocks and interfaces of the wall.")
    try:
        check_followed(details, assembly)
    except ValueError as error:
        raise AnswerFault(f"The method's details cannot be used: {error}.") from None
    return details


def _fits(moved: _Displaced, assembly: Assembly) -> bool:
    contacts = {len(moved.interface), len(moved.onto), len(moved.point), len(moved.normal), len(moved.force)}
    return (
        len(contacts) == 1
        and len(moved.places) == assembly.n_blocks
        and all(0 <= place < assembly.n_interfaces for place in moved.interface)
        and all(0 <= block < assembly.n_blocks for block in moved.onto)
    )


def _plain(value: Any, depth: int) -> Any:
    """JSON values: arrays as lists, NumPy's scalars as numbers, numbers that are not finite as None, others as text."""
    if depth > DEEPEST:
        raise AnswerFault(f"The method's details are nested more than {DEEPEST} deep.")
    if isinstance(value, np.ndarray):
        return _plain(value.tolist(), depth)
    if isinstance(value, np.generic):
        return _plain(value.item(), depth)
    if isinstance(value, dict):
        return {_text(str(key), "name of a detail"): _plain(item, depth + 1) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(item, depth + 1) for item in value]
    if isinstance(value, float):
        return float(value) if math.isfinite(value) else None
    if value is None or isinstance(value, bool):
        return value
    if isinstance(value, int):
        if abs(value) > sys.float_info.max:
            raise AnswerFault("The method's details have a number beyond those of 64 bits.")
        return int(value)
    return encodable(str(value), "details")
