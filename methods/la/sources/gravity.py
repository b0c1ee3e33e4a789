"""What the dead load does to a wall with springs in its joints and no self-stress in them."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

from harness.model.assembly import FloatArray
from methods.la.core.problem import Problem
from methods.springs.model.factor import Factor, make_factor
from methods.springs.model.points import GapSettings
from methods.springs.model.wall_model import WallModel, build_model
from methods.springs.rest.equilibrium import gravity_state
from methods.springs.rest.newton import Equilibrium


@dataclass(frozen=True)
class Gravity:
    """What the dead load does to a wall with springs in its joints and no self-stress in them."""

    problem: Problem
    model: WallModel
    factor: Factor
    equilibrium: Equilibrium

    @classmethod
    def of(cls, problem: Problem, ratio: float) -> Gravity:
        """The springs under the dead load of a wall that stands by statics, with kt/kn = ratio."""
        model = build_model(problem.assembly, GapSettings(stiffness_ratio=ratio))
        factor = make_factor(model)
        return cls(problem, model, factor, gravity_state(model, factor))

    @property
    def falling(self) -> list[str]:
        """Names of the blocks that fall; none where there is equilibrium, or the search for it did not end."""
        motion = self.model.block_displacements(self.equilibrium.rate)
        return [] if self.equilibrium.found else self.model.moving_blocks(motion, self.model.options.newton.falling)

    @cached_property
    def forces(self) -> FloatArray | None:
        """The scaled contact forces (m, 3); None where no equilibrium is found."""
        model, found = self.model, self.equilibrium
        if not found.found:
            return None
        return model.end_forces(*model.forces(found.u, found.history, found.state)) / self.problem.unit_force
