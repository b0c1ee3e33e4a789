"""Benchmark on the walls that accuracy is asked about; METHOD is `de` if none is given.

Run as `python -m benchmarks distinct_elements [small | all] [METHOD]`.

Prints one row a wall: error of the reported multiplier, spread over orders, CPU seconds for one order and in all,
beside what the project's first study of pymunk reached. The reference of a running bond is the greatest multiplier
whose head joints carry nothing (a linear programme); of the others it is a closed form.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np
import scipy.sparse as sp
from scipy.optimize import linprog

from benchmarks.walls import bond, stack
from harness.model.assembly import Assembly
from harness.model.method_registry import load_method


def greatest_with_unloaded_heads(assembly: Assembly) -> float:
    """Greatest multiplier of admissible forces that leave the head joints empty (static theorem, HiGHS)."""
    m = assembly.n_interfaces
    dead, live = assembly.free_loads()
    matrices: Any = [assembly.kinematic_matrix.T, live[:, None]]
    equilibrium: Any = sp.hstack(matrices)
    sliding: Any = sp.kron(sp.diags(assembly.friction), np.array([[1.0, 1.0, 0.0]] * 2)) + sp.kron(
        sp.eye(m), np.array([[0.0, 0.0, 1.0], [0.0, 0.0, -1.0]])
    )
    bounds: list[Any] = []
    for name in assembly.joint:
        bounds += [(0.0, 0.0)] * 3 if name == "head" else [(0.0, None), (0.0, None), (None, None)]
    objective: Any = np.append(np.zeros(3 * m), -1.0)
    inequality: Any = sp.hstack([-sliding, sp.csr_matrix((2 * m, 1))])
    found: Any = linprog(
        objective, A_ub=inequality, b_ub=np.zeros(2 * m), A_eq=equilibrium, b_eq=-dead, bounds=[*bounds, (None, None)]
    )
    return float(found.x[-1])


def cases(size: str) -> Iterator[tuple[str, Assembly, float, str]]:
    """Name, wall, reference, and what the first study reached (error; seconds a run)."""
    yield "slide, friction 0.3", stack(1, 0.4, 0.2, 0.3), 0.3, "0.05 %; 0.1-3 s"
    yield "topple", stack(1, 0.2, 0.4, 0.7), 0.5, "0.05 %; 0.1-3 s"
    for count in (2, 5, 10):
        yield f"stack of {count}", stack(count, 0.4, 0.2, 0.7), min(0.7, 2.0 / count), "0.05 %; 0.1-3 s"
    for friction in (0.3, 0.4, 0.5, 0.65, 0.75, 1.0):
        reached = "0.04 %; 0.3-1 s" if friction <= 0.5 else "0.4 %; 0.3-1 s"
        yield f"21 bricks, friction {friction}", bond(6, 3, friction, 0.2), min(friction, 13 / 23), reached
    low, high = 0.175, 0.2
    walls = [("55 bricks", 10, 5, 0.65, low, "0.15 %; 2-5 s"), ("105 bricks", 10, 10, 0.65, low, "0.15 %; 9-14 s")]
    walls += [("203 bricks", 14, 14, 0.65, low, "0.3 % (210 bricks); 17-28 s")]
    walls += [("55 bricks 2:1", 10, 5, 0.65, high, "none"), ("105 bricks 2:1", 14, 7, 0.65, high, "none")]
    walls += [("210 bricks 2:1", 20, 10, 0.65, high, "0.3 %; 17-28 s")]
    if size == "all":
        walls += [("440 bricks, 16 courses", 16, 27, 0.65, low, "0.05 %; 60 s")]
        walls += [("435 bricks, 30 courses", 30, 14, 0.75, low, "-3 %, not converged; 160 s")]
        walls += [("1,010 bricks, 20 courses", 20, 50, 0.65, low, "none")]
    for name, count, bricks, friction, height, reached in walls:
        assembly = bond(count, bricks, friction, height)
        yield name, assembly, greatest_with_unloaded_heads(assembly), reached


def main(arguments: Sequence[str] | None = None) -> int:
    """Print the table."""
    given = sys.argv[1:] if arguments is None else arguments
    size = given[0] if given else "small"
    method = load_method(given[1] if len(given) > 1 else "de")
    print("| wall | blocks | reference | error % | bracket % | spread % | undecided | s an order | s in all | before |")
    print("|---|---|---|---|---|---|---|---|---|---|")
    for name, assembly, reference, before in cases(size):
        start = time.process_time()
        answer = method.solve(assembly, method.Settings())
        seconds = time.process_time() - start
        orders = answer.details.get("orders", ())
        error = "-" if answer.multiplier is None else f"{100 * (answer.multiplier / reference - 1):+.3f}"
        low, high = answer.bracket or (float("nan"), float("nan"))
        bracket = f"{100 * (low / reference - 1):+.2f} {100 * (high / reference - 1):+.2f}"
        spread = answer.details.get("spread")
        print(
            f"| {name} | {assembly.n_free} | {reference:.6f} | {error} | {bracket} "
            f"| {100 * spread if spread is not None else float('nan'):.3f} | {answer.details['undecided']} "
            f"| {seconds / (len(orders) or 1):.2f} | {seconds:.2f} | {before} |",
            flush=True,
        )
    return 0


if __name__ == "__main__":
    sys.exit(main())
