"""Neighbours of a study share what they found, and it stays true, told, and the same for any number of workers."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest

from drystone.studies import rows_of
from harness.engine.executors import LocalExecutor
from harness.engine.store import open_store
from harness.engine.sweep.expand import SweepRun, expand, sources_of
from harness.engine.sweep.frame import tidy
from harness.engine.sweep.neighbours import handed_on
from harness.engine.sweep.running import Row, sweep
from harness.engine.sweep.study import Study
from harness.engine.sweep.summary import summarise, varied_of
from harness.model.method import Finding, Status
from harness.model.method_registry import load_method
from harness.model.reading import validate
from harness.model.result import relative_velocities
from tests.model.test_components import three_columns
from tests.walls import assembly, running_bond, stack, wall_data

SQUARE = running_bond(6, 3, length=0.2)
"""The paper's wall of bricks 1:1: the quick search finds its least state (0.26696) at friction 0.9 and not at 1.0."""
COST = ["cpu_seconds", "wall_seconds", "peak_memory_bytes", "started"]


def study(**more: Any) -> Study:
    data = {"name": "made-up", "title": "A study of a test", "methods": ["la"], "wall": wall_data(SQUARE)}
    return validate(Study, data | {"neighbours": True} | more, "test")


def table_of(asked: Study, store: Path, processes: int = 1) -> pd.DataFrame:
    with open_store(store) as opened:
        executor = LocalExecutor(processes)
        rows = rows_of(asked, expand(asked, sources_of(asked)), opened, executor)
    return tidy(rows, varied_of(asked))


def motion_of(wall: Any, mechanism: Any) -> np.ndarray[Any, Any]:
    opening, slip = relative_velocities(wall, np.asarray(mechanism))
    return np.column_stack([opening, slip])


def test_a_state_missed_at_one_friction_is_found_by_the_mechanism_of_the_next_for_any_number_of_workers(tmp_path: Path):
    quick = {"la": {"effort": "quick", "starts": 6}}
    asked = study(vary={"friction": [1.0, 1.1]}, methods=["la", "la-associated"], settings=quick)
    one, two = (table_of(asked, tmp_path / f"{n}.sqlite", n) for n in (1, 2))
    pd.testing.assert_frame_equal(one.drop(columns=COST), two.drop(columns=COST))
    found = one[one["method"] == "la"].set_index("friction")
    assert found["multiplier"][1.0] == pytest.approx(found["multiplier"][1.1], rel=1e-9)
    assert found["from_neighbour"].tolist() == [True, False]
    assert found["multiplier_alone"][1.0] > found["multiplier"][1.0] + 0.01
    assert found["judge_accepted"].all()
    assert one[one["method"] == "la-associated"]["from_neighbour"].isna().all(), "it takes up no mechanism"
    with open_store(tmp_path / "1.sqlite") as store:
        kept = store.get(found["key"][1.0])
        assert kept is not None
        assert kept[0].given == [found["key"][1.1]], "the stored row tells whose mechanism it took up"
    summary = summarise(asked, one)
    assert summary.tables["neighbours"]["friction"].tolist() == [1.0]
    assert "1 of 4 runs" in summary.remarks[0]


def test_what_is_in_the_store_is_not_handed_on_again(tmp_path: Path):
    asked = study(wall=wall_data(stack(2)), vary={"friction": [0.1, 0.2, 2.0]})
    first = table_of(asked, tmp_path / "s.sqlite")
    with open_store(tmp_path / "s.sqlite") as store:
        before = {row[0]: row[3] for row in store.table()}
    again = table_of(asked, tmp_path / "s.sqlite")
    with open_store(tmp_path / "s.sqlite") as store:
        assert {row[0]: row[3] for row in store.table()} == before
    pd.testing.assert_frame_equal(first, again)
    assert not first["from_neighbour"].any()


def test_runs_of_other_joints_or_settings_take_nothing_from_each_other(tmp_path: Path):
    asked = study(wall=wall_data(stack(2)), vary={"pattern.count": [2, 3], "settings.la.seed": [0, 1]})
    runs, asking = expand(asked, sources_of(asked)), list[SweepRun]()
    with open_store(tmp_path / "s.sqlite") as store:
        rows = [row for _, row, _ in sweep(runs, store, LocalExecutor(1))]

        def make(some: Any) -> list[Row]:
            asking.extend(some)
            return []

        assert len(handed_on(runs, rows, store, make)) == 4
    assert asking == []


def test_a_run_that_did_not_try_what_neighbours_found_is_never_one_that_none_led_lower(tmp_path: Path):
    asked = study(wall=wall_data(stack(2)), vary={"friction": [1.0, 1.1, 1.2]})
    runs = expand(asked, sources_of(asked))
    with open_store(tmp_path / "s.sqlite") as store:
        rows = [row for _, row, _ in sweep(runs, store, LocalExecutor(1))]
        kept = store.get(str(rows[0]["key"]))
        assert kept is not None
        store.put("early", kept[0].model_copy(update={"details": {"stopped_by_limit": True}}), 1.0)

        def make(some: Any) -> list[Row]:
            ends = [
                ("timeout", "It took 2 s", ""),
                ("crashed", "Signal 11", ""),
                ("not_converged", "No fit", "early"),
            ]
            return [
                dict(row, status=status, sentence=sentence, key=key or row["key"], multiplier=None, finding="none")
                for row, (status, sentence, key) in zip(rows, ends, strict=True)
            ]

        table = tidy(handed_on(runs, rows, store, make), varied_of(asked))
    assert table["from_neighbour"].isna().all()
    assert table["neighbour_failure"].tolist() == ["timeout: It took 2 s", "crashed: Signal 11", "stopped: No fit"]
    assert table["multiplier"].tolist() == [row["multiplier"] for row in rows]
    assert summarise(asked, table).remarks[:4] == [
        "1 of 3 runs did not try all mechanisms of their neighbours, timeout: It took 2 s",
        "1 of 3 runs did not try all mechanisms of their neighbours, crashed: Signal 11",
        "1 of 3 runs did not try all mechanisms of their neighbours, stopped: No fit",
        "No other run found a lower state from the mechanisms of its neighbours.",
    ]


def test_a_given_mechanism_counts_by_the_forces_of_this_wall_alone():
    la = load_method("la")
    assert la.follows_motions
    rough, smooth = assembly(stack(1), friction=2.0), assembly(stack(1), friction=0.2)
    topples = la.solve(rough, la.Settings())
    assert topples.multiplier == pytest.approx(1.5)
    taken = la.solve_from(smooth, la.Settings(), [motion_of(rough, topples.mechanism)])
    assert taken.multiplier is None, "at friction 0.2 no forces fit the block that topples"
    assert (taken.status, taken.finding) == (Status.NOT_CONVERGED, Finding.NONE)
    tall = assembly(stack(1, height=0.4), friction=2.0)
    taken = la.solve_from(tall, la.Settings(), [motion_of(rough, topples.mechanism)])
    assert taken.multiplier == pytest.approx(0.75), "b / h of this wall, not of that"


def test_a_wall_whose_joints_crush_is_searched_whatever_is_given():
    """b / h - gamma b / f_c. Joints have further limits in series, of which no motion is given: it crashed."""
    la = load_method("la")
    assert la.follows_motions
    strong, weak = (assembly(stack(2, 0.4, 1.0), 1.0, compressive_strength=strength) for strength in (800.0, 200.0))
    topples = la.solve(strong, la.Settings())
    assert topples.multiplier == pytest.approx(0.19, abs=1e-12)
    taken = la.solve_from(weak, la.Settings(), [motion_of(strong, topples.mechanism)])
    assert taken.multiplier == pytest.approx(0.16, abs=1e-12)
    assert taken.finding is Finding.COLLAPSES


def test_a_component_in_which_nothing_given_moves_is_searched():
    la = load_method("la")
    assert la.follows_motions
    wall = three_columns((1.0, 0.0), (1.0, 0.0), (1.0, 0.0))
    whole = la.solve(wall, la.Settings())
    taken = la.solve_from(wall, la.Settings(), [motion_of(wall, whole.mechanism)])
    assert taken.multiplier == pytest.approx(whole.multiplier, rel=1e-12)
    assert taken.finding is Finding.COLLAPSES
