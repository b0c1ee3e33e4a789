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


def _case_page(folder: Path) -> None:
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


def _signs_figure(folder: Path) -> None:
    """Two blocks with the interface between them: ends, normal, tangent, and what acts on b."""
    from matplotlib.figure import Figure

    page = Figure(figsize=(4.6, 3.4))
    axes = page.subplots()
    axes.set_aspect("equal")
    axes.axis("off")
    for corners, name in ((((0, -1), (4, -1), (4, 0), (0, 0)), "a"), (((0, 0), (4, 0), (4, 1.6), (0, 1.6)), "b")):
        axes.fill(*zip(*corners, strict=True), facecolor="#eef2f6", edgecolor="#14202b", linewidth=0.8)
        axes.text(3.7, 0.5 * (corners[0][1] + corners[2][1]), name, fontsize=11, style="italic", va="center")
    arrow = {"arrowstyle": "-|>", "linewidth": 1.4, "shrinkA": 0, "shrinkB": 0}
    for (x, y), (dx, dy), words, (tx, ty), colour in (
        ((0, 0), (0, 0.9), "$n_1$", (0.1, 0.8), "#17508c"),
        ((4, 0), (0, 0.7), "$n_2$", (4.1, 0.55), "#17508c"),
        ((1.0, 0.12), (0.9, 0), "$s$", (1.4, 0.2), "#17508c"),
        ((2.4, 0), (0, 0.6), "$n$", (2.5, 0.5), "#a63c06"),
        ((2.4, 0), (0.6, 0), "$t$", (2.9, -0.3), "#a63c06"),
    ):
        axes.annotate("", (x + dx, y + dy), (x, y), arrowprops={**arrow, "color": colour})
        axes.text(tx, ty, words, color=colour, fontsize=11)
    axes.plot([0, 4], [0, 0], "o", color="#14202b", markersize=4)
    axes.text(-0.3, -0.05, "1", va="center")
    axes.text(4.15, -0.2, "2", va="center")
    axes.plot([2], [1.2], "+", color="#14202b")
    axes.text(2.1, 1.2, "$c$", va="center")
    axes.annotate("", (1.75, 1.35), (2.3, 0.95), arrowprops={**arrow, "connectionstyle": "arc3,rad=0.9"})
    axes.text(1.35, 1.2, "$\\omega$", fontsize=11)
    page.savefig(folder / "signs.svg", bbox_inches="tight", metadata={"Date": None})


def _generate(_app: Any) -> None:
    folder = HERE / "generated"
    folder.mkdir(exist_ok=True)
    _command_pages(folder)
    _columns_page(folder)
    _settings_page(folder)
    _case_page(folder)
    _signs_figure(folder)


def setup(app: Any) -> None:
    """Write the generated pages before Sphinx looks for sources."""
    app.connect("builder-inited", _generate)
