"""A method whose package is missing is refused with a sentence, and no other method is touched."""

from __future__ import annotations

import sys

import pytest

from harness.model.errors import InputError
from harness.model.method_registry import load_method
from tests.walls import assembly, stack


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
