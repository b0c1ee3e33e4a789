"""Where a multiplier lies as its method vouches for it, and how far several lie from each other."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from harness.model.result import Result

Range = tuple[float, float]


def range_of(result: Result) -> Range | None:
    """Lowest and highest value: a measured multiplier lies in its bracket, another is its value; None without one."""
    if result.multiplier is None:
        return None
    if result.flow == "approximate" and result.bracket is not None:
        return result.bracket
    return result.multiplier, result.multiplier


def differences(ranges: Sequence[Range]) -> Range:
    """Least and greatest possible (highest - lowest) / lowest of values in ranges; infinite where the lowest is 0.

    Args:
        ranges: two or more.
    """
    least = _over(max(low for low, _ in ranges), min(high for _, high in ranges))
    pairs = ((low, high) for k, (low, _) in enumerate(ranges) for j, (_, high) in enumerate(ranges) if k != j)
    return least, max(_over(high, low) for low, high in pairs)


def _over(high: float, low: float) -> float:
    if high <= low:
        return 0.0
    return high / low - 1.0 if low > 0.0 else math.inf


def percent_text(least: float, most: float, decimals: int = 1) -> str:
    """A difference that lies between two, in percent: "1.3 %", "19.0 to 36.0 %" or "at least 1.3 %"."""
    if math.isinf(least):
        return "all of the value"
    if math.isinf(most):
        return f"at least {100.0 * least:.{decimals}f} %"
    ends = [f"{100.0 * end:.{decimals}f}" for end in (least, most)]
    return f"{' to '.join(dict.fromkeys(ends))} %"
