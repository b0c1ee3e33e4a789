"""When numbers of the continuation count as soft, as straight, as lost, or as a mechanism."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class SoftMotions:
    """When a piece of the path is soft, so that its motion is pinned in the factor.

    Attributes:
        velocity: multiple of the first piece's velocity, at the same rate of the multiplier, above which the fastest
            displacement is pinned.
        response: the same of the pinned wall's response to the live load, which shows a further soft motion.
        held: share of the fastest displacement below which the pin no longer holds the motion, and is moved.
        most: pins at most.
    """

    velocity: float = 1e4
    response: float = 1e8
    held: float = 1e-3
    most: int = 4


@dataclass(frozen=True)
class RefinementTolerances:
    """Iterative refinement of the velocity, by its defect in K v = l live.

    Attributes:
        defect: share of the live load above which a velocity is refined, and the tangent factorised afresh when that no
            longer helps.
        soft_defect: the same on pinned pieces, as forces over a motion as long as the displacements; soft_accepted:
            when refinement no longer helps, above which the tangent is factorised afresh.
        contraction: share of the defect before it that a step must leave at most, or refinement no longer helps.
        steps: at most.
        doubled: displacements (dimensionless) above which gap rates of pinned pieces are measured in doubled
            precision: up to there their rounding changes no force by more than 1e-9.
    """

    defect: float = 1e-7
    soft_defect: float = 1e-7
    soft_accepted: float = 1e-4
    contraction: float = 0.5
    steps: int = 8
    doubled: float = 1e6


@dataclass(frozen=True)
class UpdateTolerances:
    """How long a factor is corrected by rank-one changes before the tangent is factorised afresh.

    Attributes:
        pivot: |1 + b'y|, or its inverse, above which a change would cost digits.
        balance_every: changes between two looks at the out-of-balance force.
    """

    pivot: float = 1e8
    balance_every: int = 8


@dataclass(frozen=True)
class DriftTolerances:
    """Out-of-balance forces on the path, as shares of the load scale.

    Attributes:
        removed: above this equilibrium is found again.
        rounding: below this there is nothing to correct.
        corrections: steps of that at most.
        lost: at this the path counts as lost.
    """

    removed: float = 1e-9
    rounding: float = 1e-14
    corrections: int = 2
    lost: float = 1e-5


@dataclass(frozen=True)
class MechanismTests:
    """When a piece of the path is a mechanism, and when a mechanism is the collapse.

    Attributes:
        elastic: elastic force rates below this share of the strain rates count as zero: the direction is a mechanism.
        least: share of the present displacement by which it moves before its next breakpoint, to be looked at.
        far: multiple of the present displacement that it moves before its next breakpoint as the collapse.
        growth: of the displacements from one check to the next.
        confirmed: displacements, in multiples of the first, at which one that passes its check is the collapse.
    """

    elastic: float = 1e-8
    least: float = 1e-3
    far: float = 1e4
    growth: float = 1.1
    confirmed: float = 1e10


SOFT_MOTIONS = SoftMotions()
REFINEMENT = RefinementTolerances()
UPDATES = UpdateTolerances()
DRIFT = DriftTolerances()
MECHANISM = MechanismTests()
