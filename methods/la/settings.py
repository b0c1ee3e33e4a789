"""Settings of the limit-analysis methods."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from harness.model.method import Settings


class AssociatedSettings(Settings):
    """Settings of `la-associated`.

    Attributes:
        solver: "highs" (simplex), "interior" (own primal-dual interior point) or "auto" (by size).
    """

    solver: Literal["auto", "highs", "interior"] = "auto"


class CvxpySettings(Settings):
    """Settings of `la-associated-cvxpy`.

    Attributes:
        solver: a linear solver cvxpy knows; HIGHS gives a vertex.
    """

    solver: str = "HIGHS"


class SearchSettings(Settings):
    """Settings of `la`. Effort is counted in programmes, so the answer does not depend on the machine.

    Attributes:
        seed: of all random draws.
        effort: "quick" one start; "normal" a few starts and, above `continuation_from`, continuation in friction;
            "deep" many of each.
        starts: random interior starts; None as `effort` says.
        failures: draws without success that end a ray descent; None as `effort` says.
        rational_interfaces: interfaces up to which the result is confirmed in fractions.
    """

    seed: int = Field(default=0, ge=0)
    effort: Literal["quick", "normal", "deep"] = "normal"
    starts: int | None = Field(default=None, ge=0)
    failures: int | None = Field(default=None, ge=1)
    rational_interfaces: int = Field(default=100, ge=0)
