"""Sparse linear equations in fractions."""

from __future__ import annotations

from fractions import Fraction

from harness.model.assembly import FloatArray

DENOMINATOR = 10**6
"""Greatest of a fraction that counts as short: coordinates and loads are written with few digits."""


Row = dict[int, Fraction]


def solve_sparse(equations: list[Row], right: list[Fraction], guess: FloatArray) -> Row:
    """A solution of sparse linear equations in fractions; free unknowns take short fractions near the guess.

    Unknowns beyond the guess are slacks of equations that may hold as inequalities: zero where all can be, else not
    below zero. What is an active set in floats may contradict itself in fractions, by a little, and needs one then.

    Raises:
        ArithmeticError: the equations contradict each other.
    """
    count = len(guess)
    work = [({c: v for c, v in row.items() if v}, value) for row, value in zip(equations, right, strict=True)]
    where: dict[int, set[int]] = {}
    for k, (row, _) in enumerate(work):
        for column in row:
            where.setdefault(column, set()).add(k)
    open_rows = set(range(len(work)))
    pivots: list[tuple[int, int]] = []
    of_slacks: list[int] = []
    while open_rows:
        k = min(open_rows, key=lambda index: len(work[index][0]) or -1)
        open_rows.remove(k)
        row = work[k][0]
        columns = [c for c in row if c < count]
        if not columns:
            of_slacks.append(k)
            continue
        column = min(columns, key=lambda c: len(where[c] & open_rows) if len(where[c]) < 50 else 99)
        pivots.append((k, column))
        _eliminate(work, where, (k, column), where[column] & open_rows)
    while contradicted := [k for k in of_slacks if work[k][1]]:
        k = contradicted[0]
        row, value = work[k]
        above_zero = [c for c, entry in row.items() if value / entry > 0]
        if not above_zero:
            raise ArithmeticError("the active set has no solution in exact arithmetic")
        column = above_zero[0]
        of_slacks.remove(k)
        pivots.append((k, column))
        _eliminate(work, where, (k, column), where[column] & set(of_slacks))
    solution: Row = {}
    for k, column in reversed(pivots):
        row, value = work[k]
        for c, entry in row.items():
            if c != column:
                if c not in solution:
                    solution[c] = Fraction(float(guess[c])).limit_denominator(DENOMINATOR) if c < count else Fraction(0)
                value -= entry * solution[c]
        solution[column] = value / row[column]
    return solution


def _eliminate(
    work: list[tuple[Row, Fraction]], where: dict[int, set[int]], pivot: tuple[int, int], others: set[int]
) -> None:
    """Take the column of a pivot (equation, column) out of other equations; `where` says which hold a column."""
    k, column = pivot
    row, value = work[k]
    for other in others:
        target, other_value = work[other]
        factor = target[column] / row[column]
        for c, entry in row.items():
            changed = target.get(c, Fraction(0)) - factor * entry
            if changed:
                target[c] = changed
                where[c].add(other)
            elif c in target:
                del target[c]
                where[c].discard(other)
        work[other] = (target, other_value - factor * value)
