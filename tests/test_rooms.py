"""A class name of the methods leads to one place, and benchmarks run on one runner."""

from __future__ import annotations

import ast
import os
import subprocess
import sys
from collections import Counter
from pathlib import Path

ROOT = Path(__file__).parents[1]
MODULES = [path for path in (ROOT / "methods").rglob("*.py") if path.name != "__init__.py"]


def test_no_two_classes_of_the_methods_have_one_name():
    classes = [
        node.name
        for path in MODULES
        for node in ast.parse(path.read_text(encoding="utf-8")).body
        if isinstance(node, ast.ClassDef) and not node.name.startswith("_")
    ]
    assert len(MODULES) > 80
    assert len(classes) > 100
    assert [name for name, count in Counter(classes).items() if count > 1] == []


def benchmarks(*words: str) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-m", "benchmarks", *words]
    return subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)


def test_benchmarks_are_listed_with_what_they_measure():
    done = benchmarks()
    assert done.returncode == 0, done.stderr
    listed = {line.split()[0] for line in done.stdout.splitlines()}
    assert listed == {path.stem for path in (ROOT / "benchmarks").glob("[a-z]*.py")} - {"walls"}
    assert all(len(line.split(maxsplit=1)[1]) > 20 for line in done.stdout.splitlines())


def test_unknown_benchmark_is_refused_with_the_list_of_those_there_are():
    done = benchmarks("speed")
    assert done.returncode == 2
    assert "overhead" in done.stdout


def test_list_of_benchmarks_ends_without_a_word_where_its_reader_has_left():
    reading, writing = os.pipe()
    os.close(reading)
    done = subprocess.run(
        [sys.executable, "-m", "benchmarks"], cwd=ROOT, stdout=writing, stderr=subprocess.PIPE, check=False
    )
    os.close(writing)
    assert (done.returncode, done.stderr) == (0, b"")
