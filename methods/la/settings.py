"""Settings of the limit-analysis methods."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from harness.model.method import Settings

PositiveFactor = Annotated[float, Field(gt=0.0)]


class AssociatedSettings(Settings):
    """Settings of `la-associated`.

    Attributes:
        solver: "highs" (simplex), "interior" (own interior point, and a vertex of HiGHS where its end is not clear) or
            "auto" (by size).
    """

    solver: Literal["auto", "highs", "interior"] = "auto"


class CvxpySettings(Settings):
    """Settings of `la-associated-cvxpy`.

    Attributes:
        solver: a linear solver cvxpy knows; HIGHS gives a vertex.
        cone_solver: one for second-order cones, where joints have a compressive strength.
    """

    solver: str = "HIGHS"
    cone_solver: str = "CLARABEL"


class SearchSettings(Settings):
    """Settings of `la`. Effort is counted in programmes, so the answer does not depend on the machine.

    Attributes:
        seed: of all random draws.
        effort: "quick" few paths and descents; "normal" continuation in friction too, less of it on large walls; "deep"
            much of everything, whatever the size.
        starts: central paths with other weights of the blocks that may lead to nothing lower in a row; None as
            `effort` says.
        continuation: factors on friction of the friction continuation, in order; None as `effort` says, empty for none.
        failures: draws without success that end a ray descent; None as `effort` says.
        rational_interfaces: interfaces up to which the result is confirmed in fractions.
        bound_seconds: of CPU time for a lower bound as of `la-bound`, where no tree proves the state to be the least;
            None: 60 for "deep", else none. The multiplier does not depend on it.
    """

    seed: int = Field(default=0, ge=0)
    effort: Literal["quick", "normal", "deep"] = "normal"
    starts: int | None = Field(default=None, ge=0)
    continuation: tuple[PositiveFactor, ...] | None = None
    failures: int | None = Field(default=None, ge=1)
    rational_interfaces: int = Field(default=100, ge=0)
    bound_seconds: float | None = Field(default=None, ge=0.0)

    @property
    def bound(self) -> BoundSettings | None:
        """The settings of the bound; None where none is asked for."""
        seconds = self.bound_seconds if self.bound_seconds is not None else 60.0 * (self.effort == "deep")
        return BoundSettings(bound_seconds=seconds) if seconds > 0.0 else None


class BoundSettings(Settings):
    """Settings of `la-bound`.

    Attributes:
        seed, effort: of the search of `la` that comes first.
        bound_seconds: of CPU time for the bound, which is the best one reached by then.
        most_interfaces: walls with more have no bound, because the matrices of products are dense, and tens of
            thousands of iterations are needed.
        largest_certificate: characters of a certificate above which the answer holds its bound only, because results
            are kept and copied; `drystone bound` writes it whatever its size.
    """

    seed: int = Field(default=0, ge=0)
    effort: Literal["quick", "normal", "deep"] = "normal"
    bound_seconds: float = Field(default=120.0, gt=0.0)
    most_interfaces: int = Field(default=300, ge=0)
    largest_certificate: int = Field(default=500_000, ge=0)

    def search(self) -> SearchSettings:
        """The settings of the search."""
        return SearchSettings(seed=self.seed, effort=self.effort)


class PaperSettings(Settings):
    """Settings of `la-paper`.

    Attributes:
        start: "zero" for the paper's r2 = 0, "fe" for the contact forces of the finite-element collapse state.
        max_blocks: walls with more free blocks are refused.
        max_iterations: of Ipopt, for each relaxation.
        epsilons: bounds on y.m relative to the live work, in order.
    """

    start: Literal["zero", "fe"] = "zero"
    max_blocks: int = Field(default=50, ge=1)
    max_iterations: int = Field(default=500, ge=1)
    epsilons: tuple[PositiveFactor, ...] = (1e-2, 1e-4, 1e-6, 1e-8)


class TrescaSettings(Settings):
    """Settings of `la-tresca`.

    Attributes:
        max_iterations: programmes at most.
        weight: part of the new normal force in the next friction bound.
        settled: largest change of a bound, in mean block weights, at which the sequence has settled.
    """

    max_iterations: int = Field(default=300, ge=1)
    weight: float = Field(default=0.7, gt=0.0, le=1.0)
    settled: float = Field(default=1e-10, gt=0.0)


class FromFeSettings(Settings):
    """Settings of `la-from-fe`.

    Attributes:
        seed: of the ray descent.
        fe_method: the installed method whose collapse state is the start.
        failures: draws without success that end a descent.
    """

    seed: int = Field(default=0, ge=0)
    fe_method: str = "fe"
    failures: int = Field(default=12, ge=1)


class ReactionSettings(Settings):
    """Settings of `la-reaction`.

    Attributes:
        greatest: whether the greatest reaction is asked for; else the least.
    """

    greatest: bool = False


class ClosureTolerances(Settings):
    """How exactly points that meet are brought together again after a step along a mechanism.

    Attributes:
        distance: between them at the end, in sizes of a block.
        steps: of Newton's method, at most.
        damping: added to the normal equations, as a share of their mean diagonal: closed joints give more conditions
            than there are motions.
    """

    distance: float = 1e-13
    steps: int = 30
    damping: float = 1e-12


class SettlingSteps(Settings):
    """Steps of the displacement. Lengths are in sizes of a block, moved by the fastest vertex of the supports.

    Attributes:
        first, longest: step; longer: factor on the next. Between two steps nothing changes but by the linkage, so that
            they only space the points of the curve.
        width: to which the largest displacement with an admissible state is bisected: forces are exact to 1e-12.
        proofs: powers of ten of the width beyond it, at most, at which a mechanism is looked for that proves the fall;
            immense: forces, in dead loads of the wall, that it would need to stand in spite of that. Rounding leaves
            each contact half a unit in the last place to close by, and a single one three times as much, so the proof
            takes a displacement of about 1e-7.
        moves: rates below this share of the fastest vertex are none: those of a vertex are exact to 1e-12.
        far: displacement after which the supports are followed no further.
        most: steps.
        closure: how exactly pins are closed.
    """

    first: float = 0.02
    longer: float = 1.5
    longest: float = 0.1
    width: float = 1e-9
    proofs: int = 6
    immense: float = 1e7
    moves: float = 1e-8
    far: float = 1e3
    most: int = 20_000
    closure: ClosureTolerances = Field(default_factory=ClosureTolerances)


class CapacitySteps(SettlingSteps):
    """Steps of a collapse that goes on, shorter: a curve of them is drawn."""

    first: float = 0.01
    longer: float = 1.2
    longest: float = 0.02
