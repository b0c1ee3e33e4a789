"""From a drawing to a wall: which file is read how, what layers mean, which stones are supports; with an account."""

from __future__ import annotations

import contextlib
import io
import math
import warnings
from collections import Counter
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any, Literal

import numpy as np
import shapely
from pydantic import BeforeValidator, Field

from harness.formats.drawing import LINES, Asked, Drawing, Outline
from harness.formats.places import across, down_of, refuse_degrees, refuse_frame
from harness.formats.registry import format_read
from harness.model.assembly import FloatArray
from harness.model.errors import InputError, first_few, in_file
from harness.model.fields import Coefficient, Name, NonNegative, Point, Positive, Strict
from harness.model.friction_fields import FrictionRule
from harness.model.json_text import read_toml
from harness.model.reading import parse_wall, validate
from harness.model.units import METRES, LengthUnit
from harness.model.wall import Wall

_FRICTION = 0.6
_UNIT_WEIGHT = 20.0
"""Taken where nothing is said: round values of dry stone [-, kN/m3], and shown as assumed with the answer."""


_FINE = 0.02
"""Steps of rounding up to this part of a stone's size are taken for such; coarser ones are the module of the bond."""
_MOST = 0.95
"""Part of the coordinates that lie on a grid when they are taken for rounded; mended corners lie beside it."""
_NEAR = 0.1
"""Stones nearer than this part of a stone's size are likely to be in contact: joints of dry masonry are 5 to 25 mm
wide, and its stones 75 to 500 mm high."""


_MOST_REASON = 200
"""Letters of what a parser says is wrong."""
_MOST_TOLD = 8
"""Kinds of things left out that a warning names; the account has all."""


def _scale(value: Any) -> Any:
    """The scale of a drawing from a number, or from words as "1:50"."""
    if not isinstance(value, str):
        return value
    one, _, many = value.partition(":")
    try:
        return float(many) / float(one) if many else float(one)
    except (ValueError, ZeroDivisionError):
        raise ValueError('a scale is a number or "1:50"') from None


class Layer(Strict):
    """What the stones of a layer are."""

    use: Literal["stone", "support", "hole", "ignore"] = "stone"
    material: str = "stone"
    groups: list[Name] = Field(default_factory=list)
    unit_weight: NonNegative | None = Field(None, description="[kN/m3]")


class Mapping(Strict):
    """What a drawing does not say, as a small TOML file beside it."""

    title: str = ""
    units: LengthUnit | None = Field(None, description="of the drawing; else what the drawing declares, else metres")
    scale: Annotated[Positive, BeforeValidator(_scale)] | None = Field(
        None, description='lengths of the wall in lengths of the drawing, as 50 or "1:50"; 1 if absent'
    )
    accuracy: Positive | None = Field(None, description="of curves [m]; one millimetre if absent")
    friction: Coefficient | None = Field(None, description="coefficient of friction, tan(phi)")
    rules: list[FrictionRule] = Field(default_factory=list, description="friction of head or bed joints, of materials")
    unit_weight: NonNegative | None = Field(None, description="[kN/m3]")
    thickness: Positive | None = Field(None, description="out of plane [length of the wall]")
    tolerance: Positive | None = Field(None, description="greatest gap of a joint [length of the wall]")
    supports: str | None = Field(None, description='"lowest-course", "ground-line Y", "layer NAME" or "drawn"')
    live: Point | None = Field(None, description="live load as a multiple (x, y) of every weight")
    gravity: Point | None = Field(None, description="as a multiple (x, y) of every weight, of a drawing that is turned")
    layers: dict[str, Layer] = Field(default_factory=dict)
    plane: Literal["xz", "yz", "xy"] | None = Field(
        None, description="that solids are cut by, xz if absent; that polylines of a DXF lie in, xy if absent"
    )
    at: float | None = Field(None, description="where the plane lies on the third axis; the middle if absent")


@dataclass(frozen=True)
class Imported:
    """A wall from a drawing.

    Attributes:
        wall: the wall.
        account: what was read, left out and taken, sentence by sentence; what of it a reader of the answer should
            hear are the doubts of the wall.
    """

    wall: Wall
    account: tuple[str, ...]


def read_mapping(path: Path) -> Mapping:
    """The mapping of a TOML file.

    Raises:
        InputError: naming the file and the field.
    """
    return validate(Mapping, read_toml(path), str(path))


def mapping_beside(path: Path) -> Mapping:
    """The mapping of the TOML file of the drawing's name beside it, or an empty one."""
    beside = path.with_suffix(".toml")
    return read_mapping(beside) if beside.is_file() else Mapping()


def import_drawing(path: Path, mapping: Mapping | None = None) -> Imported:
    """The wall that a drawing shows.

    Args:
        path: a drawing of a format that `harness.formats.registry` reads.
        mapping: what the drawing does not say; of the file beside it if None.

    Raises:
        InputError: naming the file, what is wrong and what would be right.
    """
    chosen = mapping_beside(path) if mapping is None else mapping
    with in_file(str(path)):
        return _imported(path, chosen, _read(path, chosen))


def _imported(path: Path, chosen: Mapping, drawing: Drawing) -> Imported:
    drawing.once()
    drawing.require(str(path))
    doubts = []
    unit: Any = chosen.units or drawing.unit
    if not unit:
        refuse_degrees(drawing.outlines)
        unit = "m"
        doubts.append("the drawing declares no unit of length: metres are assumed (--units gives another)")
    drawing = drawing.scaled(chosen.scale or 1.0)
    closed = sum(count for what, count in drawing.read.items() if what.startswith(LINES))
    if closed:
        doubts.append(
            f"{closed} stones are areas that lines close: an opening between stones counts as a stone too; draw "
            "stones as closed polylines if there are openings"
        )
    _known_layers(chosen, drawing, path)
    drawing.cut_out(name for name, layer in chosen.layers.items() if layer.use == "hole")
    kept = [item for item in drawing.outlines if _layer(chosen, item).use != "ignore"]
    if not kept:
        raise InputError(
            "no outline is left that is a stone", 'Leave a layer that is neither "hole" nor "ignore"', "layers"
        )
    refuse_frame(kept)
    if drawing.left_out:
        lost = [f"{count} x {what}" for what, count in drawing.left_out.items()]
        doubts.append(f"left out of the drawing: {first_few(lost, _MOST_TOLD)}")
    doubts += dict.fromkeys(drawing.notes)
    left_out = [f"left out {count} x {what}" for what, count in drawing.left_out.items()]
    if len(kept) < len(drawing.outlines):
        left_out.append(f"left out {len(drawing.outlines) - len(kept)} x outline on a layer to be ignored")
    down = down_of(chosen.gravity or (0.0, -1.0))
    held, how, guessed = _supports(kept, chosen, down)
    supports = f"{sum(held)} of {len(kept)} stones, {how}"
    supports = f"the drawing marks no supports: {supports}, are assumed" if guessed else f"supports: {supports}"
    doubts += [supports] if guessed else []
    live = chosen.live or across(down)
    names = _names(kept)
    metre = 1.0 / METRES[unit]
    data: dict[str, Any] = {
        "format": "wall/1",
        "title": chosen.title or path.stem,
        "units": {"length": unit, "force": "kN", "unit_weight": "kN/m3"},
        "unit_weight": _UNIT_WEIGHT if chosen.unit_weight is None else chosen.unit_weight,
        "thickness": metre if chosen.thickness is None else chosen.thickness,
        "friction": _friction(chosen),
        "blocks": [
            _block(item, name, _layer(chosen, item), still) for item, name, still in zip(kept, names, held, strict=True)
        ],
        "loads": {"live": {"body": [{"per_weight": list(live)}]}},
    }
    if chosen.gravity is not None:
        data["loads"]["gravity"] = list(chosen.gravity)
    tolerance, tolerated = _tolerance(kept, chosen)
    if tolerance is not None and chosen.tolerance is None:
        doubts += tolerated
    sight = {"sight": _NEAR * _size(kept)}
    data["interfaces"] = sight if tolerance is None else sight | {"tolerance": tolerance}
    for name, value, said in (
        ("friction", f"{_FRICTION}", chosen.friction),
        ("unit weight", f"{_UNIT_WEIGHT:g} kN/m3", chosen.unit_weight),
        ("thickness", "one metre", chosen.thickness),
        ("live load", f"{_in_words(live)},", chosen.live),
    ):
        if said is None:
            doubts.append(f"no {name} is given for the drawing: {value} is assumed")
    account = [
        *(f"read {count} x {what}" for what, count in drawing.read.items()),
        *left_out,
        f"unit of length: {unit}" + (f", at a scale of {chosen.scale:g}" if chosen.scale else ""),
        *tolerated,
        supports,
    ]
    account = list(dict.fromkeys([*account, *doubts]))
    data["metadata"] = {"source": path.name, "import": account}
    data["doubts"] = doubts
    return Imported(parse_wall(data, str(path)), tuple(account))


def _read(path: Path, mapping: Mapping) -> Drawing:
    found = format_read(path)
    accuracy = Asked().accuracy if mapping.accuracy is None else mapping.accuracy
    asked = Asked(accuracy, mapping.units or "", mapping.scale or 1.0, mapping.plane, mapping.at)
    try:
        reader = found.read
        with _heard() as warned:
            drawing = reader(path, asked)
        drawing.notes += warned
        return drawing
    except InputError:
        raise
    except Exception as error:  # parsers of other people's formats fail in as many ways as they have lines
        reason = " ".join(str(error).split())[:_MOST_REASON] or type(error).__name__
        raise InputError(
            f"it is no {path.suffix.lower()} that can be read ({reason})",
            "Save it again from the program that made it",
            source=str(path),
        ) from None


@contextmanager
def _heard() -> Iterator[list[str]]:
    """What a reader warns of, instead of what it prints."""
    warned: list[str] = []
    nowhere = io.StringIO()
    with (
        contextlib.redirect_stdout(nowhere),
        contextlib.redirect_stderr(nowhere),
        warnings.catch_warnings(record=True, action="always") as caught,
    ):
        yield warned
    words = [str(item.message) for item in caught if not issubclass(item.category, RuntimeWarning | DeprecationWarning)]
    warned += [f"its reader warns: {text[:_MOST_REASON]}" for text in words]


def _in_words(live: tuple[float, float]) -> str:
    """The live load that is taken where none is said."""
    towards = "to the right" if live == (1.0, 0.0) else f"along ({live[0]:.3g}, {live[1]:.3g})"
    return f"a horizontal force of every weight, {towards}"


def _layer(mapping: Mapping, outline: Outline) -> Layer:
    return mapping.layers.get(outline.layer) or Layer()


def _known_layers(mapping: Mapping, drawing: Drawing, path: Path) -> None:
    there = {outline.layer for outline in drawing.outlines}
    for name in mapping.layers:
        if name not in there:
            known = ", ".join(f'"{item}"' for item in sorted(there)) or "none"
            raise InputError(
                f'no outline is on a layer "{name}"', f"Layers with outlines: {known}", "layers", str(path)
            )


def _friction(mapping: Mapping) -> Any:
    value = _FRICTION if mapping.friction is None else mapping.friction
    if not mapping.rules:
        return value
    return {"default": value, "rules": [rule.model_dump(exclude_none=True) for rule in mapping.rules]}


def _block(outline: Outline, name: str, layer: Layer, still: bool) -> dict[str, Any]:
    groups = list(layer.groups) or ([outline.layer] if outline.layer else [])
    block: dict[str, Any] = {
        "id": name,
        "polygon": [tuple(point) for point in outline.polygon.tolist()],
        "material": outline.material or layer.material,
        "groups": groups,
    }
    if outline.holes:
        block["holes"] = [[tuple(point) for point in hole.tolist()] for hole in outline.holes]
    if layer.unit_weight is not None:
        block["unit_weight"] = layer.unit_weight
    if still:
        block["fixed"] = True
    return block


def _names(outlines: list[Outline]) -> list[str]:
    """Names of the drawing where they are there and differ; else numbers in the order of the file."""
    given = Counter(outline.name for outline in outlines if outline.name)
    names = []
    taken = {name for name, count in given.items() if count == 1}
    number = 0
    for outline in outlines:
        if given[outline.name] == 1:
            names.append(outline.name)
            continue
        number += 1
        while str(number) in taken:
            number += 1
        names.append(str(number))
    return names


def _size(outlines: list[Outline]) -> float:
    """Typical size of a stone: the median of the square roots of their areas."""
    return float(np.median(np.sqrt(shapely.area([item.shape for item in outlines]))))


def _tolerance(outlines: list[Outline], mapping: Mapping) -> tuple[float | None, list[str]]:
    """Greatest gap of a joint, and how it was chosen; None leaves it to the wall format.

    Coordinates rounded to a step lie at most step/sqrt(2) from where they were, so two faces that were one lie at most
    sqrt(2) steps apart: 1.5 steps hold them together.
    """
    if mapping.tolerance is not None:
        return mapping.tolerance, [f"joints: faces up to {mapping.tolerance:g} apart, as given"]
    size = _size(outlines)
    points = np.concatenate([item.polygon for item in outlines])
    for exponent in range(math.floor(math.log10(_FINE * size)), math.ceil(math.log10(1e-6 * size)), -1):
        step = 10.0**exponent
        on_grid = abs(points - np.round(points / step) * step) <= 1e-9 * step + 1e-15 * abs(points).max()
        if on_grid.mean() >= _MOST:
            warned = f"joints: faces up to {1.5 * step:g} apart, because the coordinates are rounded to {step:g}"
            return 1.5 * step, [warned]
    return None, []


def _supports(outlines: list[Outline], mapping: Mapping, down: FloatArray) -> tuple[list[bool], str, bool]:
    """Which stones are supports, how that was decided, and whether it was a guess; heights are against gravity."""
    drawn = [item.fixed or _layer(mapping, item).use == "support" for item in outlines]
    word, _, value = (mapping.supports or ("drawn" if any(drawn) else "lowest-course")).partition(" ")
    guessed = mapping.supports is None and not any(drawn)
    rises = [-(item.polygon @ down) for item in outlines]
    bottoms, tops = (np.array([extreme(rise) for rise in rises]) for extreme in (np.min, np.max))
    if word == "drawn":
        held, how = drawn, "as drawn"
    elif word == "lowest-course":
        # A course is level within half a stone: rounding and survey noise are far less, a second course far more.
        limit = bottoms.min() + 0.5 * float((tops - bottoms)[bottoms == bottoms.min()].min())
        held, how = [bool(bottom < limit) for bottom in bottoms], "the lowest course"
    elif word in ("ground-line", "ground"):
        try:
            level = float(value)
        except ValueError:
            raise InputError(f'"{value}" is no height', "Say ground-line and a number", "supports") from None
        # The coordinate of the drawing along gravity: with y downward, as in pixels, the ground has the greater y.
        way = -1.0 if down[int(np.argmax(np.abs(down)))] > 0.0 else 1.0
        held = [bool(middle < way * level) for middle in 0.5 * (bottoms + tops)]
        how = f"whose middle lies below {level:g}"
    elif word == "layer":
        held, how = [item.layer == value for item in outlines], f'on layer "{value}"'
    else:
        raise InputError(
            f'"{word}" is no rule for supports', 'Say lowest-course, "ground-line Y" or "layer NAME"', "supports"
        )
    held = [one or other for one, other in zip(held, drawn, strict=True)]
    if not any(held):
        raise InputError("no stone is a support", 'Say lowest-course, "ground-line Y" or "layer NAME"', "supports")
    return held, how, guessed
