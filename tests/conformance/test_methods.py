"""Every method that comes with Drystone passes the suite that is shipped for others."""

from __future__ import annotations

import pytest

from harness.conformance import Check, checks
from harness.model.method import load_method

METHODS = ["fe", "la", "la-associated", "de"]


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("check", [pytest.param(check, id=name) for name, check in checks()])
def test_method_conforms(method: str, check: Check):
    assert check(load_method(method)) == ""
