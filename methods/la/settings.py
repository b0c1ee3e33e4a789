"""Settings of the limit-analysis methods."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from harness.model.method import Settings

PositiveFactor = Annotated[float, Field(gt=0.0)]


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
        effort: "quick" one start; "normal" a few starts and continuation in friction, less of both on large walls;
            "deep" many of each whatever the size.
        starts: random interior starts; None as `effort` says.
        ladder: factors on friction for the continuation, in order; None as `effort` says, empty for none.
        failures: draws without success that end a ray descent; None as `effort` says.
        rational_interfaces: interfaces up to which the result is confirmed in fractions.
    """

    seed: int = Field(default=0, ge=0)
    effort: Literal["quick", "normal", "deep"] = "normal"
    starts: int | None = Field(default=None, ge=0)
    ladder: tuple[PositiveFactor, ...] | None = None
    failures: int | None = Field(default=None, ge=1)
    rational_interfaces: int = Field(default=100, ge=0)
