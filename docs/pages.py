"""Pages of the documentation that are written from the code, under docs/generated/."""

from __future__ import annotations

import inspect
import re
from pathlib import Path
from typing import Any


def command_pages(folder: Path) -> None:
    """The help of every command."""
    from click import Context

    from drystone.cli.main import COMMANDS, main

    context = Context(main, info_name="drystone")
    parts = ["# The command", "", "Generated from the command.", ""]
    for name in sorted(COMMANDS):
        command = main.get_command(context, name)
        assert command is not None
        text = command.get_help(Context(command, info_name=name, parent=context))
        parts += [f"## drystone {name}", "", "```text", text, "```", ""]
    (folder / "command.md").write_text("\n".join(parts), encoding="utf-8")


def columns_page(folder: Path) -> None:
    """The columns of tables of results, of their comparisons with references, and of studies."""
    from harness.engine.sweep.running import STUDY
    from harness.model.bar_forces import BARS
    from harness.model.columns import COMPARISONS, RESULTS
    from harness.model.joint_margins import ANSWERED
    from harness.model.support_reactions import REACTIONS

    parts = ["# Columns of results"]
    for sentence, columns in (
        ("Of results.csv, results.parquet and `to_pandas()`.", RESULTS),
        ("Of comparisons.csv.", COMPARISONS),
        ("Of joints.csv and `joints_to_pandas()`, one row a joint, in the units of the wall.", ANSWERED),
        ("Of `reactions_to_pandas()`, and names of `reactions` in JSON, in the units of the wall.", REACTIONS),
        ("Of `bars_to_pandas()` and bars.csv, and names of `bars` in JSON, in the units of the wall.", BARS),
        ("Of the runs.csv of a study; the varied quantities follow `case`.", STUDY),
    ):
        parts += ["", sentence, "", "| column | type | unit | meaning |", "|---|---|---|---|"]
        parts += [f"| `{item.name}` | {item.dtype} | {item.unit} | {item.meaning} |" for item in columns]
    (folder / "columns.md").write_text("\n".join(parts) + "\n", encoding="utf-8")


def settings_page(folder: Path) -> None:
    """Every installed method with its settings."""
    from harness.model.errors import InputError
    from harness.model.method_registry import listed_methods, load_method

    parts = ["# Methods and their settings", ""]
    for name in listed_methods():
        try:
            method = load_method(name)
        except InputError as error:
            parts += [f"## {name}", "", f"{error}", ""]
            continue
        parts += [f"## {name}", "", f"{method.title}. Its value: {method.traits.caption or 'not stated'}.", ""]
        fields = method.Settings.model_fields
        if fields:
            meanings = _attributes(method.Settings)
            parts += ["| setting | default | meaning |", "|---|---|---|"]
            parts += [
                f"| `{key}` | `{field.get_default(call_default_factory=True)}` | {_one_line(meanings.get(key))} |"
                for key, field in fields.items()
            ]
            parts.append("")
    (folder / "settings.md").write_text("\n".join(parts), encoding="utf-8")


def case_page(folder: Path) -> None:
    """The fields of case.toml."""
    from harness.model.case import CaseFile, Erratum, Reference

    parts = ["# Fields of case.toml", "", "A case is a folder with `case.toml` and `wall.json`. Each field:", ""]
    for title, model in (("The case", CaseFile), ("[[references]]", Reference), ("[[errata]]", Erratum)):
        schema = model.model_json_schema()
        parts += [f"## {title}", "", "| field | type | default | meaning |", "|---|---|---|---|"]
        for name, field in schema["properties"].items():
            default = "needed" if name in schema.get("required", ()) else f"`{field.get('default', [])}`"
            parts.append(f"| `{name}` | {_type_of(field)} | {default} | {_one_line(field.get('description'))} |")
        parts.append("")
    (folder / "case.md").write_text("\n".join(parts), encoding="utf-8")


def _type_of(field: dict[str, Any]) -> str:
    """The type of a field of a JSON Schema, in a few words."""
    if "anyOf" in field:
        return " or ".join(dict.fromkeys(_type_of(item) for item in field["anyOf"]))
    if "enum" in field:
        return ", ".join(str(item) for item in field["enum"])
    if "$ref" in field:
        return str(field["$ref"].rsplit("/", 1)[-1])
    return f"list of {_type_of(field['items'])}" if "items" in field else str(field.get("type", field.get("const", "")))


def _attributes(settings: type) -> dict[str, str]:
    """What the docstrings of a class and its bases say of each attribute under "Attributes:"."""
    found: dict[str, str] = {}
    for base in reversed(settings.__mro__[:-1]):
        name = ""
        text = inspect.cleandoc(base.__doc__ or "")
        for line in text.partition("Attributes:\n")[2].splitlines():
            begun = re.match(r"    (\w+): (.*)", line)
            if begun:
                name = begun[1]
                found[name] = begun[2]
            elif line.startswith("     ") and name:
                found[name] += " " + line
            elif not line.startswith("    "):
                name = ""
    return found


def _one_line(text: str | None) -> str:
    return " ".join((text or "").split()).replace("|", "\\|").replace("$", "\\$")


def licences_page(folder: Path) -> None:
    """The packages that the locks hold, with their licences as they state them."""
    from importlib.metadata import PackageNotFoundError, metadata

    root = Path(__file__).resolve().parent.parent
    parts = ["# Licences of other packages", "", "Drystone has the MIT licence and contains no code of others."]
    for sentence, lock in (
        ("Installed for the main job:", "requirements.lock"),
        ("Installed for the tests as well:", "requirements-tests.lock"),
    ):
        names = dict.fromkeys(re.findall(r"^([\w.-]+)==", (root / lock).read_text(encoding="utf-8"), re.MULTILINE))
        parts += ["", sentence, "", "| package | version | licence |", "|---|---|---|"]
        for name in names:
            try:
                about = metadata(name)
            except PackageNotFoundError:  # it is for another system or version of Python
                continue
            parts.append(f"| {name} | {about['Version']} | {_licence(about)} |")
    (folder / "licences.md").write_text("\n".join(parts) + "\n", encoding="utf-8")


def _licence(about: Any) -> str:
    """The licence that a package states, in a few words."""
    stated = about.get("License-Expression")
    marks = [mark.rsplit(" :: ", 1)[-1] for mark in about.get_all("Classifier") or () if mark.startswith("License ::")]
    first = _one_line((about.get("License") or "").strip().split("\n")[0])
    return _one_line(stated or ", ".join(marks) or first[:80] or "not stated")


ALL = (command_pages, columns_page, settings_page, case_page, licences_page)
"""Every writer of a page."""
