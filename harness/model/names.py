"""Names in a wall: every block has one of its own, and loads, interfaces and rules name blocks that there are."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from itertools import islice
from typing import Any

from harness.model.errors import MOST_NAMED, MOST_WORDED, Hints, InputError, Spot, uncounted
from harness.model.friction_fields import Friction
from harness.model.load_fields import Load
from harness.model.pressure_fields import Fill, Pressure
from harness.model.wall import Block, Detection, Wall


def _name_faults(blocks: Iterable[tuple[str, str]], named: Iterable[tuple[str, str]]) -> list[InputError]:
    """What is wrong with names: ids that two blocks have, and blocks named that there are not.

    Args:
        blocks: place in the file and id of every block.
        named: place in the file and id of every block that something else names.
    """
    seen: set[str] = set()

    def twice() -> Iterator[InputError]:
        for place, name in blocks:
            if name in seen:
                remedy = "Give every block an id of its own (patterns: a prefix)"
                yield InputError("two blocks have this id", remedy, place, spot=Spot((name,)))
            seen.add(name)

    found = _first_worded(twice(), "blocks have the id of another", "blocks")
    hints = Hints(seen)
    unknown = (unknown_block(name, place, hints) for place, name in named if name not in seen)
    return found + _first_worded(unknown, "names are of no block", "wall")


def unknown_block(name: str, place: str, hints: Hints) -> InputError:
    """The fault that no block of a wall, whose names the hints are of, has this name."""
    remedy = f"{hints.of(name)} Blocks of this wall: {hints.there(MOST_NAMED)}".strip()
    return InputError(f'no block is called "{name}"', remedy, place)


def faults_of_wall(wall: Wall, blocks: list[Block]) -> list[InputError]:
    """The faults of names of a wall whose patterns are blocks by now."""
    found = _name_faults(((f'block "{block.id}"', block.id) for block in blocks), _named(wall))
    return found + _groups_and_supports(wall, blocks)


def _groups_and_supports(wall: Wall, blocks: list[Block]) -> list[InputError]:
    """Loads of groups that no block is in, and of blocks and bars that cannot move."""
    fixed = {block.id for block in blocks if block.fixed}
    faults = _first_worded(_unknown_groups(wall, blocks), "loads name groups that no block is in", "loads")
    faults += _first_worded(_loads_on_supports(wall, fixed), "loads are on fixed blocks", "loads")
    faults += _first_worded(_bars_between_supports(wall, fixed), "bars join two fixed blocks", "wall")
    return faults + _first_worded(_bars_of_one_name(wall), "bars have the name of another", "wall")


def _loads_of(wall: Wall) -> tuple[tuple[str, Load], tuple[str, Load]]:
    return ("loads.dead", wall.loads.dead), ("loads.live", wall.loads.live or Load())


def _on_faces(where: str, load: Load) -> list[tuple[str, Pressure | Fill]]:
    """Pressures and fills with the places where they stand."""
    return [
        *((f"{where}.pressures[{number}]", pressure) for number, pressure in enumerate(load.pressures)),
        *((f"{where}.fills[{number}]", fill) for number, fill in enumerate(load.fills)),
    ]


def _unknown_groups(wall: Wall, blocks: list[Block]) -> Iterator[InputError]:
    groups = {group for block in blocks for group in block.groups}
    hints = Hints(groups)
    there = hints.there(MOST_NAMED) or "none"
    named: list[tuple[str, str | None]] = []
    for where, load in _loads_of(wall):
        named += [(f"{where}.body[{number}]", body.group) for number, body in enumerate(load.body)]
        named += [(place, each.group) for place, each in _on_faces(where, load)]
    named += [(f"travelling.{name}", travelling.group) for name, travelling in wall.travelling.items()]
    for place, group in named:
        if group is not None and group not in groups:
            remedy = f"{hints.of(group)} Groups of this wall: {there}".strip()
            yield InputError(f'no block is in a group "{group}"', remedy, place)


def _loads_on_supports(wall: Wall, fixed: set[str]) -> Iterator[InputError]:
    remedy = "Load a block that is free to move"
    for where, load in _loads_of(wall):
        for place, each in _on_faces(where, load):
            for name in sorted(fixed.intersection(each.blocks or ())):
                yield InputError(f'block "{name}" is fixed', remedy, place, spot=Spot((name,)))
        for number, point in enumerate(load.points):
            if point.block in fixed:
                spot, place = Spot((point.block,), point.at), f"{where}.points[{number}]"
                yield InputError(f'block "{point.block}" is fixed', remedy, place, spot=spot)


def _bars_between_supports(wall: Wall, fixed: set[str]) -> Iterator[InputError]:
    for kind, bars in (("ties", wall.ties), ("props", wall.props)):
        for number, bar in enumerate(bars):
            ends = (bar.start.block, bar.end.block)
            if fixed.issuperset(ends):
                remedy = "Join a block that is free to move to another or to a fixed one"
                yield InputError("both of its blocks are fixed", remedy, f"{kind}[{number}]", spot=Spot(ends))


def names_of_bars(wall: Wall) -> list[str]:
    """Names of the ties and then of the props: their ids, or "tie 1", "prop 1" and so on."""
    kinds = (("tie", wall.ties), ("prop", wall.props))
    return [bar.id or f"{kind} {number}" for kind, bars in kinds for number, bar in enumerate(bars, start=1)]


def _bars_of_one_name(wall: Wall) -> Iterator[InputError]:
    """Bars that have the name of one before them: tables and the columns of a path know a bar by its name."""
    seen: set[str] = set()
    for place, name in enumerate(names_of_bars(wall)):
        if name in seen:
            ties = len(wall.ties)
            where = f"ties[{place}]" if place < ties else f"props[{place - ties}]"
            yield InputError(f'another tie or prop is called "{name}" too', "Give every bar an id of its own", where)
        seen.add(name)


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
    return faults + _name_faults(
        ((f'blocks[{k}] ("{item["id"]}")', item["id"]) for k, item in enumerate(blocks)), named
    )


def _list(data: dict[str, Any], name: str) -> list[dict[str, Any]]:
    items = data.get(name)
    return [item for item in items if isinstance(item, dict)] if isinstance(items, list) else []


def _first_worded(faults: Iterable[InputError], more: str, element: str) -> list[InputError]:
    """The first of many faults of one kind, and a last one that says how many more there are.

    Args:
        faults: made one by one, so that thousands take no memory.
        more: what the others are, in words; element: what they are about.
    """
    waiting = iter(faults)
    found = list(islice(waiting, MOST_WORDED))
    if count := sum(1 for _ in waiting):
        found.append(uncounted(count, more, element))
    return found
