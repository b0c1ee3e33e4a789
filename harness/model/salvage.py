"""What can be looked at of a wall file with faults: the fields that are at fault are left out, the rest is read."""

from __future__ import annotations

from typing import Any

from pydantic import ValidationError

from harness.model.errors import InputError
from harness.model.fields import TAGS
from harness.model.reading import parse_wall
from harness.model.wall import Wall


def salvaged(data: Any, source: str) -> tuple[Wall | None, tuple[InputError, ...]]:
    """A wall from JSON data without the parts that are at fault, and the faults.

    A block loses the field at fault, or is left out where it cannot be without it; a load, an interface or a rule is
    left out as a whole.

    Returns:
        The wall, None where no wall is left; the faults of the file, none if it has none.
    """
    try:
        return parse_wall(data, source), ()
    except InputError as error:
        faults = error.faults
        if error.more:
            faults += (InputError(f"it has {error.more:,} more faults", "Mend those listed first", source=source),)
    rest = _copied(data)
    if not isinstance(rest, dict) or rest.get("format") != "wall/1":
        return None, faults
    while True:
        try:
            wall = Wall.model_validate(rest)
            return (wall if wall.blocks or wall.pattern else None), faults
        except ValidationError as error:
            places = {_present(rest, _place(rest, fault["loc"])) for fault in error.errors()}
            if not all(_left_out(rest, place) for place in sorted(places, key=_in_the_file, reverse=True)):
                return None, faults


def _copied(data: Any) -> Any:
    """A copy of JSON data, in a fifth of the time of `copy.deepcopy`, which remembers every object."""
    if isinstance(data, dict):
        return {name: _copied(item) for name, item in data.items()}
    return [_copied(item) for item in data] if isinstance(data, list) else data


_Place = tuple[int | str, ...]


def _in_the_file(place: _Place) -> list[str]:
    """A key of the order of the file: what is left out from its end does not shift what is still to be left out."""
    return [str(part).zfill(9) for part in place]


def _place(data: Any, location: _Place) -> _Place:
    """The part that is left out for a fault: a field of a block, an item of another list, or a field of the wall."""
    here: Any = data
    place: list[int | str] = []
    for number, part in enumerate(location):
        if part in TAGS or (isinstance(here, dict) and part not in here and number < len(location) - 1):
            continue  # the name of an alternative, not of a field
        place.append(part)
        here = here[part] if _has(here, part) else None
        if isinstance(part, int) and place[0] != "blocks":
            break
    return tuple(place[:3] if place[:1] == ["blocks"] else place)


def _present(data: Any, place: _Place) -> _Place:
    """The part, or that which it is missing in."""
    here = data
    for number, part in enumerate(place):
        if not _has(here, part):
            return place[:number]
        here = here[part]
    return place


def _left_out(data: Any, place: _Place) -> bool:
    """Leave a part out of the data; False if there is nothing left to leave out."""
    if not place:  # the wall gives no friction, or it gives two: the geometry does not depend on it
        amiss = "friction" not in data or "friction_angle" in data
        data.pop("friction_angle", None)
        data.setdefault("friction", 1.0)
        return amiss
    here = data
    for part in place[:-1]:
        here = here[part]
    del here[place[-1]]
    return True


def _has(here: Any, part: int | str) -> bool:
    if isinstance(here, dict):
        return part in here
    return isinstance(here, list) and isinstance(part, int) and part < len(here)
