"""Named load cases of one wall: each is a wall of its own, with what `loads` gives for all and what the case adds."""

from __future__ import annotations

import math
import re
from collections.abc import Collection, Iterator, Mapping
from dataclasses import dataclass, replace
from itertools import product
from pathlib import Path
from typing import Any

from harness.model.blocks import blocks_of_wall, polygons_of
from harness.model.build import Built, build
from harness.model.case import Case
from harness.model.errors import MOST_NAMED, InputError, did_you_mean, first_few, in_file, raise_faults
from harness.model.laid import Laid, lay
from harness.model.load_fields import DEAD, Load, Loads
from harness.model.loads import times, together
from harness.model.travelling import Upward
from harness.model.wall import MOST_LOAD_CASES, Wall

_TITLE_JOINT = ", load case "
"""Between the title of a wall and the name of a load case."""
_MOST_ADDED = 100_000
"""Forces and pressures that the combinations of a wall add up, a second of work."""
_MOST_BUILT = 200_000
"""Blocks that are built under load cases, those of every load case counted: some seconds of work."""


@dataclass(frozen=True)
class _NamedLoads:
    """A load case of a wall.

    Attributes:
        own: what it adds to the gravity and the dead load of `loads`.
        common: factor of these.
        place: where the file says it.
        stands: where loads that travel stand in it, in words; empty without any.
    """

    own: Loads
    place: str
    common: float = 1.0
    stands: str = ""


def named_loads(wall: Wall) -> dict[str, _NamedLoads]:
    """All load cases of a wall by name: those written out, one for each place of loads that travel, combinations.

    A combination of a load that travels is one of its load cases for each place.

    Raises:
        InputError: a load travels over no face, a combination names what there is not, or cannot be added up, or the
            load cases are too many.
    """
    found = {name: _NamedLoads(own, f"load_cases.{name}") for name, own in wall.load_cases.items()}
    members = {name: [name] for name in found}
    if wall.travelling:
        blocks = blocks_of_wall(wall)
        upward = Upward(blocks, polygons_of(blocks), wall.loads.gravity_per_weight)
    for name, travelling in wall.travelling.items():
        place = f"travelling.{name}"
        loads = upward.loads(travelling, place, MOST_LOAD_CASES - len(found))
        members[name] = [f"{name}-{number}" for number in range(1, len(loads) + 1)]
        for each, own in zip(members[name], loads, strict=True):
            _add(found, each, _NamedLoads(own, place, stands=f"{name} {_stands(own, wall)}"))
    alone, added = dict(found), 0
    for name, factors in wall.combinations.items():
        for suffix, chosen in _chosen(name, factors, members, alone, MOST_LOAD_CASES - len(found)):
            cases = {each: alone[each] for each in chosen}
            added += sum(loads_in(case.own) for case in cases.values())
            if added > _MOST_ADDED:
                raise InputError(
                    f"it and those before it add up more than {_MOST_ADDED:,} forces and pressures",
                    "Combine fewer load cases, or give those on the same blocks as one",
                    f"combinations.{name}",
                )
            _add(found, f"{name}{suffix}", _combined(name, cases, chosen, factors))
    return found


def named_loads_of(case: Case) -> dict[str, _NamedLoads]:
    """All load cases of the wall of a case by name, as `named_loads`.

    Raises:
        InputError: as `named_loads`, with the file.
    """
    with in_file(case.origin):
        return named_loads(case.wall)


def _stands(own: Loads, wall: Wall) -> str:
    """Where the force of a load that travels acts, in words."""
    assert own.live is not None
    (force,) = own.live.points
    x, y = (0.0 if abs(part) <= 1e-9 * math.hypot(*force.at) else part for part in force.at)  # rounding
    unit = "" if wall.units.length == "1" else f" {wall.units.length}"
    return f"on {force.block} at ({x:.4g}, {y:.4g}){unit}"


def loads_in(loads: Loads) -> int:
    """Forces and pressures of a load case."""
    return sum(
        len(load.body) + len(load.points) + len(load.pressures) + len(load.fills)
        for load in (loads.dead, loads.live or Load())
    )


def _add(found: dict[str, _NamedLoads], name: str, loads: _NamedLoads) -> None:
    """Another load case, whose name no other has."""
    if name in found:
        problem = f'its load case "{name}" has the name of another'
        raise InputError(problem, "Give one of them another name", loads.place)
    found[name] = loads


def _chosen(
    name: str, factors: dict[str, float], members: dict[str, list[str]], known: Collection[str], most: int
) -> Iterator[tuple[str, dict[str, float]]]:
    """The load cases of a combination with their factors, for each place of loads that travel, and what names it.

    Args:
        name, factors: of the combination; members: load cases by what makes them; known: all that may be combined.
        most: load cases that a wall may still have.
    """
    options = []
    for each, factor in factors.items():
        if each == DEAD:
            continue
        cases = members.get(each, [each] if each in known else [])
        if not cases:
            there = first_few([DEAD, *members], MOST_NAMED)
            remedy = f"{did_you_mean(each, [*members, *known])} There are: {there}".strip()
            raise InputError(f'no load case is called "{each}"', remedy, f"combinations.{name}")
        options.append([(case, factor, "" if case == each else case.removeprefix(each)) for case in cases])
    count = math.prod(len(each) for each in options)
    if count > most:
        raise InputError(
            f"it makes {count:.6g} load cases, and the wall may have {most:,} more at most",
            "Combine loads that travel with each other at fewer places, or one at a time",
            f"combinations.{name}",
        )
    for chosen in product(*options):
        sums: dict[str, float] = {}
        for case, factor, _ in chosen:  # a place of a load that travels may be named besides, and be met twice
            sums[case] = sums.get(case, 0.0) + factor
        yield "".join(suffix for _, _, suffix in chosen), sums


def _combined(
    name: str, cases: dict[str, _NamedLoads], chosen: dict[str, float], factors: dict[str, float]
) -> _NamedLoads:
    """The sum of load cases with factors."""
    place = f"combinations.{name}"
    for each, case in cases.items():
        if case.own.gravity is not None:
            remedy = "Leave gravity out of load cases that are combined, or write the combination out as a load case"
            raise InputError(f'the load case "{each}" has a gravity of its own', remedy, place)
    live = [times(case.own.live, chosen[each]) for each, case in cases.items() if case.own.live is not None]
    dead = together(*(times(case.own.dead, chosen[each]) for each, case in cases.items()))
    stands = ", ".join(case.stands for case in cases.values() if case.stands)
    return _NamedLoads(Loads(dead=dead, live=together(*live) if live else None), place, factors.get(DEAD, 1.0), stands)


def under_load_case(wall: Wall, name: str, known: dict[str, _NamedLoads] | None = None) -> Wall:
    """The wall under one of its load cases, whose dead load is added to that of `loads`.

    Args:
        wall: with load cases; name: of one; known: all of them, where they have been made.

    Raises:
        InputError: there is no such load case.
    """
    known = named_loads(wall) if known is None else known
    if name not in known:
        there = f"There are: {first_few(list(known), MOST_NAMED)}" if known else 'A wall gives them in "load_cases"'
        made = [each for each, loads in known.items() if loads.place in (f"travelling.{name}", f"combinations.{name}")]
        if made:
            which = made[0] if len(made) == 1 else f"one of {made[0]} to {made[-1]}"
            remedy = f"It acts at {len(made)} place(s), each a load case: give {which}"
        else:
            remedy = f"{did_you_mean(name, known)} {there}".strip()
        raise InputError(f'no load case is called "{name}"', remedy, wall.load_cases_place)
    own, factor = known[name].own, known[name].common
    gravity = wall.loads.gravity if own.gravity is None else own.gravity
    if factor != 1.0:
        x, y = wall.loads.gravity_per_weight
        gravity = (factor * x, factor * y)
    loads = own.model_copy(update={"gravity": gravity, "dead": together(times(wall.loads.dead, factor), own.dead)})
    return wall.model_copy(update={"loads": loads, "load_cases": {}, "travelling": {}, "combinations": {}})


def each_built(
    wall: Wall, names: Mapping[str, str], known: dict[str, _NamedLoads], laid: Laid | None = None
) -> Iterator[tuple[str, Wall, Built]]:
    """A wall under its load cases, one after another, with the assembly; blocks and joints are laid once.

    Args:
        wall: with load cases; names: of the assemblies by load case; known: all load cases.
        laid: its blocks and joints, where they are known.

    Raises:
        InputError: as `under_load_case`; as `build`, with the place where the file says it; or so many load cases of so
            many blocks that they take minutes to build.
    """
    walls = {load_case: under_load_case(wall, load_case, known) for load_case in names}
    blocks = blocks_of_wall(wall) if laid is None else laid.blocks
    if len(names) > 1 and len(names) * len(blocks) > _MOST_BUILT:
        raise InputError(
            f"its {len(blocks):,} blocks are built under each of {len(names):,} load cases, and at most "
            f"{_MOST_BUILT:,} in all",
            "Give fewer load cases, or choose one with --load-case of run or expand",
            wall.load_cases_place,
        )
    laid = lay(wall, blocks) if laid is None else laid
    for load_case, name in names.items():
        try:
            built = build(walls[load_case], name, laid)
        except InputError as error:
            for fault in error.faults:
                fault.element = _in_the_file(fault.element, wall, load_case, known)
            raise_faults(error.faults)
            raise
        yield load_case, walls[load_case], built


def _in_the_file(element: str, wall: Wall, load_case: str, known: dict[str, _NamedLoads]) -> str:
    """The place of a load in the file, where `element` is that of the wall under one load case."""
    found = re.fullmatch(r"loads\.(dead|live)(?:\.(\w+)(?:\[(\d+)\])?)?", element)
    if found is None:
        return element
    if load_case not in wall.load_cases:
        return known[load_case].place
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
    if name is None and not case.wall.load_case_fields:
        return [case]
    with in_file(case.origin):
        known = named_loads(case.wall)
        wanted = {each: f"{case.id}-{each}" for each in (known if name is None else [name])}
        found = each_built(case.wall, wanted, known)
        return [_one(case, each, known[each].stands, wall, built) for each, wall, built in found]


def title_of_wall(case: Case) -> str:
    """The title of a wall of which a case is a load case, without the name of that."""
    title, _, name = case.file.title.rpartition(_TITLE_JOINT)
    return title if title and case.load_case.startswith(name.partition(" (")[0]) else case.file.title


def _one(case: Case, name: str, stands: str, wall: Wall, built: Built) -> Case:
    update: dict[str, Any] = {
        "id": f"{case.id}-{name}",
        "title": f"{case.file.title}{_TITLE_JOINT}{name}" + (f" ({stands})" if stands else ""),
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
        load_place=stands,
    )
    found.__dict__["built"] = built  # where the places of its faults in the file are known: `Case.built` keeps it
    return found
