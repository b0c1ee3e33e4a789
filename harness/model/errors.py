"""Errors a user may meet: each names the file, the element, what is wrong and what would be right."""

from __future__ import annotations

from collections.abc import Sequence


class InputError(Exception):
    """Something a user gave cannot be used. The command line prints it and exits with code 2.

    Args:
        problem: what is wrong.
        remedy: what would be right; may be empty where the problem says it.
        element: the block, interface, load or field concerned; may be empty.
        source: the file concerned; may be empty and filled in later.
    """

    def __init__(self, problem: str, remedy: str = "", element: str = "", source: str = "") -> None:
        self.problem, self.remedy, self.element, self.source = problem, remedy, element, source
        super().__init__(problem)

    def __str__(self) -> str:
        head = ": ".join(part for part in (self.source, self.element) if part)
        text = f"{head}: {self.problem}" if head else self.problem
        return f"{text}. {self.remedy}" if self.remedy else text

    def __reduce__(self) -> tuple[type[InputError], tuple[str, str, str, str]]:
        return InputError, (self.problem, self.remedy, self.element, self.source)


def first_few(names: Sequence[str], most: int) -> str:
    """So many names in words, and how many more there are."""
    more = f" and {len(names) - most} more" if len(names) > most else ""
    return ", ".join(names[:most]) + more
