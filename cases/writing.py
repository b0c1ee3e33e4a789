"""Cases as text: `case.toml` and `wall.json` written so that a person can read them and a diff stays small.

Used by the generators of this package. The text depends on the values only, so writing twice gives the same bytes.
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from harness.model.case import CaseFile
from harness.model.wall import Wall
from harness.model.writing import write_whole

WIDTH = 118
"""Longest line of JSON that is kept on one line."""


def _case_text(file: CaseFile) -> str:
    """The content of `case.toml`, fields at their defaults left out."""
    data = file.model_dump(mode="json", exclude_defaults=True)
    errata = data.pop("errata", [])
    references = data.pop("references", [])
    parts = [_table(data)]
    parts += ["\n[[errata]]\n" + _table(erratum) for erratum in errata]
    parts += ["\n[[references]]\n" + _table(reference) for reference in references]
    return "".join(parts)


def wall_text(wall: Wall) -> str:
    """The content of `wall.json`, fields at their defaults left out and short lists on one line."""
    return _json(_type_first(wall.document()), 0) + "\n"


def case_files(file: CaseFile, wall: Wall) -> dict[str, str]:
    """The two files of a case by their path below `cases/`."""
    return {f"{file.id}/case.toml": _case_text(file), f"{file.id}/{file.wall}": wall_text(wall)}


def write_files(files: dict[str, str], root: Path) -> list[str]:
    """Write files below a folder and return the paths of those that changed."""
    changed = []
    for name, text in files.items():
        path = root / name
        if path.is_file() and path.read_text(encoding="utf-8") == text:
            continue
        write_whole(path, text)
        changed.append(name)
    return changed


def _type_first(value: Any) -> Any:
    if isinstance(value, list):
        return [_type_first(item) for item in value]
    if not isinstance(value, dict):
        return value
    ordered = {"type": value["type"]} | value if "type" in value else value
    return {key: _type_first(item) for key, item in ordered.items()}


def _table(data: dict[str, Any]) -> str:
    return "".join(f"{key} = {_toml(value)}\n" for key, value in data.items())


def _toml(value: Any) -> str:
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{key} = {_toml(item)}" for key, item in value.items()) + " }" if value else "{}"
    if isinstance(value, list):
        return "[" + ", ".join(_toml(item) for item in value) + "]"
    if isinstance(value, str):
        return json.dumps(value, ensure_ascii=False)
    return repr(value)


def _json(value: Any, depth: int) -> str:
    line = json.dumps(value, ensure_ascii=False, allow_nan=False)
    if not isinstance(value, dict | list) or (depth > 0 and len(line) + depth <= WIDTH):
        return line
    indent = " " * (depth + 1)
    if isinstance(value, dict):
        items = [f"{indent}{json.dumps(key)}: {_json(item, depth + 1)}" for key, item in value.items()]
        return "{\n" + ",\n".join(items) + "\n" + " " * depth + "}"
    items = [indent + _json(item, depth + 1) for item in value]
    return "[\n" + ",\n".join(items) + "\n" + " " * depth + "]"
