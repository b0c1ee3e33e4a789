"""Faults of the store: whatever happened to the file, one sentence names the true cause and nothing is lost."""

from __future__ import annotations

import json
import os
import shutil
import sqlite3
import subprocess
import sys
import zlib
from contextlib import closing
from pathlib import Path
from typing import Any

import pytest

from harness.engine.compare import comparison_run, recall, remember
from harness.engine.executors import LocalExecutor
from harness.engine.judge import judge
from harness.engine.pipeline import execute, executed, judged
from harness.engine.plan import plan_case
from harness.engine.run import Limits, Run
from harness.engine.store import SCHEMA_VERSION, open_store
from harness.model.errors import InputError
from harness.model.method import Traits
from harness.model.result import Result
from tests.commands import drystone
from tests.walls import case, stack


def filled(path: Path) -> Path:
    """A store with one comparison of two runs."""
    wall = case(stack(2))
    runs = plan_case(wall, ["la", "la-associated"], Limits(60.0))
    with open_store(path) as store:
        results = execute(runs, store, 1)
        remember(store, comparison_run("two", "drystone compare", [wall], runs, results), runs)
    return path


@pytest.fixture(scope="module")
def whole(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return filled(tmp_path_factory.mktemp("store") / "whole.sqlite")


@pytest.fixture
def store(whole: Path, tmp_path: Path) -> Path:
    return Path(shutil.copyfile(whole, tmp_path / "s.sqlite"))


def change(path: Path, statement: str, *values: Any) -> None:
    connection = sqlite3.connect(path)
    with connection:
        connection.execute(statement, values)
    connection.close()


def told_in_one_sentence(done: subprocess.CompletedProcess[str], *words: str) -> None:
    assert done.returncode == 2, done.stderr
    lines = done.stderr.strip().splitlines()
    assert len(lines) == 1, done.stderr
    assert lines[0].startswith("drystone: ")
    for word in words:
        assert word in lines[0]


def report(store: Path, **more: Any) -> subprocess.CompletedProcess[str]:
    return drystone("report", "--store", store, "--report", store.parent / "report.html", **more)


def read_all(path: Path, *, read_only: bool) -> None:
    with open_store(path, read_only=read_only) as opened:
        compared = recall(opened)
        assert compared is not None
        assert [result.multiplier is not None for result in compared.cases[0].results] == [True, True]


@pytest.mark.parametrize("read_only", [True, False])
def test_every_damaged_page_is_told_or_does_no_harm(store: Path, read_only: bool):
    """4,096 bytes of noise at each page in turn: the comparison is read whole, or the damage is told."""
    content, told = store.read_bytes(), 0
    for start in range(0, len(content), 4096):
        store.write_bytes(content[:start] + bytes(reversed(content[start : start + 4096])) + content[start + 4096 :])
        try:
            read_all(store, read_only=read_only)
        except InputError as error:
            told += 1
            assert any(word in str(error) for word in ("damaged", "not a result store", "version")), error  # noqa: PT017
        for beside in ("-wal", "-shm"):
            store.with_name(store.name + beside).unlink(missing_ok=True)
    assert told > 2


@pytest.mark.parametrize("part", [0.0, 0.001, 0.3, 0.5, 0.7])
def test_a_truncated_store_is_told(store: Path, part: float):
    content = store.read_bytes()
    store.write_bytes(content[: int(part * len(content))])
    if part == 0.0:
        with open_store(store) as opened:  # an empty file is an empty store
            assert recall(opened) is None
        return
    with pytest.raises(InputError, match=r"damaged|not a result store"):
        read_all(store, read_only=True)


@pytest.mark.parametrize(
    "column",
    [
        "UPDATE run SET result = substr(result, 1, length(result) / 2)",
        "UPDATE run SET result = '[]'",
        "UPDATE run SET result = CAST(x'7b22ff' AS TEXT)",
        "UPDATE run SET result = x'00ff'",
        "UPDATE run SET tolerance = 'much'",
    ],
)
def test_truncated_json_of_a_run_names_the_run(store: Path, column: str):
    change(store, column)
    with pytest.raises(InputError, match="the result of la on made-up in it: it is damaged"):
        read_all(store, read_only=True)


EDITS = {
    "multiplier": """UPDATE run SET result = json_set(result, '$.multiplier', 9.5)""",
    "multiplier, text": """UPDATE run SET result = replace(result, '"multiplier":', '"multiplier":1')""",
    "judgement": """UPDATE run SET result = json_set(result, '$.judge.sentence', 'It is true.')""",
    "residual": """UPDATE run SET result = replace(result, '"residuals":{', '"residuals":{"own":0.0,')""",
    "seconds": """UPDATE run SET result = replace(result, '"cpu_seconds":', '"cpu_seconds":1')""",
    "tolerance": "UPDATE run SET tolerance = 0.009",
    "method": "UPDATE run SET method = 'fe'",
    "fields of another": "UPDATE run SET fields = (SELECT fields FROM run WHERE method = 'la-associated')",
    "fields taken out": "UPDATE run SET fields = NULL",
    "row of another": "UPDATE run SET result = (SELECT result FROM run WHERE method = 'la-associated')",
    "environment": "UPDATE environment SET content = replace(content, 'seeks_least', 'seeks_least')||' '",
    "environment taken out": "DELETE FROM environment",
}


ENVIRONMENT = ("environment", "environment taken out")


@pytest.mark.parametrize("how", list(EDITS))
def test_what_was_edited_by_hand_is_told_and_not_believed(store: Path, how: str):
    read_all(store, read_only=True)
    change(store, EDITS[how] + (" WHERE method = 'la'" if how not in ENVIRONMENT else ""))
    with pytest.raises(InputError, match=r"the result of .* on made-up in it: it is damaged"):
        read_all(store, read_only=True)
    told_in_one_sentence(report(store), "damaged", "--fresh")


@pytest.mark.parametrize(
    "how", ["multiplier, text", "judgement", "seconds", "tolerance", "row of another", *ENVIRONMENT]
)
def test_a_study_does_not_believe_an_edited_row_either(store: Path, how: str):
    with open_store(store, read_only=True) as opened:
        keys = {row[0] for row in opened.table()}
        assert len(opened.summaries(keys)) == 2
    change(store, EDITS[how] + (" WHERE method = 'la'" if how not in ENVIRONMENT else ""))
    with open_store(store, read_only=True) as opened, pytest.raises(InputError, match="it is damaged"):
        opened.summaries(keys)


def test_an_edited_comparison_is_told(store: Path):
    """Its wall, or the value it is held against, is another than the runs were made for."""
    change(store, """UPDATE comparison SET content = replace(content, '"friction": ', '"friction": 1')""")
    told_in_one_sentence(report(store), "the last comparison in it", "changed after it was stored")


@pytest.mark.parametrize("depth", [60, 300, 100_000])
@pytest.mark.parametrize("column", ["fields", "result"])
def test_a_result_that_is_nested_too_deeply_is_told(store: Path, column: str, depth: int):
    text = '{"details": {"x": ' + "[" * depth + "]" * depth + "}}"
    change(store, f"UPDATE run SET {column} = ?", zlib.compress(text.encode()) if column == "fields" else text)
    with pytest.raises(InputError, match="the result of la on made-up in it: it is damaged"):
        read_all(store, read_only=True)


@pytest.mark.parametrize("text", ['{"title": ', "[1]", "{}", '{"title": 3}', "\x00", "[" * 5000])
def test_a_damaged_comparison_is_told(store: Path, text: str):
    change(store, "UPDATE comparison SET content = ?", text)
    with pytest.raises(InputError, match="the last comparison in it"):
        read_all(store, read_only=True)


@pytest.mark.parametrize("name", ["forces", "states", "mechanism"])
def test_arrays_of_another_wall_are_told(whole: Path, name: str):
    """A fuzzed store held a result without forces for a wall with interfaces; the judge met arrays of unlike shapes."""
    run, found = stored(whole)
    for wrong in ([], getattr(found, name)[1:]):
        with pytest.raises(InputError, match=f"the stored result of la on made-up: its {name} have"):
            judged(run, found.model_copy(update={name: wrong}), 1e-9)


def stored(whole: Path) -> tuple[Run, Result]:
    with open_store(whole, read_only=True) as opened:
        compared = recall(opened)
    assert compared is not None
    return plan_case(compared.cases[0].case, ["la"], Limits(60.0))[0], compared.cases[0].results[0]


def test_a_stored_result_is_held_to_what_an_answer_has_to_be(whole: Path):
    """Each ended the report with a traceback, or was shown as it is, where its seal was taken off or made anew."""
    run, found = stored(whole)
    assert judged(run, found, 1e-9).judge.accepted
    wrong: list[tuple[dict[str, Any], str]] = [
        ({"details": {"histories": 5}}, "histories"),
        ({"details": {"start_values": ["a"]}}, "start_values"),
        ({"path": {"multiplier": [1.0, 2.0], "displacement": [1.0]}}, "different lengths"),
        ({"flow": "fine"}, 'flow rule "fine"'),
        ({"iterations": -1}, "number of iterations"),
        ({"multiplier": None}, "without a multiplier"),
        ({"method": "fe"}, "it is one of fe"),
    ]
    for change, words in wrong:
        with pytest.raises(InputError, match=f"the stored result of la on made-up: .*{words}"):
            judged(run, found.model_copy(update=change), 1e-9)


def test_what_follows_from_a_stored_answer_is_derived_anew(whole: Path):
    run, found = stored(whole)
    assert found.states is not None
    own = {"blocks": 99, "interfaces": 0, "bracket_wide": True, "bracket_width": 0.5, "unknowns": -1}
    again = judged(run, found.model_copy(update=own | {"states": ["stick"] * len(found.states)}), 1e-9)
    assert again.states == found.states
    assert {name: getattr(again, name) for name in own} == {name: getattr(found, name) for name in own}


def test_a_study_judges_a_row_without_its_seal_anew(store: Path):
    run, _ = stored(store)
    change(store, EDITS["multiplier"].replace("json_set(result", "json_set(json_remove(result, '$.seal')"))
    with open_store(store) as opened:
        ((_, result, was_stored),) = executed([run], opened, LocalExecutor(1), whole=False)
    assert was_stored
    assert (result.multiplier, result.judge.accepted) == (9.5, False)


LIES: dict[str, dict[str, Any]] = {
    "family": {"family": "fe"},
    "settings": {"settings": {"effort": "quick"}},
    "traits": {"traits": Traits(bounds_above=True, brackets=True, accuracy=0.5)},
}


@pytest.mark.parametrize("whole_result", [True, False])
@pytest.mark.parametrize("lie", list(LIES))
def test_what_a_method_says_of_itself_is_asked_of_it_where_a_seal_was_made_anew(
    store: Path, lie: str, whole_result: bool
):
    run, found = stored(store)
    with open_store(store) as opened:
        kept = opened.get(run.key)
        assert kept is not None
        opened.put(run.key, kept[0].model_copy(update=LIES[lie] | {"bracket_wide": True}), kept[1])
        ((_, result, was_stored),) = executed([run], opened, LocalExecutor(1), whole=whole_result)
    assert was_stored
    for name in (*LIES, "bracket_wide"):
        assert getattr(result, name) == getattr(found, name)


def test_a_coarser_tolerance_under_a_seal_made_anew_accepts_nothing_more(store: Path):
    """A multiplier that is .4 % too high is within a hundredth of the loads, and beyond the 1e-10 of its method."""
    run, found = stored(store)
    assert found.multiplier is not None
    higher = 1.004 * found.multiplier
    with open_store(store) as opened:
        kept = opened.get(run.key)
        assert kept is not None
        raised = kept[0].model_copy(update={"multiplier": higher, "forces_multiplier": higher})
        word = judge(run.case.assembly, raised, 9e-3).model_copy(update={"code": kept[0].judge.code})
        assert word.accepted
        for whole_result in (True, False):
            opened.put(run.key, raised.model_copy(update={"judge": word}), 9e-3)
            ((_, result, was_stored),) = executed([run], opened, LocalExecutor(1), whole=whole_result)
            assert was_stored
            assert (result.judge.tolerance, result.judge.accepted) == (found.judge.tolerance, False)


@pytest.mark.parametrize("whole_result", [True, False])
@pytest.mark.parametrize(
    "name", ["iterations", "unknowns", "blocks", "interfaces", "peak_memory_bytes", "cpu_seconds", "wall_seconds"]
)
def test_numbers_that_no_run_has_are_told_where_a_seal_was_made_anew(store: Path, name: str, whole_result: bool):
    """Tables have no counts beyond 64 bits: those of `compare`, `report` and `sweep` ended with a traceback."""
    run, _ = stored(store)
    with open_store(store) as opened:
        kept = opened.get(run.key)
        assert kept is not None
        for wrong in (-1,) if name.endswith("seconds") else (-1, 10**30):
            opened.put(run.key, kept[0].model_copy(update={name: wrong}), kept[1])
            with pytest.raises(InputError, match="the result of la on made-up in it: it is damaged"):
                list(executed([run], opened, LocalExecutor(1), whole=whole_result))


def test_a_study_takes_no_row_of_another_method(store: Path):
    run, _ = stored(store)
    with open_store(store) as opened:
        kept = opened.get(run.key)
        assert kept is not None
        opened.put(run.key, kept[0].model_copy(update={"method": "fe"}), kept[1])
        with pytest.raises(InputError, match="the stored result of la on made-up: it is one of fe"):
            list(executed([run], opened, LocalExecutor(1), whole=False))


def test_a_run_of_a_wall_that_the_comparison_does_not_have_is_told(store: Path):
    connection = sqlite3.connect(store)
    content = json.loads(connection.execute("SELECT content FROM comparison").fetchone()[0])
    connection.close()
    change(store, "UPDATE comparison SET content = ?", json.dumps(content | {"cases": {}}))
    with pytest.raises(InputError, match='no wall "made-up"'):
        read_all(store, read_only=True)


def test_another_programs_database_is_refused_and_left_as_it_is(tmp_path: Path):
    path = tmp_path / "other.sqlite"
    change(path, "CREATE TABLE run (id INTEGER PRIMARY KEY, distance REAL)")
    before = path.read_bytes()
    told_in_one_sentence(drystone("compare", "stack-2", "--store", path), "run", "another program's")
    assert path.read_bytes() == before
    unrelated = tmp_path / "unrelated.sqlite"
    change(unrelated, "CREATE TABLE bookmarks (id INTEGER PRIMARY KEY)")
    told_in_one_sentence(drystone("compare", "stack-2", "--store", unrelated), "bookmarks")


def test_a_store_of_a_later_release_is_refused(store: Path):
    change(store, f"PRAGMA user_version = {SCHEMA_VERSION + 1}")
    told_in_one_sentence(report(store), f"version {SCHEMA_VERSION + 1}", f"version {SCHEMA_VERSION}:")


@pytest.mark.parametrize("kind", ["fifo", "device", "folder", "text"])
def test_what_is_no_store_is_told(tmp_path: Path, kind: str):
    path = tmp_path / "s.sqlite"
    if kind == "fifo":
        os.mkfifo(path)
    elif kind == "device":
        path = Path("/dev/zero")
    elif kind == "folder":
        path.mkdir()
    else:
        path.write_text("no database at all, " * 100)
    told_in_one_sentence(drystone("report", "--store", path, "--report", tmp_path / "r.html"), str(path), "not a")


def test_a_file_in_place_of_the_folder_of_a_store_is_told(tmp_path: Path):
    (tmp_path / "notes").write_text("no folder")
    for path in (tmp_path / "notes" / "s.sqlite", tmp_path / "notes" / "more" / "s.sqlite"):
        with pytest.raises(InputError, match="is no folder") as told, open_store(path):
            pass
        assert str(path) in str(told.value)


def test_a_killed_run_leaves_a_log_and_a_report_from_a_read_only_copy_still_has_all_of_it(whole: Path, tmp_path: Path):
    path = tmp_path / "s.sqlite"
    script = (
        f"import os, shutil; from pathlib import Path; from tests.faults.test_store import filled, open_store\n"
        f"shutil.copyfile({str(whole)!r}, {str(path)!r})\n"
        f"with open_store(Path({str(path)!r})) as s:\n"
        f"    content = s.last_comparison(); content['title'] = 'in the log'\n"
        f"    s.remember('2026-11-25', content)\n"
        f"    os._exit(9)\n"
    )
    assert subprocess.run([sys.executable, "-c", script], timeout=120).returncode == 9
    assert path.with_name("s.sqlite-wal").stat().st_size > 0
    with open_store(path, read_only=True) as opened:
        compared = recall(opened)
    assert compared is not None
    assert compared.title == "in the log"


def test_a_store_that_is_locked_for_long_is_told(store: Path, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr("harness.engine.store.WAIT_SECONDS", 0.2)
    holder = sqlite3.connect(store, isolation_level=None)
    holder.execute("BEGIN EXCLUSIVE")
    with pytest.raises(InputError, match="another program has been writing it"), open_store(store) as opened:
        opened.remember("now", {})
    holder.close()


def test_two_programs_may_make_one_store_at_once(tmp_path: Path):
    script = (
        f"from pathlib import Path; from harness.engine.store import open_store\n"
        f"for k in range(20):\n"
        f"    with open_store(Path({str(tmp_path)!r}) / f's{{k}}.sqlite') as s: s.remember('now', {{}})\n"
    )
    running = [subprocess.Popen([sys.executable, "-c", script], stderr=subprocess.PIPE, text=True) for _ in range(3)]
    errors = [process.communicate(timeout=120)[1] for process in running]
    assert [process.returncode for process in running] == [0, 0, 0], errors
    for number in range(20):
        connection = sqlite3.connect(tmp_path / f"s{number}.sqlite")
        assert connection.execute("SELECT count(*) FROM comparison").fetchone() == (3,)
        connection.close()


def test_a_run_that_is_not_there_any_more_is_told(store: Path):
    with closing(sqlite3.connect(store)) as connection, connection:
        connection.execute("DELETE FROM run WHERE rowid = 1")
    told_in_one_sentence(report(store), "the result of", "not in it any more")


def test_an_index_that_has_lost_a_run_is_told_as_damage(store: Path):
    with closing(sqlite3.connect(store)) as connection, connection:
        connection.execute("CREATE INDEX spare ON run (case_id)")
        connection.execute("PRAGMA writable_schema = ON")
        connection.execute(
            "UPDATE sqlite_master SET rootpage = (SELECT rootpage FROM sqlite_master WHERE name = 'spare') "
            "WHERE name = 'sqlite_autoindex_run_1'"
        )
    told_in_one_sentence(report(store), "damaged")
