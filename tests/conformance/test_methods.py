"""Every method that comes with Drystone passes the suite that is shipped for others."""

from __future__ import annotations

import pytest

from harness.conformance import ConformanceCheck, checks
from harness.conformance.suite import Outcome
from harness.model.method_registry import load_method

METHODS = [
    "fe",
    "fe-newton",
    "fe-qp",
    "la",
    "la-associated",
    "la-associated-cvxpy",
    "la-from-fe",
    "la-paper",
    "la-tresca",
]
METHODS += ["de", "de-soft", "de-tilt"]


FULL = {(check, method) for check in ("time", "memory") for method in METHODS if method not in ("fe", "la", "de")}
"""Checks left to the full tier: many methods use the two or five seconds of these runs."""


@pytest.mark.parametrize(
    ("check", "method"),
    [
        pytest.param(check, method, id=f"{name}-{method}", marks=[pytest.mark.slow] * ((name, method) in FULL))
        for name, check in checks()
        for method in METHODS
    ],
)
def test_method_conforms(check: ConformanceCheck, method: str):
    """Walls with cohesion or dilatancy, or of a hundred blocks, may be refused, and nothing else."""
    row = check.row(load_method(method))
    allowed = {Outcome.CONFORMS, Outcome.REFUSED} if check.group in ("features", "limits") else {Outcome.CONFORMS}
    assert row.outcome in allowed, row.sentence
