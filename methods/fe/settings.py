"""What a user may choose about the gap-spring methods."""

from __future__ import annotations

from pydantic import Field

from methods.springs.model.points import GapSettings


class GapSpringsSettings(GapSettings):
    """Settings of `fe`, the exact continuation.

    Attributes:
        histories: how often the friction history is committed, as fractions of the multiplier reached; 0: never.
            None: none and 1 %, and 0.2 % where their plateaus differ by more than 0.1 %; above 1,200 blocks none alone.
            Where joints are brittle the slip is updated as they break, and no other history is followed. Where they
            dilate it is not updated.
        max_events: changes of state after which one history is given up; None: 2,000 and, for every gap
            point, 30 on the first history and 5 on those after it. Where the first is given up,
            the load is raised in finite steps and the path goes on from there, with as many changes again.
        friction_cap: friction coefficients above this are lowered to it while the path is traced; the final state is
            checked with the true ones, and traced again with them if it does not hold. Coefficients such as 1000,
            which stand for "no sliding", would otherwise make the path stiff for nothing.
        load_steps: points of the path, from the dead load to the plateau, that the answer keeps with displacements,
            contact forces and states of joints (`details["load_steps"]`); spread evenly over the changes of state.
    """

    histories: tuple[float, ...] | None = None
    max_events: int | None = Field(None, ge=1)
    friction_cap: float = Field(2.0, gt=0.0)
    load_steps: int = Field(0, ge=0, le=1000)


class SupportPathSettings(GapSpringsSettings):
    """Settings of `fe-reaction`: those of the springs.

    Attributes:
        gives_way: whether the supports move as prescribed; else they push, backwards.
    """

    gives_way: bool = True


class NewtonSettings(GapSettings):
    """Settings of `fe-newton`.

    Attributes:
        first_step: first step of the live load, as a share of the dead load (to a factor of two).
        cuts: halvings after which load control stops.
        displacement_steps: steps of displacement control.
    """

    first_step: float = Field(0.02, gt=0.0)
    cuts: int = Field(8, ge=0)
    displacement_steps: int = Field(1500, ge=0)


class ConvexSettings(GapSettings):
    """Settings of `fe-qp`.

    Attributes:
        first_step: first step of the live load, as a share of the dead load (to a factor of two).
        resolution: relative width of the bracket at which to stop.
        fixed_points: Tresca iterations in a row that may bring a step no nearer; max_blocks: size above which the
            method refuses.
        friction_cap: friction coefficients above this are lowered to it.
    """

    first_step: float = Field(0.05, gt=0.0)
    resolution: float = Field(0.001, gt=0.0)
    fixed_points: int = Field(60, ge=1)
    max_blocks: int = Field(60, ge=1)
    friction_cap: float = Field(2.0, gt=0.0)
