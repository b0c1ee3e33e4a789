"""Settings of the peers."""

from __future__ import annotations

from pydantic import Field

from harness.model.method import Settings


class ScipSettings(Settings):
    """Settings of `scip`.

    Attributes:
        seconds: of the wall clock; what is found by then is the answer.
        seed: shift of all of its random seeds.
        virtual_work: whether the row of virtual work is written, without which its bound stays at zero.
    """

    seconds: float = Field(default=60.0, gt=0.0)
    seed: int = Field(default=0, ge=0)
    virtual_work: bool = True


class DiscoptSettings(Settings):
    """Settings of `discopt`.

    Attributes:
        seconds: of the wall clock; what is found by then is the answer.
        greatest_rate: bound on every opening and slip, as a multiple of the mean live displacement of a block. The
            bound that discopt claims is of mechanisms within it.
        gap: relative gap between state and bound at which it ends.
    """

    seconds: float = Field(default=60.0, gt=0.0)
    greatest_rate: float = Field(default=1e3, gt=0.0)
    gap: float = Field(default=1e-6, gt=0.0)


class PounceSettings(Settings):
    """Settings of `pounce`.

    Attributes:
        seconds: of the wall clock; the relaxation reached by then is the answer.
        epsilons: bounds on y.g relative to the live work, in order.
        most_iterations: of each relaxation.
        greatest_rate: bound on every opening and slip, as a multiple of the mean live displacement of a block.
    """

    seconds: float = Field(default=60.0, gt=0.0)
    epsilons: tuple[float, ...] = (1e-2, 1e-4, 1e-6, 1e-8)
    most_iterations: int = Field(default=500, ge=1)
    greatest_rate: float = Field(default=1e3, gt=0.0)


class OpenSeesSettings(Settings):
    """The joints, and how the load is raised.

    Attributes:
        stiffness: of the joints across, per length of joint, in mean dead loads of a block over the square of the
            length scale; half of it at each end. Geometry stays as drawn, so that it decides the path alone.
        shear_ratio: stiffness along the joints over stiffness across.
        load_step: first load step, as a part of the dead load; it is halved where it does not converge.
            Points that open within a step keep their shear, so that it is small.
        least_step: load step at which the path ends.
        load_cap: live load, as a multiple of the dead load, at which it is given up.
    """

    stiffness: float = Field(default=1e4, gt=0.0)
    shear_ratio: float = Field(default=1.0, gt=0.0)
    load_step: float = Field(default=0.001, gt=0.0, le=1.0)
    least_step: float = Field(default=1e-7, gt=0.0, le=0.1)
    load_cap: float = Field(default=100.0, gt=0.0)


class BisectionSettings(Settings):
    """How the multiplier is bisected.

    Attributes:
        load_step: first load step, as a part of the dead load; it doubles until there is no solution.
        load_cap: live load, as a multiple of the dead load, at which the search is given up.
        accuracy: the bracket is narrowed to this fraction of the multiplier.
    """

    load_step: float = Field(default=0.1, gt=0.0)
    load_cap: float = Field(default=100.0, gt=0.0)
    accuracy: float = Field(default=5e-4, gt=0.0, le=0.1)


class CraSettings(BisectionSettings):
    """How the multiplier is bisected, and the bounds of CRA on the motion of joints.

    Attributes:
        motion: most that joints move, in length scales: `d_bnd` of compas_cra, whose default it is.
        overlap: of contacts that press, in length scales: its `eps`.
    """

    motion: float = Field(default=1e-3, gt=0.0)
    overlap: float = Field(default=1e-4, gt=0.0)


class Lmgc90Settings(BisectionSettings):
    """How the multiplier is bisected, and how LMGC90 follows a load.

    Attributes:
        time_step: in times in which a fall from rest passes about half a length scale.
        theta: of the time integration.
        alert: gap up to which contacts are looked for, in length scales.
        moved: displacement from which the wall has moved, in length scales.
        at_rest: largest displacement of a block in a step at rest, beside that of a free fall in it.
        rest_steps: that a wall must be so for.
        most_steps: after which it has not come to rest.
    """

    accuracy: float = Field(default=2e-3, gt=0.0, le=0.1)
    time_step: float = Field(default=0.02, gt=0.0, le=1.0)
    theta: float = Field(default=0.5, ge=0.5, le=1.0)
    alert: float = Field(default=0.01, gt=0.0, le=0.1)
    moved: float = Field(default=1e-3, gt=0.0, le=0.1)
    at_rest: float = Field(default=1e-3, gt=0.0, le=0.1)
    rest_steps: int = Field(default=20, ge=1)
    most_steps: int = Field(default=2000, ge=1)
