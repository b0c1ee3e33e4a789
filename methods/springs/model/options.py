"""Options of the gap-spring model and of its solvers. A `WallModel` carries them to all that is done with it."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Regularisation:
    """The stiffness of blocks against the ground that a singular tangent is factorised with.

    Attributes:
        stiffness: of a block, in springs of a gap point; refinement removes its force.
        least: share of it below which a motion has no stiffness of its own: rounding of the tangent leaves 1e-8 of it.
    """

    stiffness: float = 1e-8
    least: float = 1e-4


@dataclass(frozen=True)
class BreakpointTolerances:
    """When a gap point sits on its breakpoint, and when it moves towards it.

    Attributes:
        force: forces, as a share of the load scale, that count as the same: a point that near its breakpoint may be in
            either state, and the choice among near ties may overrun a breakpoint by as much. Compressions that a
            path starts from are at least as large, in block weights.
        rate: rates of breakpoint functions below this share of the fastest gap rate count as zero.
        soft_rate: the same on pieces with pins, as forces over a motion as long as the displacements so far.
        sure_rate: such a rate, over the fastest velocity, from which its sign in a new direction is beyond doubt.
        broken: slack, as a share of the load scale, up to which a brittle joint is at its strength: rounding of a path
            is less, and the judge accepts ten times as much.
    """

    force: float = 1e-12
    broken: float = 1e-9
    rate: float = 1e-11
    soft_rate: float = 1e-7
    sure_rate: float = 1e-6


@dataclass(frozen=True)
class FactorTuning:
    """How tangents are factorised, and how long a factor is corrected.

    Attributes:
        dense: unknowns up to which the dense inverse is faster than the sparse product form.
        growth: entries of L above this cost too many digits: rows are exchanged then.
        updates: rank-one changes of one factor at most, for which the product form has room.
    """

    dense: int = 70
    growth: float = 1e5
    updates: int = 64


@dataclass(frozen=True)
class NewtonTolerances:
    """When Newton's steps are at an end.

    Attributes:
        steps: at most.
        balanced: out-of-balance force, as a share of the load scale, of an equilibrium.
        runaway: step, in dimensionless displacements over the load scale, after which none is to be expected.
        falling: share of the fastest block's motion above which another falls with it; the others may still settle by
            less.
    """

    steps: int = 40
    balanced: float = 1e-8
    runaway: float = 1e9
    falling: float = 1e-3


@dataclass(frozen=True)
class FirstSteps:
    """The Newton steps off the breakpoints on which gravity leaves many gap points.

    Attributes:
        multiplier: of the first.
        shorter: factor on it where the wall does not stand that one; tries: how often, at most: a wall may collapse at
            a multiplier below it.
        newton_steps: at most, of each of the doubled steps that follow.
    """

    multiplier: float = 1e-3
    shorter: float = 0.1
    tries: int = 5
    newton_steps: int = 25


@dataclass(frozen=True)
class PseudoTime:
    """sigma, the inverse square of the pseudo-time step, and how friction limits lag.

    Attributes:
        first, least, most: sigma at first, at least, and at which the motion is given up.
        faster: factor after an increment of at most `easy` Newton steps; slower: after one that was not found.
        relaxation: share of their way to mu N that the limits go after an increment.
    """

    first: float = 1.0
    least: float = 1e-4
    most: float = 1e8
    faster: float = 0.5
    slower: float = 4.0
    easy: int = 8
    relaxation: float = 0.5


@dataclass(frozen=True)
class IncrementTuning:
    """Newton's method with a line search, in one increment.

    Attributes:
        balanced, rounding: out-of-balance force at its end, as a share of the load scale and of kn times the
            displacements.
        steps: at most; halvings: of one line search, at most.
        slope: share of the slope at the start of a line search that is small enough at its end.
    """

    balanced: float = 1e-12
    rounding: float = 1e-14
    steps: int = 60
    halvings: int = 12
    slope: float = 0.5


@dataclass(frozen=True)
class RestTests:
    """When a motion ends, at rest or in a fall.

    Attributes:
        still: forces of inertia, and changes of the friction limits (shares of the load scale), below which a wall is
            at rest.
        newton_every: increments after which plain Newton is tried; newton_steps: of it.
        steady: increments over which the forces of inertia of a wall that falls keep up; kept: the share of them left
            at the end.
        steps: Newton steps from one rest to the next, at most; steps_under_dead_load: to the first of all.
    """

    still: float = 1e-9
    newton_every: int = 5
    newton_steps: int = 12
    steady: int = 25
    kept: float = 0.99
    steps: int = 2000
    steps_under_dead_load: int = 10_000


@dataclass(frozen=True)
class LoadRaising:
    """The load raised from rest to rest.

    Attributes:
        first: rise of the multiplier, as a share of its scale; longer: factor on it after a rest.
        width: of a bracket, over its upper end, that is narrow enough.
        lowest: share of the scale below which a multiplier without rest is not halved again.
        furthest: multiple of it beyond which none lies.
    """

    first: float = 1.0 / 64.0
    longer: float = 2.0
    width: float = 0.1
    lowest: float = 1e-3
    furthest: float = 1e6


@dataclass(frozen=True)
class SoftMotions:
    """When a piece of the path is soft, so that its motion has a pin in the factor.

    Attributes:
        velocity: multiple of the first piece's velocity, at the same rate of the multiplier, above which the fastest
            displacement has a pin.
        response: the same of the response of the wall with pins to the live load, which shows a further soft motion.
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
            longer helps. On pieces with pins it is of the forces over a motion as long as the displacements.
        soft_accepted: the same on pieces with pins when refinement no longer helps.
        contraction: share of the defect before it that a step must leave at most, or refinement no longer helps.
        steps: at most.
        doubled: displacements (dimensionless) above which gap rates of pieces with pins are measured in doubled
            precision: up to there their rounding changes no force by more than 1e-9.
    """

    defect: float = 1e-7
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


@dataclass(frozen=True)
class CollapseTolerances:
    """How a collapse state is solved for, and when it counts as exact.

    Attributes:
        certificate: largest relative residual at which a final state counts as an exact collapse state.
        exact: residual at which no more exact state is looked for.
        zero: multipliers up to this share of the load unit are zero to rounding, as of a wall at its limit under the
            dead load.
        rounds: changes of states allowed while the last piece is solved for, and iterations with inertia.
        corrections: Newton steps with which forces and multiplier are solved for in one set of states.
        inertia: shift of a tangent in which several motions have no stiffness; iteration removes what it leaves.
        still: rates below this share of the fastest are none, where several mechanisms move at once.
    """

    certificate: float = 1e-8
    exact: float = 1e-12
    zero: float = 1e-13
    rounds: int = 10
    corrections: int = 4
    inertia: float = 1e-7
    still: float = 1e-6


@dataclass(frozen=True)
class CommitTuning:
    """The finite step after a commit.

    Attributes:
        within: displacements, in multiples of the first, up to which the history is still committed.
        steps: Newton steps at most.
        updates: changed points above which a fresh factor is cheaper than updates.
        pivot: |1 + b'y|, or its inverse, above which updates are not trusted here.
        longest: steps longer than this many tangent steps may have left the branch and are not taken.
        balanced: out-of-balance force (share of the load scale) up to which a step is taken without a further one: by
            way of huge displacements, over a nearly singular tangent, it loses digits.
    """

    within: float = 300.0
    steps: int = 12
    updates: int = 24
    pivot: float = 1e3
    longest: float = 5.0
    balanced: float = 1e-9


@dataclass(frozen=True)
class JumpTuning:
    """When jumps are tried, and to where.

    Attributes:
        turn: share of the peak by which a path may turn down before a jump from it is tried.
        most: jumps tried along one path: a loop would be tried to be left for ever.
        above: share of the peak by which the load is raised above it; least: multiplier added to that.
    """

    turn: float = 0.1
    most: int = 10
    above: float = 1e-3
    least: float = 1e-9


@dataclass(frozen=True)
class SpringOptions:
    """All options of a gap-spring model, of its equilibria and of its paths."""

    regularisation: Regularisation = Regularisation()
    breakpoints: BreakpointTolerances = BreakpointTolerances()
    factors: FactorTuning = FactorTuning()
    newton: NewtonTolerances = NewtonTolerances()
    first_steps: FirstSteps = FirstSteps()
    pseudo_time: PseudoTime = PseudoTime()
    increment: IncrementTuning = IncrementTuning()
    rest: RestTests = RestTests()
    load_raising: LoadRaising = LoadRaising()
    soft_motions: SoftMotions = SoftMotions()
    refinement: RefinementTolerances = RefinementTolerances()
    updates: UpdateTolerances = UpdateTolerances()
    drift: DriftTolerances = DriftTolerances()
    mechanism: MechanismTests = MechanismTests()
    collapse: CollapseTolerances = CollapseTolerances()
    commits: CommitTuning = CommitTuning()
    jump: JumpTuning = JumpTuning()
