"""What the docs tell a reader to type: every command line exists, and those of `console` blocks end well.

A block ```` ```json NAME ```` or ```` ```toml NAME ```` is the file NAME of the commands below it on its page. Blocks
```` ```console ```` are run in their order; those marked `slow` in the full tier only; other blocks are only parsed.
"""

from __future__ import annotations

import re
import shlex
from dataclasses import dataclass
from pathlib import Path

import click
import pytest
from click.testing import CliRunner

from drystone.cli.main import COMMANDS, main

ROOT = Path(__file__).resolve().parents[2]
PAGES = [
    path
    for path in (*ROOT.glob("*.md"), *(ROOT / "docs").rglob("*.md"))
    if "generated" not in path.relative_to(ROOT).parts and path.name != "CHANGELOG.md"
]
FENCE = re.compile(r"^```([^\n`]*)\n(.*?)^```", re.DOTALL | re.MULTILINE)
INLINE = re.compile(r"`(drystone [^`]+)`")


@dataclass(frozen=True)
class Step:
    """A file to write (`name`) or a command to run."""

    name: str
    text: str
    slow: bool


def _steps(page: Path) -> list[Step]:
    steps = []
    for info, text in FENCE.findall(page.read_text(encoding="utf-8")):
        words = info.split()
        if words[:1] == ["console"]:
            steps += [Step("", line, "slow" in words) for line in _commands(text)]
        elif len(words) == 2 and "." in words[1]:
            steps.append(Step(words[1], text, False))
    return steps


def _commands(text: str) -> list[str]:
    return [line for line in text.splitlines() if line.startswith("drystone ")]


def _written(page: Path) -> list[str]:
    text = page.read_text(encoding="utf-8")
    shown = [line for _, block in FENCE.findall(text) for line in _commands(block)]
    return shown + INLINE.findall(FENCE.sub("", text))


RUN = [page for page in PAGES if any(not step.name for step in _steps(page))]


@pytest.mark.parametrize("page", PAGES, ids=lambda path: str(path.relative_to(ROOT)))
def test_commands_and_options_exist(page: Path):
    for line in _written(page):
        words = shlex.split(line.split("#")[0])[1:]
        if words[0].startswith("-"):
            continue
        assert words[0] in COMMANDS, line
        context = click.Context(main)
        command = main.get_command(context, words[0])
        if isinstance(command, click.Group) and words[1:] and not words[1].startswith("-"):
            command = command.get_command(context, words[1])
        assert command is not None, line
        known = {name for item in command.params for name in (*item.opts, *item.secondary_opts)} | {"--help", "-h"}
        assert [word for word in words[1:] if word.startswith("-") and word not in known] == [], line


@pytest.mark.parametrize("page", RUN, ids=lambda path: str(path.relative_to(ROOT)))
@pytest.mark.parametrize("slow", [False, pytest.param(True, marks=pytest.mark.slow)], ids=["quick", "slow"])
def test_commands_end_well(page: Path, slow: bool, tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.chdir(tmp_path)
    for step in _steps(page):
        if step.name:
            path = tmp_path / step.name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(step.text, encoding="utf-8")
        elif slow or not step.slow:
            done = CliRunner().invoke(main, shlex.split(step.text.split("#")[0])[1:])
            assert done.exit_code == 0, f"{step.text}\n{done.output}"
