"""The store loses nothing; verdicts and theory gates say what holds."""

from __future__ import annotations

import os
import signal
import sqlite3
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import numpy as np
import psutil
import pytest

from harness.engine.compare import comparison_run, recall, remember
from harness.engine.pipeline import execute
from harness.engine.plan import plan_case
from harness.engine.run import Limits, Run
from harness.engine.store import Store, open_store
from harness.engine.verdict import compare, theory_gates, violations
from harness.model.case import Reference
from harness.model.comparison import CaseResults, ComparisonRun
from harness.model.displaced import DisplacedState
from harness.model.errors import InputError
from harness.model.method import Finding, Status, Traits
from harness.model.proof import least_known
from harness.model.result import Judgement, Result, Verdict
from tests.walls import case, stack


def reference(**changes: Any) -> Reference:
    data: dict[str, Any] = {
        "id": "r",
        "type": "exact",
        "value": 0.5,
        "tolerance": 1e-9,
        "applies_to": ["la"],
        "gate": True,
        "source": "a test",
        "requirement": "It is a half.",
    }
    return Reference.model_validate(data | changes)


TRAITS = {
    "la": Traits(seeks_least=True, any_self_stress=True),
    "la-associated": Traits(bounds_above=True, any_self_stress=True),
    "de": Traits(brackets=True),
}


def result(method: str = "la", multiplier: float | None = 0.5, **changes: Any) -> Result:
    traits = changes.get("traits", TRAITS.get(method, Traits()))
    data: dict[str, Any] = {
        "case": "made-up",
        "method": method,
        "family": method.split("-")[0],
        "status": Status.OK,
        "finding": Finding.COLLAPSES,
        "sentence": "",
        "multiplier": multiplier,
        "blocks": 1,
        "interfaces": 1,
        "judge": Judgement(accepted=True),
        "traits": traits,
        "flow": "associated" if traits.bounds_above else "non-associated",
    }
    return Result.model_validate(data | changes)


@pytest.mark.parametrize(
    ("changes", "multiplier", "verdict"),
    [
        ({}, 0.5 + 1e-10, Verdict.AGREES),
        ({}, 0.5 + 1e-8, Verdict.OUTSIDE_TOLERANCE),
        ({"relation": "at_most"}, 0.4, Verdict.AGREES),
        ({"relation": "at_most", "type": "bound"}, 0.6, Verdict.VIOLATES_BOUND),
        ({"relation": "at_least"}, 0.4, Verdict.OUTSIDE_TOLERANCE),
        ({"relation": "inside", "value": [0.4, 0.6]}, 0.55, Verdict.AGREES),
        ({"relation": "inside", "value": [0.4, 0.6]}, 0.65, Verdict.OUTSIDE_TOLERANCE),
    ],
)
def test_verdict_of_a_multiplier(changes: dict[str, Any], multiplier: float, verdict: Verdict):
    assert compare(reference(**changes), result(multiplier=multiplier)).verdict is verdict


def test_bracket_is_what_an_interval_is_compared_with():
    inside = reference(relation="inside", value=[0.4, 0.5455], applies_to=["de"])
    assert compare(inside, result("de", 0.5, bracket=(0.45, 0.54))).verdict is Verdict.AGREES
    assert compare(inside, result("de", 0.5, bracket=(0.45, 0.56))).verdict is Verdict.OUTSIDE_TOLERANCE
    contains = reference(relation="contains", value=0.5)
    assert compare(contains, result("de", 0.5, bracket=(0.45, 0.54))).verdict is Verdict.AGREES


def test_run_that_failed_or_was_rejected_never_agrees():
    failed = result(multiplier=None, status=Status.TIMEOUT, finding=Finding.NONE, sentence="It was stopped.")
    assert compare(reference(), failed).verdict is Verdict.OUTSIDE_TOLERANCE
    rejected = result(judge=Judgement(accepted=False, sentence="No equilibrium."))
    said = compare(reference(), rejected)
    assert said.verdict is Verdict.OUTSIDE_TOLERANCE
    assert "No equilibrium." in said.sentence


def test_findings_are_compared_as_words():
    stands = reference(quantity="finding", value="stands", tolerance=0.0)
    assert compare(stands, result(multiplier=None, finding=Finding.STANDS)).verdict is Verdict.AGREES
    assert compare(stands, result(multiplier=None, finding=Finding.FALLS)).verdict is Verdict.OUTSIDE_TOLERANCE


def gates(*results: Result) -> dict[str, bool | None]:
    return {gate.name: gate.passed for gate in theory_gates(CaseResults(case(stack(1)), list(results)))}


def test_theory_gates_hold_and_break():
    associated = result("la-associated", 0.6)
    good = gates(associated, result("la", 0.5), result("fe", 0.55), result("de", 0.57, bracket=(0.56, 0.58)))
    assert all(good.values())
    assert set(good) == {
        "la-below-associated",
        "fe-below-associated",
        "la-below-fe",
        "de-held-below-associated",
    }
    assert gates(associated, result("fe", 0.61))["fe-below-associated"] is False
    assert gates(result("la", 0.56), result("fe", 0.55))["la-below-fe"] is False
    assert gates(associated, result("de", 0.62, bracket=(0.61, 0.63)))["de-held-below-associated"] is False
    rejected = result("fe", 0.9, judge=Judgement(accepted=False))
    assert "fe-below-associated" not in gates(associated, rejected)


def test_a_bracket_breaks_a_gate_with_the_end_that_is_shown_only():
    associated = result("la-associated", 0.6)
    assert gates(associated, result("fe-qp", 0.6001, bracket=(0.5998, 0.6004)))["fe-qp-below-associated"] is True
    assert gates(result("la", 0.6), result("fe-qp", 0.5999, bracket=(0.5996, 0.6002)))["la-below-fe-qp"] is True
    assert gates(result("la", 0.61), result("fe-qp", 0.5999, bracket=(0.5996, 0.6002)))["la-below-fe-qp"] is False


def test_no_gate_of_the_wall_as_drawn_holds_for_a_state_that_has_moved_far():
    moved = result("de-closed", 0.7, bracket=(0.69, 0.71), details=DisplacedState(*[np.zeros(0)] * 6).as_details())
    assert gates(result("la-associated", 0.6), moved) == {}


def test_no_method_may_hold_a_wall_that_has_no_equilibrium():
    falls = result("la-associated", None, finding=Finding.FALLS)
    assert gates(falls, result("de", None, finding=Finding.STANDS)) == {"de-falls-without-equilibrium": False}


def test_no_wall_moves_below_a_least_multiplier_that_is_proved_or_the_only_one():
    def moving(value: float, name: str = "de") -> Result:
        details = {"lowest_moving": value}
        return result(name, value, bracket=(value, value), details=details).model_copy(
            update={"traits": Traits(brackets=True, moves_no_lower=name != "de-soft")}
        )

    proved = result("la", 0.5, details={"proved_least": True})
    assert gates(proved, moving(0.498))["de-moves-no-lower"]
    assert gates(proved, moving(0.497))["de-moves-no-lower"] is False
    assert gates(proved, moving(0.497), moving(0.501, "de-mujoco"))["de-mujoco-moves-no-lower"]
    assert "de-soft-moves-no-lower" not in gates(proved, moving(0.497, "de-soft"))
    assert "de-moves-no-lower" not in gates(result("la", 0.5), moving(0.4))
    falls = moving(0.0).model_copy(update={"finding": Finding.FALLS, "multiplier": None})
    assert gates(proved, falls)["de-moves-no-lower"] is False
    # A block that turns about its corner, and one that slides, at the maximum of associated flow.
    turns, slides = [[0.0] * 3, [0.1, 0.15, -1.0]], [[0.0] * 3, [1.0, 0.0, 0.0]]
    for mechanism, gated in ((turns, True), (slides, False)):
        both = [result(name, 0.5, mechanism=mechanism) for name in ("la", "la-associated")]
        assert ("de-moves-no-lower" in gates(*both, moving(0.4))) == gated
    answers = [proved, moving(0.4)]
    item = CaseResults(case(stack(1)), answers, theory_gates(CaseResults(case(stack(1)), answers)))
    assert any("de-moves-no-lower" in line for line in violations(ComparisonRun("one", "", "", [item])))


def dummy_run(does: str, **limits: float) -> Run:
    return Run(case(stack(1)), "dummy", {"does": does}, Limits(**{"seconds": 30.0} | limits))


def test_second_run_comes_from_the_store_and_fresh_runs_again(tmp_path: Path):
    told: list[bool] = []
    runs = [dummy_run("answer"), dummy_run("raise")]
    with open_store(tmp_path / "s.sqlite") as store:
        for fresh in (False, False, True):
            execute(runs, store, 2, fresh=fresh, progress=lambda run, result, stored: told.append(stored))
    assert told == [False, False, True, True, False, False]


def test_key_depends_on_wall_method_settings_and_limits():
    runs = [dummy_run("answer"), dummy_run("raise"), dummy_run("answer", seconds=31.0)]
    runs.append(Run(case(stack(2)), "dummy", {"does": "answer"}, Limits(seconds=30.0)))
    runs.append(Run(case(stack(1)), "fe", {}, Limits(seconds=30.0)))
    assert len({run.key for run in runs}) == len(runs)
    assert dummy_run("answer").key == runs[0].key


def test_report_of_the_last_comparison_is_rebuilt_from_the_store_alone(tmp_path: Path):
    made = case(stack(1), references=[reference(applies_to=["dummy"], value=2.0)])
    runs = plan_case(made, ["dummy"], Limits(seconds=30.0))
    with open_store(tmp_path / "s.sqlite") as store:
        results = execute(runs, store, 1)
        compared = comparison_run("a title", "a command", [made], runs, results)
        remember(store, compared, runs)
        again = recall(store)
    assert again is not None
    assert again.title == "a title"
    assert [row.model_dump() for row in again.cases[0].results] == [row.model_dump() for row in results]
    assert violations(again) == violations(compared)
    assert len(violations(again)) == 2  # the reference, and the judge, who has nothing to see


def test_foreign_files_are_refused_and_left_alone(tmp_path: Path):
    path = tmp_path / "notes.txt"
    path.write_text("not a database, but long enough to be read as a header of one" * 20)
    before = path.read_bytes()
    with pytest.raises(InputError, match="not a result store"):
        Store(path)
    assert path.read_bytes() == before
    later = tmp_path / "later.sqlite"
    connection = sqlite3.connect(later)
    connection.execute("PRAGMA user_version = 99")
    connection.close()
    with pytest.raises(InputError, match="version 99"):
        Store(later)


def test_killing_the_process_loses_no_finished_run(tmp_path: Path):
    program = f"""
from pathlib import Path
from tests.engine.test_store_and_verdict import dummy_run
from harness.engine.pipeline import execute
from harness.engine.store import open_store
with open_store(Path({str(tmp_path / "s.sqlite")!r})) as store:
    execute([dummy_run("answer"), dummy_run("hang")], store, 1, progress=lambda *_: print("done", flush=True))
"""
    child = subprocess.Popen([sys.executable, "-c", program], stdout=subprocess.PIPE, text=True)
    assert child.stdout is not None
    assert child.stdout.readline() == "done\n"
    time.sleep(0.3)
    started = psutil.Process(child.pid).children(recursive=True)
    assert started
    os.kill(child.pid, signal.SIGKILL)
    child.wait()
    assert not psutil.wait_procs(started, timeout=10.0)[1], "a method that hangs outlives the engine"
    child.stdout.close()
    with open_store(tmp_path / "s.sqlite") as store:
        assert store.get(dummy_run("answer").key) is not None
        assert store.get(dummy_run("hang").key) is None


def test_a_store_of_version_1_is_brought_up_to_date_with_all_it_holds(tmp_path: Path):
    run = dummy_run("answer")
    (made,) = execute([run], None, 1)
    path = tmp_path / "old.sqlite"
    connection = sqlite3.connect(path)
    with connection:
        connection.execute(
            "CREATE TABLE run (key TEXT PRIMARY KEY, case_id TEXT NOT NULL, method TEXT NOT NULL, "
            "started TEXT NOT NULL, tolerance REAL NOT NULL, result TEXT NOT NULL)"
        )
        connection.execute(
            "CREATE TABLE comparison (number INTEGER PRIMARY KEY AUTOINCREMENT, created TEXT NOT NULL, "
            "content TEXT NOT NULL)"
        )
        values = (run.key, made.case, made.method, made.started, 1e-9, made.model_dump_json())
        connection.execute("INSERT INTO run VALUES (?, ?, ?, ?, ?, ?)", values)
        connection.execute("PRAGMA user_version = 1")
    connection.close()
    with pytest.raises(InputError, match="version 1"), open_store(path, read_only=True):
        pass
    with open_store(path) as store:
        found = store.get(run.key)
        assert found is not None
        assert found[0] == made
        assert store.table()[0][4:7] == ("ok", "collapses", 1.0)
        store.put("another", made, 1e-9)
        again = store.get("another")
    assert again is not None
    assert again[0] == made
    with open_store(path, read_only=True) as store:
        assert len(store.table()) == 2


def test_what_many_runs_share_is_kept_once_and_fields_are_small(tmp_path: Path):
    (made,) = execute([Run(case(stack(200)), "dummy", {"does": "answer"}, Limits(30.0))], None, 1)
    with open_store(tmp_path / "s.sqlite") as store:
        for number in range(50):
            store.put(str(number), made, 1e-9)
        assert store.get("7") == (made, 1e-9)
    connection = sqlite3.connect(tmp_path / "s.sqlite")
    assert connection.execute("SELECT count(*) FROM environment").fetchone() == (1,)
    (size,) = connection.execute("SELECT max(length(result) + length(fields)) FROM run").fetchone()
    connection.close()
    assert size < len(made.model_dump_json()) / 3


def test_gates_go_by_what_methods_say_of_themselves_and_not_by_names():
    bounding = result("ceiling", 0.6, traits=Traits(bounds_above=True))
    least = result("floor", 0.5, traits=Traits(seeks_least=True))
    held = result("measured", 0.65, bracket=(0.55, 0.75), traits=Traits(brackets=True))
    assert gates(bounding, least, held, result("path", 0.7)) == {
        "floor-below-associated": True,
        "measured-held-below-associated": True,
        "path-below-associated": False,
        "floor-below-path": True,
    }


def test_a_method_that_calls_another_state_the_associated_maximum_breaks_no_gate_of_others():
    liar = result("liar", 0.5, traits=Traits(bounds_above=True), flow="non-associated")
    found = gates(liar, result("la-associated", 0.6), result("fe", 0.55))
    assert found == {"fe-below-associated": True, "liar-below-associated": True}


def test_each_method_that_seeks_the_least_is_held_to_it_and_hides_no_other():
    found = gates(result("floor", 0.5, traits=Traits(seeks_least=True)), result("la", 0.6))
    assert found == {"floor-below-la": True, "la-below-floor": False}


def test_a_lower_bound_above_a_known_state_is_told():
    said = result("bold", 0.9, judge=Judgement(), details={"lower_bound": 0.8})
    assert gates(said, result("la", 0.5)) == {"bold-bounds-below": False}
    assert gates(result("modest", 0.9, judge=Judgement(), details={"lower_bound": 0.5}), result("la", 0.5)) == {
        "modest-bounds-below": True
    }


def test_a_state_that_the_judge_holds_loosely_is_no_least_one():
    loose = result("loose", 0.49, judge=Judgement(accepted=True, residuals={"equilibrium": 2e-3}, tolerance=1e-2))
    close = result("la", 0.5, judge=Judgement(accepted=True, residuals={"equilibrium": 1e-12}))
    assert least_known(CaseResults(case(stack(1)), [loose, close])) is close


def test_a_state_is_held_against_others_within_what_the_judge_leaves_open_of_it():
    def found(error: float) -> dict[str, bool | None]:
        loose = result("loose", 0.49, judge=Judgement(accepted=True, multiplier_error=error))
        return gates(result("la", 0.5), loose)

    assert found(0.011) == {"la-below-loose": True}
    assert found(0.009) == {"la-below-loose": False}


def test_what_a_method_says_of_itself_comes_back_from_its_own_process_and_the_store(tmp_path: Path):
    run = Run(case(stack(1)), "la-associated", {}, Limits(seconds=60.0))
    with open_store(tmp_path / "s.sqlite") as store:
        made, kept = (execute([run], store, 1)[0].traits for _ in range(2))
    assert made == kept
    assert made.bounds_above
    assert made.caption == "associated maximum"
