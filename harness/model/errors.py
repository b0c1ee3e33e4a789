"""Errors a user may meet: each names the file, the element, what is wrong and what would be right."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from difflib import get_close_matches
from functools import lru_cache
from typing import TypeVar

Item = TypeVar("Item")
Made = TypeVar("Made")

MOST_FAULTS = 100
"""Lines about one file that are told; the rest are counted."""
LIKE_MEANING = {"polygon": ("vertices", "corners", "points", "coordinates", "coords", "outline", "shape")}
"""Words of other formats for fields of a wall."""
MOST_ALIKE = 3
"""Elements with the same fault that are told one by one."""
MOST_NAMED = 20
"""Names that a sentence lists."""
MOST_WORDED = 500
"""Faults of one input that are put into words; the rest are counted."""


def visible(text: str) -> str:
    """Text of any origin with control characters, line ends, direction marks and lone surrogates spelled out.

    What a file says is shown and never obeyed: an escape sequence in the name of a block would otherwise reach the
    terminal, and a line end would make one message look like two.
    """
    return "".join(letter if letter.isprintable() else letter.encode("unicode_escape").decode() for letter in text)


@dataclass(frozen=True)
class Spot:
    """Where in the plane of a wall something is wrong.

    Attributes:
        blocks: names of the blocks concerned.
        at: a point (x, y) of it [length]; None where the blocks are the place.
        size: of what is wrong: depth of an overlap, width of a gap [length]; None where it has none.
    """

    blocks: tuple[str, ...]
    at: tuple[float, float] | None = None
    size: float | None = None


class InputError(Exception):
    """Something a user gave cannot be used. The command line prints it and exits with code 2.

    Args:
        problem: what is wrong.
        remedy: what would be right; may be empty where the problem says it.
        element: the block, interface, load or field concerned; may be empty.
        source: the file concerned; may be empty and filled in later.
        spot: where in the plane of the wall; None where it is not in the geometry.
    """

    def __init__(
        self, problem: str, remedy: str = "", element: str = "", source: str = "", spot: Spot | None = None
    ) -> None:
        self.problem, self.remedy, self.element, self.source, self.spot = problem, remedy, element, source, spot
        super().__init__(problem)

    more = 0
    """Faults besides, which are not put into words."""

    @property
    def faults(self) -> tuple[InputError, ...]:
        """The faults one by one; a plain error is one fault."""
        return (self,)

    def __str__(self) -> str:
        return visible(_sentence(self, self.source))

    def __reduce__(self) -> tuple[type[InputError], tuple[object, ...]]:
        return InputError, (self.problem, self.remedy, self.element, self.source, self.spot)


class MissingPackage(InputError):
    """A package that an extra brings is not installed; the problem names it."""


class InputFaults(InputError):
    """Several faults of one input, told together in the order of the file, so that one round mends them all.

    Args:
        faults: at least one; those without a source take that of the whole.
        source: the file concerned; may be empty and filled in later.
        more: faults that there are besides.
    """

    def __init__(self, faults: Iterable[InputError], source: str = "", more: int = 0) -> None:
        self._faults = tuple(part for fault in faults for part in fault.faults)
        self.more = more
        first = self._faults[0]
        super().__init__(first.problem, first.remedy, first.element, source or first.source)

    @property
    def faults(self) -> tuple[InputError, ...]:
        """The faults one by one, each with its source."""
        for fault in self._faults:
            fault.source = fault.source or self.source
        return self._faults

    def __str__(self) -> str:
        count = len(self.faults) + self.more
        if count == 1:
            return str(self.faults[0])
        head = f"{visible(self.source)}: {count} faults" if self.source else f"{count} faults"
        alike: dict[tuple[object, ...], list[InputError]] = {}
        for number, fault in enumerate(self.faults):
            same = (fault.source, fault.problem, fault.remedy, number if fault.spot or not fault.element else None)
            alike.setdefault(same, []).append(fault)
        lines = [line for faults in alike.values() for line in self._lines(faults)]
        more = [f"and {len(lines) - MOST_FAULTS} lines more"] if len(lines) > MOST_FAULTS else []
        more += [f"and {self.more} faults more"] * (self.more > 0)
        return "\n  ".join([head, *lines[:MOST_FAULTS], *more])

    def _lines(self, alike: Sequence[InputError]) -> list[str]:
        """Faults that differ by their element alone: a line each, or one line where there are many."""
        source = "" if alike[0].source == self.source else alike[0].source
        if len(alike) <= MOST_ALIKE:
            return [visible(_sentence(fault, source)) for fault in alike]
        places = first_few([fault.element for fault in alike], MOST_ALIKE)
        return [visible(_sentence(InputError(alike[0].problem, alike[0].remedy, places), source))]

    def __reduce__(self) -> tuple[type[InputError], tuple[object, ...]]:
        return InputFaults, (self._faults, self.source, self.more)


def _sentence(error: InputError, source: str) -> str:
    head = ": ".join(part for part in (source, error.element) if part)
    place = f", near ({error.spot.at[0]:.6g}, {error.spot.at[1]:.6g})" if error.spot and error.spot.at else ""
    text = f"{head}: {error.problem}{place}" if head else f"{error.problem}{place}"
    return f"{text}. {error.remedy}" if error.remedy else text


def raise_faults(faults: Sequence[InputError], source: str = "", more: int = 0) -> None:
    """Raise what was found, one error as itself and several together; nothing if there are none.

    Args:
        faults: that were put into words; more: how many there are besides.
        source: the file concerned.

    Raises:
        InputError: the one fault, or `InputFaults` of all.
    """
    if len(faults) == 1 and not more:
        faults[0].source = faults[0].source or source
        raise faults[0]
    if faults:
        raise InputFaults(faults, source, more)


def of_each(make: Callable[[Item], Made], items: Iterable[Item]) -> list[Made]:
    """What is made of every item; the faults of all items are told together.

    Raises:
        InputError: the one fault, or `InputFaults` of all.
    """
    faults, made = sorted_out(make, items)
    raise_faults(faults)
    return list(made.values())


def sorted_out(make: Callable[[Item], Made], items: Iterable[Item]) -> tuple[list[InputError], dict[int, Made]]:
    """The faults of items that nothing can be made of, and what is made of the others, by their numbers."""
    faults: list[InputError] = []
    made: dict[int, Made] = {}
    for number, item in enumerate(items):
        try:
            made[number] = make(item)
        except InputError as error:
            faults.extend(error.faults)
    return faults, made


def did_you_mean(word: str, known: Iterable[str]) -> str:
    """The question whether a known word that is near, or of like meaning, was meant; empty where none is."""
    return _did_you_mean(word, tuple(known))


@lru_cache(maxsize=128)  # a field that is misspelled is so in all blocks
def _did_you_mean(word: str, known: tuple[str, ...]) -> str:
    names = {name.lower(): name for name in known}
    names |= {other: names[name] for name, others in LIKE_MEANING.items() if name in names for other in others}
    near = get_close_matches(word.lower(), names, n=1, cutoff=0.6)
    return f'Did you mean "{names[near[0]]}"?' if near else ""


def first_few(names: Sequence[str], most: int) -> str:
    """So many names in words, and how many more there are."""
    more = f" and {len(names) - most} more" if len(names) > most else ""
    return ", ".join(names[:most]) + more
