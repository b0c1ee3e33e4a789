"""Quantities of a wall by name: a path into its data, or a short name with a rule of its own."""

from __future__ import annotations

import copy
import json
import math
import re
from collections.abc import Callable, Iterator, Mapping
from itertools import islice
from typing import Any

from harness.model.errors import InputError, did_you_mean
from harness.model.library import library
from harness.model.wall import Wall

_STEP = re.compile(r"([A-Za-z_][A-Za-z0-9_]*)|\[(\d+)\]")
_SETTING = "settings."
_MOST_NUMBERS = 2000
"""Numbers of a wall that a wrong name is compared with."""


def setting_of(name: str) -> tuple[str, str] | None:
    """The method and its setting that a name means, or None if it is a quantity of the wall."""
    short = library().settings.get(name)
    full = name if short is None else _SETTING + short
    if not full.startswith(_SETTING):
        return None
    method, dot, setting = full.removeprefix(_SETTING).rpartition(".")
    if not dot or not method:
        raise InputError(f'"{name}" names no setting', "Give settings.METHOD.NAME", "vary")
    return method, setting


def with_values(data: Mapping[str, Any], values: Mapping[str, Any]) -> dict[str, Any]:
    """Data of a wall with quantities changed.

    Args:
        data: format wall/1.
        values: by name; short names are friction (the default one where there are rules), proportion (block length over
            height of a running bond), inset (fraction of every interface) and direction (the live load turned by so
            many degrees, counter-clockwise).

    Raises:
        InputError: a path that leads nowhere in this wall.
    """
    changed = copy.deepcopy(dict(data))
    for name, value in values.items():
        rule = _RULES.get(name)
        if rule is not None:
            rule(changed, value)
        else:
            _put(changed, name, value)
    return changed


def has_number(data: Mapping[str, Any], name: str) -> bool:
    """Whether data of a wall have a number where a name leads; short names always mean one."""
    here: Any = data
    for field, index in _STEP.findall(name) if name not in _RULES else ():
        try:
            here = here[field or int(index)]
        except (KeyError, IndexError, TypeError):
            return False
    return name in _RULES or (isinstance(here, int | float) and not isinstance(here, bool))


def number_meant(data: Mapping[str, Any], name: str) -> str:
    """The question whether the name of another number in data of a wall was meant; empty where none is near."""
    return did_you_mean(name, [*_RULES, *islice(_numbers(data, ""), _MOST_NUMBERS)])


def _numbers(here: Any, path: str) -> Iterator[str]:
    """Paths of the numbers below a place in data of a wall."""
    if isinstance(here, dict):
        for name, value in here.items():
            yield from _numbers(value, f"{path}.{name}" if path else name)
    elif isinstance(here, list):
        for number, value in enumerate(here):
            yield from _numbers(value, f"{path}[{number}]")
    elif isinstance(here, int | float) and not isinstance(here, bool):
        yield path


def _put(data: dict[str, Any], path: str, value: Any) -> None:
    steps = [match.group(1) or int(match.group(2)) for match in _STEP.finditer(path)]
    if not steps or "".join(f"[{step}]" if isinstance(step, int) else f".{step}" for step in steps).lstrip(".") != path:
        raise InputError(f'"{path}" is no path', 'Write it as "loads.live.body[0].per_weight"', "vary")
    if steps[0] not in Wall.model_fields:
        names = [*_RULES, *library().settings, *Wall.model_fields]
        remedy = (
            f"{did_you_mean(path, names)} Give {', '.join(_RULES)} or a path into the wall, as pattern.count".strip()
        )
        raise InputError(f'a wall has no quantity "{path}"', remedy, "vary")
    here: Any = data
    for number, step in enumerate(steps[:-1]):
        following = steps[number + 1]
        if isinstance(step, str) and isinstance(here, dict):
            here = here.setdefault(step, [] if isinstance(following, int) else {})
        elif isinstance(step, int) and isinstance(here, list) and step < len(here):
            here = here[step]
        else:
            raise _nowhere(data, path)
    last: Any = steps[-1]
    if isinstance(last, str) == isinstance(here, dict) and isinstance(here, dict | list) and _there(here, last):
        here[last] = value
    else:
        raise _nowhere(data, path)


def _there(here: Any, step: str | int) -> bool:
    return isinstance(step, str) or step < len(here)


def _nowhere(data: Mapping[str, Any], path: str) -> InputError:
    remedy = f"{number_meant(data, path)} `drystone expand` shows what a wall has".strip()
    return InputError(f'"{path}" leads nowhere in this wall', remedy, "vary")


def _number(name: str, value: Any) -> float:
    """The value of a quantity that is computed with.

    Raises:
        InputError: it is no number.
    """
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise InputError(f"{json.dumps(value)} is no number", f"Give {_NUMBERS[name]}", f"vary.{name}")
    return float(value)


def _friction(data: dict[str, Any], value: Any) -> None:
    if isinstance(data.get("friction"), dict):
        data["friction"]["default"] = value
    else:
        data["friction"] = value


def _proportion(data: dict[str, Any], value: Any) -> None:
    proportion = _number("proportion", value)
    pattern = data.get("pattern")
    bonds = [pattern] if isinstance(pattern, dict) else list(pattern or [])
    bonds = [item for item in bonds if item.get("type") == "running_bond"]
    if not bonds:
        raise InputError("proportion is that of a running bond, and the wall has none", element="vary.proportion")
    for item in bonds:
        item["block_length"] = float(f"{proportion * item['block_height']:.12g}")


def _inset(data: dict[str, Any], value: Any) -> None:
    data["contact_inset"] = {"fraction": value}


def _direction(data: dict[str, Any], value: Any) -> None:
    live = (data.get("loads") or {}).get("live")
    if not live:
        raise InputError("direction is that of the live load, and the wall has none", element="vary.direction")
    turn = math.radians(_number("direction", value))
    c, s = math.cos(turn), math.sin(turn)
    for item in live.get("body", []):
        x, y = item["per_weight"]
        item["per_weight"] = [c * x - s * y, s * x + c * y]
    for item in live.get("points", []):
        x, y = item["force"]
        item["force"] = [c * x - s * y, s * x + c * y]


_NUMBERS = {
    "direction": "degrees counter-clockwise, as 0,180 for a load to the right and to the left",
    "proportion": "block length over height, as 1.5",
}
_RULES: dict[str, Callable[[dict[str, Any], Any], None]] = {
    "friction": _friction,
    "proportion": _proportion,
    "inset": _inset,
    "direction": _direction,
}
"""Short names of quantities of a wall."""
