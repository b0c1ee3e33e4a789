"""How Sphinx builds the documentation: `make docs`. Pages under generated/ are written from the code at each build."""

from __future__ import annotations

import inspect
import re
import sys
from pathlib import Path
from typing import Any

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))

import drystone  # noqa: E402

project, author, release = "Drystone", "the Drystone authors", drystone.__version__
extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx.ext.napoleon"]
myst_enable_extensions = ["dollarmath", "deflist"]
myst_heading_anchors = 4
html_theme = "furo"
html_title = f"Drystone {release}"
html_extra_path = ["wall-1.schema.json"]
exclude_patterns = ["_build"]
autodoc_typehints = "description"


def _command_pages(folder: Path) -> None:
    from click import Context

    from harness.cli import COMMANDS, main

    context = Context(main, info_name="drystone")
    parts = ["# The command", "", "Written from the command itself.", ""]
    for name in sorted(COMMANDS):
        command = main.get_command(context, name)
        assert command is not None
        text = command.get_help(Context(command, info_name=name, parent=context))
        parts += [f"## drystone {name}", "", "```text", text, "```", ""]
    (folder / "command.md").write_text("\n".join(parts), encoding="utf-8")


def _columns_page(folder: Path) -> None:
    from reports.columns import RESULTS

    parts = ["# Columns of results", "", "Of results.csv, results.parquet and `to_pandas()`.", ""]
    parts += ["| column | type | unit | meaning |", "|---|---|---|---|"]
    parts += [f"| `{item.name}` | {item.dtype} | {item.unit} | {item.meaning} |" for item in RESULTS]
    (folder / "columns.md").write_text("\n".join(parts) + "\n", encoding="utf-8")


def _settings_page(folder: Path) -> None:
    from harness.model.errors import InputError
    from harness.model.method import load_method, method_names, traits_of

    parts = ["# Methods and their settings", ""]
    for name in method_names():
        try:
            method = load_method(name)
        except InputError as error:
            parts += [f"## {name}", "", f"{error}", ""]
            continue
        parts += [f"## {name}", "", f"{method.title}. Its number: {traits_of(method).caption or 'not said'}.", ""]
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


def _generate(_app: Any) -> None:
    folder = HERE / "generated"
    folder.mkdir(exist_ok=True)
    _command_pages(folder)
    _columns_page(folder)
    _settings_page(folder)


def setup(app: Any) -> None:
    """Write the generated pages before Sphinx looks for sources."""
    app.connect("builder-inited", _generate)
