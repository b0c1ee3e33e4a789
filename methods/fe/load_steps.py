"""The load steps that an answer of the springs keeps: displacements, contact forces and states along its path."""

from __future__ import annotations

import numpy as np

from harness.model.assembly import IntArray
from harness.model.load_steps import STATES, LoadSteps
from methods.springs.model.gap_law import OPEN, SLIP_MINUS, SLIP_PLUS, gap_forces
from methods.springs.model.wall_model import WallModel
from methods.springs.path.path_record import PathStep


def load_steps(model: WallModel, steps: list[PathStep], most: int) -> LoadSteps:
    """At most so many of the steps of a path (one at least), evenly picked, the first and the last among them."""
    pick = np.unique(np.linspace(0, len(steps) - 1, min(len(steps), most)).astype(int))
    kept = [steps[-1]] if most == 1 else [steps[k] for k in pick]
    normal, shear = np.empty(model.n_points), np.empty(model.n_points)
    joints = ~model.assembly.is_bar
    forces = []
    for step in kept:
        gap_forces(step.opening, step.trial, model.kn, model.mu, model.lift, step.state, normal, shear)
        forces.append(model.end_forces(normal, shear)[joints])
    return LoadSteps(
        model.assembly.block_ids,
        np.array([step.multiplier for step in kept]),
        np.array([model.block_displacements(step.u) for step in kept]),
        np.array(forces),
        np.array([joint_states(model, step.state)[joints] for step in kept]),
    )


def joint_states(model: WallModel, state: IntArray) -> IntArray:
    """(m,) places in `STATES` of the interfaces whose gap points are in the given states (P,)."""
    m, contacts = model.assembly.n_interfaces, model.n_contacts
    interface, position = model.interface[:contacts], model.position[:contacts]

    def every(holds: np.ndarray) -> np.ndarray:
        return np.asarray(np.bincount(interface, ~holds[:contacts], m) == 0)

    open_ = state == OPEN
    slides = (state == SLIP_PLUS) | (state == SLIP_MINUS)
    end = (position == 0.0) | (position == 1.0)
    slips = every(slides | open_)
    slips[model.cohesive] &= slides[contacts:]
    names = np.where(slips, STATES.index("slip"), STATES.index("stick"))
    names[~every(~(open_[:contacts] & end))] = STATES.index("rock")
    names[every(open_)] = STATES.index("open")
    return np.asarray(names, dtype=np.int64)
