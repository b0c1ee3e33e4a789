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
