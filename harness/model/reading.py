"""Reading files: JSON text becomes a checked model, and every fault becomes one clear sentence."""

from __future__ import annotations

import json
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any, TypeVar

from pydantic import BaseModel, ValidationError

from harness.model.build import Built, build
from harness.model.errors import MOST_WORDED, InputError, did_you_mean, in_file, raise_faults
from harness.model.field_words import SCOPE, names_at, outside_the_model, remedy_at
from harness.model.fields import MOST_BLOCKS, TAGS
from harness.model.json_text import MOST_SHOWN, read_json, require_format, value_text
from harness.model.names import faults_of_data
from harness.model.wall import Wall

ModelType = TypeVar("ModelType", bound=BaseModel)

_PLAIN = {
    "missing": "it is missing",
    "tuple_type": "it should be a list, in square brackets",
    "list_type": "it should be a list, in square brackets",
    "dict_type": "it should be an object, in braces",
    "model_type": "it should be an object, in braces",
    "model_attributes_type": "it should be an object, in braces",
    "float_type": "it should be a number",
    "int_type": "it should be a whole number",
    "int_from_float": "it should be a whole number",
    "literal_error": "it should be {expected}",
    "string_type": "it should be text, in quotes",
    "string_too_short": "it should not be empty",
    "bool_type": "it should be true or false",
    "too_long": "it has {actual_length} entries, and may have {max_length} at most",
    "too_short": "it has {actual_length} entries, and should have at least {min_length}",
    "union_tag_not_found": 'it has no "type"',
    "union_tag_invalid": 'its type is "{tag}", and should be one of {expected_tags}',
}
"""Words for kinds of faults for which those of the validating library suppose that one writes Python."""
_SHAPES = ("missing", "tuple_type", "list_type", "dict_type", "model_type", "model_attributes_type")
"""Faults whose remedy is the kind of value that the field takes."""


def validate(
    model: type[ModelType], data: Any, source: str, more: Callable[[Any], list[InputError]] = lambda data: []
) -> ModelType:
    """Data as a model.

    Args:
        model: the model.
        data: what a file held.
        source: what errors call the file.
        more: further faults that show in the data, reported beside those of the model.

    Raises:
        InputError: the fault of the data with its place, or `InputFaults` of all of them in the order of the file.
    """
    try:
        return model.model_validate(data)
    except ValidationError as error:
        raise_found(error, model, data, source, more)
        raise AssertionError("a validation error has faults") from None


def raise_found(
    error: ValidationError,
    model: type[BaseModel],
    data: Any,
    source: str,
    more: Callable[[Any], list[InputError]] = lambda data: [],
) -> None:
    """Raise what the validating library found, in words.

    Args:
        error: its own; model, data, source, more: as of `validate`.

    Raises:
        InputError: as `validate`.
    """
    found = error.errors(include_url=False)
    beyond = max(0, len(found) - MOST_WORDED)
    found = found[:MOST_WORDED]
    faults = [_fault(model, data, fault, source) for fault in found if fault["loc"]]
    if not beyond:
        faults += more(data)
    faults = faults or [_fault(model, data, fault, source) for fault in found]
    first_of_place: dict[str, InputError] = {}
    for each in faults:
        first_of_place.setdefault(each.element, each)
    raise_faults(sorted(first_of_place.values(), key=lambda fault: _order(fault.element, data)), source, beyond)


def _order(element: str, data: Any) -> tuple[int, ...]:
    """Where in the file an element stands: the place of every part of its path among its neighbours."""
    places: list[int] = []
    here = data
    for part in re.findall(r"[^.\[\]]+", element.split(" (")[0]):
        if isinstance(here, dict) and part in here:
            places.append(list(here).index(part))
            here = here[part]
        elif isinstance(here, list) and part.isdecimal() and int(part) < len(here):
            places.append(int(part))
            here = here[int(part)]
    return tuple(places)


def _fault(model: type[BaseModel], data: Any, fault: Any, source: str) -> InputError:
    """One fault that the validating library found, in the words of this project."""
    place = _place(fault["loc"], data)
    message = str(fault["msg"]).removeprefix("Value error, ").replace("Input should", "it should")
    remedy = ""
    if fault["type"] in _PLAIN:
        context = dict(fault.get("ctx", {}))
        if context.get("actual_length", 0) is None:  # pydantic does not count the entries of an object
            context["actual_length"] = len(fault["input"])
        message = _PLAIN[fault["type"]].format(**context).replace("'", '"')
    if fault["type"] == "extra_forbidden":
        return _unknown_field(model, fault["loc"], place, source)
    if fault["type"] == "literal_error":
        remedy = did_you_mean(str(fault["input"])[:MOST_SHOWN], re.findall("'([^']*)'", fault["ctx"]["expected"]))
    if fault["type"] in _SHAPES:
        remedy = remedy_at(model, fault["loc"])
    elif fault["type"] == "union_tag_not_found":
        remedy = remedy_at(model, (*fault["loc"], "type"))
    if "input" in fault and not isinstance(fault["input"], dict | list):
        message += f" (given: {value_text(fault['input'])})"
    return InputError(message, remedy, place, source)


def _unknown_field(model: type[BaseModel], location: tuple[int | str, ...], place: str, source: str) -> InputError:
    name = str(location[-1])
    beyond = outside_the_model(name)
    if beyond:
        return InputError(
            f'"{name}" is outside the model: Drystone has rigid blocks, and joints of friction and constant strength, '
            f"in the plane, not {beyond}",
            f"Leave it out; {SCOPE} says what is modelled, and other tools",
            place,
            source,
        )
    fields = names_at(model, location[:-1])
    known = f"Known here: {', '.join(fields)}" if fields else "Leave it out or correct its name"
    meant = did_you_mean(name[:MOST_SHOWN], fields)
    return InputError(f'unknown field "{name}"', f"{meant} {known}".strip(), place, source)


def _place(location: tuple[int | str, ...], data: Any) -> str:
    """Where a fault is, as a path, with the id of the block where there is one."""
    path = ""
    named = ""
    here = data
    for part in location:
        if part in TAGS:
            continue
        if isinstance(part, int):
            path += f"[{part}]"
            here = here[part] if isinstance(here, list) and part < len(here) else None
        elif isinstance(here, dict) and part not in here and part != location[-1]:
            continue  # the name of a union member, not of a field
        elif isinstance(here, list | float | int | str):
            continue
        else:
            path += f".{part}" if path else str(part)
            here = here.get(part) if isinstance(here, dict) else None
        if isinstance(here, dict) and isinstance(here.get("id"), str):
            named = f' ("{here["id"]}")'
    return path + named


_MOST_ENTRIES = {"blocks": MOST_BLOCKS, "interfaces": 3 * MOST_BLOCKS}
"""Of a wall: no plane graph has more than three joints a block."""
DRAWINGS: dict[str, Callable[[Path], Any]] = {}
"""Readers of drawings by the ending of their names: each gives JSON data of a wall.

Filled by `harness.formats.register`; the model knows no format of drawings."""


def read_document(path: Path) -> Any:
    """JSON data of a wall file or of a drawing.

    Raises:
        InputError: naming the file and what is wrong.
    """
    return DRAWINGS.get(path.suffix.lower(), read_json)(path)


def parse_wall(data: Any, source: str) -> Wall:
    """A wall from JSON data.

    Raises:
        InputError: not an object, another format or version, or any fault of a field.
    """
    require_format(data, "wall/1", "a wall", source)
    for entries, most in _MOST_ENTRIES.items():
        listed = data.get(entries)
        if isinstance(listed, list) and len(listed) > most:
            problem = f"it has {len(listed):,} {entries}, and at most {most:,} are read"
            raise InputError(problem, "Model a part", entries, source)
    return validate(Wall, data, source, faults_of_data)


def read_wall(path: Path, name: str = "") -> Built:
    """The wall of a file and its assembly.

    Raises:
        InputError: naming the file and the element.
    """
    wall = parse_wall(read_document(path), str(path))
    with in_file(str(path)):
        return build(wall, name or path.stem)


def wall_json(wall: Wall) -> str:
    """A wall as indented JSON text, fields at their defaults left out."""
    return json.dumps(wall.document(), indent=1, ensure_ascii=False, allow_nan=False) + "\n"
