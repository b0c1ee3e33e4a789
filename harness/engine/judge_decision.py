"""How the judge decides: residuals within tolerances, numbers that can be counted with, tensions that can be read."""

from __future__ import annotations

from typing import Any

import numpy as np

from harness.engine.bar_checks import tensions_beyond
from harness.model.assembly import Assembly, FloatArray
from harness.model.details import BAR_FORCES
from harness.model.followed import COUNTABLE
from harness.model.result import Judgement, Result

UNCOUNTABLE = f"Its numbers are not finite, or larger than {COUNTABLE:g}."
NO_FORCES = "It gives no contact forces, so it cannot be checked."


def countable(values: Any) -> bool:
    """Whether all numbers are finite and no larger than `COUNTABLE`."""
    return bool((abs(np.asarray(values, dtype=float)) <= COUNTABLE).all())


def said_of(tolerance: float, accepted: bool | None, sentence: str) -> Judgement:
    """A judgement without residuals."""
    return Judgement(tolerance=tolerance, accepted=accepted, sentence=sentence)


def beyond_prestress(assembly: Assembly, result: Result) -> FloatArray | None:
    """The tensions (k,) of bars beyond their prestress, None without bars; `judge` has refused what cannot be read."""
    found = tensions_beyond(assembly, result.details, BAR_FORCES)
    return None if isinstance(found, str) else found


def apart(multiplier: float, other: float) -> float:
    """The difference of two multipliers, relative to the larger of them."""
    return abs(multiplier - other) / (max(abs(multiplier), abs(other)) or 1.0)


def decide(
    residuals: dict[str, float],
    tolerance: float,
    what: str,
    stricter: dict[str, float] | None = None,
    wider: dict[str, float] | None = None,
) -> Judgement:
    """Accepted where every residual is within the tolerance, or within its own where that is stricter or wider.

    What was recomputed ends with its verb, "was" or "were".
    """
    within = {name: min(tolerance, (stricter or {}).get(name, tolerance)) for name in residuals}
    within |= {name: max(tolerance, value) for name, value in (wider or {}).items() if name in residuals}
    failed = [
        f"{name} {value:.3g}" + (f" (at most {within[name]:.3g})" if within[name] != tolerance else "")
        for name, value in residuals.items()
        if name != "live_work" and not value <= within[name]
    ]
    if "live_work" in residuals and not residuals["live_work"] > 0.0:
        failed.append("the live load does no work on the mechanism")
    holds = "holds" if what.endswith("was") else "hold"
    sentence = f"{what} recomputed from the equilibrium of the blocks"
    sentence += (
        f"; not within {tolerance:.3g}: {', '.join(failed)}." if failed else f" and {holds} within {tolerance:.3g}."
    )
    signless = {name: value + 0.0 for name, value in residuals.items()}  # the maximum of 0 and -0 may be -0
    return Judgement(residuals=signless, tolerance=tolerance, accepted=not failed, sentence=sentence)
