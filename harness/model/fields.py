"""Kinds of numbers and names in files that people write, and the base of their models."""

from __future__ import annotations

from typing import Annotated

from pydantic import AfterValidator, BaseModel, BeforeValidator, ConfigDict, Field
from pydantic_core import PydanticKnownError

LARGEST = 1e15
"""Greatest size of any number of the format, whatever its unit, so that no product of a few of them overflows."""
MOST_BLOCKS = 100_000
"""Blocks of a wall at most, those that patterns make included."""
Number = Annotated[float, Field(ge=-LARGEST, le=LARGEST, strict=True)]
Point = tuple[Number, Number]
_SMALLEST = 1e-100
"""Least size of a number that has to be positive, whatever its unit, so that no quotient of a few of them overflows."""


def _can_divide(value: float) -> float:
    """A positive number.

    Raises:
        ValueError: it is as small as none.
    """
    if value < _SMALLEST:
        raise ValueError(f"{value:.3g} is as small as none: give at least {_SMALLEST:g}")
    return value


def _not_text(value: object) -> object:
    """What is given for a whole number, unless it is text, or true or false."""
    if isinstance(value, str | bool):
        raise PydanticKnownError("int_type")
    return value


Positive = Annotated[float, Field(gt=0.0, le=LARGEST, strict=True), AfterValidator(_can_divide)]
NonNegative = Annotated[float, Field(ge=0.0, le=LARGEST, strict=True)]
Coefficient = Annotated[float, Field(ge=0.0, le=1e4, strict=True)]
Angle = Annotated[float, Field(ge=0.0, lt=90.0, strict=True)]
MOST_COUNTED = 2**53
"""Largest count of an answer and its run: tables have whole numbers of 64 bits, and up to here floats are exact."""
Counted = Annotated[int, Field(ge=0, le=MOST_COUNTED)]
Cost = Annotated[float, Field(ge=0.0, allow_inf_nan=False)]
"""Seconds that a run took."""
NO_TEXT = BeforeValidator(_not_text)
"""Of a whole number, which may be written with a decimal point as programs do, but not in quotes."""
Count = Annotated[int, Field(ge=1, le=MOST_BLOCKS), NO_TEXT]
Name = Annotated[str, Field(min_length=1, max_length=200)]
Blocks = Annotated[list[Name], Field(min_length=1)]
"""Ids of the blocks that a load or a settlement is about: of none it would do nothing."""


class Strict(BaseModel):
    """Base of the format: unknown fields, NaN and infinities are refused."""

    model_config = ConfigDict(defer_build=True, extra="forbid", allow_inf_nan=False, frozen=True, populate_by_name=True)


TAGS = ONE, MANY, OBJECT, OTHER = "(one)", "(many)", "(object)", "(other)"
"""Alternatives of a field, distinguished by what is given, so that only the faults of the one meant are found.

Parentheses keep them apart from names of fields.
"""
