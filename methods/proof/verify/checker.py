"""Check of a certificate that no collapse state lies below a multiplier, in fractions, by nothing that found it.

A certificate holds blocks, interfaces and loads as fractions, and a tree over contacts: each leaf holds some slacks at
zero (tight) and some rates at zero (still), with velocities or forces that exclude every collapse state below the
multiplier within it; or windows, which `verify_window` checks, and cases, which `verify_cases` does. Only the standard
library is used. docs/theory-bound.md says why the conditions suffice.

What each statement of a certificate stands for, a definition or a theorem that is checked here:

- blocks, interfaces: the wall, of which all else is said (`ExactWall`). That it is a given one is for `same_wall`.
- state: definition of a collapse state (`check_state`); without it no multiplier is shown, and none is handed on.
- bound: no collapse state of the wall has a multiplier from zero to below it. Nothing is assumed of the wall under its
  dead load.
- leaves: in a collapse state every contact is tight or still, so leaves that divide at one contact after the other hold
  all states (`_check_cover`). No contact of a leaf is both, else it would count for both halves of a division and
  exclude only what lies in both.
- velocities of a leaf: virtual work, and Farkas' lemma for the forces at each interface.
- forces of a leaf: virtual work, and the sign of each force for the rates that it works on.
- windows: each begins where all below is excluded, from zero on.
- digest: nothing; it shows accidents.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence
from fractions import Fraction
from pathlib import Path
from typing import Any

from methods.proof.verify.cases import States, case_bound, states_of
from methods.proof.verify.document import FORMAT, digest, read
from methods.proof.verify.exact_wall import (
    CertificateError,
    ExactWall,
    Vector,
    contacts,
    fractions_of,
    in_digits,
    listed,
    number,
    refusal_of,
)
from methods.proof.verify.windows import WindowLimits

SECONDS = 600.0
"""CPU time that a check may take. The longest of the library takes six seconds."""


def verify(document: Any, seconds: float = SECONDS) -> tuple[Fraction, Fraction | None]:
    """(lower bound, multiplier of the collapse state) that a certificate proves; no multiplier without a state.

    Args:
        document: the certificate.
        seconds: of CPU time after which it is refused.

    Raises:
        CertificateError: it proves nothing of the kind.
    """
    try:
        if document["digest"] != digest(document):
            raise CertificateError("its digest is not that of its content")
        if document["format"] != FORMAT:
            raise CertificateError(f"its format is not {FORMAT}")
        wall = ExactWall(document, seconds)
        bound, upper = number(document["bound"]), None
        if bound < 0:
            raise CertificateError("it says nothing of multipliers below zero, where its bound is")
        if "state" in document:
            upper = number(document["multiplier"])
            check_state(wall, upper, document["state"])
            if bound > upper:
                raise CertificateError("the bound is above the collapse state")
        elif "multiplier" in document:
            number(document["multiplier"])
        if "windows" in document:
            _check_windows(wall, bound, document)
        else:
            _check_leaves(wall, bound, document["leaves"])
    except (LookupError, TypeError, ValueError, ArithmeticError, AttributeError, RecursionError) as error:
        raise refusal_of(error) from error
    return bound, upper


def _check_windows(wall: ExactWall, bound: Fraction, document: Any) -> None:
    """Whether the windows, one above the other from zero, and cases of the last leave no state below the bound."""
    if "leaves" in document:
        raise CertificateError("it has leaves and windows")
    proved = Fraction(0)
    states: States | None = None
    for window in listed(document["windows"]):
        limits = WindowLimits(wall, window)
        if limits.forces.low > proved:
            raise CertificateError(
                f"a window begins at {in_digits(limits.forces.low)}, where {in_digits(proved)} is proved"
            )
        greatest = limits.greatest_size(window["size"])
        proved = max(proved, limits.bound(window["multiplier"], greatest))
        states = states_of(limits, greatest, proved)
    if "cases" in document and states is not None:
        proved = max(proved, case_bound(states, document["cases"]))
    if proved < bound:
        raise CertificateError(f"the windows prove {in_digits(proved)} only")


def check_state(wall: ExactWall, multiplier: Fraction, state: Any) -> None:
    """Whether forces and velocities are a collapse state of this multiplier.

    Raises:
        CertificateError: they are not.
    """
    forces = fractions_of(state["forces"], len(wall.sparse))
    velocities = fractions_of(state["velocities"], len(wall.dead))
    loads = [d + multiplier * f for d, f in zip(wall.dead, wall.live, strict=True)]
    if any(a + b for a, b in zip(wall.resultant(forces), loads, strict=True)):
        raise CertificateError("the collapse state is not in equilibrium")
    if wall.work(wall.live, velocities) <= 0:
        raise CertificateError("the live load does no work in the collapse state")
    for p, mu in enumerate(wall.friction):
        n1, n2, s = forces[3 * p : 3 * p + 3]
        open1, open2, slip = wall.strains(p, velocities)
        strength = mu * (n1 + n2)
        if min(n1, n2, strength - abs(s), open1, open2) < 0 or n1 * open1 or n2 * open2:
            raise CertificateError("the collapse state violates yield or passes through a joint")
        if (slip > 0 and s != -strength) or (slip < 0 and s != strength):
            raise CertificateError("the collapse state slips below the friction limit")


def _check_leaves(wall: ExactWall, bound: Fraction, documents: Any) -> None:
    """Whether the leaves hold all states, and each excludes those below the bound."""
    leaves = [Leaf(wall, leaf) for leaf in listed(documents)]
    _check_cover(wall, [(leaf.tight, leaf.still) for leaf in leaves])
    for leaf in leaves:
        leaf.check(wall, bound)


def _check_cover(wall: ExactWall, leaves: list[tuple[frozenset[int], frozenset[int]]]) -> None:
    """Whether every choice of tight or still contacts lies in a leaf: all leaves of a node divide at one contact.

    Since no contact of a leaf is both, a leaf goes to one half only, and the nodes are at most as many as the contacts
    that the leaves name.
    """
    open_nodes = [leaves]
    while open_nodes:
        wall.in_time()
        node = open_nodes.pop()
        if any(not tight and not still for tight, still in node):
            continue
        common = frozenset.intersection(*(tight | still for tight, still in node)) if node else frozenset()
        if not common:
            raise CertificateError("the leaves do not cover all cases")
        k = frozenset([min(common)])
        open_nodes.append([(tight - k, still - k) for tight, still in node if k <= tight])
        open_nodes.append([(tight - k, still - k) for tight, still in node if k <= still])


class Leaf:
    """A leaf of the tree of cases: contacts that are tight and contacts that are still, and what excludes the rest.

    Args:
        wall: the wall; document: the leaf as the certificate states it.

    Raises:
        CertificateError: it is no leaf.
    """

    def __init__(self, wall: ExactWall, document: Any) -> None:
        wall.in_time()
        self.tight, self.still = (contacts(document[name], wall.n_interfaces) for name in ("tight", "still"))
        if self.tight & self.still:
            raise CertificateError("a leaf holds a contact both tight and still")
        self.velocities = self.forces = None
        if ("velocities" in document) == ("forces" in document):
            raise CertificateError("a leaf has either velocities or forces")
        if "velocities" in document:
            self.velocities = fractions_of(document["velocities"], len(wall.dead))
        else:
            self.forces = fractions_of(document["forces"], len(wall.sparse))
            self.dead, self.live = fractions_of(document["parts"], 2)

    def check(self, wall: ExactWall, bound: Fraction) -> None:
        """Raise CertificateError unless no state of these contacts is below the bound."""
        if self.velocities is not None:
            self._check_velocities(wall, bound, self.velocities)
        elif self.forces is not None:
            self._check_forces(wall, bound, self.forces)

    def _check_velocities(self, wall: ExactWall, bound: Fraction, velocities: Vector) -> None:
        """Virtual work: -(dead + lambda live).u <= 0 for all forces of the leaf; it is above zero below the bound."""
        at_zero = -wall.work(wall.dead, velocities)
        at_bound = at_zero - bound * wall.work(wall.live, velocities)
        if at_zero <= 0 or at_bound < 0:
            raise CertificateError("the velocities of a leaf exclude nothing")
        for p, mu in enumerate(wall.friction):
            open1, open2, slip = wall.strains(p, velocities)
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
            document = read(Path(name).read_bytes())
            lower, upper = verify(document)
        except (CertificateError, OSError) as error:
            print(f"{name}: refused: {error}")
            failed = 1
        else:
            one = "" if upper is None else f"; one at {upper} = {in_digits(upper)}"
            print(f"{name}: no collapse state from zero to below {lower} = {in_digits(lower)}{one}")
    return failed


if __name__ == "__main__":
    sys.exit(main())
