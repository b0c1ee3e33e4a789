"""A case: a wall with what is known of it. One folder, `case.toml` beside `wall.json`."""

from __future__ import annotations

from dataclasses import dataclass, replace
from enum import StrEnum
from functools import cached_property
from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import Field, StrictBool, model_validator

from harness.model.assembly import Assembly
from harness.model.build import Built, build
from harness.model.content import hash_of
from harness.model.errors import InputError, in_file
from harness.model.fields import Strict
from harness.model.json_text import read_json, read_toml
from harness.model.method_registry import method_names
from harness.model.reading import parse_wall, read_document, validate
from harness.model.wall import Wall

_LARGEST_CASE_FILE = 2**20
"""Bytes of a case.toml at most: the library's longest has 5,046."""


class ReferenceType(StrEnum):
    """Where a reference value comes from, and so what a disagreement would mean."""

    EXACT = "exact"
    """A closed form, or proved: verification."""
    BOUND = "bound"
    """A value no right answer may pass: verification."""
    PUBLISHED = "published"
    """Computed by others: benchmark."""
    MEASURED = "measured"
    """Found by an experiment: validation."""
    REGRESSION = "regression"
    """Our own value of an earlier release."""


class Reference(Strict):
    """One thing that is known of a case.

    `relation` says how an answer must stand to `value`: equal (within the tolerance), at_most, at_least, inside
    (a pair: the whole bracket, or the multiplier), or contains (the bracket must contain the value).
    """

    id: Annotated[str, Field(min_length=1, description="its name within the case")]
    type: ReferenceType = Field(description="exact, bound, published, measured or regression")
    quantity: Annotated[
        str, Field(description='"multiplier", "finding", "blocks", "interfaces", "unknowns", a detail')
    ] = "multiplier"
    relation: Literal["equal", "at_most", "at_least", "inside", "contains"] = Field(
        "equal", description="relation of an answer to the value; inside: a pair; contains: the bracket must"
    )
    value: float | tuple[float, float] | str = Field(description="a number, a pair for inside, or a finding")
    tolerance: Annotated[float, Field(ge=0.0, description="absolute")] = 0.0
    tolerance_reason: str = Field("", description="the reason for the tolerance")
    applies_to: Annotated[list[str], Field(min_length=1, description="names of methods")]
    gate: StrictBool = Field(False, description="a violation makes `drystone check` fail")
    tier: Literal["quick", "full"] = Field("quick", description="the tier of `drystone check` that runs it")
    settings: dict[str, Any] = Field(default_factory=dict, description="method settings for the reference")
    source: Annotated[str, Field(min_length=1, description="author, year, and where in it")]
    requirement: Annotated[str, Field(min_length=1, description="one sentence for readers")]

    @model_validator(mode="after")
    def _fitting_value(self) -> Reference:
        if (self.relation == "inside") != isinstance(self.value, tuple):
            raise ValueError('relation "inside" goes with a pair of values, the others with one')
        if isinstance(self.value, str) and self.relation != "equal":
            raise ValueError("a word is compared by relation equal")
        return self


class Erratum(Strict):
    """Something the source leaves open, or states otherwise than we find."""

    text: Annotated[str, Field(min_length=1)]


class CaseFile(Strict):
    """The content of `case.toml`."""

    id: Annotated[str, Field(pattern=r"^[a-z0-9][a-z0-9-]*$", description="the name of its folder, which users type")]
    title: Annotated[str, Field(min_length=1, description="a few words for headings")]
    summary: str = Field("", description="what it shows, for the report")
    kind: Literal["multiplier", "stability"] = Field("multiplier", description="multiplier or stability")
    wall: str = Field("wall.json", description="file of the wall, in the folder")
    suites: list[str] = Field(default_factory=list, description='suites it belongs to, as "small"')
    source: Annotated[str, Field(min_length=1, description="where the wall comes from")]
    methods: list[str] | None = Field(None, description="methods that are run on it; the suite's otherwise")
    errata: list[Erratum] = Field(default_factory=list, description="gaps and errors of the source")
    references: list[Reference] = Field(default_factory=list, description="reference values")

    @model_validator(mode="after")
    def _one_id_each(self) -> CaseFile:
        ids = [reference.id for reference in self.references]
        twice = next((name for name in ids if ids.count(name) > 1), None)
        if twice is not None:
            raise ValueError(f'two references are called "{twice}"; give each an id of its own')
        return self


@dataclass(frozen=True)
class Case:
    """A case as the engine runs it.

    Attributes:
        file: what `case.toml` says.
        wall: the wall.
        origin: the path of the wall's file.
        notes: what a person should hear about how the case was found.
        wall_id: id of the wall of which this is one of several load cases; empty if it is the only one.
        load_case: name of this load case; empty if it is the only one.
        load_place: where loads that travel stand in it, as "axle on v5 at (-1.03, 1.94) m"; empty without any.
        argument: what names the wall to a command: the id of the case, or its file; empty where none has this load.
    """

    file: CaseFile
    wall: Wall
    origin: str
    notes: tuple[str, ...] = ()
    wall_id: str = ""
    load_case: str = ""
    load_place: str = ""
    argument: str = ""

    @cached_property
    def built(self) -> Built:
        """The wall's assembly, explicit form and warnings."""
        with in_file(self.origin):
            return build(self.wall, self.file.id)

    @property
    def assembly(self) -> Assembly:
        """The numeric view of the wall."""
        return self.built.assembly

    @cached_property
    def content(self) -> str:
        """Hash of what decides an answer about it."""
        return hash_of(self.wall)

    @property
    def load_in_words(self) -> str:
        """The load case and where loads that travel stand in it; empty if it is the only one."""
        return f"{self.load_case} ({self.load_place})" if self.load_place else self.load_case

    @property
    def id(self) -> str:
        """The name users type."""
        return self.file.id

    @property
    def warnings(self) -> tuple[str, ...]:
        """What a person should hear about the wall, and about references that no installed method can be held to."""
        known = method_names()
        unknown = [
            f'reference "{item.id}" applies to "{name}", which is not installed: it is not compared'
            for item in self.file.references
            for name in item.applies_to
            if name not in known
        ]
        return (*self.notes, *self.built.warnings, *unknown)

    def called(self, name: str) -> Case:
        """The same case under another id."""
        return replace(self, file=self.file.model_copy(update={"id": name}))


def read_case(folder: Path) -> Case:
    """The case of a folder.

    Raises:
        InputError: naming the file and the element.
    """
    path = folder / "case.toml"
    if not path.exists():
        raise InputError("there is no case.toml", "A case is a folder with case.toml and wall.json", source=str(folder))
    file = validate(CaseFile, read_toml(path, _LARGEST_CASE_FILE), str(path))
    if file.id != folder.name:
        raise InputError(f'id is "{file.id}" in a folder called "{folder.name}"', "Give both one name", "id", str(path))
    wall_path = folder / file.wall
    wall = parse_wall(read_json(wall_path), str(wall_path))
    if file.kind == "multiplier" and wall.loads.live is None and not wall.load_case_fields:
        raise InputError(
            "a multiplier is asked for and there is no live load",
            'Give loads.live, or set kind = "stability" in case.toml',
            "loads.live",
            str(wall_path),
        )
    return Case(file, wall, str(wall_path), argument=file.id)


def id_of(words: str) -> str:
    """The id that words make: small letters and digits, everything else a hyphen."""
    letters = (letter if letter.isalnum() and letter.isascii() else "-" for letter in words.lower())
    return "".join(letters).strip("-") or "wall"


def case_of_wall(path: Path) -> Case:
    """A case without references from a wall file that stands alone.

    Raises:
        InputError: naming the file and the element.
    """
    wall = parse_wall(read_document(path), str(path))
    file = CaseFile(
        id=id_of(path.stem), title=wall.title or path.stem, source=str(wall.metadata.get("source", "the user"))
    )
    return Case(file, wall, str(path), argument=path.name)


def shipped_cases() -> Path:
    """The folder of the cases that come with Drystone."""
    import importlib.util

    spec = importlib.util.find_spec("cases")
    assert spec is not None
    assert spec.submodule_search_locations is not None
    return Path(next(iter(spec.submodule_search_locations)))


def case_folders(roots: list[Path]) -> dict[str, Path]:
    """Folders with a `case.toml` below the roots, by case id, in alphabetical order.

    Raises:
        InputError: a root that is no folder, or one id in two of them.
    """
    found: dict[str, Path] = {}
    for root in roots:
        if not root.is_dir():
            raise InputError("it is not a folder", "Name a folder that holds case folders", source=str(root))
        for path in sorted(root.glob("*/case.toml")):
            name = path.parent.name
            if name in found:
                raise InputError(f'the case "{name}" is also in {found[name].parent}', "Rename one", source=str(root))
            found[name] = path.parent
    return dict(sorted(found.items()))
