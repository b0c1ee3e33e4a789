"""Named load cases of one wall: each is a wall of its own, with what `loads` gives for all and what the case adds."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path
from typing import Any

from harness.model.build import Built, build
from harness.model.case import Case
from harness.model.errors import MOST_NAMED, InputError, did_you_mean, first_few, raise_faults
from harness.model.wall import Load, Wall


def under_load_case(wall: Wall, name: str) -> Wall:
    """The wall under one of its load cases, whose dead load is added to that of `loads`.

    Raises:
        InputError: there is no such load case.
    """
    if name not in wall.load_cases:
        there = (
            f"There are: {first_few(list(wall.load_cases), MOST_NAMED)}"
            if wall.load_cases
            else 'A wall gives them in "load_cases"'
        )
        remedy = f"{did_you_mean(name, wall.load_cases)} {there}".strip()
        raise InputError(f'no load case is called "{name}"', remedy, "load_cases")
    common, own = wall.loads, wall.load_cases[name]
    dead = Load(
        body=[*common.dead.body, *own.dead.body],
        points=[*common.dead.points, *own.dead.points],
        pressures=[*common.dead.pressures, *own.dead.pressures],
    )
    gravity = common.gravity if own.gravity is None else own.gravity
    loads = own.model_copy(update={"gravity": gravity, "dead": dead})
    return wall.model_copy(update={"loads": loads, "load_cases": {}})


def build_load_case(wall: Wall, load_case: str, name: str = "wall") -> Built:
    """The assembly of a wall under one of its load cases.

    Raises:
        InputError: as `build`, with the place where the file says it.
    """
    try:
        return build(under_load_case(wall, load_case), name)
    except InputError as error:
        for fault in error.faults:
            fault.element = _in_the_file(fault.element, wall, load_case)
        raise_faults(error.faults)
        raise


def _in_the_file(element: str, wall: Wall, load_case: str) -> str:
    """The place of a load in the file, where `element` is that of the wall under one load case."""
    found = re.fullmatch(r"loads\.(dead|live)(?:\.(\w+)(?:\[(\d+)\])?)?", element)
    if found is None:
        return element
    kind, group, number = found.groups()
    if kind == "dead" and number is not None:
        common = len(getattr(wall.loads.dead, group))
        if int(number) < common:
            return element
        return f"load_cases.{load_case}.dead.{group}[{int(number) - common}]"
    return f"load_cases.{load_case}{element.removeprefix('loads')}"


def load_cases_of(case: Case, name: str | None = None) -> list[Case]:
    """The load cases of a case, each a case of its own, in the order of the file; the case itself if it has none.

    What is known of a case is not known of its load cases: they have no references and no certificate.

    Args:
        case: with a wall of load cases, or of one load.
        name: of one load case; None: all.

    Raises:
        InputError: there is no such load case, or one of them cannot be built.
    """
    if name is None and not case.wall.load_cases:
        return [case]
    try:
        return [_one(case, each) for each in (list(case.wall.load_cases) if name is None else [name])]
    except InputError as error:
        error.source = error.source or case.origin
        raise


def _one(case: Case, name: str) -> Case:
    wall = under_load_case(case.wall, name)
    update: dict[str, Any] = {
        "id": f"{case.id}-{name}",
        "title": f"{case.file.title}, load case {name}",
        "kind": "multiplier" if wall.loads.live is not None else "stability",
        "references": [],
    }
    found = replace(
        case,
        file=case.file.model_copy(update=update),
        wall=wall,
        origin=f'{Path(case.origin).name}, load case "{name}"',
        wall_id=case.id,
        load_case=name,
    )
    # Built here once, where the places of its faults in the file are known: `Case.built` keeps it.
    found.__dict__["built"] = build_load_case(case.wall, name, found.id)
    return found
