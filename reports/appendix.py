"""The appendix to a structural report: one wall on two to four sheets, for an engineer to sign."""

from __future__ import annotations

import hashlib
import io
import json
from dataclasses import dataclass
from importlib.resources import files
from pathlib import Path
from typing import TYPE_CHECKING

from markupsafe import Markup

from harness.model.assembly import FloatArray
from harness.model.bar_forces import bar_forces_of
from harness.model.case import Case
from harness.model.comparison import CaseResults, ComparisonRun
from harness.model.live_load import direction_in_words
from harness.model.load_cases import title_of_wall
from harness.model.method import Status
from harness.model.result import Result
from harness.model.writing import write_whole
from reports.environment import environment
from reports.figures.figures import results_figure, style, wall_figure
from reports.findings.strength import strength_text
from reports.geometry import shapes
from reports.labels import labels, numbers
from reports.labels.wall_summary import value_in_words, wall_summary
from reports.page.governing import governing
from reports.page.summary import wall_findings, which_number

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_BLOCK_ROWS = 36
"""Largest number of blocks with a row each; of more only sums are given: the appendix stays within four sheets."""

_JOINT_ROWS = 8
"""Number of most critical joints with a row each."""

_DRAWN_BLOCKS = 2000
"""Largest number of blocks whose drawings stand in the page; a drawing takes some 5 kB a block."""


def assumptions(case: Case) -> tuple[str, ...]:
    """What the analysis of a wall assumes, a sentence each; joints are dry unless the wall gives their strength."""
    dry = "Joints are dry: they bear no tension, and shear up to friction times compression (Coulomb), at each contact."
    strength = strength_text(case.assembly, case.wall.units.force)
    joints = f"The strength of joints beside friction is plastic, it remains however far a joint moves: {strength}."
    if case.assembly.strong:
        joints += " Cohesion and tension of mortar are brittle: rely on the value without them."
    crush = "joints crush by a rectangular stress block" if case.assembly.crushes else "joints do not crush"
    return (
        f"The wall is plane; blocks are rigid, and {crush}.",
        joints if strength else dry,
        "Sliding is without dilatancy, except in the associated maximum: an upper bound and no design value.",
        "Displacements before collapse are small: equilibrium is that of the wall as drawn.",
        "Dead loads act first and stay; the live load grows by one multiplier, slowly.",
    )


@dataclass(frozen=True)
class _MethodRow:
    """One method's answer."""

    method: str
    value: str
    number_is: str
    judged: str
    residual: str
    cpu: str


@dataclass(frozen=True)
class _SheetBlock:
    """What is given of one free block."""

    name: str
    x: str
    y: str
    weight: str
    dead: str
    live: str


def write_appendix(run: ComparisonRun, path: Path) -> None:
    """Write the appendix of one wall as one HTML file, ready to print on A4."""
    write_whole(path, render(run))


def render(run: ComparisonRun) -> str:
    """The appendix as text.

    Args:
        run: a comparison of one wall; or of its load cases; or of two, the second with the opposite live load. The one
            that collapses at the lowest multiplier governs, and is the one whose state is shown.
    """
    found = governing(run.cases, _JOINT_ROWS)
    item, case, shown = found.item, found.item.case, found.shown
    document = json.dumps(case.wall.document(), sort_keys=True, ensure_ascii=False)
    return (
        environment()
        .get_template("appendix.html.j2")
        .render(
            run=run,
            case=case,
            title=title_of_wall(case),
            origin=Path(case.origin).name,
            digest=hashlib.sha256(document.encode()).hexdigest()[:16],
            finding=wall_findings(item),
            advice=which_number(item, found.unanswered),
            found=found,
            direction=direction_in_words(item.case),
            facts=wall_summary(case),
            assumptions=assumptions(case),
            loads=_loads(item),
            blocks=_blocks(item),
            methods=[_method_row(result) for result in labels.in_order(item)],
            gates=[gate for gate in item.gates if gate.passed is not None],
            wall=_svg(wall_figure(case.built)) if _drawn(item) else Markup(""),
            every=shapes.drawn_every(len(shapes.load_arrows(case.assembly, case.assembly.live))),
            answer=[_svg(results_figure(case, [shown], kind)) for kind in ("mechanism", "forces")]
            if shown and _drawn(item)
            else [],
            shown=shown,
            value=value_in_words(shown) if shown else "",
            bars=bar_forces_of(case, shown) if shown else [],
            warnings=(*case.warnings, *item.refusals),
            units=case.wall.units,
            style=Markup(files("reports").joinpath("static/appendix.css").read_text(encoding="utf-8")),
            numbers=numbers,
        )
    )


def _drawn(item: CaseResults) -> bool:
    return item.case.assembly.n_blocks <= _DRAWN_BLOCKS


def _loads(item: CaseResults) -> list[tuple[str, str, str]]:
    """Sums of the loads on free blocks: what, along x, along y."""
    assembly = item.case.assembly
    return [
        (name, numbers.plain(float(total[0]), 4), numbers.plain(float(total[1]), 4))
        for name, load in (("Dead load, with the weights", assembly.dead), ("Live load at multiplier 1", assembly.live))
        for total in [load[assembly.free, :2].sum(axis=0)]
    ]


def _blocks(item: CaseResults) -> list[_SheetBlock]:
    assembly = item.case.assembly
    if assembly.n_free > _BLOCK_ROWS:
        return []
    return [
        _SheetBlock(
            assembly.block_ids[k],
            numbers.plain(float(assembly.centroid[k, 0]), 4),
            numbers.plain(float(assembly.centroid[k, 1]), 4),
            numbers.plain(float(assembly.weight[k]), 4),
            _pair(assembly.dead[k]),
            _pair(assembly.live[k]),
        )
        for k in assembly.free
    ]


def _pair(load: FloatArray) -> str:
    return f"{numbers.plain(float(load[0]), 4)}, {numbers.plain(float(load[1]), 4)}"


def _method_row(result: Result) -> _MethodRow:
    worst = result.judge.worst
    answered = result.status is Status.OK
    return _MethodRow(
        method=result.method,
        value=value_in_words(result) if answered else f"{labels.STATUS[result.status][1]}: {result.sentence}",
        number_is=result.traits.caption,
        judged={None: "not judged", True: "accepted", False: "rejected"}[result.judge.accepted],
        residual=numbers.NOTHING if worst is None else numbers.residual(worst[1]),
        cpu=numbers.seconds(result.cpu_seconds),
    )


def _svg(figure: Figure) -> Markup:
    """A figure of ours: its letters are drawn as outlines, so that no text of a file becomes markup."""
    with style():
        drawn = io.StringIO()
        figure.savefig(drawn, format="svg", metadata={"Date": None, "Creator": "Drystone"})
    text = drawn.getvalue()
    return Markup(text[text.index("<svg") :])
