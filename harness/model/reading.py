"""Reading files: JSON text becomes a checked model, and every fault becomes one clear sentence."""

from __future__ import annotations

import json
import math
import os
import re
import stat
from collections import Counter
from collections.abc import Callable
from pathlib import Path
from typing import IO, Any, TypeVar

from pydantic import BaseModel, ValidationError

from harness.model.broken_json import MOST_SHOWN, broken
from harness.model.build import Built, build
from harness.model.errors import MOST_WORDED, InputError, did_you_mean, raise_faults
from harness.model.fields import MOST_BLOCKS
from harness.model.names import faults_of_data
from harness.model.scope import SCOPE, outside_the_model
from harness.model.wall import TAGS, Wall

ModelType = TypeVar("ModelType", bound=BaseModel)

LARGEST_FILE = 256 * 2**20
"""Bytes that are read from one file at most: 100,000 blocks with their interfaces written out are about 150 MB."""
MOST_VALUES = 4_000_000
"""Numbers, texts, lists and objects of a JSON document: 100,000 blocks with interfaces written out have as many. Each
takes some 200 bytes when it is read, so the document takes less than 1 GB."""
MOST_NESTED = 40
"""Depth of a JSON document. A wall needs 7 levels; beyond some 200 its readers and writers reach their own limits."""
HALF_CHARACTER = re.compile(r"\\u[dD][89a-fA-F]")
"""An escape that is one half of a surrogate pair."""
KINDS = {
    b"\x89PNG": "a PNG picture",
    b"\xff\xd8\xff": "a JPEG picture",
    b"GIF8": "a GIF picture",
    b"II*\0": "a TIFF picture",
    b"MM\0*": "a TIFF picture",
    b"RIFF": "a WebP picture or another RIFF file",
    b"%PDF": "a PDF",
    b"PK\x03\x04": "a ZIP archive, as documents of office programs are",
    b"\x1f\x8b": "compressed (gzip)",
    b"AC10": "a DWG drawing",
    b"SQLite format 3": "an SQLite file, as a store of results is",
    b"\xff\xfe": "text in UTF-16",
    b"\xfe\xff": "text in UTF-16",
}
"""What is no text, by its first bytes."""
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
    "too_long": "it has {actual_length} entries, and may have {max_length} at most",
    "too_short": "it has {actual_length} entries, and should have at least {min_length}",
    "union_tag_not_found": 'it needs a "type"',
    "union_tag_invalid": 'its type is "{tag}", and should be one of {expected_tags}',
}
"""Words for kinds of faults for which those of the validating library suppose that one writes Python."""


def read_bytes(path: Path, limit: int = LARGEST_FILE) -> bytes:
    """The content of a regular file of limited size: no device, no pipe, nothing that never ends.

    Args:
        path: the file.
        limit: most bytes that are read.

    Raises:
        InputError: no such file, not a regular file, larger than the limit, or unreadable.
    """
    source = str(path)
    try:
        with open(path, "rb", opener=_without_waiting) as file:
            status = os.fstat(file.fileno())
            if not stat.S_ISREG(status.st_mode):
                raise InputError("it is not a regular file", "Write its content to a file first", source=source)
            content = _up_to(limit + 1, file) if status.st_size <= limit else b""
    except FileNotFoundError:
        raise InputError("there is no such file", "Check the path", source=source) from None
    except (OSError, ValueError) as error:
        reason = error.strerror if isinstance(error, OSError) and error.strerror else str(error)
        raise InputError(f"it cannot be read ({reason})", "Give a file that you may read", source=source) from None
    if status.st_size > limit or len(content) > limit:
        size = max(status.st_size, len(content))
        raise InputError(
            f"it has {size:,} bytes, and at most {limit:,} are read",
            "Check that it is the file you mean",
            source=source,
        )
    return content


def _up_to(most: int, file: IO[bytes]) -> bytes:
    """So many bytes of a file at most; `read` of so many would reserve memory for all of them."""
    content = bytearray()
    while len(content) < most and (part := file.read(min(most - len(content), 2**20))):
        content += part
    return bytes(content)


def _without_waiting(path: str, flags: int) -> int:
    """Open without waiting for the other end of a pipe."""
    return os.open(path, os.O_RDONLY | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_CLOEXEC", 0))


def read_text(path: Path, limit: int = LARGEST_FILE) -> str:
    """The content of a UTF-8 text file of limited size, a byte order mark left out.

    Args:
        path: the file.
        limit: most bytes that are read.

    Raises:
        InputError: no such file, not a regular file, larger than the limit, or not UTF-8.
    """
    return text_of(read_bytes(path, limit), str(path))


def text_of(content: bytes, source: str, otherwise: str = "") -> str:
    """The text of a file in UTF-8, a byte order mark left out, or in the encoding `otherwise` where that is given.

    Raises:
        InputError: it is no text; what it is where its first bytes say so.
    """
    kind = next((kind for begin, kind in KINDS.items() if content.startswith(begin)), "")
    if kind:
        raise InputError(f"it is {kind}", "Give a UTF-8 text file", source=source)
    try:
        return content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        if otherwise:
            return content.decode(otherwise, errors="replace")
        line = content.count(b"\n", 0, error.start) + 1
        raise InputError(
            f"it is no UTF-8 text: byte {content[error.start]:#x} in line {line}",
            "Give a UTF-8 text file",
            source=source,
        ) from None


def read_json(path: Path, limit: int = LARGEST_FILE) -> Any:
    """The content of a JSON file.

    Raises:
        InputError: unreadable, not JSON, NaN or infinite numbers, a name given twice, or nested too deeply.
    """
    return json_of(read_text(path, limit), str(path))


def json_of(text: str, source: str, most_values: int = MOST_VALUES) -> Any:
    """The value of JSON text.

    Args:
        text: of the document.
        source: what errors call it.
        most_values: values that it may have; commas and brackets are counted for them before anything is made.

    Raises:
        InputError: not JSON, NaN or infinite numbers, a name given twice, half a character, or too much or nested too
            deeply to be read.
    """
    if 1 + sum(text.count(sign) for sign in ",[{") > most_values:
        raise InputError(
            f"it has more than {most_values:,} values", "Check that it is the file you mean", source=source
        )

    def refuse_constant(word: str) -> float:
        raise InputError(f"{word} is not a number", "Give finite numbers", source=source)

    def finite(word: str) -> float:
        value = float(word)
        return value if math.isfinite(value) else refuse_constant(word)

    def unique(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
        found = dict(pairs)
        if len(found) != len(pairs):
            twice = next(name for name, count in Counter(name for name, _ in pairs).items() if count > 1)
            raise InputError(f'the name "{twice}" is given twice in one object', "Keep one", source=source)
        return found

    too_deep = InputError(f"it is nested more than {MOST_NESTED} deep", "Give a wall/1 document", source=source)
    try:
        data = json.loads(text, parse_constant=refuse_constant, parse_float=finite, object_pairs_hook=unique)
    except json.JSONDecodeError as error:
        raise broken(text, error, source) from None
    except ValueError:
        raise InputError("it has a number of thousands of digits", "Give finite numbers", source=source) from None
    except RecursionError:
        raise too_deep from None
    if nested_deeper(data, MOST_NESTED):
        raise too_deep
    if HALF_CHARACTER.search(text):
        _refuse_half_characters(data, source)
    return data


def nested_deeper(data: Any, most: int) -> bool:
    """Whether JSON data are nested deeper than so many levels."""
    level = [data]
    for _ in range(most):
        level = [
            child
            for item in level
            if isinstance(item, dict | list)
            for child in (item.values() if isinstance(item, dict) else item)
            if isinstance(child, dict | list)
        ]
        if not level:
            return False
    return True


def _refuse_half_characters(data: Any, source: str) -> None:
    """Refuse text with one half of a surrogate pair: no file in UTF-8 can hold it, so no answer could be written."""
    try:
        json.dumps(data, ensure_ascii=False).encode()
    except UnicodeEncodeError as error:
        half = error.object[error.start].encode("unicode_escape").decode()
        raise InputError(f"it has half a character, {half}", "Give both halves, or none", source=source) from None


def validate(
    model: type[ModelType], data: Any, source: str, more: Callable[[Any], list[InputError]] = lambda data: []
) -> ModelType:
    """Data as a model.

    Args:
        model: the model.
        data: what a file held.
        source: what errors call the file.
        more: further faults that show in the data, told beside those of the model.

    Raises:
        InputError: the fault of the data with its place, or `InputFaults` of all of them in the order of the file.
    """
    try:
        return model.model_validate(data)
    except ValidationError as error:
        found = error.errors(include_url=False)
        beyond = max(0, len(found) - MOST_WORDED)
        found = found[:MOST_WORDED]
        faults = [_fault(model, data, fault, source) for fault in found if fault["loc"]]
        if not beyond:
            faults += more(data)
        faults = faults or [_fault(model, data, fault, source) for fault in found]
        first_of_place = {fault.element: fault for fault in reversed(faults)}.values()
        raise_faults(sorted(first_of_place, key=lambda fault: _order(fault.element, data)), source, beyond)
        raise AssertionError("a validation error has faults") from None


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
    if fault["type"] in PLAIN:
        told = dict(fault.get("ctx", {}))
        if told.get("actual_length", 0) is None:  # pydantic does not count the entries of an object
            told["actual_length"] = len(fault["input"])
        message = PLAIN[fault["type"]].format(**told)
    if fault["type"] == "extra_forbidden":
        return _unknown_field(model, fault["loc"], place, source)
    if "input" in fault and not isinstance(fault["input"], dict | list):
        message += f" (given: {repr(fault['input'])[:MOST_SHOWN]})"
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
    fields = _fields_at(model, location[:-1])
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


MOST_ENTRIES = {"blocks": MOST_BLOCKS, "interfaces": 3 * MOST_BLOCKS}
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
    if not isinstance(data, dict):
        raise InputError("a wall is a JSON object", 'Begin with {"format": "wall/1", ...}', source=source)
    if data.get("format") != "wall/1":
        given = f"format is {data['format']!r}" if "format" in data else "it has no format"
        raise InputError(given, 'This release reads "format": "wall/1"', "format", source)
    for entries, most in MOST_ENTRIES.items():
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
    try:
        return build(wall, name or path.stem)
    except InputError as error:
        error.source = error.source or str(path)
        raise


def wall_json(wall: Wall) -> str:
    """A wall as indented JSON text, fields at their defaults left out."""
    return json.dumps(wall.document(), indent=1, ensure_ascii=False, allow_nan=False) + "\n"
