"""What a program says of itself (`prog --describe`, format `describe/1`), and settings from a JSON Schema.

What it does not take is known before it runs, so that walls with it are refused by name.
"""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import BaseModel, ConfigDict, Field, create_model, model_validator

from harness.model.errors import InputError
from harness.model.method import Settings, Traits

Feature = Literal["dilatancy", "strength"]
NAME = r"[a-z0-9][a-z0-9._-]{0,59}"
_KINDS: dict[str, type] = {"number": float, "integer": int, "boolean": bool, "string": str}
"""Types of settings by their names in JSON Schema."""


class ProgramTraits(BaseModel):
    """Those of `Traits` that a program may claim: what its numbers are, and how they are drawn."""

    model_config = ConfigDict(defer_build=True, extra="forbid", allow_inf_nan=False, frozen=True)
    caption: str = Field("", description="what its multiplier is, in a few words")
    brackets: bool = Field(False, description="its multiplier is measured between a load held and one that moved")
    accuracy: Annotated[float, Field(gt=0.0, lt=1.0)] = Field(5e-3, description="relative, of a measured multiplier")
    seeks_least: bool = Field(False, description="it looks for the least collapse state")
    bounds_above: bool = Field(False, description="no wall bears more than its multiplier: the associated maximum")
    elastic: bool = Field(False, description="its joints are springs, loaded from the dead load on")
    colour: str = Field("", pattern="^(#[0-9a-f]{6})?$")
    marker: str = ""
    line: Literal["solid", "dashed", "dotted", "dashdot"] = "solid"


class SettingSchema(BaseModel):
    """One setting, in the words of JSON Schema."""

    model_config = ConfigDict(defer_build=True, extra="forbid", allow_inf_nan=False, frozen=True)
    type: Literal["number", "integer", "boolean", "string"]
    default: bool | int | float | str
    description: str = ""
    minimum: float | None = None
    maximum: float | None = None
    enum: tuple[bool | int | float | str, ...] = ()


class About(BaseModel):
    """What is said of a program, by itself or in `methods.toml`."""

    model_config = ConfigDict(defer_build=True, extra="forbid", allow_inf_nan=False, frozen=True)
    title: str = Field("", description="a few words for the head of a column")
    family: str = Field("", pattern=f"^({NAME})?$", description="groups methods in the report; else its name")
    version: str = ""
    licence: str = ""
    tolerance: Annotated[float, Field(gt=0.0, le=1e-2)] = Field(
        1e-7, description="largest relative residual that the judge may find in its answers"
    )
    traits: ProgramTraits = Field(default_factory=ProgramTraits)
    takes: tuple[Feature, ...] = Field((), description="features of walls besides dry joints of constant friction")
    most_blocks: Annotated[int, Field(ge=1)] | None = Field(
        None, description="free blocks of the largest wall it takes"
    )

    @property
    def all_traits(self) -> Traits:
        """Its traits as the engine has them, what it takes among them."""
        taken = {"any_dilatancy": "dilatancy" in self.takes, "any_strength": "strength" in self.takes}
        return Traits.model_validate(self.traits.model_dump() | taken)


class Description(About):
    """What `prog --describe` prints, format `describe/1`."""

    format: Literal["describe/1"]
    name: str = Field(pattern=f"^{NAME}$")
    settings: dict[str, SettingSchema] = Field(default_factory=dict, description="by name")

    @model_validator(mode="after")
    def _settings_that_can_be(self) -> Description:
        for name, schema in self.settings.items():
            if not name.isidentifier() or name.startswith(("_", "model_")):
                raise ValueError(f'"{name}" is no name of a setting: give letters, digits and underscores')
            if hasattr(Settings, name):
                raise ValueError(f'"{name}" is no name of a setting: pydantic has it for itself')
            if not isinstance(schema.default, _KINDS[schema.type]) and schema.type != "number":
                raise ValueError(f'the default of the setting "{name}" is no {schema.type}')
        return self


def settings_class(name: str, schemas: dict[str, SettingSchema]) -> type[Settings]:
    """The class of settings that schemas describe; each is checked before a program is started.

    Raises:
        InputError: a default that its own schema does not allow.
    """
    fields: dict[str, Any] = {}
    for setting, schema in schemas.items():
        kind: Any = Literal[schema.enum] if schema.enum else _KINDS[schema.type]
        bounds = {"ge": schema.minimum, "le": schema.maximum}
        limits: dict[str, Any] = {key: value for key, value in bounds.items() if value is not None and not schema.enum}
        fields[setting] = (kind, Field(schema.default, description=schema.description, validate_default=True, **limits))
    made = create_model(f"{name}Settings", __base__=Settings, **fields)
    try:
        made()
    except ValueError as error:
        problem = str(error).splitlines()[2:3] or [str(error)]
        raise InputError(f"the default of a setting is none of its values ({problem[0].strip()})", "", name) from None
    return made
