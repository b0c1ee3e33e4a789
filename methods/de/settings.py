"""Settings of the damped-hold methods, with the reasons for their defaults."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from harness.model.method import Settings


class HoldSettings(Settings):
    """How a damped hold is run and judged, and how the collapse multiplier is bracketed.

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
            tunings in `methods.de.engines.courses`; 0: masses in proportion to areas.
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
            rigid-body engine, which looks for the contacts again in every step and takes 1.5 times as long on 25 blocks
            and 3.4 times on 820.
    """

    engine: Literal["sweeps", "pymunk"] = "sweeps"


class MujocoSettings(HoldSettings):
    """Settings of the holds in MuJoCo: those of `de`, and how soft its contacts are.

    Attributes:
        iterations: most Newton iterations of the contact solver in a time step. Walls take a hundred and more; cut
            short at 50, a wall of 105 bricks explodes.
        impedance: constraint impedance of the contacts; None: 0.9 on walls, 0.97 on chains of blocks. Nearer to 1 is
            stiffer and settles sooner, but head joints of walls then chatter.
        friction_ratio: MuJoCo's impratio. Shear forces cost a creep that falls with it: at 100 it exceeds
            `held_residual`, at 1e4 the contact problem is so ill-conditioned that walls chatter. It is raised in
            proportion to the courses above 6, as the creep is.
        hold_steps: contacts so soft settle slowly near collapse; with 20, walls of 55 bricks were undecided there.
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
