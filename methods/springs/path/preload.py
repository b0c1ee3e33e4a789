"""A path that starts from contact forces as they stand, instead of from gravity.

Forces in equilibrium within yield, whatever found them, are what the springs carry while nothing has moved yet. From
there the wall is led to a mechanism like any other. Joints of dry stone carry some such forces that nobody knows.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from harness.model.assembly import FloatArray
from methods.springs.model.factor import Factor
from methods.springs.model.gap_law import STICK
from methods.springs.model.wall_model import WallModel
from methods.springs.path.continuation import PathFollower


def preloaded(
    model: WallModel, factor: Factor, multiplier: float, forces: FloatArray, certificate: float | None = None
) -> PathFollower:
    """The path from contact forces, with a gap point at each end of every interface.

    Args:
        model: the wall; factor: its tangent.
        multiplier: of the live load that the forces are in equilibrium with.
        forces: (m, 3) end forces n1, n2, s [force] within yield; the shear is shared out as the compression is.
        certificate: largest residual of a mechanism that ends the path; None for that of the options.
    """
    ends = np.maximum(forces[:, :2] / model.force, model.options.breakpoints.force)
    share = (forces[:, 2] / model.force / ends.sum(axis=1))[model.interface]
    normal = np.where(model.position == 0.0, ends[model.interface, 0], ends[model.interface, 1])
    loaded = replace(model, initial_opening=-normal / model.kn)
    u, state = np.zeros(model.n_unknowns), np.full(model.n_points, STICK)
    return PathFollower(loaded, factor, u, multiplier, -share * normal, state, certificate=certificate)
