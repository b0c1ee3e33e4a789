"""Words of the case library as a whole (`cases/library.toml`): methods asked by default, families and their titles."""

from __future__ import annotations

from functools import cache
from typing import Annotated, TypeVar

from pydantic import Field

from harness.model.case import shipped_cases
from harness.model.fields import Strict
from harness.model.json_text import read_toml
from harness.model.reading import validate

Words = TypeVar("Words", bound=Strict)


class _DefaultMethods(Strict):
    """Names of the methods that are asked where nobody names any."""

    compare: Annotated[tuple[str, ...], Field(min_length=1, description="of a comparison, besides those of references")]
    sweep: Annotated[tuple[str, ...], Field(min_length=1, description="of a study")]
    one: str = Field(description="for a single answer")
    quick: str = Field(description="for many walls at once")


class Library(Strict):
    """The content of `library.toml`."""

    families: dict[str, str] = Field(description="titles of families, in the order of tables")
    methods: _DefaultMethods
    settings: dict[str, str] = Field(description="METHOD.NAME of settings that studies call by a short name")

    def family_title(self, family: str, method: str) -> str:
        """The family's name for a heading, whatever word a third party's method uses."""
        return self.families.get(family, family or method)

    def order(self, method: str, family: str) -> tuple[int, bool, str]:
        """Sort key of methods: families in the order of the file, a family's main method first."""
        known = list(self.families)
        return (known.index(family) if family in known else len(known), method != family, method)


def shipped_words(kind: type[Words], name: str) -> Words:
    """The content of a TOML file that stands beside the cases."""
    path = shipped_cases() / name
    return validate(kind, read_toml(path), str(path))


@cache
def library() -> Library:
    """The library's own words, read once."""
    return shipped_words(Library, "library.toml")
