"""Check of a certificate that no collapse state lies below a multiplier, in fractions, by nothing that found it.

A certificate holds blocks, interfaces and loads as fractions, and a tree over contacts: each leaf holds some slacks at
zero (tight) and some rates at zero (still), with velocities or forces that exclude every collapse state below the
multiplier within it. Only the standard library is used. docs/theory-bound.md says why the conditions suffice.
"""

from __future__ import annotations

import hashlib
import json
import sys
from collections.abc import Sequence
from fractions import Fraction
from pathlib import Path
from typing import Any

from methods.bound.exact_wall import CertificateError, ExactWall, Vector, dot, fractions_of
from methods.bound.verify_cases import States, case_bound, states_of
from methods.bound.verify_window import WindowLimits


def digest(document: Any) -> str:
    """SHA-256 of all that a certificate holds but the digest itself: it shows accidents, the fractions show errors."""
    content = {name: value for name, value in document.items() if name != "digest"}
    return hashlib.sha256(json.dumps(content, sort_keys=True).encode()).hexdigest()


def verify(document: Any) -> tuple[Fraction, Fraction]:
    """(lower bound, multiplier of the collapse state) that a certificate proves.

    A certificate without a state says its multiplier to rounding, and proves the bound only.

    Raises:
        CertificateError: it proves nothing of the kind.
    """
    try:
        if document["digest"] != digest(document):
            raise CertificateError("its digest is not that of its content")
        wall = ExactWall(document)
        bound, upper = Fraction(str(document["bound"])), Fraction(str(document["multiplier"]))
        if "state" in document:
            check_state(wall, upper, document["state"])
        if "windows" in document:
            _check_windows(wall, bound, document)
            leaves = []
        else:
            leaves = [_Leaf(wall, leaf) for leaf in document["leaves"]]
            _check_cover([(leaf.tight, leaf.still) for leaf in leaves])
    except (LookupError, TypeError, ValueError, ArithmeticError, AttributeError) as error:
        raise CertificateError(str(error)) from error
    for leaf in leaves:
        leaf.check(wall, bound)
    if bound > upper:
        raise CertificateError("the bound is above the collapse state")
    return bound, upper


def _check_windows(wall: ExactWall, bound: Fraction, document: Any) -> None:
    """Whether the windows, one above the other from zero, and cases of the last leave no state below the bound."""
    proved = Fraction(0)
    states: States | None = None
    for window in document["windows"]:
        limits = WindowLimits(wall, window)
        if limits.forces.low > proved:
            raise CertificateError(
                f"a window begins at {float(limits.forces.low):.9g}, where {float(proved):.9g} is proved"
            )
        greatest = limits.greatest_size(window["size"])
        proved = max(proved, limits.bound(window["multiplier"], greatest))
        states = states_of(limits, greatest, proved)
    if "cases" in document and states is not None:
        proved = max(proved, case_bound(states, document["cases"]))
    if proved < bound:
        raise CertificateError(f"the windows prove {float(proved):.9g} only")


def check_state(wall: ExactWall, multiplier: Fraction, state: Any) -> None:
    """Whether forces and velocities are a collapse state of this multiplier.

    Raises:
        CertificateError: they are not.
    """
    forces = fractions_of(state["forces"], len(wall.rows))
    velocities = fractions_of(state["velocities"], len(wall.dead))
    loads = [d + multiplier * f for d, f in zip(wall.dead, wall.live, strict=True)]
    if any(a + b for a, b in zip(wall.resultant(forces), loads, strict=True)):
        raise CertificateError("the collapse state is not in equilibrium")
    if dot(wall.live, velocities) <= 0:
        raise CertificateError("the live load does no work in the collapse state")
    for p, mu in enumerate(wall.friction):
        n1, n2, s = forces[3 * p : 3 * p + 3]
        open1, open2, slip = (dot(row, velocities) for row in wall.rows[3 * p : 3 * p + 3])
        strength = mu * (n1 + n2)
        if min(n1, n2, strength - abs(s), open1, open2) < 0 or n1 * open1 or n2 * open2:
            raise CertificateError("the collapse state violates yield or passes through a joint")
        if (slip > 0 and s != -strength) or (slip < 0 and s != strength):
            raise CertificateError("the collapse state slips below the friction limit")


def _check_cover(leaves: list[tuple[frozenset[int], frozenset[int]]]) -> None:
    """Whether every choice of tight or still contacts lies in a leaf: all leaves of a node divide at one contact."""
    open_nodes = [leaves]
    while open_nodes:
        node = open_nodes.pop()
        if any(not tight and not still for tight, still in node):
            continue
        common = frozenset.intersection(*(tight | still for tight, still in node)) if node else frozenset()
        if not common:
            raise CertificateError("the leaves do not cover all cases")
        k = frozenset([min(common)])
        open_nodes.append([(tight - k, still - k) for tight, still in node if k <= tight])
        open_nodes.append([(tight - k, still - k) for tight, still in node if k <= still])


class _Leaf:
    def __init__(self, wall: ExactWall, document: Any) -> None:
        self.tight, self.still = frozenset(document["tight"]), frozenset(document["still"])
        if not all(type(k) is int and 0 <= k < 4 * len(wall.friction) for k in self.tight | self.still):
            raise CertificateError("a leaf names a contact that is not there")
        self.velocities = self.forces = None
        if "velocities" in document:
            self.velocities = fractions_of(document["velocities"], len(wall.dead))
        else:
            self.forces = fractions_of(document["forces"], len(wall.rows))
            self.dead, self.live = fractions_of(document["parts"], 2)

    def check(self, wall: ExactWall, bound: Fraction) -> None:
        if self.velocities is not None:
            self._check_velocities(wall, bound, self.velocities)
        elif self.forces is not None:
            self._check_forces(wall, bound, self.forces)

    def _check_velocities(self, wall: ExactWall, bound: Fraction, velocities: Vector) -> None:
        """Virtual work: (lambda - bound) live.u >= -(dead + bound live).u for all forces of the leaf."""
        live = dot(wall.live, velocities)
        rest = -dot(wall.dead, velocities) - bound * live
        if live < 0 or rest < 0 or live + rest <= 0:
            raise CertificateError("the velocities of a leaf exclude nothing")
        for p, mu in enumerate(wall.friction):
            open1, open2, slip = (dot(row, velocities) for row in wall.rows[3 * p : 3 * p + 3])
            above, below = [], []
            for k, opening in ((4 * p, open1), (4 * p + 1, open2)):
                if k not in self.tight:
                    if mu > 0:
                        above.append(opening / mu)
                    elif opening > 0:
                        raise CertificateError("a leaf's velocities open a joint that may press")
            below += [value for k, value in ((4 * p + 2, -slip), (4 * p + 3, slip)) if k not in self.tight]
            if above and below and max(above) > min(below):
                raise CertificateError("a leaf's velocities gain work from forces within yield")

    def _check_forces(self, wall: ExactWall, bound: Fraction, forces: Vector) -> None:
        """Forces without work lost on any mechanism of the leaf, under dead + bound live and more live load."""
        if self.dead < 0 or self.live < 0 or self.dead + self.live <= 0:
            raise CertificateError("the forces of a leaf exclude nothing")
        total = wall.resultant(forces)
        for value, dead, live in zip(total, wall.dead, wall.live, strict=True):
            if value + self.dead * (dead + bound * live) + self.live * live:
                raise CertificateError("the forces of a leaf are not in equilibrium")
        for p in range(len(wall.friction)):
            n1, n2, s = forces[3 * p : 3 * p + 3]
            for k, value in enumerate((n1, n2, s, -s)):
                if value < 0 and 4 * p + k not in self.still:
                    raise CertificateError("the forces of a leaf lose work on a mechanism")


def main(arguments: Sequence[str] | None = None) -> int:
    """Check certificate files; 1 if one proves nothing."""
    failed = 0
    for name in sys.argv[1:] if arguments is None else arguments:
        try:
            lower, upper = verify(json.loads(Path(name).read_text()))
        except (CertificateError, OSError, json.JSONDecodeError) as error:
            print(f"{name}: refused: {error}")
            failed = 1
        else:
            print(f"{name}: no collapse state below {lower} = {float(lower):.9g}; one at {upper} = {float(upper):.9g}")
    return failed


if __name__ == "__main__":
    sys.exit(main())
