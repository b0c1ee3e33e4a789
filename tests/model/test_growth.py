"""Building a wall looks at a number of pairs of faces that grows with the blocks, not with their square."""

from __future__ import annotations

import numpy as np
import pytest
import shapely

from harness.model.blocks import blocks_of_wall, polygons_of
from harness.model.contacts import edges_of
from harness.model.geometry import centroids
from harness.model.wall import Wall

PATTERNS = {
    "ring": lambda n: {"type": "ring", "inner_radius": 9.0, "outer_radius": 10.0, "count": n},
    "stack": lambda n: {"type": "stack", "width": 1.0, "height": 0.5, "count": n},
    "running_bond": lambda n: {
        "type": "running_bond",
        "count": int(n**0.5),
        "bricks": int(n**0.5),
        "block_length": 0.25,
        "block_height": 0.1,
    },
    "panel": lambda n: {
        "type": "panel",
        "cell_length": 0.25,
        "cell_height": 0.1,
        "layout": [chr(0x4E00 + k) for k in range(n)],
        "fixed": chr(0x4E00 + n - 1),
    },
}


def pairs(kind: str, blocks: int) -> int:
    """How many pairs of edges are looked at more closely."""
    wall = Wall.model_validate(
        {"format": "wall/1", "unit_weight": 20, "friction": 0.6, "pattern": PATTERNS[kind](blocks)}
    )
    return len(edges_of(polygons_of(blocks_of_wall(wall))).side_by_side(1e-6)[0])


@pytest.mark.parametrize("kind", PATTERNS)
def test_four_times_the_blocks_have_about_four_times_the_pairs(kind: str) -> None:
    assert pairs(kind, 4000) < 4.5 * pairs(kind, 1000)


@pytest.mark.parametrize("seed", range(5))
def test_no_face_beside_another_is_missed(seed: int) -> None:
    rng = np.random.default_rng(seed)
    low = rng.integers(0, 8, (60, 2))
    high = low + rng.integers(1, 5, (60, 2))
    turn = np.array([[np.cos(seed), np.sin(seed)], [-np.sin(seed), np.cos(seed)]])
    boxes = shapely.box(low[:, 0], low[:, 1], high[:, 0], high[:, 1])
    edges = edges_of([shapely.get_coordinates(box)[:-1] @ turn for box in boxes])
    one, two = edges.side_by_side(1e-9)
    found = set(zip(one.tolist(), two.tolist(), strict=True))
    upright_first, upright_last = edges.first @ turn.T, edges.last @ turn.T
    lines = shapely.linestrings(np.round(np.stack([upright_first, upright_last], axis=1)))
    i, j = shapely.STRtree(lines).query(lines, predicate="intersects")
    beside = (shapely.length(shapely.intersection(lines[i], lines[j])) > 0.5) & (edges.owner[i] != edges.owner[j])
    wanted = set(zip(i[beside].tolist(), j[beside].tolist(), strict=True))
    assert len(wanted) > 100
    assert wanted <= found


@pytest.mark.parametrize("closer", [1e-3, 0.2, 0.5])
def test_a_closer_look_sees_what_a_look_of_its_own_would(closer: float) -> None:
    rng = np.random.default_rng(1)
    low = rng.uniform(0, 8, (60, 2))
    boxes = [shapely.get_coordinates(shapely.box(*corner, *(corner + 1.0)))[:-1] for corner in low]
    wide, own = edges_of(boxes), edges_of(boxes)
    seen = set(zip(*(part.tolist() for part in wide.near(0.6)), strict=True))
    kept = set(zip(*(part.tolist() for part in wide.near(closer)), strict=True))
    assert kept == set(zip(*(part.tolist() for part in own.near(closer)), strict=True))
    assert kept < seen


def test_centroids_of_outlines_of_many_sizes_are_those_of_shapely() -> None:
    rng = np.random.default_rng(2)
    outlines = []
    for size in rng.integers(3, 12, 50):
        angle = np.sort(rng.uniform(0, 2 * np.pi, size))
        outlines.append(1e3 + np.stack([np.cos(angle), np.sin(angle)], axis=1))
    by_shapely = [shapely.Polygon(outline - 1e3).centroid.coords[0] for outline in outlines]
    assert centroids(outlines) == pytest.approx(np.array(by_shapely) + 1e3, abs=1e-9)
