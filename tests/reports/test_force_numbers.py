"""Numbers of contact forces: beside their own arrow, over no other, and the largest forces first."""

from __future__ import annotations

import numpy as np
import pytest
import shapely

from reports.drawing.display_list import LETTERS, Group, Polygons, Text
from reports.drawing.force_drawing import CLEAR, force_drawing
from reports.labels import numbers
from tests.reports import samples

Named = list[tuple[str, shapely.Polygon]]


def drawn(sizes: np.ndarray, slope: float, courses: int = 3) -> tuple[Named, Named]:
    """The numbers with their boxes, and the arrows with the number that each would carry."""
    case = samples.bond(courses=courses, bricks=3)
    count = case.assembly.n_interfaces
    normal = np.resize(sizes, count)
    forces = [(0.5 * n, 0.5 * n, slope * n) for n in normal.tolist()]
    result = samples.solved(case, "la", 0.5).model_copy(update={"forces": forces})
    parts = force_drawing(case, result).parts
    boxes = []
    for part in parts:
        if isinstance(part, Text) and part.role == "said":
            half = 0.3 * LETTERS * len(part.text)
            x, y = part.at
            boxes.append((part.text, shapely.box(x - half, y - 0.8 * LETTERS, x + half, y)))
    arrows = []
    for group in (part for part in parts if isinstance(part, Group) and part.joint is not None):
        n1, n2, s = (float(value or 0.0) for value in group.values[:3])
        outlines = [shape.outlines[0] for shape in group.parts if isinstance(shape, Polygons)]
        arrows.append((numbers.given(float(np.hypot(n1 + n2, s)), 3), shapely.Polygon(outlines[0])))
    return boxes, arrows


@pytest.mark.parametrize("slope", [0.0, 0.3, -0.6])
def test_numbers_stand_beside_their_own_arrow_and_over_none(slope: float):
    boxes, arrows = drawn(np.linspace(0.2, 1.0, 17), slope)
    assert len(boxes) > 8
    for text, box in boxes:
        own = min(arrow.distance(box) for name, arrow in arrows if name == text)
        assert own < 2.0 * CLEAR + 0.5 * LETTERS, text
    for _, box in boxes:
        assert not any(box.buffer(-CLEAR / 2.0).intersects(arrow) for _, arrow in arrows)
    for k, (_, box) in enumerate(boxes):
        assert not any(box.buffer(-1.0).intersects(other) for _, other in boxes[k + 1 :])


def test_the_largest_force_has_its_number_where_not_all_have_room():
    boxes, arrows = drawn(np.linspace(0.06, 1.0, 23), 0.4)
    assert len(boxes) < len(arrows)
    assert max(float(name) for name, _ in arrows) in [float(text) for text, _ in boxes]


def test_of_many_forces_the_largest_have_their_numbers():
    boxes, arrows = drawn(np.linspace(0.2, 1.0, 66), 0.3, courses=8)
    said = [float(text) for text, _ in boxes]
    named = sorted((float(name) for name, _ in arrows), reverse=True)
    assert len(named) > 60
    assert 8 < len(said) <= 45
    assert said == sorted(said, reverse=True)
    assert said[0] >= named[10]
    assert said[-1] >= named[44]
