"""Text, JSON and TOML of a file that may be anything: sizes and depths have an end, every fault is one sentence."""

from __future__ import annotations

import json
import math
import os
import re
import stat
import tomllib
from collections import Counter
from pathlib import Path
from typing import IO, Any

from harness.model.errors import InputError, did_you_mean

LARGEST_FILE = 256 * 2**20
"""Bytes that are read from one file at most: 100,000 blocks with their interfaces written out are about 150 MB."""


_MOST_VALUES = 4_000_000
"""Numbers, texts, lists and objects of a JSON document: 100,000 blocks with interfaces written out have as many. Each
takes some 200 bytes when it is read, so the document takes less than 1 GB."""


MOST_NESTED = 40
"""Depth of a JSON document. A wall needs 7 levels; beyond some 200 its readers and writers reach their own limits."""


_HALF_CHARACTER = re.compile(r"\\u[dD][89a-fA-F]")
"""An escape that is one half of a surrogate pair."""


_KINDS = {
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


def value_text(value: Any) -> str:
    """A value as a file writes it, cut where it is long: true, null and text in double quotes, not True and None."""
    return json.dumps(value, ensure_ascii=False, default=str)[:MOST_SHOWN]


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
        raise InputError("there is no such file", near(path) or "Check the path", source=source) from None
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


def near(path: Path) -> str:
    """The question whether another file of the same folder was meant; empty where none is near."""
    try:
        return did_you_mean(path.name, sorted({each.name for each in path.parent.iterdir()} - {path.name}))
    except OSError:
        return ""


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


def read_toml(path: Path, limit: int = LARGEST_FILE) -> dict[str, Any]:
    """The content of a TOML file of limited size.

    Args:
        path: the file.
        limit: most bytes that are read.

    Raises:
        InputError: as by `read_text`, or the text is no TOML, nested too deeply, or has a number of too many digits.
    """
    text, source = read_text(path, limit), str(path)
    try:
        return tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise InputError(f"it is no TOML ({error})", "Give valid TOML", source=source) from None
    except ValueError:
        raise InputError("it has a number of thousands of digits", "Give finite numbers", source=source) from None
    except RecursionError:
        raise InputError("its lists or tables are nested too deeply", "Give flat ones", source=source) from None


def text_of(content: bytes, source: str, otherwise: str = "") -> str:
    """The text of a file in UTF-8, a byte order mark left out, or in the encoding `otherwise` where that is given.

    Raises:
        InputError: it is no text; what it is where its first bytes say so.
    """
    kind = next((kind for begin, kind in _KINDS.items() if content.startswith(begin)), "")
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


def require_format(data: Any, wanted: str, what: str, source: str) -> dict[str, Any]:
    """The fields of a JSON document of one format.

    Args:
        data: the document.
        wanted: the format that is read, as "wall/1".
        what: a document of it is called, as "a wall".
        source: what errors call the file.

    Raises:
        InputError: it is no object, or has another format or version, or none.
    """
    if not isinstance(data, dict):
        raise InputError(f"{what} is a JSON object", f'Begin with {{"format": "{wanted}", ...}}', source=source)
    if data.get("format") != wanted:
        remedy = f'This release reads "format": "{wanted}"'
        raise InputError(f"it is not {what}: {format_in_words(data)}", remedy, "format", source)
    return data


def format_in_words(data: dict[str, Any]) -> str:
    """The format that a JSON document says it has, as the clause of a sentence."""
    return f"its format is {value_text(data['format'])}" if "format" in data else "it has no format"


def read_json(path: Path, limit: int = LARGEST_FILE) -> Any:
    """The content of a JSON file.

    Raises:
        InputError: unreadable, not JSON, NaN or infinite numbers, a name given twice, or nested too deeply.
    """
    return json_of(read_text(path, limit), str(path))


def json_of(text: str, source: str, most_values: int = _MOST_VALUES, most_nested: int = MOST_NESTED) -> Any:
    """The value of JSON text.

    Args:
        text: of the document.
        source: what errors call it.
        most_values: values that it may have; commas and brackets are counted for them before anything is made.
        most_nested: levels that it may have.

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

    too_deep = InputError(f"it is nested more than {most_nested} deep", "Give a flat document", source=source)
    try:
        data = json.loads(text, parse_constant=refuse_constant, parse_float=finite, object_pairs_hook=unique)
    except json.JSONDecodeError as error:
        raise _broken(text, error, source) from None
    except ValueError:
        raise InputError("it has a number of thousands of digits", "Give finite numbers", source=source) from None
    except RecursionError:
        raise too_deep from None
    if nested_deeper(data, most_nested):
        raise too_deep
    if _HALF_CHARACTER.search(text):
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


MOST_SHOWN = 60
"""Characters of a wrong value that are shown."""


def _broken(text: str, error: json.JSONDecodeError, source: str) -> InputError:
    """What stands where JSON text is broken, and what should."""
    if not text.strip():
        return InputError("it is empty", "Give a JSON document", source=source)
    if text.lstrip().startswith("<"):
        return InputError(
            "it is XML or HTML, not JSON", "Give a drawing the ending of its format, as .svg", source=source
        )
    left, rest = text[: error.pos].rstrip(), text[error.pos :].lstrip()
    awaited = error.msg.startswith(("Illegal trailing comma", "Expecting property", "Expecting value"))
    comma = awaited and (left.endswith(",") or rest.startswith(","))
    rest = rest.removeprefix(",").lstrip() if comma else rest
    found, right = f"{error.msg[0].lower()}{error.msg[1:]}", "Give valid JSON"
    if error.msg.startswith("Extra data"):
        found, right = "something stands after the end of the document", "Give one document"
    elif error.msg.startswith(("Unterminated string", "Invalid control")):
        found, right = "a text has no end in its line", "Close it with a quote"
    elif not rest:
        found, right = "the file ends in the middle", "Close its brackets, or copy the whole of it"
    elif comma and rest[0] in "]}":
        found, right = f'a comma too many stands before "{rest[0]}"', "Take it out"
    elif awaited and rest[0] in "]}":
        found, right = f'a value is missing before "{rest[0]}"', "Give it"
    elif rest[0] == "'":
        found, right = "single quotes stand round a text", 'Use double quotes, "'
    elif rest.startswith(("//", "/*", "#")):
        found, right = "a comment stands there, and JSON has none", "Take it out"
    elif python := re.match("True|False|None", rest):
        found, right = f"{python[0]} is a word of Python", "Write true, false or null"
    elif error.msg.startswith("Expecting ',' delimiter"):
        found, right = f'"{rest[0]}" stands where a comma or a closing bracket is expected', "Put it in"
    elif error.msg.startswith("Expecting ':' delimiter"):
        found, right = f'"{rest[0]}" stands where a colon is expected', "Put it in"
    elif awaited:
        what = "a name in double quotes" if "property" in error.msg else "a value"
        found, right = f'"{rest.split()[0][:MOST_SHOWN]}" stands where {what} is expected', "Give valid JSON"
    return InputError(f"line {error.lineno}, column {error.colno}: {found}", right, source=source)
