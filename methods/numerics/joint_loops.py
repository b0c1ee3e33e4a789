"""The law of joints in compiled loops, as `harness.model.joint_law.JointLaw` has it for arrays."""

from __future__ import annotations

from methods.numerics.compiled import compiled


@compiled
def shear_limit(mu: float, normal: float) -> float:
    """Shear mu N that friction bears at the compression N: `JointLaw.by_friction`."""
    return mu * normal


@compiled
def shear_within(shear: float, mu: float, normal: float, backward: float, forward: float) -> float:
    """A shear cut off at what friction and cohesion against negative and positive shear bear: `JointLaw.within`."""
    limit = shear_limit(mu, normal)
    return min(max(shear, -(limit + backward)), limit + forward)
