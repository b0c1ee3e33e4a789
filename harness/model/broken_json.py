"""What stands where a JSON text is broken, in words, and what should."""

from __future__ import annotations

import json
import re

from harness.model.errors import InputError

MOST_SHOWN = 60
"""Characters of a wrong value that are shown."""


def broken(text: str, error: json.JSONDecodeError, source: str) -> InputError:
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
