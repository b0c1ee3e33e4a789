"""Compiled code: the library of kernels, and numba where there is no library or no folder can be written."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any, NamedTuple

import numba
import numpy as np
import pytest
from numba.core.caching import CacheImpl

from methods.numerics import built
from methods.numerics.compiled import Kernel, compiled, fused
from methods.springs.path import kinks

HERE = Path(__file__).parents[2]
needs_compiler = pytest.mark.skipif(shutil.which("cc") is None, reason="there is no C compiler")


class Pair(NamedTuple):
    first: Any
    second: Any


def doubled(value: float) -> float:
    return 2.0 * value


def total(pair: Pair, share: float) -> float:
    return pair.first[0] / share + pair.second[0, 0]


def room(values: Any, size: int) -> float:
    made = np.empty(size)
    made[0] = values[-1]
    return made[0]


@numba.njit
def chosen(values: Any, which: int) -> float:
    return values[which]


def ends(values: Any) -> float:
    return chosen(values, 0) + chosen(values, 2)


def look_in(folder: Path, patch: pytest.MonkeyPatch) -> None:
    """Take libraries from a folder; the sources lie beside this module."""
    patch.setattr(built, "FOLDER", folder)
    patch.setattr(built, "LIST", folder / "list.json")
    patch.setattr(built, "ROOT", Path(__file__).parent)


@pytest.fixture
def afresh() -> Any:
    """No library is known before the test, nor its own after it."""

    def forget() -> None:
        built._library.cache_clear()
        built._made_of.cache_clear()

    forget()
    yield
    forget()


def build_three(folder: Path) -> None:
    """Build a library of three functions, beside a list of what it was made of."""
    from methods.numerics import ahead

    with pytest.MonkeyPatch.context() as patch:
        look_in(folder, patch)
        calls: list[tuple[Callable[..., Any], tuple[Any, ...]]] = [
            (total, (Pair(np.ones(1), np.ones((1, 1))), 1.0)),
            (room, (np.ones(3), 1)),
            (ends, (np.ones(3),)),
        ]
        kernels = [numba.njit(function) for function, _ in calls]
        for kernel, (_, arguments) in zip(kernels, calls, strict=True):
            kernel(*arguments)
        ahead.build([*kernels, chosen])  # which was compiled for two constants


@pytest.fixture(scope="module")
def library(tmp_path_factory: pytest.TempPathFactory) -> Any:
    """The folder of such a library, built in a process of its own as `harness.kernels` does."""
    folder = tmp_path_factory.mktemp("library")
    program = f"from pathlib import Path; from {__name__} import build_three; build_three(Path({str(folder)!r}))"
    places = os.pathsep.join([str(Path(__file__).parent), str(HERE)])
    environment = os.environ | {"PYTHONPATH": places}
    subprocess.run([sys.executable, "-c", program], env=environment, timeout=300, check=True)
    return folder


@pytest.fixture
def entries(library: Path, afresh: None, monkeypatch: pytest.MonkeyPatch) -> dict[str, Any]:
    look_in(library, monkeypatch)
    return {function.__name__: built.entry(function) for function in (total, room, ends)}


def test_functions_are_compiled_without_a_cache_where_no_folder_can_be_written(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(CacheImpl, "_locator_classes", [])
    assert compiled(doubled)(21.0) == 42.0


def test_a_fused_product_is_rounded_once_in_python_as_in_a_compiled_function() -> None:
    a, b = 1.0 + 2.0**-30, 1.0 - 2.0**-30
    alone = numba.njit(lambda x, y, z: fused(x, y, z))
    assert fused(a, b, -1.0) == alone(a, b, -1.0) == -(2.0**-60)
    assert a * b - 1.0 == 0.0


@needs_compiler
def test_a_function_of_the_library_answers_and_raises_as_it_does_in_python(entries: dict[str, Any]) -> None:
    pair = Pair(np.array([3.0]), np.array([[0.5]]))
    assert entries["total"]((pair, 2.0)) == total(pair, 2.0) == 2.0
    with pytest.raises(ZeroDivisionError):
        entries["total"]((pair, 0.0))
    with pytest.raises(MemoryError):
        entries["room"]((np.ones(3), 2**50))


@needs_compiler
@pytest.mark.parametrize(
    "other",
    [
        np.arange(6.0)[::2],
        np.arange(3),
        np.ones((3, 1)),
        np.array(1.0),
        np.arange(3, dtype=">f8"),
        np.arange(3, dtype=np.float32),
        np.frombuffer(np.arange(3.0).tobytes()),
        [1.0, 2.0],
        None,
    ],
    ids=["strided", "integers", "two_ways", "no_way", "swapped", "short", "read_only", "list", "none"],
)
def test_the_library_refuses_arrays_that_it_was_not_built_for(entries: dict[str, Any], other: Any) -> None:
    count = sys.getrefcount(other)
    for _ in range(100):
        with pytest.raises(TypeError):
            entries["room"]((other, 1))
        with pytest.raises(TypeError):
            entries["total"]((Pair(other, np.ones((1, 1))), 1.0))
    assert sys.getrefcount(other) <= count + 1
    for arguments in ((), (np.ones(3),), ([], 1.0), (Pair(np.ones(1), np.ones((1, 1))), 1.0, 1.0)):
        with pytest.raises(TypeError):
            entries["total"](arguments)


@needs_compiler
def test_what_compiled_code_calls_with_constants_is_inside_its_callers_alone(entries: dict[str, Any]) -> None:
    assert entries["ends"]((np.array([3.0, 0.0, 0.5]),)) == 3.5
    assert built.entry(chosen.py_func) is None


@needs_compiler
def test_numba_takes_what_the_library_refuses(entries: dict[str, Any]) -> None:
    assert built.holds(room)
    assert Kernel(room, False)(np.arange(6.0)[::2], 1) == 4.0


@needs_compiler
@pytest.mark.parametrize("change", ["sources", "conditions", "file"])
def test_another_source_or_processor_makes_the_library_void(
    change: str, library: Path, afresh: None, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    told = json.loads((library / "list.json").read_text(encoding="utf-8"))
    look_in(library, monkeypatch)
    monkeypatch.setattr(built, "LIST", tmp_path / "list.json")
    for changed, valid in ((False, True), (True, False)):
        if changed:
            told[change] = "other.so" if change == "file" else dict.fromkeys(told[change], "other")
        built.LIST.write_text(json.dumps(told), encoding="utf-8")
        built._library.cache_clear()
        built._made_of.cache_clear()
        assert built.holds(total) is valid


ANSWER = """
import sys
from methods.numerics import built
if sys.argv[1] == "numba":
    built.LIST = built.LIST.with_name("none")
import drystone
found = drystone.analyse(drystone.library_wall("wall-21"), "fe")
print("numba" in sys.modules, found.multiplier.hex(), found.forces, found.mechanism)
"""


@needs_compiler
def test_the_library_gives_the_bits_of_numba() -> None:
    assert built.holds(kinks.next_kink), "build the library for these sources: python -m harness.kernels"
    said = {}
    for way in ("library", "numba"):
        done = subprocess.run(
            [sys.executable, "-c", ANSWER, way], cwd=HERE, capture_output=True, text=True, timeout=300, check=True
        )
        imported, _, said[way] = done.stdout.partition(" ")
        assert imported == str(way == "numba")
    assert said["library"] == said["numba"]


@needs_compiler
def test_a_wall_of_many_blocks_finds_its_kernels_in_the_library_too() -> None:
    program = (
        "import sys, drystone\n"
        "found = drystone.analyse(drystone.new_wall('running-bond', length=9.0, height=2.6), 'la-associated')\n"
        "print(found.blocks, found.status, 'drystone_kernels' in sys.modules, 'numba' in sys.modules)"
    )
    done = subprocess.run(
        [sys.executable, "-c", program], cwd=HERE, capture_output=True, text=True, timeout=120, check=True
    )
    assert done.stdout.split() == ["241", "ok", "True", "False"]
