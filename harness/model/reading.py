"""Reading files: JSON text becomes a checked model, and every fault becomes one clear sentence."""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any, TypeVar

from pydantic import BaseModel, ValidationError

from harness.model.build import Built, build
from harness.model.errors import InputError
from harness.model.wall import TAGS, Wall

ModelType = TypeVar("ModelType", bound=BaseModel)

MOST_SHOWN = 60
"""Characters of a wrong value that are shown."""
PLAIN = {
    "missing": "it is missing",
    "tuple_type": "it should be a list, in square brackets",
    "list_type": "it should be a list, in square brackets",
    "dict_type": "it should be an object, in braces",
    "model_type": "it should be an object, in braces",
    "model_attributes_type": "it should be an object, in braces",
    "float_type": "it should be a number",
    "int_type": "it should be a whole number",
    "string_type": "it should be text, in quotes",
    "bool_type": "it should be true or false",
    "too_long": "it has too many entries",
    "union_tag_not_found": 'it needs a "type"',
    "union_tag_invalid": 'its type is "{tag}", and should be one of {expected_tags}',
}
"""Words for kinds of faults for which those of the validating library suppose that one writes Python."""


def read_json(path: Path) -> Any:
    """The content of a JSON file.

    Raises:
        InputError: unreadable, not JSON, NaN or infinite numbers, or a name given twice.
    """
    source = str(path)
    try:
        text = path.read_text(encoding="utf-8-sig")
    except FileNotFoundError:
        raise InputError("there is no such file", "Check the path", source=source) from None
    except (OSError, UnicodeDecodeError) as error:
        raise InputError(f"it cannot be read ({error})", "Give a UTF-8 text file", source=source) from None

    def refuse_constant(word: str) -> float:
        raise InputError(f"{word} is not a number", "Give finite numbers", source=source)

    def finite(word: str) -> float:
        value = float(word)
        return value if math.isfinite(value) else refuse_constant(word)

    def unique(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
        names = [name for name, _ in pairs]
        if len(set(names)) != len(names):
            twice = next(name for name in names if names.count(name) > 1)
            raise InputError(f'the name "{twice}" is given twice in one object', "Keep one", source=source)
        return dict(pairs)

    try:
        return json.loads(text, parse_constant=refuse_constant, parse_float=finite, object_pairs_hook=unique)
    except json.JSONDecodeError as error:
        raise InputError(
            f"line {error.lineno}, column {error.colno}: {error.msg}", "Give valid JSON", source=source
        ) from None
    except ValueError:
        raise InputError("it has a number of thousands of digits", "Give finite numbers", source=source) from None
    except RecursionError:
        raise InputError("it is nested too deeply", "Give a wall/1 document", source=source) from None


def validate(model: type[ModelType], data: Any, source: str) -> ModelType:
    """Data as a model.

    Raises:
        InputError: the first fault of the data, with its place.
    """
    try:
        return model.model_validate(data)
    except ValidationError as error:
        faults = error.errors()
        fault = faults[0]
        place = _place(fault["loc"], data)
        message = str(fault["msg"]).removeprefix("Value error, ")
        if fault["type"] in PLAIN:
            message = PLAIN[fault["type"]].format(**fault.get("ctx", {}))
        more = f" (and {len(faults) - 1} more)" if len(faults) > 1 else ""
        remedy = ""
        if fault["type"] == "extra_forbidden":
            fields = _fields_at(model, fault["loc"][:-1])
            message = f'unknown field "{fault["loc"][-1]}"'
            remedy = f"Known here: {', '.join(fields)}" if fields else "Leave it out or correct its name"
        elif "input" in fault and not isinstance(fault["input"], dict | list):
            message += f" (given: {repr(fault['input'])[:MOST_SHOWN]})"
        raise InputError(message + more, remedy, place, source) from None


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


def _fields_at(model: type[BaseModel], location: tuple[int | str, ...]) -> list[str]:
    current: Any = model
    for part in location:
        if isinstance(part, int):
            continue
        if not (isinstance(current, type) and issubclass(current, BaseModel)):
            return []
        field = current.model_fields.get(part)
        if field is None:
            continue
        inner = [
            member
            for member in _members(field.annotation)
            if isinstance(member, type) and issubclass(member, BaseModel)
        ]
        if len(inner) != 1:
            return []
        current = inner[0]
    return [field.alias or name for name, field in current.model_fields.items()]


def _members(annotation: Any) -> list[Any]:
    arguments = getattr(annotation, "__args__", None)
    if not arguments:
        return [annotation]
    return [member for argument in arguments for member in _members(argument)]


def parse_wall(data: Any, source: str) -> Wall:
    """A wall from JSON data.

    Raises:
        InputError: not an object, another format or version, or any fault of a field.
    """
    if not isinstance(data, dict):
        raise InputError("a wall is a JSON object", 'Begin with {"format": "wall/1", ...}', source=source)
    if data.get("format") != "wall/1":
        given = f"format is {data['format']!r}" if "format" in data else "it has no format"
        raise InputError(given, 'This release reads "format": "wall/1"', "format", source)
    return validate(Wall, data, source)


def read_wall(path: Path, name: str = "") -> Built:
    """The wall of a file and its assembly.

    Raises:
        InputError: naming the file and the element.
    """
    wall = parse_wall(read_json(path), str(path))
    try:
        return build(wall, name or path.stem)
    except InputError as error:
        error.source = error.source or str(path)
        raise


def wall_json(wall: Wall) -> str:
    """A wall as indented JSON text, fields at their defaults left out."""
    data = wall.model_dump(mode="json", by_alias=True, exclude_defaults=True)
    return json.dumps({"format": "wall/1"} | data, indent=1, ensure_ascii=False, allow_nan=False) + "\n"
