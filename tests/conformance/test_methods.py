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


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("check", [pytest.param(check, id=name) for name, check in checks()])
def test_method_conforms(method: str, check: ConformanceCheck):
    """Walls with cohesion or dilatancy, or of a hundred blocks, may be refused, and nothing else."""
    row = check.row(load_method(method))
    allowed = {Outcome.CONFORMS, Outcome.REFUSED} if check.group in ("features", "limits") else {Outcome.CONFORMS}
    assert row.outcome in allowed, row.sentence
