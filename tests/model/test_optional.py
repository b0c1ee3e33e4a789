"""A method or a figure whose package is missing is refused with a sentence, and nothing else is touched."""

from __future__ import annotations

import subprocess
import sys
from base64 import b64decode
from pathlib import Path

import pytest

from drystone import Result, Wall, analyse, library_wall
from harness.model.errors import InputError, MissingPackage
from harness.model.method_registry import load_method, prepared
from tests.walls import assembly, stack

WITHOUT_FIGURES = """
import sys
sys.modules["matplotlib"] = sys.modules["PIL"] = None
from drystone.__main__ import main
sys.argv[:] = ["drystone", *sys.argv[1:]]
main()
"""


@pytest.mark.parametrize(
    ("method", "package", "extra"),
    [
        ("la-paper", "ipyopt", "paper"),
        ("la-associated-cvxpy", "cvxpy", "cvxpy"),
        ("de-mujoco", "mujoco", "mujoco"),
        ("de-box2d", "pyb2d3", "box2d"),
    ],
)
def test_a_missing_package_is_told_with_the_extra_that_brings_it(
    method: str, package: str, extra: str, monkeypatch: pytest.MonkeyPatch
):
    monkeypatch.setitem(sys.modules, package, None)
    found = load_method(method)
    with pytest.raises(InputError, match=rf"needs the package {package} .*drystone\[{extra}\]"):
        found.solve(assembly(stack(2)), found.Settings())


def test_a_peer_that_loads_a_missing_package_says_so_and_no_class_of_python(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setitem(sys.modules, "pyscipopt", None)
    with pytest.raises(MissingPackage, match=r"needs the package pyscipopt .*drystone\[scip\]") as caught:
        prepared(load_method("scip"))
    assert "cannot be loaded" not in str(caught.value)


def without_figures(folder: Path, *words: str) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-c", WITHOUT_FIGURES, *words]
    return subprocess.run(command, cwd=folder, capture_output=True, text=True, timeout=120, check=False)


@pytest.mark.parametrize(
    "words",
    [
        ("show", "slide"),
        ("figure", "slide"),
        ("animate", "slide"),
        ("domain", "slide", "-o", "domain.svg"),
        ("report", "--figures"),
        ("report", "--appendix", "slide"),
    ],
    ids=" ".join,
)
def test_a_figure_without_matplotlib_is_refused_before_anything_is_written(words: tuple[str, ...], tmp_path: Path):
    done = without_figures(tmp_path, *words)
    assert done.returncode == 2, done.stderr
    assert 'pip install "drystone[figures]"' in done.stderr
    assert list(tmp_path.iterdir()) == []


def test_a_comparison_and_a_notebook_need_no_matplotlib(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    done = without_figures(tmp_path, "compare", "slide", "--methods", "la-associated,fe", "--store", "runs.sqlite")
    assert done.returncode == 0, done.stderr
    assert (tmp_path / "out/report.html").exists()
    monkeypatch.setitem(sys.modules, "matplotlib", None)
    assert b"<svg" in drawn(library_wall("slide"))
    assert b"<svg" in drawn(analyse(library_wall("slide"), "la-associated"))


def drawn(shown: Wall | Result) -> bytes:
    """The image in what a notebook shows."""
    return b64decode(shown._repr_html_().partition("base64,")[2].partition('"')[0])
