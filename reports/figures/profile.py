"""A figure of methods on a set of walls: performance profiles, and height above the least known state over CPU time."""

from __future__ import annotations

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from harness.model.errors import InputError
from harness.model.method_registry import load_method
from reports.figures.figures import PAGE, style

_ROUNDING = 1e-12
"""What lies less above the least known state is drawn here."""


def profile_figure(profiles: dict[str, tuple[list[float], list[float]]], table: pd.DataFrame) -> Figure:
    """Two panels for a page of a journal.

    Args:
        profiles: per method, ratios of CPU time to the quickest correct method and the share of walls within each.
        table: a row a wall and method with `method`, `correct`, `cpu_seconds`, `above_least`.
    """
    with style():
        page = Figure(figsize=(PAGE, 0.45 * PAGE), layout="constrained")
        left, right = page.subplots(1, 2)
        most = 2.0 * max((ratios[-1] for ratios, _ in profiles.values() if ratios), default=1.0)
        for method, (ratios, shares) in profiles.items():
            look = _look(method)
            (line,) = left.step(
                [1.0, *ratios, most], [0.0, *shares, shares[-1] if shares else 0.0], where="post", **look
            )
            own = table[(table["method"] == method) & table["correct"] & table["above_least"].notna()]
            height = np.maximum(own["above_least"].to_numpy(dtype=float), _ROUNDING)
            right.plot(own["cpu_seconds"], height, linestyle="", marker=".", color=line.get_color(), label=method)
        left.set_xscale("log")
        left.set_ylim(0.0, 1.02)
        left.set_xlabel("CPU time over that of the quickest correct method")
        left.set_ylabel("share of all walls answered correctly within it")
        left.legend()
        right.set_xscale("log")
        right.set_yscale("log")
        right.set_xlabel("CPU time [s]")
        right.set_ylabel("multiplier above the least known state, relative")
        for axis in (left.xaxis, right.xaxis, right.yaxis):
            axis.set_major_formatter("{x:g}")
        for ax in (left, right):
            ax.grid(linewidth=0.3)
    return page


def _look(method: str) -> dict[str, str]:
    """The colour and line that a method names; those of matplotlib for one that names none or is not installed here."""
    try:
        traits = load_method(method).traits
    except (InputError, KeyError):
        return {"label": method}
    look = {"label": method, "linestyle": traits.line}
    return look | {"color": traits.colour} if traits.colour else look
