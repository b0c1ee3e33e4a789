"""How far the multiplier depends on unknown data: stiffness ratio, gap points and initial shear.

Run as `python -m benchmarks sensitivity FOLDER`. Writes `fe_sensitivity.csv` and `fe_sensitivity.svg` there, for the
55-brick wall at friction 0.65. Deterministic: the initial shears come from seeds 0 to 4.
"""

from __future__ import annotations

import csv
import sys
from collections.abc import Sequence
from pathlib import Path

from benchmarks.walls import running_bond
from harness.model.assembly import Assembly
from methods.fe.gap_springs import GapSprings
from methods.fe.settings import GapSpringsSettings

RATIOS = (0.01, 0.03, 0.1, 0.3, 0.5, 1.0, 3.0, 10.0)


def study(wall: Assembly) -> list[dict[str, str | float]]:
    """One row for every variation of one datum: what was varied, its value, plateau, peak and spread."""
    variations: list[tuple[str, str, GapSpringsSettings]] = [
        ("kt/kn", f"{ratio:g}", GapSpringsSettings(stiffness_ratio=ratio, histories=(0.0,))) for ratio in RATIOS
    ]
    variations += [
        ("points", f"{rule} {count}", GapSpringsSettings(rule=rule, points=count, histories=(0.0,)))
        for rule, count in (("uniform", 2), ("uniform", 3), ("lobatto", 3), ("lobatto", 4), ("uniform", 5))
    ]
    variations += [
        ("weighting", weighting, GapSpringsSettings(weighting=weighting, histories=(0.0,)))
        for weighting in ("point", "length")
    ]
    variations += [
        ("initial shear", f"seed {seed}", GapSpringsSettings(initial_shear=0.5, seed=seed, histories=(0.0,)))
        for seed in range(5)
    ]
    variations.append(("history", "1 %", GapSpringsSettings(histories=(0.01,))))
    variations.append(("history", "0.2 %", GapSpringsSettings(histories=(0.002,))))
    rows: list[dict[str, str | float]] = []
    for datum, value, settings in variations:
        answer = GapSprings().solve(wall, settings)
        plateau = float("nan") if answer.multiplier is None else answer.multiplier
        peak = float(answer.details.get("peak", float("nan")))
        rows.append({"datum": datum, "value": value, "plateau": plateau, "peak": peak})
    return rows


def main(arguments: Sequence[str] | None = None) -> int:
    """Write the table and the plot into the folder given."""
    given = sys.argv[1:] if arguments is None else list(arguments)
    if len(given) != 1:
        print("usage: python -m benchmarks sensitivity FOLDER", file=sys.stderr)
        return 2
    folder = Path(given[0])
    folder.mkdir(parents=True, exist_ok=True)
    rows = study(running_bond(10, 5, 0.65))
    with (folder / "fe_sensitivity.csv").open("w", newline="", encoding="utf-8") as stream:
        writer = csv.DictWriter(stream, list(rows[0]))
        writer.writeheader()
        writer.writerows(rows)
    _plot(rows, folder / "fe_sensitivity.svg")
    return 0


def _plot(rows: list[dict[str, str | float]], path: Path) -> None:
    """Plateaus and peaks of all variations, one line each."""
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    figure, axes = pyplot.subplots(figsize=(6.4, 0.24 * len(rows) + 1.0), layout="constrained")
    places = range(len(rows))
    axes.plot([float(r["plateau"]) for r in rows], places, "o", label="plateau")
    axes.plot([float(r["peak"]) for r in rows], places, "|", label="peak")
    axes.set_yticks(list(places), [f"{r['datum']} {r['value']}" for r in rows])
    axes.invert_yaxis()
    axes.set_xlabel("multiplier of the live load (-), 55 bricks, friction 0.65")
    axes.legend()
    figure.savefig(path, metadata={"Date": None})
    pyplot.close(figure)


if __name__ == "__main__":
    sys.exit(main())
