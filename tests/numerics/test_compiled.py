"""Compiled code where no folder can be written."""

from __future__ import annotations

import pytest
from numba.core.caching import CacheImpl

from methods.numerics.compiled import compiled


def doubled(value: float) -> float:
    return 2.0 * value


def test_functions_are_compiled_without_a_cache_where_no_folder_can_be_written(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(CacheImpl, "_locator_classes", [])
    assert compiled(doubled)(21.0) == 42.0
