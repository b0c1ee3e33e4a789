"""Every drawing of the corpus has the answer of the exact wall."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from cases.start import stack
from harness.formats.importing import import_drawing
from harness.model.build import build
from harness.model.errors import InputError
from harness.model.method_registry import load_method
from harness.model.wall import Wall
from tests.formats.corpus import BASES, TRAITS, Trait, drawn

ROUNDED = 0.03
"""Coordinates off by .7 mm move the hinges of stones 75 mm high by 1 % of their height, and turned faces out of line by
as much; twice that, and a hair of .4 mm more."""
EXACT = 1e-6
"""Accuracy of the linear programme where the drawing keeps all digits."""


def _tilted(wall: Wall) -> Wall:
    document = wall.document()
    return Wall.model_validate(document | {"loads": {"live": {"body": [{"per_weight": [1.0, 0.0]}]}}})


def _value(wall: Wall) -> float:
    method = load_method("la-associated")
    answer = method.solve(build(wall).assembly, method.Settings())
    assert answer.multiplier is not None, answer.sentence
    return float(answer.multiplier)


@pytest.fixture(scope="module")
def exact() -> dict[str, float]:
    return {name: _value(_tilted(base())) for name, base in BASES.items()}


VOIDS = ("door", "two-leaf", "facade")
"""Walls that enclose a void: drawn as lines it looks like a stone, and the importer doubts it."""
DRAWINGS = [(base, trait) for base in BASES for trait in TRAITS if not (trait == "lines" and base in VOIDS)]


@pytest.mark.parametrize(("base", "trait"), DRAWINGS)
def test_a_drawing_has_the_answer_of_the_exact_wall(
    base: str, trait: str, exact: dict[str, float], tmp_path: Path
) -> None:
    wall = _tilted(BASES[base]())
    mapping = drawn(wall, TRAITS[trait], tmp_path / "wall.dxf")
    imported = import_drawing(tmp_path / "wall.dxf", mapping)
    assert len(imported.wall.blocks) == len(build(wall).assembly.polygons)
    tolerance = ROUNDED if TRAITS[trait].step else EXACT
    assert _value(imported.wall) == pytest.approx(exact[base], rel=tolerance)


def test_an_opening_between_lines_is_doubted(tmp_path: Path) -> None:
    mapping = drawn(_tilted(BASES["facade"]()), TRAITS["lines"], tmp_path / "wall.dxf")
    assert any(
        "areas that lines close" in doubt for doubt in import_drawing(tmp_path / "wall.dxf", mapping).wall.doubts
    )


def test_open_joints_are_told_with_their_width_and_closed_when_asked_for(tmp_path: Path) -> None:
    apart = Trait(change=lambda polygons: [polygon + np.array([0.0, 0.01 * k]) for k, polygon in enumerate(polygons)])
    wall = stack(3)
    mapping = drawn(wall, apart, tmp_path / "wall.dxf")
    with pytest.raises(InputError) as caught:
        build(import_drawing(tmp_path / "wall.dxf", mapping).wall)
    assert "lie opposite each other 10 apart" in str(caught.value)
    assert '"tolerance": 10.2' in str(caught.value)
    wide = mapping.model_copy(update={"tolerance": 10.2})
    assert _value(import_drawing(tmp_path / "wall.dxf", wide).wall) == pytest.approx(_value(wall), rel=0.05)
