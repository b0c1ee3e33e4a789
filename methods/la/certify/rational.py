"""Confirmation of a collapse state in fractions: equilibrium, yield and complementarity hold exactly, not to rounding.

The coordinates, friction and loads are read as the short fractions they were written as; where some are not short
fractions (curved geometry) there is no confirmation.
"""

from __future__ import annotations

from fractions import Fraction
from typing import Any

import numpy as np

from harness.model.assembly import FloatArray
from methods.la.core.problem import Problem
from methods.la.core.state import CollapseState, tight_contacts
from methods.proof.tree.sparse_fractions import DENOMINATOR, Row, solve_sparse


class _NotShortError(ValueError):
    """A number of the wall is not a short fraction."""


def _short_fraction(value: float) -> Fraction:
    """The fraction of denominator up to 10^6 that a float stands for.

    Raises:
        _NotShortError: there is none within rounding.
    """
    fraction = Fraction(value).limit_denominator(DENOMINATOR)
    if abs(float(fraction) - value) > 1e-13 * max(1.0, abs(value)):
        raise _NotShortError(f"{value!r} is not a short fraction")
    return fraction


def confirm(problem: Problem, state: CollapseState) -> dict[str, Any]:
    """What exact arithmetic says of a state: {"confirmed": bool, "multiplier": "p/q", ...} or the reason why not."""
    try:
        forces, multiplier, columns = _solve_statics(problem, state)
        moving_ok, works = _check_mechanism(problem, state, columns)
    except (_NotShortError, ArithmeticError) as error:
        return {"confirmed": False, "reason": str(error)}
    friction = [_short_fraction(mu) for mu in problem.assembly.friction.tolist()]
    held = True
    for p, (n1, n2, s) in enumerate(forces):
        strength = friction[p] * (n1 + n2)
        slack = (n1, n2, strength + s, strength - s)
        held &= min(slack) >= 0 and all(slack[k] == 0 for k in range(4) if state.moving[p, k])
    return {
        "confirmed": bool(held and moving_ok and works),
        "multiplier": f"{multiplier.numerator}/{multiplier.denominator}",
        "value": float(multiplier),
    }


def _fractions_of(problem: Problem) -> tuple[list[Row], list[Fraction], list[Fraction]]:
    """Rows of the unscaled C (3m rows over 3n columns), dead and live load (3n)."""
    assembly = problem.assembly
    matrix = assembly.kinematic_matrix.tocsr()
    rows: list[Row] = []
    for k in range(matrix.shape[0]):
        span = slice(matrix.indptr[k], matrix.indptr[k + 1])
        pairs = zip(matrix.indices[span].tolist(), matrix.data[span].tolist(), strict=True)
        rows.append({column: _short_fraction(value) for column, value in pairs if value != 0.0})
    dead, live = assembly.free_loads()
    unit = problem.unit_force
    return rows, [_short_fraction(v / unit) for v in dead.tolist()], [_short_fraction(v / unit) for v in live.tolist()]


def _solve_statics(
    problem: Problem, state: CollapseState
) -> tuple[list[tuple[Fraction, Fraction, Fraction]], Fraction, list[Row]]:
    rows, dead, live = _fractions_of(problem)
    friction = [_short_fraction(mu) for mu in problem.assembly.friction.tolist()]
    tight = tight_contacts(problem, state.forces) | state.moving
    m, n = problem.n_interfaces, len(dead)
    equations: list[Row] = [{} for _ in range(n)]

    def add(column: int, by_row: Row, factor: Fraction) -> None:
        for dof, value in by_row.items():
            equations[dof][column] = equations[dof].get(column, Fraction(0)) + factor * value

    for p in range(m):
        sign = -1 if tight[p, 2] else (1 if tight[p, 3] else 0)
        for end in (0, 1):
            if not tight[p, end]:
                add(3 * p + end, rows[3 * p + end], Fraction(1))
                if sign:
                    add(3 * p + end, rows[3 * p + 2], sign * friction[p])
        if not sign and not (tight[p, 0] and tight[p, 1]):
            add(3 * p + 2, rows[3 * p + 2], Fraction(1))
    for dof in range(n):
        if live[dof]:
            equations[dof][3 * m] = live[dof]
    solution = solve_sparse(equations, [-value for value in dead], _guess(problem, state))
    forces = []
    for p in range(m):
        n1, n2 = solution.get(3 * p, Fraction(0)), solution.get(3 * p + 1, Fraction(0))
        sign = -1 if tight[p, 2] else (1 if tight[p, 3] else 0)
        shear = sign * friction[p] * (n1 + n2) if sign else solution.get(3 * p + 2, Fraction(0))
        forces.append((n1, n2, shear))
    return forces, solution.get(3 * m, Fraction(0)), rows


def _guess(problem: Problem, state: CollapseState) -> FloatArray:
    return np.append(state.forces.ravel(), state.multiplier * problem.unit_multiplier)


def _check_mechanism(problem: Problem, state: CollapseState, rows: list[Row]) -> tuple[bool, bool]:
    """Whether velocities exist in fractions that move in the state's contacts only, as it says, with live work."""
    equations, right = [], []
    for p in range(problem.n_interfaces):
        moves = state.moving[p]
        for k, moving in enumerate((moves[0], moves[1], moves[2] or moves[3])):
            if not moving:
                equations.append(dict(rows[3 * p + k]))
                right.append(Fraction(0))
    _, live = problem.assembly.free_loads()
    equations.append({k: _short_fraction(v / problem.unit_force) for k, v in enumerate(live.tolist()) if v})
    right.append(Fraction(1))
    size = problem.unit_multiplier / problem.live_work
    guess = (state.velocities.reshape(-1, 3) / np.array([1.0, 1.0, problem.unit_length])).ravel() * size
    solution = solve_sparse(equations, right, guess)
    for p in range(problem.n_interfaces):
        strain = [
            sum((value * solution.get(c, Fraction(0)) for c, value in rows[3 * p + k].items()), Fraction(0))
            for k in range(3)
        ]
        moves = state.moving[p]
        if min(strain[0], strain[1]) < 0 or (strain[2] > 0 and not moves[2]) or (strain[2] < 0 and not moves[3]):
            return False, True
    return True, True
