"""Compiled loops: kept on disk where a folder takes them, and the same arithmetic as in Python."""

from __future__ import annotations

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
