"""Commands about drawings of walls: validate, repair, show."""

from __future__ import annotations

import sys
from dataclasses import asdict
from pathlib import Path

import click

from drystone.cli import terminal
from drystone.cli.options import (
    INPUT_ERROR,
    OUTPUT,
    case_argument,
    cases_option,
    catching,
    json_flag,
    known_methods,
    load_case_option,
    print_json,
    runs_options,
    say,
)
from harness.engine.pipeline import Runs
from harness.engine.plan import check_methods, find_cases
from harness.engine.sensitivity import Plateau, advised, over_tolerance, suggested
from harness.model.build import build
from harness.model.errors import InputError, in_file, raise_faults
from harness.model.inspection import Inspection, inspect
from harness.model.library import library
from harness.model.load_cases import named_loads
from harness.model.plausibility import saying
from harness.model.reading import parse_wall, read_document, wall_json
from harness.model.repair import repair as mend
from harness.model.salvage import salvaged
from harness.model.writing import write_whole
from reports.labels.numbers import count


@click.command()
@case_argument
@click.option(
    "--method",
    shell_complete=known_methods,
    default=library().methods.quick,
    show_default=True,
    help="The method that is run once for each set of joints.",
)
@json_flag
@cases_option
@runs_options
@catching
def validate(case: str, method: str, as_json: bool, folders: tuple[Path, ...], runs: Runs) -> None:
    """List everything that is wrong or doubtful in CASE (an id, a case folder, a WALL.json or a drawing).

    Its joints and answer over the tolerance are listed too.

    Each fault and doubt has its place, its size and what would mend it; `drystone show` draws them under the same
    numbers. A tolerance is a good one where its neighbours find the same joints. Exit code 2 if the wall cannot be
    built as it stands; the list and the table are printed all the same.
    """
    check_methods([method], "--method")
    looked = looked_at(case, folders)
    joints = looked.built.assembly.n_interfaces if looked.built is not None else None
    plateaus = _plateaus(looked, method, runs)
    advice = suggested(plateaus)
    if as_json:
        rows = [{"number": k} | asdict(mark) | {"text": str(mark)} for k, mark in enumerate(looked.marks, start=1)]
        by_kind = {f"{kind}s": [row for row in rows if row["kind"] == kind] for kind in ("fault", "doubt")}
        print_json(
            {"joints": joints, **by_kind, "suggested_tolerance": advice[0] if advice else None}
            | {"tolerances": [asdict(plateau) for plateau in plateaus]}
        )
    else:
        say(_found(joints) if joints is not None else f"it cannot be built; errors: {len(looked.faults)}")
        _list_marks(looked, advice[0] if advice else None)
        if plateaus:
            if looked.wall.load_case_fields:
                say(f"the answers are those of the load case {next(iter(named_loads(looked.wall)))}")
            terminal.print_rows(
                [
                    {
                        "tolerance": f"{plateau.low:.3g} to {plateau.high:.3g}",
                        "joints": "-" if plateau.joints is None else plateau.joints,
                        method: plateau.answer,
                    }
                    for plateau in plateaus
                ]
            )
        if advice is not None and joints != advice[1].joints:
            say(
                f"the widest range of tolerances with the same joints is {advice[1].low:.3g} to {advice[1].high:.3g}: "
                f"say {saying(advice[0])}"
            )
    sys.exit(INPUT_ERROR if looked.faults else 0)


def _found(joints: int) -> str:
    return f"{count(joints, 'joint')} {'is' if joints == 1 else 'are'} found"


def looked_at(case: str, folders: tuple[Path, ...], load_case: str | None = None) -> Inspection:
    """A case, a wall file or a drawing looked over, under one of its load cases or the first.

    Raises:
        InputError: there is none, or nothing in it can be looked at, or it has no such load case.
    """
    path = Path(case)
    if not path.is_file():
        (found,) = find_cases([case], None, folders)
        for note in found.notes:
            say(f"drystone: {note}", err=True)
        with in_file(found.origin):
            return inspect(found.wall, found.id, load_case=load_case)
    wall, before = salvaged(read_document(path), str(path))
    if wall is None:
        raise_faults(before, str(path))
        raise AssertionError("a wall that is not read has an error")
    with in_file(str(path)):
        return inspect(wall, path.stem, before, load_case)


def _list_marks(looked: Inspection, advice: float | None) -> None:
    """Faults and doubts as sentences, and the near misses, which may be hundreds, as a table besides."""
    for sentence in looked.sentences(advice):
        say(sentence)
    near = [(number, mark) for number, mark in enumerate(looked.marks, start=1) if mark.near_miss]
    if near:
        terminal.print_rows(
            [
                {
                    "no.": number,
                    "blocks": " and ".join(mark.blocks),
                    "apart": f"{mark.size:.3g}",
                    "near": _place(mark.at),
                }
                for number, mark in near
            ]
        )


def _plateaus(looked: Inspection, method: str, runs: Runs) -> list[Plateau]:
    """The plateaus over the tolerance; none where joints are given or no tolerance mends the wall."""
    if isinstance(looked.wall.interfaces, list):
        return []
    try:
        plateaus = over_tolerance(looked.wall, method, runs)
    except InputError:  # an outline is no polygon, or names are wrong: the marks say so
        return []
    return plateaus if any(plateau.joints is not None for plateau in plateaus) else []


@click.command()
@click.argument("wall", type=click.Path(path_type=Path))
@click.option("-o", "--output", type=OUTPUT, required=True, help="The file of the repaired wall.")
@click.option(
    "--snap", type=click.FloatRange(min=0.0, min_open=True), required=True, help="Greatest displacement of a vertex."
)
@json_flag
@catching
def repair(wall: Path, output: Path, snap: float, as_json: bool) -> None:
    """Close the gaps and overlaps of WALL.json by moving vertices, and show what moved by how much.

    Lengths are in the unit of the file. Outlines that are drawn twice are taken once; faces get a vertex where another
    block ends in them.
    """
    described = parse_wall(read_document(wall), str(wall))
    with in_file(str(wall)):
        mended = mend(described, snap)
        built = build(mended.wall, wall.stem)
    write_whole(output, wall_json(mended.wall))
    furthest = max((move.distance for move in mended.moves), default=0.0)
    if as_json:
        rows = [asdict(move) | {"distance": move.distance} for move in mended.moves]
        print_json(
            {"moves": rows, "doubles": mended.doubles, "splits": mended.splits, "joints": built.assembly.n_interfaces}
        )
        return
    if mended.moves:
        rows = [
            {"block": move.block, "vertex": move.vertex, "from": _place(move.start), "to": _place(move.end)}
            | {"moved by": f"{move.distance:.3g}"}
            for move in sorted(mended.moves, key=lambda move: -move.distance)
        ]
        terminal.print_rows(rows)
    for left, kept in mended.doubles:
        say(f'left out: block "{left}", which repeats the outline of "{kept}"')
    for block, added in mended.splits:
        say(f'block "{block}": {added} vertices added to its faces at the ends of others')
    say(f"{len(mended.moves)} vertices moved, {furthest:.3g} at most; {_found(built.assembly.n_interfaces)}")
    for warning in built.warnings:
        say(f"doubtful: {warning}")


def _place(point: tuple[float, float] | None) -> str:
    return f"({point[0]:.6g}, {point[1]:.6g})" if point is not None else ""


@click.command()
@case_argument
@click.option("-o", "--output", type=OUTPUT, default=Path("wall.svg"), show_default=True)
@click.option("--window", is_flag=True, help="Draw in a window instead of to a file.")
@click.option("--axes/--no-axes", default=True, show_default=True, help="Coordinates of the file, and a scale.")
@click.option("--dimensions", is_flag=True, help="Sizes of the wall and of every block.")
@load_case_option
@cases_option
@catching
def show(
    case: str,
    output: Path,
    window: bool,
    axes: bool,
    dimensions: bool,
    load_case: str | None,
    folders: tuple[Path, ...],
) -> None:
    """Draw CASE (an id, a WALL.json or a drawing) to a file (.svg, .pdf, .png) or in a window, before anything is run.

    A wall with faults is drawn too, with the faults marked under the numbers of `drystone validate`; exit code 2 then.
    Of several load cases the first is drawn, or that of --load-case; the drawing names it. Needs drystone[figures].
    """
    from reports.figures.figures import show_window
    from reports.figures.wall_check_figure import draw_inspected, inspected_figure

    looked = looked_at(case, folders, load_case)
    for sentence in looked.sentences(advised(looked)):
        say(f"drystone: {sentence}", err=True)
    if window:
        show_window(inspected_figure(looked, axes=axes, dimensions=dimensions), looked.wall.title or case)
    else:
        draw_inspected(looked, output, axes=axes, dimensions=dimensions)
        say(str(output))
    sys.exit(INPUT_ERROR if looked.faults else 0)
