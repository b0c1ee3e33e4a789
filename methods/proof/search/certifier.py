"""The certificate of a bracket as it goes up: documents of its windows, and of the cases they are divided into."""

from __future__ import annotations

import json
from abc import ABC, abstractmethod
from fractions import Fraction
from typing import Any, NamedTuple

import numpy as np

from harness.model.assembly import FloatArray
from methods.proof.same_wall import SAME_NUMBER
from methods.proof.search.equations import Equations
from methods.proof.search.rate_bounds import RateProof
from methods.proof.search.relaxation import Relaxation
from methods.proof.search.slack_bounds import SlackBounds, SlackProgramme
from methods.proof.search.subproblem import AtContact, Division
from methods.proof.search.window_document import Scales, WindowDocument, below, whole_values
from methods.proof.search.window_search import WindowProof
from methods.proof.verify.cases import States, states_of
from methods.proof.verify.document import MOST_NESTED, share_of_largest
from methods.proof.verify.exact_wall import CertificateError, ExactWall

_Fact = tuple[str, int]
"""What a step shows: the rate of a contact is bounded, its slack is zero, or an interface is loaded."""


class _Passage(NamedTuple):
    """A part of a certificate, and how much of the largest that is checked it takes."""

    content: dict[str, Any]
    share: float


def _passage(content: dict[str, Any]) -> _Passage:
    return _Passage(content, share_of_largest(json.dumps(content)))


class _Passages(ABC):
    """What a certificate holds so far, of which no more is written than is checked."""

    @abstractmethod
    def kept(self) -> list[_Passage]:
        """All of it."""

    @abstractmethod
    def depth(self) -> int:
        """How often its states are divided, and divided again."""

    def has_room(self, processes: int = 1) -> bool:
        """Whether two passages as large as any fit, from a window of each, and one more for a collapse state."""
        shares = [each.share for each in self.kept()]
        levels = 2 * self.depth() + 10  # two a division, and fewer than ten for all else
        return levels <= MOST_NESTED and sum(shares) + (2 * processes + 1) * max(shares) <= 1.0


class Certifier(_Passages):
    """The documents of windows as a bracket goes up, asked after each.

    Args:
        wall: of the certificate, as it stands there.
        scales: from the search to it.
        equations: of the search.

    Attributes:
        cases: into which the states of the last of them are divided, if they are.
        refused: why there is no document of the last window; empty where there is.
    """

    def __init__(self, wall: dict[str, Any], scales: Scales, equations: Equations) -> None:
        self.wall, self.scales = ExactWall(wall), scales
        self._wall = _passage(wall)
        self._windows: list[_Passage] = []
        self.cases: _CaseCertifier | None = None
        self.refused = ""
        self._programme = SlackProgramme(equations)
        self._proved = Fraction(0)
        self._last: tuple[Relaxation, States] | None = None

    @property
    def documents(self) -> list[dict[str, Any]]:
        """Of the windows that raise the bound, in order."""
        return [each.content for each in self._windows]

    def kept(self) -> list[_Passage]:
        """The wall, windows, and cases."""
        return [self._wall, *self._windows, *([] if self.cases is None else self.cases.kept())]

    def depth(self) -> int:
        """How often the states of the last window are divided."""
        return 0 if self.cases is None else self.cases.depth()

    @property
    def bound(self) -> Fraction:
        """What the documents prove."""
        return self._proved if self.cases is None else max(self._proved, self.cases.bound)

    def window(self, proof: WindowProof, needed: float) -> float:
        """The scaled multiplier below which the documents leave no collapse state, this window among them.

        Args:
            proof: of the window.
            needed: scaled multiplier that is enough.
        """
        exact = Fraction(needed) * Fraction(self.scales.multiplier)
        writer = WindowDocument(self.wall, self.scales, proof, self._programme)
        try:
            document, bound = writer.document(exact)
        except CertificateError as error:
            self.refused = str(error)
            return self.scales.scaled(self._proved)
        self.refused = ""
        if bound > self._proved:
            if self._last is not None and proof.relaxation is self._last[0]:
                self._windows.pop()
            self._windows.append(_passage(document))
            greatest = writer.limits.greatest_size(document["size"])
            self._proved = bound
            self._last = proof.relaxation, states_of(writer.limits, greatest, bound)
        return self.scales.scaled(self._proved)

    def part(self, at: Division, first: bool) -> _CaseCertifier | None:
        """The certificate of half of the states of the last window; None if none is proved."""
        if self._last is None:
            return None
        if self.cases is None:
            self.cases = _CaseCertifier(self.scales, self._programme, self._last[1])
        return self.cases.part(at, first)

    def slacks(self, bounds: SlackBounds) -> None:
        """Nothing: windows of all states bring this with them."""

    def statics(self, velocities: FloatArray) -> float:
        """What is proved already."""
        return self.scales.scaled(self._proved)

    def rates(self, proofs: list[RateProof]) -> float:
        """What is proved already."""
        return self.scales.scaled(self._proved)


class _CaseCertifier(_Passages):
    """What is proved of the states of one case, step by step, and of its halves once it is divided.

    Args:
        scales: from the search to the certificate.
        programme: of the slacks of the search.
        states: with what is known of them at first.
    """

    def __init__(self, scales: Scales, programme: SlackProgramme, states: States) -> None:
        self._scales, self._programme, self._states = scales, programme, states
        self._steps: list[_Passage] = []
        self._halves: dict[bool, _CaseCertifier] = {}
        self._at: dict[str, Any] = {}
        self._before = states
        self._last: Relaxation | None = None

    @property
    def bound(self) -> Fraction:
        """Multiplier below which no state of the case is left."""
        halves = [half.bound for half in self._halves.values()]
        return min(halves) if len(halves) == 2 else self._states.low

    def kept(self) -> list[_Passage]:
        """This node, its steps, and all below it."""
        node = _passage(self._at | {"parts": [], "steps": []})
        return [node, *self._steps, *(each for half in self._halves.values() for each in half.kept())]

    def depth(self) -> int:
        """How often the states of this node are divided, and divided again."""
        return 1 + max((half.depth() for half in self._halves.values()), default=0)

    def document(self) -> dict[str, Any]:
        """The node of the certificate, without the steps that nothing needs."""
        return self._needed()[0]

    def _needed(self) -> tuple[dict[str, Any], set[_Fact]]:
        """The node, and what it needs that is known before it."""
        node: dict[str, Any] = {}
        needs: set[_Fact] = set()
        if len(self._halves) == 2:
            parts = [self._halves[first]._needed() for first in (True, False)]
            node |= self._at | {"parts": [part for part, _ in parts]}
            needs = parts[0][1] | parts[1][1]
        steps = []
        for step, _ in reversed(self._steps):
            shown = _fact(step)
            if shown is None or shown in needs:
                steps.append(step)
                needs |= _needs_of(step, self._states)
        return node | {"steps": steps[::-1]}, needs

    def part(self, at: Division, first: bool) -> _CaseCertifier:
        """Of the first or the second half of a division."""
        if isinstance(at, AtContact):
            self._at = {"contact": at.contact}
        else:
            normal = below(at.normal / float(self._scales.length[at.interface]))
            self._at = {"interface": at.interface, "normal": str(normal)}
        half = self._states.halves(self._at)[0 if first else 1]
        self._halves[first] = _CaseCertifier(self._scales, self._programme, half)
        return self._halves[first]

    def window(self, proof: WindowProof, needed: float) -> float:
        """The bound after a window, of which so much is needed."""
        exact = Fraction(needed) * Fraction(self._scales.multiplier)
        before = self._before if proof.relaxation is self._last else self._states
        writer = WindowDocument(before.wall, self._scales, proof, self._programme, before)
        try:
            document, bound = writer.document(exact)
        except CertificateError:
            return self._lower
        if bound > self._states.low:
            if proof.relaxation is self._last:
                self._steps.pop()
            self._before, self._last = before, proof.relaxation
            self._steps.append(_passage(document))
            self._states = before.at(bound)
        return self._lower

    def slacks(self, bounds: SlackBounds) -> None:
        """Note what is new of slacks that stay above zero and of least normal forces."""
        length, margin = self._scales.length, self._programme.margin
        for contact in np.flatnonzero(bounds.least > margin).tolist():
            if contact not in self._states.known.still:
                velocities = self._scales.velocities(bounds.still_velocities[contact] / length[contact // 4])
                self._learn({"shows": "still", "contact": contact, "velocities": velocities})
        for p in np.flatnonzero(bounds.normal_least > margin).tolist():
            least = below(float(bounds.normal_least[p] / length[p]))
            known = self._states.known.least.get(p)
            if known is None or abs(least - known) > SAME_NUMBER * least:
                velocities = self._scales.velocities(bounds.least_velocities[p] / length[p])
                self._learn({"shows": "loaded", "interface": p, "least": str(least), "velocities": velocities})

    def statics(self, velocities: FloatArray) -> float:
        """The bound after velocities, of either sign, that bound the multiplier."""
        for sign in (1.0, -1.0):
            self._learn({"shows": "statics", "velocities": self._scales.velocities(sign * velocities)})
        return self._lower

    def rates(self, proofs: list[RateProof]) -> float:
        """The bound after virtual forces that show something of the mechanisms."""
        scales, exponent = self._scales, self._scales.precision.forces
        for proof in proofs:
            unit = scales.length[proof.contact // 4] if proof.contact >= 0 else 1.0
            step: dict[str, Any] = {
                "shows": proof.shows,
                "exponent": exponent,
                "strains": whole_values(unit * proof.strains / np.repeat(scales.length, 3), exponent),
                "lift": round(unit * proof.lift * 2**exponent),
                "work": round(unit * scales.multiplier * proof.work * 2**exponent),
            }
            if proof.contact >= 0:
                step["contact"] = proof.contact
            self._learn(step)
        return self._lower

    @property
    def _lower(self) -> float:
        return self._scales.scaled(self._states.low)

    def _learn(self, step: dict[str, Any]) -> None:
        """Take a step, if it shows what it says and something new."""
        if self._states.low >= self._states.high:
            return
        try:
            after = self._states.after(step)
        except CertificateError:
            return
        if after.low > self._states.low or step["shows"] in ("still", "loaded", "slow", "tight"):
            self._steps.append(_passage(step))
            self._states, self._last = after, None


def _fact(step: dict[str, Any]) -> _Fact | None:
    """What a step shows of contacts; None where it raises the bound."""
    match step["shows"]:
        case "still" | "slow":
            return "rate", int(step["contact"])
        case "loaded":
            return "force", int(step["interface"])
        case "tight":
            return "slack", int(step["contact"])
    return None


def _needs_of(step: dict[str, Any], states: States) -> set[_Fact]:
    """All that a step may need, of what is known of the states at the end."""
    slacks: set[_Fact] = {("slack", k) for k in states.forces.tight}
    if "strains" not in step:
        known = states.known
        every: set[_Fact] = {("rate", k) for k in known.still | known.slow.keys()} | {("force", p) for p in known.least}
        return slacks | every if step["shows"] == "window" else slacks
    needs: set[_Fact] = set()
    for strain, value in enumerate(step["strains"]):
        p, k = divmod(strain, 3)
        if k < 2 and value > 0:
            needs.add(("rate", 4 * p + k))
        elif k == 2 and value:
            needs |= {("force", p), ("rate", 4 * p + 2), ("rate", 4 * p + 3)}
    return needs
