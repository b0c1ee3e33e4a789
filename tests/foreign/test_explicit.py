"""The wall that a program reads is the wall: read as `wall/1` it has the same arrays, and those beside it too."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import scipy.sparse as sp

from harness.engine.symmetry import VIEWS
from harness.model.build import build
from harness.model.case import case_folders, read_case, shipped_cases
from harness.model.foreign.explicit import LISTED, explicit_document, write_arrays
from harness.model.foreign.result_document import answer_from_file, answer_of
from harness.model.reading import parse_wall
from tests.walls import assembly, stack

CASES = ("slide", "wall-21", "arch-100-tilt", "column-point-load", "two-frictions", "opening-lintel")
STRONG: dict[str, Any] = {"cohesion": 0.4, "tensile_strength": 0.2}


@pytest.mark.parametrize("name", CASES)
@pytest.mark.parametrize("view", [None, "rotated", "renumbered"])
def test_the_explicit_wall_is_the_wall(name: str, view: str | None):
    wall = read_case(case_folders([shipped_cases()])[name]).assembly
    wall = wall if view is None else VIEWS[view](wall)
    again = build(parse_wall(json.loads(json.dumps(explicit_document(wall))), "a file")).assembly
    assert again.block_ids == wall.block_ids
    for field in LISTED:
        size = max(1.0, float(abs(np.asarray(getattr(wall, field), dtype=float)).max(initial=0.0)))
        found, known = (np.asarray(getattr(each, field), dtype=float) for each in (again, wall))
        assert found == pytest.approx(known, abs=1e-12 * size), field  # loads are sums of forces at points


def test_strength_is_that_of_the_joints():
    wall = assembly(stack(2), 0.5, **STRONG)
    again = build(parse_wall(explicit_document(wall), "a file")).assembly
    assert again.constant == pytest.approx(wall.constant, rel=1e-12)


def test_arrays_of_numpy_hold_the_kinematic_matrix_and_the_loads(tmp_path: Path):
    wall = assembly({"type": "ring", "inner_radius": 1.0, "outer_radius": 1.3, "count": 5}, 0.6)
    write_arrays(tmp_path / "wall.npz", wall)
    with np.load(tmp_path / "wall.npz") as arrays:
        matrix = sp.csr_matrix((arrays["C_data"], arrays["C_indices"], arrays["C_indptr"]), arrays["C_shape"])
        assert (matrix != wall.kinematic_matrix).nnz == 0
        assert np.array_equal(arrays["dead_free"], wall.free_loads()[0])
        assert np.array_equal(arrays["live"][arrays["free"]].ravel(), wall.free_loads()[1])


def test_what_run_prints_is_read_back_by_judge_and_a_strict_result_refuses_other_fields():
    wall = assembly(stack(1), 0.4)
    data = {"case": "x", "multiplier": 0.4, "forces": [[1.0, 2.0, 3.0]], "details": {"live_forces": [[1, 2, 3]]}}
    answer = answer_from_file(data, wall, "a file")
    assert answer.details["live_forces"] == [[1.0, 2.0, 3.0]]
    with pytest.raises(Exception, match='unknown field "case"'):
        answer_of(data | {"format": "result/1"}, wall, "a file")
    with pytest.raises(Exception, match="it has no format"):
        answer_of(data, wall, "a file")
