"""Settings of the distinct elements with deformable joints, and how their holds are tuned."""

from __future__ import annotations

from dataclasses import dataclass

from pydantic import Field

from harness.model.method import Settings
from methods.de.holds.loading import FALL


@dataclass(frozen=True)
class JointDefaults:
    """Joints where none are given: as good as rigid on low walls.

    Attributes:
        stiffness: in mean dead loads of a block over the square of the length scale.
        rounding: radius of corners, in length scales.
    """

    stiffness: float = 1e6
    rounding: float = 2e-4


@dataclass(frozen=True)
class SoftHoldTuning:
    """Holds of a wall with deformable joints.

    Attributes:
        look: time steps from one look at a hold to the next.
        low: courses up to which a hold is no longer than `hold_steps`; above, with the square of the courses.
        patience: multiple of the length of a hold that the dead load has.
        away: multiple of what the blocks had moved at the last rest from which it is asked whether the wall falls.
        share: of a small multiplier to which its bracket is narrowed.
        beyond: first relative rise above a multiplier that could not be told; it doubles until the wall falls.
    """

    look: int = 500
    low: int = 7
    patience: int = 10
    away: float = 300.0
    share: float = 2e-3
    beyond: float = 2e-3


JOINTS = JointDefaults()
SOFT_HOLDS = SoftHoldTuning()


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
    reach: float = Field(default=FALL.reach, gt=0.0)
    hold_steps: int = Field(default=100_000, ge=SOFT_HOLDS.look)
    relaxations: int = Field(default=20, ge=1)
    lean: float = Field(default=2.5e-3, gt=0.0)
    stiffest: float = Field(default=30.0, ge=1.0)
