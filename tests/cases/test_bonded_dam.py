"""A bonded wall under water by code of its own: contacts, pressure and a linear programme, none of it from Drystone."""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from scipy.optimize import linprog

from harness.model.case import read_case, shipped_cases

HEIGHT, COURSES, UNIT, WATER = 0.25, 10, 22.0, 9.81

Contact = tuple[int, int, tuple[float, float], tuple[float, float], tuple[float, float]]
"""Block below or on the left, block above or on the right (-1: the ground), both ends, normal towards the latter."""


def greatest_multiplier(friction: float) -> float:
    """The associated maximum of two bricks' length in running bond, water to the top on its left.

    Unknown are two normal forces and a shear force of every contact, and the multiplier of the water.
    """
    bond = [[0.0, 0.25, 0.75, 1.0] if k % 2 == 0 else [0.0, 0.5, 1.0] for k in range(COURSES)]
    boxes = [(a, b, k * HEIGHT) for k, joints in enumerate(bond) for a, b in pairwise(joints)]
    columns: list[np.ndarray] = []
    limits: list[tuple[int, float]] = []

    def column(forces: list[tuple[int, tuple[float, float], tuple[float, float]]]) -> None:
        sums = np.zeros((len(boxes), 3))
        for block, (x, y), (fx, fy) in forces:
            if block >= 0:
                a, b, low = boxes[block]
                sums[block] += fx, fy, (x - (a + b) / 2.0) * fy - (y - low - HEIGHT / 2.0) * fx
        columns.append(sums.ravel())

    for one, other, start, end, (nx, ny) in _contacts(boxes):
        for at in (start, end):
            column([(one, at, (-nx, -ny)), (other, at, (nx, ny))])
        column([(one, start, (ny, -nx)), (other, start, (-ny, nx))])
        limits.append((len(columns) - 3, friction))
    sums = np.zeros((len(boxes), 3))
    depth = COURSES * HEIGHT
    for block, (a, _, low) in enumerate(boxes):
        if a == 0.0:
            below, above = WATER * (depth - low), WATER * (depth - low - HEIGHT)
            force = HEIGHT * (below + above) / 2.0
            sums[block] = force, 0.0, HEIGHT**2 * (below - above) / 12.0  # of a trapezium about its middle
    columns.append(sums.ravel())
    weight = np.array([[0.0, -UNIT * (b - a) * HEIGHT, 0.0] for a, b, _ in boxes]).ravel()
    rows = np.zeros((2 * len(limits), len(columns)))
    for k, (first, mu) in enumerate(limits):
        rows[2 * k : 2 * k + 2, first : first + 2] = -mu
        rows[2 * k : 2 * k + 2, first + 2] = 1.0, -1.0
    bounds: list[Any] = [(0, None), (0, None), (None, None)] * len(limits) + [(0, None)]
    cost = np.append(np.zeros(len(columns) - 1), -1.0)
    found = linprog(cost, rows, np.zeros(len(rows)), np.array(columns).T, -weight, bounds)
    return float(found.x[-1])


def _contacts(boxes: list[tuple[float, float, float]]) -> list[Contact]:
    found: list[Contact] = []
    for i, (a, b, low) in enumerate(boxes):
        if low == 0.0:
            found.append((-1, i, (a, 0.0), (b, 0.0), (0.0, 1.0)))
        for j, (c, d, bottom) in enumerate(boxes):
            left, right = max(a, c), min(b, d)
            if bottom == low + HEIGHT and right > left:
                found.append((i, j, (left, bottom), (right, bottom), (0.0, 1.0)))
            if bottom == low and c == b:
                found.append((i, j, (b, low), (b, low + HEIGHT), (1.0, 0.0)))
    return found


def test_the_case_has_the_value_of_this_programme():
    case = read_case(shipped_cases() / "dam-bonded")
    (reference,) = [item for item in case.file.references if item.id == "programme"]
    assert reference.value == pytest.approx(greatest_multiplier(0.75), abs=reference.tolerance)
