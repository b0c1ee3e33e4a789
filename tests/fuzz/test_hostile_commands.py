"""Hostile words and files of every command: each ends at once in a sentence and exit code 2, and writes nothing."""

from __future__ import annotations

import json
import os
from pathlib import Path

import pytest

from tests.fuzz.forked import drystone as command
from tests.fuzz.hostile import KINDS, PUSH, wall

TIE = {"from": {"block": "a", "at": [0.5, 0.25]}, "to": {"block": "ground", "at": [0, -0.5]}, "yield_force": 1}
STUDY = 'name = "a"\ntitle = "a"\ncases = ["w.json"]\nmethods = ["la"]\n'
FILES = {
    "w.json": json.dumps(wall()),
    "cases.json": json.dumps(wall(loads={}, load_cases={f"c{k}": {"live": {"body": [PUSH]}} for k in range(300)})),
    "product.json": json.dumps(KINDS["products of loads that travel"](1)),
    "names.json": json.dumps(KINDS["rules for no block"](2_000)),
    "tied.json": json.dumps(wall(ties=[TIE])),
    "crushed.json": json.dumps(wall(compressive_strength=500)),
    "nested.json": "[" * 100_000,
    "digits.json": '{"format": "result/1", "multiplier": ' + "9" * 100_000 + "}",
    "long.json": json.dumps({"format": "result/1", "multiplier": 0.5, "forces": [[0, 0, 0]] * 100_000}),
    "fields.json": json.dumps({"format": "result/1", "multiplier": 0.5} | {f"x{k}": 0 for k in range(20_000)}),
    "axes.toml": STUDY + "[vary]\n" + "".join(f"a{k} = {{from = 0, to = 1, count = 1000000}}\n" for k in range(100)),
    "draws.toml": STUDY
    + "samples = 1000000\n[draw]\n"
    + "".join(f'q{k} = {{distribution = "uniform", low = 0, high = 1}}\n' for k in range(100)),
    "nested.toml": "methods = " + "[" * 5_000 + "]" * 5_000,
    "digits.toml": "methods = " + "9" * 5_000,
    "many.toml": "".join(f"[methods.m{k}]\ncommand = [5, '{{wall}}']\n" for k in range(5_000)),
    "lists.toml": STUDY + "[vary]\nfriction = " + "[" * 5_000 + "]" * 5_000 + "\n",
}
READ = ("factor {}", "reaction {}", "bound {} -o o.json", "domain {}", "figure {} -o o.pdf", "animate {} -o o.gif",
        "export {} -o o.csv", "compare {} --methods la", "run la {}", "judge {} long.json")  # fmt: skip
ASKED = [
    *(each.format(name) for each in READ for name in ("product.json", "names.json", "nested.json")),
    *("run de-soft tied.json", "run de-uneven tied.json", "run la-bound crushed.json"),
    "factor crushed.json --method fe-qp",
    "domain tied.json --method de-soft",
    "figure tied.json --methods de-soft -o o.pdf",
    "animate tied.json --method de-soft -o o.gif",
    "export tied.json --method de-soft -o o.vtu",
    "run la cases.json",
    "run la w.json --live 1e308,1e308",
    "run la w.json --seconds 1e308",
    "run la w.json --memory 999999999999999999999",
    "run la w.json --set effort=" + "[" * 20_000,
    "factor w.json --share 1e308",
    "domain w.json --live 1e308,0 --live 0,1e308",
    "bound w.json -o o.json --seconds nan",
    "animate w.json -o o.xyz",
    "figure w.json -o o.xyz",
    "domain w.json -o o.xyz",
    "sweep w.json --vary friction=0:1:1000000000",
    "sweep w.json --vary friction=1 --vary friction=2",
    "sweep w.json --vary friction=" + "[" * 100_000,
    "sweep axes.toml",
    "sweep draws.toml",
    "sweep lists.toml",
    "sweep digits.toml",
    *(f"--methods-file {name}.toml run m0 w.json" for name in ("nested", "digits", "many")),
    "judge w.json nested.json",
    "judge w.json digits.json",
    "judge w.json long.json",
    "judge w.json fields.json",
    "diff nested.json w.json",
    "verify-bound nested.json",
]
LONGEST = 60_000
"""Characters that are said: the hundred lines of an error, each with the fields that are known at its place."""


@pytest.mark.skipif(not hasattr(os, "fork"), reason="the cost of one command is that of a child process")
@pytest.mark.parametrize("asked", ASKED, ids=lambda asked: asked[:50])
def test_a_hostile_word_or_file_ends_in_a_sentence_and_nothing_is_written(asked: str, tmp_path: Path) -> None:
    folder = tmp_path / "here"
    folder.mkdir()
    for name in FILES.keys() & set(asked.split()) | {"w.json"}:
        (folder / name).write_text(FILES[name])
    before = set(os.listdir(folder))
    ended = command(asked.split(), folder, tmp_path / "said")
    assert ended.code == 2, ended.said
    assert "Traceback" not in ended.said
    assert "Warning" not in ended.said
    assert ended.said.startswith(("drystone: ", "Usage: "))
    assert len(ended.said) < LONGEST
    assert set(os.listdir(folder)) == before
    assert ended.seconds < 5.0
    assert ended.mebibytes < 1024.0
