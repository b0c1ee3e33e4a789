"""Settings of the distinct-element methods, with the reasons for their defaults."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from harness.model.method import Settings

Faces = Literal["beds", "heads", "both"]


REACH = 0.25
"""Length scales by which a block moves under one load where a wall that keeps its displacements falls."""

RISE = 2.0
"""Factor on the rise of the multiplier from one that shows no motion to the next."""

LOOK = 500
"""Time steps from one look to the next at a hold of a wall with deformable joints."""


class HoldSettings(Settings):
    """How a damped load step is run and judged, and how the collapse multiplier is bracketed.

    Attributes:
        orders: how many insertion orders of bodies and interfaces are tried; their spread is part of the answer.
        accuracy: the bracket [held, moving] of an order is narrowed to this fraction of the multiplier.
        load_step: largest first load step, as a part of the dead load: the live load grows by at most this share
            of the dead load at a time, or by `load_growth` of itself if that is more. Large steps lock head joints.
        load_growth: relative growth of the multiplier a load step may have.
        load_cap: live load, as a multiple of the dead load, at which the search for a collapse is given up.
        iterations: sweeps of the contact solver in a time step.
        mass_decay: logarithmic decay of the masses from one course to the next. Masses do not enter equilibrium, so
            they are chosen for convergence: light blocks on heavy ones. None: the quickest at multiplier zero of the
            tunings in `methods.de.engines.mass_scaling`; 0: masses in proportion to areas.
        held_residual: a state is held when the largest force left over is below this part of a block's dead load.
        moving_residual: a state moves when a steady velocity field keeps a force above this part out of balance.
        force_residual: the highest held state is followed until its residual is below this, for its contact forces.
        hold_steps: most time steps of one hold, in relaxation times 1 / (1 - damping) or, if longer, 3 courses or 100;
            four times as long at multiplier zero.
        work: most contact updates (time steps x interfaces) spent on one order.
        seed: seed of the random orders.
    """

    orders: int = Field(default=3, ge=1, le=64)
    accuracy: float = Field(default=5e-4, gt=0.0, le=0.1)
    load_step: float = Field(default=0.02, gt=0.0, le=1.0)
    load_growth: float = Field(default=0.04, ge=0.0, le=1.0)
    load_cap: float = Field(default=100.0, gt=0.0)
    iterations: int = Field(default=20, ge=1, le=1000)
    mass_decay: float | None = Field(default=None, ge=0.0, le=3.0)
    held_residual: float = Field(default=1e-6, gt=0.0, lt=1.0)
    moving_residual: float = Field(default=2e-5, gt=0.0, lt=1.0)
    force_residual: float = Field(default=1e-8, gt=0.0, lt=1.0)
    hold_steps: int = Field(default=20, ge=1)
    work: int = Field(default=200_000_000, ge=1)
    seed: int = Field(default=0, ge=0)


class SweepSettings(HoldSettings):
    """Settings of `de`: those of its holds, and what makes the time steps.

    Attributes:
        engine: "sweeps": compiled sweeps over the contacts of a wall at frozen geometry; "pymunk": the same through a
            rigid-body engine, which searches for the contacts in every step and takes longer.
    """

    engine: Literal["sweeps", "pymunk"] = "sweeps"


class MujocoSettings(HoldSettings):
    """Settings of the holds in MuJoCo: those of `de`, and how soft its contacts are.

    Attributes:
        iterations: most Newton iterations of the contact solver in a time step. Walls need a hundred and more; with too
            few, blocks separate.
        impedance: constraint impedance of the contacts; None: 0.9 on walls, 0.97 on chains of blocks. Nearer to 1 is
            stiffer and settles sooner, but head joints of walls then chatter.
        friction_ratio: MuJoCo's impratio. Shear forces cost a creep that falls with it: at 100 it exceeds
            `held_residual`, at 1e4 the contact problem is so ill-conditioned that walls chatter. It is raised in
            proportion to the courses above 6, as the creep is.
        hold_steps: walls with contacts so soft come to rest slowly near collapse.
        held_residual: above the creep that shear forces cost.
        moving_residual: above `held_residual`.
        force_residual: what the creep leaves to be gained.
    """

    iterations: int = Field(default=500, ge=1, le=10_000)
    impedance: float | None = Field(default=None, gt=0.0, lt=1.0)
    held_residual: float = Field(default=2e-5, gt=0.0, lt=1.0)
    moving_residual: float = Field(default=4e-5, gt=0.0, lt=1.0)
    force_residual: float = Field(default=1e-6, gt=0.0, lt=1.0)
    friction_ratio: float = Field(default=2e3, ge=100.0)
    hold_steps: int = Field(default=60, ge=1)
    work: int = Field(default=60_000_000, ge=1)


class Box2dSettings(HoldSettings):
    """Settings of the holds in Box2D, which computes in single precision.

    Attributes:
        iterations: sub-steps of a time step, with two sweeps over the contacts each.
        held_residual: above what single precision leaves out of balance in walls of a hundred blocks.
        moving_residual: above `held_residual`.
        force_residual: what single precision leaves to be gained.
    """

    iterations: int = Field(default=10, ge=1, le=1000)
    held_residual: float = Field(default=5e-6, gt=0.0, lt=1.0)
    moving_residual: float = Field(default=2e-5, gt=0.0, lt=1.0)
    force_residual: float = Field(default=1e-6, gt=0.0, lt=1.0)


class ReleaseSettings(SweepSettings):
    """Settings of the bracket and of the release that follows it.

    Attributes:
        excess: the wall is released at this multiple of its collapse multiplier.
        reach: the release ends when a block has moved by this many length scales (mean square root of the areas).
        release_steps: most time steps of the release, of 0.002 sqrt(length scale / gravity).
        frames: most frames kept; fewer for large walls.
        gap: contact points that have come apart by this many length scales are counted as separated.
    """

    excess: float = Field(default=1.05, ge=1.0)
    reach: float = Field(default=0.5, gt=0.0)
    release_steps: int = Field(default=20_000, ge=1)
    frames: int = Field(default=40, ge=2, le=1000)
    gap: float = Field(default=0.01, gt=0.0)


class UnevenSettings(Settings):
    """The defects of planarity and how finely the multiplier is sought.

    Attributes:
        size: greatest cut of a corner as a part of the block height; each is drawn from U(0, size x height).
        faces: which faces are uneven.
        seed: seed of the cuts.
        accuracy: the multiplier is narrowed to this difference.
        greatest: multiplier at which the loading ends.
    """

    size: float = Field(default=0.03, ge=0.0, le=0.3)
    faces: Faces = "both"
    seed: int = Field(default=0, ge=0)
    accuracy: float = Field(default=0.005, gt=0.0, le=0.1)
    greatest: float = Field(default=2.0, gt=0.0)

    @property
    def wall(self) -> str:
        """What a sentence calls the wall with these defects."""
        return f"The wall with corners cut by up to {self.size:g} of the block height (seed {self.seed})"


class ClosedSettings(UnevenSettings):
    """The defects, how finely the multiplier is sought, and what stands beside the answer.

    Attributes:
        step: load step.
        alone: methods that analyse the contacts closed under the dead load alone.
        compare: also load the same uneven wall with distinct elements alone, as `de-uneven` does, for value and cost.
    """

    step: float = Field(default=0.02, gt=0.0, le=1.0)
    alone: tuple[str, ...] = ("fe", "la")
    compare: bool = True


class SoftSettings(Settings):
    """The joints, the corners, and how the load is raised.

    Attributes:
        stiffness: of the joints across, per length of joint [force/length^2], half of it at each end. None: a million
            mean dead loads of a block over the square of the length scale, as good as rigid on low walls.
        shear_ratio: stiffness along the joints over stiffness across.
        rounding: radius of the corners [length] where contact points are not set in farther; a contact point that is
            set in rounds its corner by as much. None: 2e-4 length scales (mean square root of the areas).
        load_step: load step as a share of the dead load; load_growth: as a share of the multiplier, where that is more.
        load_cap: live load, as a multiple of the dead load, at which the search for a collapse is given up.
        accuracy: the bracket is narrowed to this live load, as a share of the dead load, or to a 500th of the
            multiplier where that is less.
        held_residual: largest force out of balance of a wall at rest, as a part of the mean dead load of a block.
        reach: a wall falls when a block has moved by this many length scales under one load, the loads doing work; or
            earlier, where `methods.de.holds.motion` shows it.
        hold_steps: most time steps under one load on a wall of up to 7 courses; higher walls get more, with the square
            of the courses, and all ten times as many under the dead load alone.
        relaxations: a wall on its way to rest is followed for so many of its own relaxation times, at most for so many
            times the length of a hold.
        lean: share of the multiplier that joints may take by giving, half the stated accuracy: beyond it the answer
            says that they are soft. Where no stiffness is given the wall is then loaded once more, with joints so much
            stiffer and corners so much sharper, if they are not set either, that they take half of it.
        stiffest: most factor on the stiffness for that; from 100 on, rounding of the places leaves forces out of
            balance.
    """

    stiffness: float | None = Field(default=None, gt=0.0)
    shear_ratio: float = Field(default=1.0, gt=0.0)
    rounding: float | None = Field(default=None, gt=0.0)
    load_step: float = Field(default=0.01, gt=0.0, le=1.0)
    load_growth: float = Field(default=0.02, ge=0.0, le=1.0)
    load_cap: float = Field(default=100.0, gt=0.0)
    accuracy: float = Field(default=5e-4, gt=0.0, le=0.1)
    held_residual: float = Field(default=1e-6, gt=0.0, lt=1.0)
    reach: float = Field(default=REACH, gt=0.0)
    hold_steps: int = Field(default=100_000, ge=LOOK)
    relaxations: int = Field(default=20, ge=1)
    lean: float = Field(default=2.5e-3, gt=0.0)
    stiffest: float = Field(default=30.0, ge=1.0)


class TimeSteps(Settings):
    """How motion in time is followed.

    Attributes:
        time_step: of the motion [sqrt(length_scale / gravity)]; rocking blocks of 1 m lose 1e-3 of e with 3e-3.
        iterations: sweeps of the contact solver in a step.
        radius, slop: see `BodyTuning`; a slop of 1e-5 sizes of a block turns a joint by as much.
        frames: states that are kept, at most; of a wall of more than 100 blocks fewer, down to 200.
        after: longest time that is followed once the ground rests [s].
    """

    time_step: float = 1e-3
    iterations: int = 60
    radius: float = 1e-6
    slop: float = 1e-5
    frames: int = 6000
    after: float = 60.0


class SoftPathSettings(SoftSettings):
    """Settings of `de-reaction`: those of the joints.

    Attributes:
        gives_way: whether the supports move as prescribed; else they push, backwards.
    """

    gives_way: bool = True


class TimeHistorySettings(TimeSteps):
    """Settings of `de-time`.

    Attributes:
        time: where the pieces of the motion of the ground begin and end, from zero [s].
        first, last: acceleration at the beginning and at the end of each piece, to the right [g].
        gravity: acceleration g [length/s2].
    """

    time: tuple[float, ...]
    first: tuple[float, ...]
    last: tuple[float, ...]
    gravity: float = Field(gt=0.0)
