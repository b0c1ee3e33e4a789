"""The least multiplier of tiny walls by going through every state of every contact.

Written from the definitions alone: the matrices come from the harness, the programmes go to scipy, and nothing is
shared with a method or with the judge.
"""

from __future__ import annotations

import itertools

import numpy as np
from scipy.optimize import linprog

from harness.model.assembly import Assembly, FloatArray

ENDS = ((False, False), (True, False), (False, True), (True, True))
"""Which of the two ends of an interface are open."""
SLIPS = (0, 1, -1)
STATES = tuple(itertools.product(ENDS, SLIPS))
"""All states of an interface: a closed end may carry compression, an open one carries none."""


States = tuple[tuple[tuple[bool, bool], int], ...]


def least_by_enumeration(wall: Assembly) -> float:
    """The least multiplier of all combinations of states for which a mechanism and forces exist.

    States of the first interfaces for which there is no mechanism, no forces, or none below what is known, whatever the
    others do, are gone through no further.
    """
    least = np.inf
    open_states: list[States] = [()]
    while open_states:
        states = open_states.pop()
        if states:
            value = _multiplier(wall, states)
            if value is None or value >= least:
                continue
            if len(states) == wall.n_interfaces:
                least = value
                continue
        open_states += [(*states, state) for state in STATES]
    return least


def _multiplier(wall: Assembly, states: States) -> float | None:
    return _least_multiplier(wall, states) if _moves(wall, states) else None


def _moves(wall: Assembly, states: States) -> bool:
    """Whether a mechanism with live work moves in these states: closed ends stay closed, open ends may open.

    Interfaces without a state may open and slip.
    """
    rows = wall.kinematic_matrix.toarray()
    closed: list[FloatArray] = []
    signed: list[FloatArray] = []
    for p, (ends, slip) in enumerate(states):
        for row, free in ((3 * p, ends[0]), (3 * p + 1, ends[1])):
            (signed if free else closed).append(rows[row])
        (signed if slip else closed).append((slip or 1) * rows[3 * p + 2])
    signed += [row for k, row in enumerate(rows[3 * len(states) :]) if k % 3 < 2]
    live = wall.free_loads()[1]
    none = np.zeros((0, rows.shape[1]))
    answer = linprog(
        np.zeros(rows.shape[1]),
        A_ub=-np.array(signed) if signed else none,
        b_ub=np.zeros(len(signed)),
        A_eq=np.vstack([*closed, live]),
        b_eq=np.append(np.zeros(len(closed)), 1.0),
        bounds=(None, None),
    )
    return bool(answer.status == 0)


def _least_multiplier(wall: Assembly, states: States) -> float | None:
    """The least multiplier of forces at the tensile strength of open ends, at the shear limit against each slip.

    Interfaces without a state carry any forces within yield.
    """
    dead, live = wall.free_loads()
    m = wall.n_interfaces
    cone: list[FloatArray] = []
    limit: list[FloatArray] = []
    within: list[float] = []
    reached: list[float] = []
    bounds: list[tuple[float | None, float | None]] = []
    anything = [((False, False), 0)] * (m - len(states))
    for p, (ends, slip) in enumerate([*states, *anything]):
        tension, cohesion = wall.constant[p, :2], wall.constant[p, 2:]
        bounds += [(-t, -t if free else None) for t, free in zip(tension, ends, strict=True)] + [(None, None)]
        for sense, bond in zip((1, -1), cohesion, strict=True):
            row = np.zeros(3 * m + 1)
            row[3 * p : 3 * p + 2] = -wall.friction[p]
            row[3 * p + 2] = -sense
            (limit if slip == sense else cone).append(row)
            (reached if slip == sense else within).append(bond)
    answer = linprog(
        np.append(np.zeros(3 * m), 1.0),
        A_ub=np.array(cone),
        b_ub=np.array(within),
        A_eq=np.vstack([np.column_stack([wall.kinematic_matrix.toarray().T, live]), *limit]),
        b_eq=np.append(-dead, reached),
        bounds=[*bounds, (0.0, None)],
    )
    return float(answer.fun) if answer.fun is not None and answer.status == 0 else None
