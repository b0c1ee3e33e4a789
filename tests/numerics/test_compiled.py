"""Compiled loops: kept on disk where a folder takes them, and the same arithmetic as in Python."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import numba
import pytest
from numba.core.caching import CacheImpl

from methods.numerics.compiled import compiled, fused
from methods.springs.path import breakpoints


def doubled(value: float) -> float:
    return 2.0 * value


def test_functions_are_compiled_without_a_cache_where_no_folder_can_be_written(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(CacheImpl, "_locator_classes", [])
    assert compiled(doubled)(21.0) == 42.0


def test_loops_are_kept_on_disk_so_that_the_next_process_need_not_compile_them() -> None:
    assert breakpoints.next_breakpoint.stats.cache_path


def test_a_fused_product_is_rounded_once_in_python_as_in_a_compiled_function() -> None:
    a, b = 1.0 + 2.0**-30, 1.0 - 2.0**-30
    alone = numba.njit(lambda x, y, z: fused(x, y, z))
    assert fused(a, b, -1.0) == alone(a, b, -1.0) == -(2.0**-60)
    assert a * b - 1.0 == 0.0


FILES = {
    "lowest.py": "from methods.numerics.compiled import compiled\n\n@compiled\ndef lowest(x):\n    return 2.0 * x\n",
    "middle.py": "from methods.numerics.compiled import compiled\nfrom lowest import lowest\nSHIFT = 1\n\n"
    "@compiled\ndef middle(x):\n    return lowest(x) + 1.0\n",
    "highest.py": "from methods.numerics.compiled import compiled\nfrom middle import SHIFT, middle\n\n"
    "@compiled\ndef highest(x):\n    return middle(x) + SHIFT\n\n"
    "print(highest(1.0), sum(highest.stats.cache_hits.values()))\n",
}
"""Loops of three files that call each other, and a number that one imports."""


def test_code_that_is_kept_is_made_anew_where_what_it_calls_or_takes_from_another_file_changes(tmp_path: Path) -> None:
    """Numba looks at the file of the caller alone, and went on with the old value."""

    def said() -> str:
        places = os.pathsep.join([str(tmp_path), str(Path(__file__).parents[2])])
        words = [sys.executable, str(tmp_path / "highest.py")]
        done = subprocess.run(
            words, env=os.environ | {"PYTHONPATH": places}, capture_output=True, text=True, check=True
        )
        return done.stdout.strip()

    for name, text in FILES.items():
        (tmp_path / name).write_text(text)
    assert said() == "4.0 0"
    assert said() == "4.0 1", "kept"
    (tmp_path / "lowest.py").write_text(FILES["lowest.py"].replace("2.0", "3.0"))
    assert said() == "5.0 0"
    (tmp_path / "middle.py").write_text(FILES["middle.py"].replace("SHIFT = 1", "SHIFT = 5"))
    assert said() == "9.0 0"
    assert said() == "9.0 1"
