"""Documents that are nearly right: valid walls, cases and results with a few faults of the kinds that files have.

A document is drawn from a `Source` of whole numbers, so that one grammar serves three drivers: a seeded generator
(fast, repeatable by number), hypothesis (shrinks what fails) and atheris (led by the code it reaches).
"""

from __future__ import annotations

import copy
import json
from collections.abc import Callable
from random import Random
from typing import Any, Protocol, TypeVar

Item = TypeVar("Item")


class Source(Protocol):
    """Where a document's choices come from."""

    def integer(self, low: int, high: int) -> int:
        """A whole number from low to high, both included."""
        ...


class Seeded:
    """Choices of a seed."""

    def __init__(self, seed: int) -> None:
        self._random = Random(seed)

    def integer(self, low: int, high: int) -> int:
        """A whole number from low to high, both included."""
        return self._random.randint(low, high)


# Tables of values are kept in lines of their kind.
# ruff: noqa: E501
NUMBERS: list[Any] = [
    0, 0.0, -0.0, 1, -1, 0.5, 2, 1e-9, -1e-9, 1e-300, 5e-324, 1e15, -1e15, 1e16, 1e300, -1e300, 1.7976931348623157e308,
    2**31, 2**53 + 1, 2**64, 10**30, 0.1, 33, 100, 89.999, 90, True,
]  # fmt: skip
WORDS: list[Any] = [
    "", "a", "b", "ground", "zz", "stone", "bed", "head", "wall/1", "wall/2", "m", "mm", "kN", "kN/m3", "\x1b[2J", "\x00",
    "a\nb", "\u202e", "\ud800", "x" * 300, "running_bond", "ring", "NaN", "1", "__class__", "../../etc/passwd", "石",
]  # fmt: skip
OTHERS: list[Any] = [None, True, False, [], {}, [[]], [0], [0, 0], [1, 0], [[0, 0], [1, 0], [1, 1]], {"a": 1}, [None]]
FIELDS = [
    "format", "title", "units", "length", "force", "unit_weight", "metadata", "thickness", "friction", "friction_angle",
    "default", "rules", "value", "materials", "joint", "between", "pattern", "type", "blocks", "id", "polygon", "weight",
    "fixed", "groups", "interfaces", "from", "to", "inset", "fraction", "tolerance", "contact_inset", "loads", "gravity",
    "dead", "live", "body", "points", "per_weight", "block", "at", "group", "cohesion", "frction", "count", "bricks",
    "courses", "angles", "supports", "offsets", "layout", "prefix", "origin", "multiplier", "forces", "mechanism", "flow",
]  # fmt: skip


def one_of(source: Source, items: list[Item]) -> Item:
    """One of the items."""
    return items[source.integer(0, len(items) - 1)]


def wall(source: Source) -> dict[str, Any]:
    """A valid wall of a few blocks."""
    data: dict[str, Any] = {"format": "wall/1", "unit_weight": 20.0}
    body = one_of(source, _BODIES)
    named = body is _BODIES[0]
    data |= copy.deepcopy(one_of(source, _FRICTIONS if named else _FRICTIONS[:-1]))
    data |= copy.deepcopy(body)
    loads = one_of(source, _LOADS if named else _LOADS[:-2])
    if loads is not None:
        data["loads"] = copy.deepcopy(loads)
    if source.integer(0, 3) == 0:
        data["units"] = copy.deepcopy(one_of(source, _UNITS))
    if source.integer(0, 5) == 0:
        data["contact_inset"] = one_of(source, [{"length": 0.01}, {"fraction": 0.1}])
    return data


_GROUND = {"id": "ground", "polygon": [[-1, -1], [5, -1], [5, 0], [-1, 0]], "fixed": True, "material": "rock"}
_FRICTIONS: list[dict[str, Any]] = [
    {"friction": 0.5},
    {"friction": 0.0},
    {"friction_angle": 33.0},
    {"friction": {"friction_angle": 30.0, "rules": [{"materials": ["stone", "rock"], "friction_angle": 20.0}]}},
    {"friction": {"default": 0.6, "rules": [{"joint": "head", "value": 0.1}, {"between": ["a", "b"], "value": 0.9}]}},
]
_BODIES: list[dict[str, Any]] = [
    {
        "blocks": [
            _GROUND,
            {"id": "a", "polygon": [[0, 0], [1, 0], [1, 0.5], [0, 0.5]], "groups": ["g"]},
            {"id": "b", "polygon": [[0, 0.5], [1, 0.5], [1, 1], [0, 1]], "weight": 5.0, "thickness": 0.5},
        ]
    },
    {
        "blocks": [_GROUND, {"id": "a", "polygon": [[0, 0], [1, 0], [1, 0.5], [0, 0.5]]}],
        "interfaces": [
            {"between": ["ground", "a"], "from": [0, 0], "to": [0.2, 0], "joint": "pad"},
            {"between": ["ground", "a"], "from": [0.8, 0], "to": [1, 0], "friction": 0.3, "inset": {"fraction": 0.1}},
        ],
    },
    {
        "blocks": [_GROUND, {"id": "a", "polygon": [[0, 0], [1, 0], [1.2, 0.5], [0.5, 0.8], [-0.1, 0.5]]}],
        "interfaces": {"tolerance": 1e-4},
    },
    {"pattern": {"type": "running_bond", "block_length": 0.4, "block_height": 0.2, "count": 2, "bricks": 2}},
    {"pattern": {"type": "running_bond", "block_length": 0.4, "block_height": 0.2, "courses": [[1, 1], [0.5, -1, 0.5]]}},
    {"pattern": {"type": "ring", "inner_radius": 1.0, "outer_radius": 1.3, "count": 4, "angles": [150, 30]}},
    {"pattern": [{"type": "stack", "width": 0.5, "height": 0.5, "count": 2, "prefix": "l", "offsets": [0, 0.1]}]},
    {"pattern": {"type": "panel", "cell_length": 1, "cell_height": 1, "layout": ["ab", "cb", "##"], "fixed": "#"}},
]  # fmt: skip
_LOADS: list[Any] = [
    None,
    {"live": {"body": [{"per_weight": [1, 0]}]}},
    {"live": {"body": [{"per_weight": [1, 0]}]}, "gravity": [0.1, -0.9]},
    {"gravity": False, "dead": {"body": [{"per_weight": [0, -1]}]}, "live": {"body": [{"per_weight": [0, -1]}]}},
    {"live": {"body": [{"per_weight": [1, 0], "group": "g"}]}, "gravity": True},
    {
        "live": {"points": [{"block": "a", "at": [0.5, 0.5], "force": [1, 0]}]},
        "dead": {"points": [{"block": "a", "at": [0.5, 0.5], "force": [0, -5]}]},
    },
]  # fmt: skip
_UNITS: list[Any] = [
    {"length": "mm", "force": "N", "unit_weight": "kN/m3"},
    {"length": "1", "force": "1"},
    {"length": "ft", "force": "kip"},
]


def case_file(source: Source) -> dict[str, Any]:
    """A valid `case.toml` of the folder "fuzzed"."""
    reference = {
        "id": "r", "type": one_of(source, ["exact", "bound", "published"]), "value": 0.5, "applies_to": ["la"],
        "source": "none", "requirement": "It is a half.", "tolerance": 1e-9, "gate": True,
    }  # fmt: skip
    data: dict[str, Any] = {"id": "fuzzed", "title": "t", "source": "none", "references": [reference]}
    if source.integer(0, 2) == 0:
        data["kind"] = "stability"
    if source.integer(0, 2) == 0:
        reference |= {"relation": "inside", "value": [0.4, 0.6], "settings": {"starts": 3}}
    return data


def result(source: Source, blocks: int, interfaces: int) -> dict[str, Any]:
    """A result file whose arrays have the right size."""

    def table(rows: int) -> list[list[float]]:
        return [[float(source.integer(-3, 3)) for _ in range(3)] for _ in range(rows)]

    data: dict[str, Any] = {
        "multiplier": float(source.integer(-2, 5)) / 4.0,
        "forces": table(interfaces),
        "mechanism": table(blocks),
        "flow": one_of(source, ["non-associated", "associated", "approximate"]),
        "finding": one_of(source, ["collapses", "stands", "falls", "unbounded", "none"]),
    }
    if source.integer(0, 2) == 0:
        del data[one_of(source, list(data))]
    if source.integer(0, 3) == 0:
        data["forces_multiplier"] = 0.25
    return data


def spoiled(source: Source, data: Any) -> Any:
    """The document with none to three faults."""
    for _ in range(one_of(source, [0, 1, 1, 1, 2, 3])):
        data = _FAULTS[source.integer(0, len(_FAULTS) - 1)](source, data)
    return data


def spoiled_text(source: Source, data: Any) -> bytes:
    """The document as text, which now and then is no JSON, not UTF-8, or cut off."""
    text = json.dumps(data).encode("utf-8", "surrogatepass")
    way = source.integer(0, 24)
    place = source.integer(0, max(0, len(text) - 1))
    if way == 0:
        return text[:place]
    if way == 1:
        return text[:place] + bytes([source.integer(0, 255)]) + text[place + 1 :]
    if way == 2:
        word = one_of(
            source, [b"NaN", b"Infinity", b"1e999", b"[" * 60, b"{" * 3, b"9" * 5000, b'"\\ud800"', b"\xef\xbb\xbf"]
        )
        return text[:place] + word + text[place:]
    if way == 3:
        return text.replace(b":", b":{" * 2, 1) if source.integer(0, 1) else text + text
    return text


def _places(data: Any, path: tuple[Any, ...] = ()) -> list[tuple[Any, ...]]:
    found = [path] if path else []
    items = data.items() if isinstance(data, dict) else enumerate(data) if isinstance(data, list) else ()
    for name, item in items:
        found += _places(item, (*path, name))
    return found


def _parent(data: Any, path: tuple[Any, ...]) -> Any:
    for name in path[:-1]:
        data = data[name]
    return data


def _at_a_place(change: Callable[[Source, Any, Any], None]) -> Callable[[Source, Any], Any]:
    def fault(source: Source, data: Any) -> Any:
        places = _places(data)
        if not places:
            return data
        data = copy.deepcopy(data)
        path = one_of(source, places)
        change(source, _parent(data, path), path[-1])
        return data

    return fault


def _value(source: Source) -> Any:
    return copy.deepcopy(one_of(source, one_of(source, [NUMBERS, NUMBERS, WORDS, OTHERS])))


def _replace(source: Source, parent: Any, name: Any) -> None:
    parent[name] = _value(source)


def _nudge(source: Source, parent: Any, name: Any) -> None:
    """Numbers change a little or a lot; anything else is replaced."""
    here = parent[name]
    if isinstance(here, bool) or not isinstance(here, int | float):
        parent[name] = _value(source)
        return
    parent[name] = one_of(
        source, [-here, here * 1e3, here * 1e-6, here + 0.25, here * (1 + 1e-12), here + 1e-7, here * 1e12]
    )


def _remove(_source: Source, parent: Any, name: Any) -> None:
    del parent[name]


def _repeat(source: Source, parent: Any, name: Any) -> None:
    if isinstance(parent, list):
        parent.insert(source.integer(0, len(parent)), copy.deepcopy(parent[name]))
    else:
        parent[one_of(source, FIELDS)] = copy.deepcopy(parent[name])


def _insert(source: Source, parent: Any, _name: Any) -> None:
    if isinstance(parent, list):
        parent.append(_value(source))
    else:
        parent[one_of(source, FIELDS)] = _value(source)


def _deepen(source: Source, parent: Any, name: Any) -> None:
    for _ in range(source.integer(1, 60)):
        parent[name] = [parent[name]] if source.integer(0, 1) else {"a": parent[name]}


_FAULTS: list[Callable[[Source, Any], Any]] = [
    _at_a_place(change) for change in (_replace, _replace, _nudge, _nudge, _nudge, _remove, _repeat, _insert, _deepen)
]
