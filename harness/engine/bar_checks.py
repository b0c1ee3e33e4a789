"""What the judge asks of ties and props: tensions in their range, and an elongation only where they are at its ends.

The prestress of a bar is part of the dead load; these are tensions beyond it. They are read from the details of an
answer (`harness.model.details.BAR_FORCES`), total tensions in the order of the wall's ties and then props.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from harness.model.assembly import Assembly, FloatArray
from harness.model.details import BAR_FORCES, AnswerDetails


def tensions_beyond(assembly: Assembly, details: dict[str, Any], name: str = BAR_FORCES) -> FloatArray | str | None:
    """(k,) tensions beyond the prestress that an answer gives under a name; None without bars; or what is wrong."""
    bars = assembly.bars
    if not len(bars):
        return None
    listed = AnswerDetails(details).bar_tensions(name)
    if listed is None:
        return f"It gives no tensions of the ties and props (`{name}`), so it cannot be checked."
    try:
        tension = np.asarray(listed, dtype=float)
    except (TypeError, ValueError):
        tension = np.full(0, np.nan)
    if tension.shape != (len(bars),) or not np.isfinite(tension).all():
        return f"`{name}` are not {len(bars)} finite tensions."
    return tension - bars.prestress


def dissipated_by_bars(assembly: Assembly, mechanism: FloatArray) -> float:
    """Power that bars take beyond what their prestress gives [force x velocity]: at yield, or where they go slack."""
    rate = _elongations(assembly, mechanism)
    return float(np.maximum(assembly.bars.greatest * rate, assembly.bars.least * rate).sum())


def _elongations(assembly: Assembly, mechanism: FloatArray) -> FloatArray:
    """(k,) elongation rates, zero where they are rounding of the speeds of the two ends, whatever the yield force."""
    bars, speeds = assembly.bars, np.zeros(len(assembly.bars))
    for block, point in ((bars.block_a, bars.end1), (bars.block_b, bars.end2)):
        arm = abs(point) + abs(assembly.centroid[block])
        speeds += abs(mechanism[block, :2]).sum(axis=1) + abs(mechanism[block, 2]) * arm.sum(axis=1)
    rate = bars.elongations(mechanism, assembly.centroid)
    return np.where(abs(rate) <= np.finfo(float).eps * speeds, 0.0, rate)


def bars_at_work(
    assembly: Assembly, beyond: FloatArray, scale: FloatArray, mechanism: FloatArray
) -> tuple[float, float]:
    """Flow residual of the bars of a component, as for sliding, and the work of their slacks: as of a plastic bar.

    A bar lengthens at its greatest tension alone and shortens at its least alone.
    """
    rate = _elongations(assembly, mechanism)
    slack = np.where(rate > 0.0, assembly.bars.greatest - beyond, beyond - assembly.bars.least)
    at_fault = np.minimum(abs(slack) / scale, abs(rate)).max(initial=0.0)
    return float(at_fault), float(abs(slack * rate).sum())
