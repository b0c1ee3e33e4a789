"""Breakpoints of a load path: which joint changes its state there, and how, as two columns of an answer's path."""

from __future__ import annotations

from dataclasses import dataclass

from harness.model.assembly import IntArray

JOINT, CHANGE = "changing_joint", "change"
"""Names of the columns: index of the interface, place in `CHANGES`; both are `NO_JOINT` where nothing changes."""
CHANGES = ("opens", "closes", "slides", "sticks")
"""What a joint does at a breakpoint, at one of its points at least."""
NO_JOINT = -1


@dataclass(frozen=True)
class Breakpoint:
    """A point of a path where a joint changes its state.

    Attributes:
        place: number of the point in the path.
        joint: index of the interface.
        change: one of `CHANGES`.
    """

    place: int
    joint: int
    change: str


def breakpoints(path: dict[str, list[float]], n_interfaces: int) -> list[Breakpoint]:
    """The breakpoints that a path names, those of joints that a wall of so many interfaces has."""
    columns = zip(path.get(JOINT, ()), path.get(CHANGE, ()), strict=False)
    return [
        Breakpoint(place, int(joint), CHANGES[int(change)])
        for place, (joint, change) in enumerate(columns)
        if 0 <= joint < n_interfaces and 0 <= change < len(CHANGES)
    ]


def of_whole_wall(path: dict[str, list[float]], interfaces: IntArray) -> dict[str, list[float]]:
    """A path of a component as one of the wall, in which its interfaces (k,) have other indices."""
    if JOINT not in path:
        return path
    return path | {JOINT: [joint if joint < 0 else float(interfaces[int(joint)]) for joint in path[JOINT]]}
