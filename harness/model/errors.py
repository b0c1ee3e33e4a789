"""Errors a user may meet: each names the file, the element, what is wrong and what would be right."""

from __future__ import annotations

import importlib
import re
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from difflib import get_close_matches
from functools import lru_cache
from itertools import accumulate
from typing import Any, TypeVar

Item = TypeVar("Item")
Made = TypeVar("Made")

_MOST_FAULTS = 100
"""Lines about one file that are printed; the rest are counted."""
_LIKE_MEANING = {"polygon": ("vertices", "corners", "points", "coordinates", "coords", "outline", "shape")}
"""Words of other formats for fields of a wall."""
_MOST_ALIKE = 3
"""Elements with the same fault that are named one by one."""
MOST_NAMED = 20
"""Names that a sentence lists."""
MOST_WORDED = 500
"""Faults of one input that are put into words; the rest are counted."""
_MOST_HINTED = 20
"""Unknown names of one kind for which one that may have been meant is looked for."""
_MOST_COMPARED = 2000
"""Names that an unknown one is compared with, in the search for the one that was meant."""
_MOST_LETTERS = 500_000
"""Pairs of letters that are compared in that search, a tenth of a second of work."""


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
    """Several faults of one input, reported together in the order of the file, so that one round mends them all.

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
        count = len(self.faults) + self.more + sum(fault.more for fault in self.faults)
        if count == 1:
            return str(self.faults[0])
        head = f"{visible(self.source)}: {count} faults" if self.source else f"{count} faults"
        alike: dict[tuple[object, ...], list[InputError]] = {}
        for number, fault in enumerate(self.faults):
            same = (fault.source, fault.problem, fault.remedy, number if fault.spot or not fault.element else None)
            alike.setdefault(same, []).append(fault)
        lines = [line for faults in alike.values() for line in self._lines(faults)]
        more = [f"and {len(lines) - _MOST_FAULTS} lines more"] if len(lines) > _MOST_FAULTS else []
        more += [f"and {self.more} faults more"] * (self.more > 0)
        return "\n  ".join([head, *lines[:_MOST_FAULTS], *more])

    def _lines(self, alike: Sequence[InputError]) -> list[str]:
        """Faults that differ by their element alone: a line each, or one line where there are many."""
        source = "" if alike[0].source == self.source else alike[0].source
        if len(alike) <= _MOST_ALIKE:
            return [visible(_sentence(fault, source)) for fault in alike]
        places = first_few([fault.element for fault in alike], _MOST_ALIKE)
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


@contextmanager
def in_file(source: str) -> Iterator[None]:
    """Errors within are about this file, but those that name another.

    Raises:
        InputError: that was raised within, with its file.
    """
    try:
        yield
    except InputError as error:
        error.source = error.source or source
        raise


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


def of_those_there(word: str, known: Iterable[str]) -> str:
    """Which of the known words was meant by one that is not among them, and all there are: a remedy."""
    names = list(known)
    return f"{did_you_mean(word, names)} There are: {first_few(names, MOST_NAMED)}".strip()


@lru_cache(maxsize=128)  # a field that is misspelled is so in all blocks
def _did_you_mean(word: str, known: tuple[str, ...]) -> str:
    names = {name.lower(): name for name in known}
    names |= {other: names[name] for name, others in _LIKE_MEANING.items() if name in names for other in others}
    letters = accumulate((len(name) * len(word) for name in names), initial=0)
    compared = [name for name, before in zip(names, letters, strict=False) if before <= _MOST_LETTERS]
    near = get_close_matches(word.lower(), compared, n=1, cutoff=0.6)
    return f'Did you mean "{names[near[0]]}"?' if near else ""


class Hints:
    """Which of some names may have been meant by names that are not among them; looked for while they are few.

    Args:
        known: the names there are.
    """

    def __init__(self, known: Iterable[str]) -> None:
        self._all = sorted(known)
        self._left = _MOST_HINTED

    def of(self, word: str) -> str:
        """The question whether another name was meant; empty where none is near, or after many such words."""
        self._left -= 1
        return did_you_mean(word, self._all[:_MOST_COMPARED]) if self._left >= 0 else ""

    def there(self, most: int) -> str:
        """So many of the names in words."""
        return first_few(self._all, most)


def uncounted(count: int, more: str, element: str) -> InputError:
    """One fault that stands for many of a kind: how many, what they are in words, what they are about."""
    fault = InputError(f"{count:,} more {more}", "Mend those listed first", element)
    fault.more = count - 1
    return fault


def without_numbers(text: str) -> str:
    """What texts have in common that differ in their numbers alone: the kind of what they say."""
    return re.sub(r"[-+]?[0-9][0-9.,]*(e[-+]?[0-9]+)?", "#", text)


def as_sentence(text: str) -> str:
    """A text that begins with a capital letter and ends in one full stop, so that another sentence may follow."""
    own = text.rstrip(".")
    return f"{own[:1].upper()}{own[1:]}."


def first_few(names: Sequence[str], most: int) -> str:
    """So many names in words, and how many more there are."""
    more = f" and {len(names) - most} more" if len(names) > most else ""
    return ", ".join(names[:most]) + more


def optional(package: str, extra: str, part: str) -> Any:
    """A package that an extra installs.

    Args:
        package: its name for Python.
        extra: of drystone that brings it.
        part: what needs it, as the error names it: "method scip".

    Raises:
        MissingPackage: it is not installed.
    """
    try:
        return importlib.import_module(package)
    except ImportError as error:
        raise MissingPackage(
            f"it needs the package {package} ({error})",
            f'Install it with pip install "drystone[{extra}]", in a clone with pip install -e ".[{extra}]"',
            part,
        ) from error
