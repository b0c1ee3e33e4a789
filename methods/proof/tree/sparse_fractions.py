"""Sparse linear equations in fractions."""

from __future__ import annotations

from fractions import Fraction

from harness.model.assembly import FloatArray

DENOMINATOR = 10**6
"""Greatest of a fraction that counts as short: coordinates and loads are written with few digits."""


Row = dict[int, Fraction]


def solve_sparse(equations: list[Row], right: list[Fraction], guess: FloatArray) -> Row:
    """A solution of sparse linear equations in fractions; free unknowns take short fractions near the guess.

    Raises:
        ArithmeticError: the equations contradict each other.
    """
    work = [({c: v for c, v in row.items() if v}, value) for row, value in zip(equations, right, strict=True)]
    where: dict[int, set[int]] = {}
    for k, (row, _) in enumerate(work):
        for column in row:
            where.setdefault(column, set()).add(k)
    open_rows = set(range(len(work)))
    pivots: list[tuple[int, int]] = []
    while open_rows:
        k = min(open_rows, key=lambda index: len(work[index][0]) or -1)
        open_rows.remove(k)
        row, value = work[k]
        if not row:
            if value != 0:
                raise ArithmeticError("the active set has no solution in exact arithmetic")
            continue
        column = min(row, key=lambda c: len(where[c] & open_rows) if len(where[c]) < 50 else 99)
        pivots.append((k, column))
        for other in list(where[column] & open_rows):
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
    solution: Row = {}
    for k, column in reversed(pivots):
        row, value = work[k]
        for c, entry in row.items():
            if c != column:
                if c not in solution:
                    solution[c] = Fraction(float(guess[c])).limit_denominator(DENOMINATOR)
                value -= entry * solution[c]
        solution[column] = value / row[column]
    return solution
