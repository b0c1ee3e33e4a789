"""Names in a wall: every block has one of its own, and loads, interfaces and rules name blocks that there are."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Any

from harness.model.errors import MOST_NAMED, InputError, Spot, did_you_mean, first_few
from harness.model.friction_fields import Friction
from harness.model.load_fields import Load
from harness.model.pressure_fields import Fill, Pressure
from harness.model.wall import Block, Detection, Wall

MOST_COMPARED = 2000
"""Ids that an unknown one is compared with, in the search for the one that was meant."""


def name_faults(blocks: Iterable[tuple[str, str]], named: Iterable[tuple[str, str]]) -> list[InputError]:
    """What is wrong with names: ids that two blocks have, and blocks named that there are not.

    Args:
        blocks: place in the file and id of every block.
        named: place in the file and id of every block that something else names.
    """
    faults = []
    seen: set[str] = set()
    for place, name in blocks:
        if name in seen:
            remedy = "Give every block an id of its own (patterns: a prefix)"
            faults.append(InputError("two blocks have this id", remedy, place, spot=Spot((name,))))
        seen.add(name)
    known = sorted(seen)[:MOST_COMPARED]
    for place, name in named:
        if name not in seen:
            remedy = did_you_mean(name, known) or "Name a block of this wall"
            faults.append(InputError(f'no block is called "{name}"', remedy, place))
    return faults


def faults_of_wall(wall: Wall, blocks: list[Block]) -> list[InputError]:
    """The faults of names of a wall whose patterns are blocks by now."""
    found = name_faults(((f'block "{block.id}"', block.id) for block in blocks), _named(wall))
    return found + _groups_and_supports(wall, blocks)


def _groups_and_supports(wall: Wall, blocks: list[Block]) -> list[InputError]:
    """Loads of groups that no block is in, and of blocks that cannot move."""
    groups = {group for block in blocks for group in block.groups}
    fixed = {block.id for block in blocks if block.fixed}
    faults = []
    for where, load in (("loads.dead", wall.loads.dead), ("loads.live", wall.loads.live or Load())):
        grouped = [(f"{where}.body[{number}]", body.group) for number, body in enumerate(load.body)]
        on_faces: list[tuple[str, Pressure | Fill]] = [
            *((f"{where}.pressures[{number}]", pressure) for number, pressure in enumerate(load.pressures)),
            *((f"{where}.fills[{number}]", fill) for number, fill in enumerate(load.fills)),
        ]
        grouped += [(place, each.group) for place, each in on_faces]
        for place, group in grouped:
            if group is not None and group not in groups:
                known = sorted(groups)[:MOST_COMPARED]
                there = first_few(known, MOST_NAMED) or "none"
                remedy = f"{did_you_mean(group, known)} Groups of this wall: {there}"
                faults.append(InputError(f'no block is in a group "{group}"', remedy.strip(), place))
        for place, each in on_faces:
            for name in sorted(fixed.intersection(each.blocks or ())):
                problem = f'block "{name}" is fixed'
                faults.append(InputError(problem, "Load a block that is free to move", place, spot=Spot((name,))))
        for number, point in enumerate(load.points):
            if point.block in fixed:
                problem, place = f'block "{point.block}" is fixed', f"{where}.points[{number}]"
                spot = Spot((point.block,), point.at)
                faults.append(InputError(problem, "Load a block that is free to move", place, spot=spot))
    for kind, bars in (("ties", wall.ties), ("props", wall.props)):
        for number, bar in enumerate(bars):
            ends = (bar.start.block, bar.end.block)
            if fixed.issuperset(ends):
                remedy = "Join a block that is free to move to another or to a fixed one"
                faults.append(InputError("both of its blocks are fixed", remedy, f"{kind}[{number}]", spot=Spot(ends)))
    return faults


def _named(wall: Wall) -> Iterator[tuple[str, str]]:
    if isinstance(wall.friction, Friction):
        for number, rule in enumerate(wall.friction.rules):
            for name in rule.between or ():
                yield f"friction.rules[{number}]", name
    if isinstance(wall.interfaces, Detection):
        for number, pair in enumerate(wall.interfaces.removed):
            yield from ((f"interfaces.removed[{number}]", name) for name in pair)
        for number, interface in enumerate(wall.interfaces.given):
            yield from ((f"interfaces.given[{number}]", name) for name in interface.between)
    else:
        for number, interface in enumerate(wall.interfaces):
            yield from ((f"interfaces[{number}]", name) for name in interface.between)
    for where, load in (("loads.dead", wall.loads.dead), ("loads.live", wall.loads.live or Load())):
        for number, body in enumerate(load.body):
            for name in body.blocks or ():
                yield f"{where}.body[{number}]", name
        for number, point in enumerate(load.points):
            yield f"{where}.points[{number}]", point.block
        for number, pressure in enumerate(load.pressures):
            for name in pressure.blocks or ():
                yield f"{where}.pressures[{number}]", name
        for number, fill in enumerate(load.fills):
            for name in fill.blocks or ():
                yield f"{where}.fills[{number}]", name
    for kind, bars in (("ties", wall.ties), ("props", wall.props)):
        for number, bar in enumerate(bars):
            yield from ((f"{kind}[{number}].{end}", at.block) for end, at in (("from", bar.start), ("to", bar.end)))
    for title, travelling in wall.travelling.items():
        for name in travelling.blocks or ():
            yield f"travelling.{title}", name
    for number, settlement in enumerate(wall.settlements):
        for name in settlement.blocks or ():
            yield f"settlements[{number}]", name


def faults_of_data(data: dict[str, Any]) -> list[InputError]:
    """The same faults of a wall as read from JSON, for a wall whose other faults keep it from being built."""
    faults = []
    if "friction" not in data and "friction_angle" not in data:
        remedy = 'Give "friction" (a coefficient, tan(phi)) or "friction_angle" (degrees)'
        faults.append(InputError("it is missing", remedy, "friction"))
    if data.get("pattern") is not None:
        return faults
    blocks = [item for item in _list(data, "blocks") if isinstance(item.get("id"), str)]
    if not blocks:
        return faults
    loads = data.get("loads")
    named = [
        (f"loads.{kind}.points[{number}]", point["block"])
        for kind in ("dead", "live")
        if isinstance(loads, dict) and isinstance(loads.get(kind), dict)
        for number, point in enumerate(_list(loads[kind], "points"))
        if isinstance(point.get("block"), str)
    ]
    return faults + name_faults(((f'blocks[{k}] ("{item["id"]}")', item["id"]) for k, item in enumerate(blocks)), named)


def _list(data: dict[str, Any], name: str) -> list[dict[str, Any]]:
    items = data.get(name)
    return [item for item in items if isinstance(item, dict)] if isinstance(items, list) else []
