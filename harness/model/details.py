"""What an answer's details say, by type: the one place that knows the names under which methods put it.

A method may add details of its own. A detail of another type than is declared here counts as missing. What an answer
claims as a proof is `Any`, as it is given: the judge, and the checker of certificates, say what is wrong with it.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from harness.model.joint_law import FloatArray

BAR_FORCES = "bar_forces"
"""Name under which an answer's details hold the (k,) tensions of the bars beside its contact forces [force]."""
DEAD_BAR_FORCES = "dead_bar_forces"
"""The same beside the `dead_forces` of a wall at its limit."""
MOVING_FORCES = "moving_forces"
"""Name under which an answer's details hold the (m, 3) contact forces that were measured with its mechanism [force]."""
MISSING_PACKAGE = "missing_package"
"""Detail of a refusal, true where a package is not installed that an extra brings."""


@dataclass(frozen=True)
class LastImprovement:
    """The last lower state that a search found.

    Attributes:
        source: starting-point strategy that led to it.
        multiplier: of the state; None where it is not said.
        cpu_seconds: processor time after which it was reached [s]; None where it is not said.
    """

    source: str
    multiplier: float | None
    cpu_seconds: float | None


@dataclass(frozen=True)
class SweepOrder:
    """The bracket of one order in which distinct elements are swept.

    Attributes:
        name: of the order.
        held: the greatest multiplier that was held; None where none was.
        moving: the least at which the wall moved; None where it did not.
    """

    name: str = ""
    held: float | None = None
    moving: float | None = None


@dataclass(frozen=True)
class Release:
    """The collapse that followed the release of a wall just above its multiplier.

    Attributes:
        time_unit: of its times; empty where walls have none.
        frames: (k, n, 3) displacements (x, y) [length] and rotations of the blocks; None where there are none.
    """

    time_unit: str
    frames: FloatArray | None


@dataclass(frozen=True)
class AnswerDetails:
    """Details of an answer that the engine and the report read, by type.

    Attributes:
        data: the details as the method gives them, JSON values by name.
    """

    data: dict[str, Any]

    @property
    def unknowns(self) -> int | None:
        """Of every method: number of unknowns of its largest problem."""
        found = self.data.get("unknowns")
        return None if found is None else int(found)

    @property
    def cap(self) -> float:
        """Of distinct elements: the greatest multiplier tried, where all were held up to it; else zero."""
        return float(self.data.get("cap") or 0.0)

    @property
    def stopped_by_limit(self) -> bool:
        """Of every method: whether the time limit ended it."""
        return bool(self.data.get("stopped_by_limit"))

    @property
    def upper_bound(self) -> float | None:
        """A multiplier above which no collapse state lies, whatever the flow."""
        return _float(self.data.get("upper_bound", self.data.get("associated")))

    @property
    def associated(self) -> float | None:
        """Of searches for the least state: the associated maximum."""
        return _float(self.data.get("associated"))

    @property
    def start_values(self) -> list[float]:
        """Of searches for the least state: the multiplier that each start led to."""
        return [float(value) for value in self.data.get("start_values") or ()]

    @property
    def last_improvement(self) -> LastImprovement | None:
        """Of searches for the least state: the last lower state that was found."""
        listed = self.data.get("improvements")
        last = listed[-1] if isinstance(listed, list) and listed else None
        if not isinstance(last, dict) or not isinstance(last.get("source"), str):
            return None
        return LastImprovement(last["source"], _number(last.get("multiplier")), _number(last.get("cpu_seconds")))

    @property
    def proved_least(self) -> bool:
        """Of searches for the least state: whether none is lower, to rounding."""
        return self.data.get("proved_least") is True

    @property
    def lower_bound(self) -> float | None:
        """Of searches for the least state: a multiplier, finite, below which there is none, to rounding."""
        value = self.data.get("lower_bound")
        found = None if isinstance(value, bool) else _number(value)
        return found if found is not None and math.isfinite(found) else None

    @property
    def certificate(self) -> Any:
        """Of proofs: a document for `drystone verify-bound`."""
        return self.data.get("certificate")

    @property
    def without_strength(self) -> Any:
        """Of walls with strength of their joints: the answer for the same wall without."""
        return self.data.get("without_strength")

    @property
    def has_without_strength(self) -> bool:
        """Whether anything stands in place of that answer."""
        return "without_strength" in self.data

    @property
    def with_strength(self) -> Any:
        """Of walls with brittle joints: the answer as if all of these kept their strength."""
        return self.data.get("with_strength")

    @property
    def has_with_strength(self) -> bool:
        """Whether anything stands in place of that answer."""
        return "with_strength" in self.data

    @property
    def broken(self) -> Any:
        """Of walls with brittle joints: numbers of those that the answer takes as broken; none where it names none."""
        return self.data.get("broken", [])

    @property
    def breaking(self) -> Any:
        """Of collapses with brittle joints: numbers of those that break at the multiplier."""
        return self.data.get("breaking")

    @property
    def has_breaking(self) -> bool:
        """Whether anything stands in place of these numbers."""
        return "breaking" in self.data

    @property
    def live_forces(self) -> Any:
        """Of loads without end: (m, 3) contact forces that balance the live load alone [force]."""
        return self.data.get("live_forces")

    @property
    def dead_forces(self) -> Any:
        """Of walls at their limit: (m, 3) contact forces under the dead load [force]."""
        return self.data.get("dead_forces")

    @property
    def dilatant_mechanism(self) -> Any:
        """Of falls and walls at their limit: (n, 3) velocities of a mechanism with associated flow."""
        return self.data.get("dilatant_mechanism")

    @property
    def moving_forces(self) -> Any:
        """Of measured motions: (m, 3) contact forces that were measured with the mechanism [force]."""
        return self.data.get(MOVING_FORCES)

    @property
    def contact_forces(self) -> dict[str, Any]:
        """Of every method: the contact forces among these, by their name in the details."""
        return {name: self.data[name] for name in ("live_forces", "dead_forces", MOVING_FORCES) if name in self.data}

    @property
    def lowest_moving(self) -> float | None:
        """Of measured motions: the least multiplier at which the wall moved."""
        return _number(self.data.get("lowest_moving"))

    def bar_tensions(self, name: str = BAR_FORCES) -> Any:
        """(k,) tensions of ties and props [force], beside the contact forces or, `DEAD_BAR_FORCES`, the dead ones."""
        return self.data.get(name)

    @property
    def missing_package(self) -> bool:
        """Of refusals: whether a package is not installed that an extra brings."""
        return self.data.get(MISSING_PACKAGE) is True

    def quantity(self, name: str) -> float | str | None:
        """A number or a text of any name, as references of cases ask for; None where it is neither."""
        found = self.data.get(name)
        return found if isinstance(found, int | float | str) else None

    @property
    def peak(self) -> float | None:
        """Of load paths: the greatest multiplier."""
        return _float(self.data.get("peak"))

    @property
    def plateau(self) -> float | None:
        """Of load paths: the multiplier at which displacements grow without end."""
        return _float(self.data.get("plateau"))

    @property
    def plateaus(self) -> list[float]:
        """Of load paths: the plateau of each history of friction."""
        entries = [entry for entry in self.data.get("histories") or () if isinstance(entry, dict)]
        return [entry["plateau"] for entry in entries if isinstance(entry.get("plateau"), float)]

    @property
    def orders(self) -> list[SweepOrder] | None:
        """Of distinct elements: the bracket of each sweep order; None where they are not said."""
        found = self.data.get("orders")
        return [_order(item) for item in found] if isinstance(found, list) else None

    @property
    def reported_order(self) -> SweepOrder:
        """Of distinct elements: the sweep order that the answer reports; without ends where it names none."""
        name = self.data.get("reporting_order")
        return next((order for order in self.orders or () if order.name == (name or "")), SweepOrder())

    @property
    def release(self) -> Release | None:
        """Of distinct elements: the collapse that followed."""
        found = self.data.get("release")
        if not isinstance(found, dict):
            return None
        frames = found.get("frames")
        listed = np.array(frames, dtype=float) if isinstance(frames, list) else None
        return Release(found.get("time_unit", ""), listed)


def _float(value: Any) -> float | None:
    return value if isinstance(value, float) else None


def _number(value: Any) -> float | None:
    return float(value) if isinstance(value, int | float) else None


def _order(data: Any) -> SweepOrder:
    if not isinstance(data, dict):
        return SweepOrder()
    return SweepOrder(str(data.get("order", "")), _number(data.get("held")), _number(data.get("moving")))
