"""What people see in a terminal: progress, tables and sentences; and the JSON of a comparison."""

from __future__ import annotations

import shutil
import sys
import textwrap
from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import Any

from drystone.cli.options import console_of
from harness.engine.pipeline import Progress
from harness.engine.run import Run
from harness.engine.verdict import violations
from harness.model.bar_forces import BARS, bar_forces_of
from harness.model.case import Case
from harness.model.columns import PRINTED, ResultColumn, ResultRow
from harness.model.comparison import CaseResults, ComparisonRun
from harness.model.difference import Difference, Kind
from harness.model.envelope import Envelope, by_wall, envelopes, ranked_text
from harness.model.errors import first_few, visible
from harness.model.joint_margins import JOINTS, joint_rows
from harness.model.live_load import direction_in_words
from harness.model.method import Finding, Status
from harness.model.proof import LABELS, Proof, Standing, least_known, proof_of
from harness.model.result import Judgement, Result, Verdict, plastic_and_residual_of, plastic_of, residual_of
from harness.model.result_texts import PROVED, VERDICT_TEXTS, answer_text, strength_in_words
from harness.model.support_reactions import REACTIONS, reactions_of
from harness.model.table import in_units, values
from reports.labels.numbers import count, met

_MOST_WALLS = 3
"""Walls of which one sentence is said that are named one by one."""
JUDGED = {True: 0, False: 1, None: 3}
"""Exit codes for an answer that is accepted, rejected, or shows nothing that proves or refutes its claim."""


def _escape(text: str) -> str:
    """Text of any origin for a table or a line: control characters made visible, brackets no markup."""
    from rich.markup import escape as literal

    return literal(visible(text))


@contextmanager
def progress_bar(total: int, *, quiet: bool = False) -> Iterator[Progress]:
    """Something to call after each run: a bar on a terminal, plain lines on standard error otherwise."""
    from rich.console import Console

    console = Console(stderr=True)
    if quiet or not console.is_terminal:

        def tell(run: Run, result: Result, stored: bool) -> None:
            if not quiet:
                how = "stored" if stored else f"{result.cpu_seconds or 0.0:.2f} s"
                line = f"{run.case.id} {run.method}: {answer_text(result)} ({how})"
                print(visible(line), file=sys.stderr, flush=True)

        yield tell
        return
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeElapsedColumn

    columns = TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn(), TimeElapsedColumn()
    with Progress(*columns, console=console, transient=True) as bar:
        task = bar.add_task("running", total=total)

        def advance(run: Run, result: Result, stored: bool) -> None:
            bar.update(task, advance=1, description=_escape(f"{run.case.id} {run.method}"))

        yield advance


def print_comparison(compared: ComparisonRun, report: Path | None, columns: Sequence[ResultColumn] = PRINTED) -> None:
    """The table of a comparison, what does not hold, and where the report is."""
    from rich.table import Table

    console = console_of(140)
    table = Table(title=f"Drystone: {_escape(compared.title)}", title_justify="left", caption_justify="left")
    for column in columns:
        whole = column.name in ("multiplier", "method")
        table.add_column(_escape(column.head), justify="right" if column.numeric else "left", no_wrap=whole)
    for case in compared.cases:
        for number, result in enumerate(case.results):
            row = ResultRow(result, proof_of(case, result), case.case.load_in_words)
            table.add_row(
                *["" if number and column.name == "case" else _escape(column.text(row)) for column in columns],
                end_section=number == len(case.results) - 1,
            )
    console.print(table)
    refusals = _by_sentence((f": {sentence}", case) for case in compared.cases for sentence in case.refusals)
    units = _walls_of((case.case.wall.units_sentence, case) for case in compared.cases)
    told = [f"Units: {sentence}" + (f" ({names})" if len(units) > 1 else "") for sentence, names in units.items()]
    unanswered = _by_sentence(
        (f", {result.method}: {result.sentence}", case)
        for case in compared.cases
        for result in case.results
        if result.status is not Status.OK
    )
    split = _by_sentence((f": {case.split_on_dead_load}.", case) for case in compared.cases if case.split_on_dead_load)
    strength = [sentence for case in compared.cases for sentence in _strength(case)]
    for sentence in (*_proofs(compared), *refusals, *told, *unanswered, *split, *strength):
        console.print(_escape(sentence), highlight=False)
    _print_envelopes(envelopes(compared.cases))
    broken = violations(compared)
    gated = sum(item.gate for case in compared.cases for result in case.results for item in result.comparisons)
    gates = sum(gate.passed is not None for case in compared.cases for gate in case.gates)
    if broken:
        known = [(gated, "checked reference", ""), (gates, "statement", " of theory")]
        held = ", ".join(f"{count(number, noun)}{of}" for number, noun, of in known if number)
        console.print(f"Not met, of {held}{' and ' if held else ''}the answers: {len(broken)}")
        for sentence in broken:
            console.print(f"  ✗ {_escape(sentence)}", highlight=False)
    else:
        console.print(_all_well(gated, gates))
    if report is not None:
        print(visible(f"Report: {report}"))


def _walls_of(said: Iterable[tuple[str, CaseResults]]) -> dict[str, str]:
    """What is said of walls, each sentence once with the names of the first few walls that it is of."""
    walls: dict[str, list[str]] = {}
    for sentence, case in said:
        walls.setdefault(sentence, []).append(case.case.id)
    return {sentence: first_few(names, _MOST_WALLS) for sentence, names in walls.items()}


def _by_sentence(said: Iterable[tuple[str, CaseResults]]) -> list[str]:
    """Sentences that begin with the walls that they are of: a refusal is the same in every load case of a wall."""
    return [f"{names}{sentence}" for sentence, names in _walls_of(said).items()]


def _print_envelopes(found: Sequence[Envelope]) -> None:
    """A table for every wall of several load cases, a row a load case, with a sentence a method on which governs."""
    for wall, mine in by_wall(found).items():
        print(visible(f"Load cases of {wall}:"))
        print_rows(
            [
                {"load case": name}
                | ({"load at": mine[0].places[k]} if any(mine[0].places) else {})
                | {each.method: ranked_text(each.results[k]) for each in mine}
                for k, name in enumerate(mine[0].names)
            ]
        )
        for each in mine:
            print(visible(each.verdict))


def _strength(case: CaseResults) -> Iterator[str]:
    """Plastic and residual values of a wall whose joints have cohesion or tension, and which of them is safe."""
    found = []
    for result in case.results:
        pair = plastic_and_residual_of(result)
        if pair is not None and result.status is Status.OK:
            plastic, residual = map(answer_text, pair)
            found.append(f"{result.method} {plastic} plastic, {residual} residual")
    if found:
        yield (
            f"{case.case.id}, strength of joints: {'; '.join(found)}. Joints of mortar are brittle: rely on the "
            "residual value of a method that is not an upper bound."
        )


def _is_minimum(case: CaseResults, result: Result) -> bool:
    return proof_of(case, result).standing is Standing.MINIMUM


def _proofs(compared: ComparisonRun) -> Iterator[str]:
    """What is proved of the least state of one wall; of several walls, what the mark of a proved minimum means."""
    if len(compared.cases) == 1:
        (case,) = compared.cases
        least = least_known(case)
        if least is not None:
            yield f"{least.method}: {replace(proof_of(case, least), refused='').sentence}"
    elif any(_is_minimum(case, result) for case in compared.cases for result in case.results):
        yield f"{PROVED} {LABELS[Standing.MINIMUM]}: an exact certificate proves that no collapse state lies lower."


def _all_well(gated: int, gates: int) -> str:
    """What was compared with what, where all agrees; a wall of one's own has no references."""
    known = met(gated, gated, "checked reference") if gated else "There are no reference values"
    theory = met(gates, gates, "tested statement", " of theory") if gates else "no statement of theory could be tested"
    return f"{known}; {theory}; the judge rejects no answer."


def comparison_json(compared: ComparisonRun, report: Path | None) -> dict[str, Any]:
    """A comparison as JSON values."""
    broken = violations(compared)
    return {
        "title": compared.title,
        "created": compared.created,
        "command": compared.command,
        "report": None if report is None else str(report),
        "passed": not broken,
        "violations": broken,
        "envelopes": [each.as_json() for each in envelopes(compared.cases)],
        "cases": [
            {
                "id": case.case.id,
                "results": [result_json(case.case, result, proof_of(case, result)) for result in case.results],
                "gates": [gate.model_dump(mode="json") for gate in case.gates],
            }
            for case in compared.cases
        ],
        "provenance": compared.provenance,
    }


def result_json(
    case: Case, result: Result, proof: Proof, *, fields: bool = False, joints: bool = False
) -> dict[str, Any]:
    """A result as JSON values, with what is proved of it and the reactions of the supports.

    Args:
        case: the wall.
        result: of it.
        proof: what is proved of the result.
        fields: whether forces, mechanism, states and path are given too.
        joints: whether the margins of the joints are given too.
    """
    listed = result.model_dump(mode="json") if fields else result.summary()
    listed |= {"proof": proof.as_json()}
    if len(case.assembly.bars):
        listed["bars"] = [values(BARS, bar) for bar in bar_forces_of(case, result)]
    listed["reactions"] = [values(REACTIONS, reaction) for reaction in reactions_of(case, result)]
    if joints:
        listed["joints"] = [values(JOINTS, row) for row in joint_rows(case, result)]
    return listed


def print_joints(case: Case, result: Result) -> None:
    """The margins of the joints of a result as a table, the most critical first."""
    columns = in_units(JOINTS, case.wall.units.force, case.wall.units.length)
    print_rows([{column.head: column.text(row) for column in columns} for row in joint_rows(case, result)])


def _bar_lines(case: Case, result: Result, most: int = 8) -> Iterator[tuple[str, str]]:
    """One line a tie or prop, up to so many, for a person."""
    unit = case.wall.units.force
    listed = bar_forces_of(case, result)
    for bar in listed[:most]:
        way = "tension" if bar.tension >= 0.0 else "compression"
        size = f"{abs(bar.tension):.6g}" + ("" if unit == "1" else f" {unit}")
        yield bar.kind, f"{bar.bar}, from {bar.start} to {bar.end}: {way} {size}, {bar.state}"
    if len(listed) > most:
        yield "", f"and {len(listed) - most} more ties and props; --json has all"


def _of_state(result: Result) -> str:
    """Of which multiplier the forces of a result are and, where it stands beside another answer, with which joints."""
    joints = strength_in_words(result)
    return f"The forces below are those at the multiplier {result.forces_multiplier or 0.0:.7g}{joints}."


def _reaction_lines(case: Case, result: Result, most: int = 8) -> Iterator[tuple[str, str]]:
    """One line a support, up to so many, for a person."""
    force, length = case.wall.units.force, case.wall.units.length
    listed = reactions_of(case, result)
    for reaction in listed[:most]:
        text = {column.name: column.text(reaction) for column in REACTIONS}
        unit = {
            column.name: "" if column.unit == "1" else f" {column.unit}"
            for column in in_units(REACTIONS, force, length)
        }
        parts = [
            f"Fx {text['fx']}{unit['fx']}",
            f"Fy {text['fy']}{unit['fy']}",
            f"moment {text['moment']}{unit['moment']}",
        ]
        line = "" if reaction.x is None else f", through ({text['x']}, {text['y']}){unit['x']}"
        yield "reaction", f"{reaction.support}: {', '.join(parts)} about its centroid{line}"
    if len(listed) > most:
        yield "", f"and {len(listed) - most} more supports; --json has all"


def print_result(result: Result, case: Case, proof: Proof) -> None:
    """One result, for a person."""
    rows = [
        ("wall", f"{case.file.title} (free blocks: {result.blocks}, interfaces: {result.interfaces})"),
        ("units", case.wall.units_sentence),
        ("live load", ", ".join(filter(None, (direction_in_words(case), case.load_place))) or "none"),
        ("method", result.method),
        ("finding", answer_text(result) if result.finding is Finding.COLLAPSES else str(result.finding)),
        ("", result.sentence),
    ]
    if (residual := residual_of(result)) is not None:
        rows.append(("residual", f"{answer_text(residual)}, without cohesion and tensile strength"))
    if (plastic := plastic_of(result)) is not None:
        rows.append(("plastic", f"{answer_text(plastic)}, if all joints kept their strength"))
    if result.bracket is not None:
        rows.append(("bracket", f"[{result.bracket[0]:.7g}, {result.bracket[1]:.7g}] {result.bracket_meaning}"))
    if proof.sentence:
        rows.append(("proof", proof.sentence))
    if borne := [*_bar_lines(case, result), *_reaction_lines(case, result)]:
        rows += [("state", _of_state(result)), *borne]
    rows += [("status", str(result.status)), ("judge", result.judge.sentence)]
    rows += [("", f"{name} {value}") for name, value in result.judge.listed()]
    for comparison in result.comparisons:
        rows.append(
            ("reference", f"{VERDICT_TEXTS[comparison.verdict]}: {comparison.reference}: {comparison.sentence}")
        )
    if result.cpu_seconds is not None:
        memory = (result.peak_memory_bytes or 0) / 2**20
        rows.append(("cost", f"{result.cpu_seconds:.3f} s of CPU, {memory:.0f} MiB"))
    _print_named(rows)


def _print_named(rows: list[tuple[str, str]]) -> None:
    """Names and sentences side by side, as wide as the terminal; what a table of rich needs is half a small run."""
    indent = max(len(name) for name, _ in rows) + 2
    width = max(shutil.get_terminal_size().columns - indent, 20)
    for name, sentence in rows:
        lines = textwrap.wrap(visible(sentence), width, break_on_hyphens=False) or [""]
        print(f"\n{' ' * indent}".join([name.ljust(indent) + lines[0], *lines[1:]]).rstrip())


def print_judgement(judgement: Judgement) -> None:
    """What the judge says, for a person."""
    print(visible(judgement.sentence))
    for name, value in judgement.listed(3):
        print(f"  {name:16s} {value}")
    print(judgement.outcome.replace("_", " "))


def print_check(lines: list[dict[str, Any]], unchecked: int) -> None:
    """One line a reference, and a count, also of the references that are not checked."""
    for line in lines:
        mark = VERDICT_TEXTS[Verdict(line["verdict"])]
        where = line["method"] + (f" {line['settings']}" if line["settings"] else "")
        line_text = f"{mark}  {line['case']}  {line['quantity']}  {where}: {line['sentence']}  [{line['source']}]"
        print(visible(line_text))
    verdicts = Counter(line["verdict"] for line in lines)
    untested = verdicts["not_tested"]
    left = f"; {untested} not tested, because a package is missing" if untested else ""
    print(f"{met(verdicts['agrees'], len(lines) - untested, 'checked reference')}{left}.")
    if unchecked:
        where = "`drystone compare` compares with them"
        print(f"References without gate = true, which are not checked: {unchecked:,}. {where}.")


def print_changes(rows: list[dict[str, Any]]) -> None:
    """What changed against the baseline, and a count of what did not."""
    for row in rows:
        if row["change"] != "same":
            print(visible(f"{row['change']:6s} {row['case']}  {row['method']}: {row['figures']}"))
    counts = Counter(row["change"] for row in rows)
    print(", ".join(f"{counts[kind]} {kind}" for kind in ("same", "better", "worse", "new") if counts[kind]))


def print_difference(found: Difference) -> None:
    """What changed between two sets of answers, times by method, and a count."""
    for row in found.rows:
        if row.kind is not Kind.SAME:
            times = "" if row.ratio is None else f"  [{row.old_seconds:.3g} s -> {row.new_seconds:.3g} s of CPU]"
            print(visible(f"{row.kind:6s} {row.case}  {row.method}: {row.figures}{times}"))
    for pair in found.pairs:
        slower = f"{pair.slower} of {pair.number} pairs slower"
        print(visible(f"time   {pair.method}: {pair.ratio:.2f} times as long in the median, {slower}"))
    for sentence in found.remarks:
        print(visible(sentence))
    counts = ", ".join(f"{number} {kind}" for kind, number in found.counts.items() if number) or "nothing compared"
    left = f"; {found.not_run} answers of the baseline were not requested" if found.not_run else ""
    print(f"{counts}{left}.")


def print_rows(rows: list[dict[str, Any]]) -> None:
    """Rows with equal names as a table."""
    from rich.table import Table

    console = console_of(160)
    table = Table(box=None, pad_edge=False)
    if rows:
        for name in rows[0]:
            table.add_column(_escape(name))
    for row in rows:
        table.add_row(*[_escape(_cell(value)) for value in row.values()])
    console.print(table, highlight=False)


def _cell(value: Any) -> str:
    if isinstance(value, list):
        return ", ".join(str(item) for item in value)
    if isinstance(value, dict):
        return ", ".join(f"{name}={item}" for name, item in value.items())
    return str(value)
