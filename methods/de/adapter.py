"""The distinct-element methods, as the engine finds them."""

from __future__ import annotations

from typing import ClassVar

from harness.model.assembly import Assembly, IntArray
from harness.model.method import Answer, Finding, Settings, Status
from methods.de.answer import solve_by_holds
from methods.de.courses import Tuning
from methods.de.settings import HoldSettings
from methods.de.space import StripSpace


class DampedHolds:
    """Damped holds of a wall of contact strips in pymunk, bracketed over body orders."""

    name: ClassVar[str] = "de"
    family: ClassVar[str] = "de"
    title: ClassVar[str] = "distinct elements (pymunk, damped holds)"
    tolerance: ClassVar[float] = 1e-6
    Settings: ClassVar[type[Settings]] = HoldSettings

    def solve(self, assembly: Assembly, settings: HoldSettings) -> Answer:
        """Bracket of the collapse multiplier over body orders; see `methods.de.answer`."""

        def engine(blocks: IntArray, joints: IntArray, tuning: Tuning) -> StripSpace:
            return StripSpace(assembly, blocks, joints, settings.iterations, tuning)

        try:
            return solve_by_holds(assembly, settings, engine)
        except ValueError as error:
            return Answer(Status.REFUSED, Finding.NONE, str(error))
