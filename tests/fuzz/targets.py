"""What a fuzzed document is given to, and what may come of it: a judged answer, or a sentence with exit code 2."""

from __future__ import annotations

import json
import signal
import sqlite3
import tempfile
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import cache
from pathlib import Path
from typing import Any

from harness.engine.compare import comparison_run, recall, remember
from harness.engine.judge import answered, judge
from harness.engine.run import Limits, Run
from harness.engine.store import open_store
from harness.model.build import Built, build
from harness.model.case import Case, CaseFile, read_case
from harness.model.errors import InputError
from harness.model.foreign.result_document import answer_from_file
from harness.model.json_text import read_json
from harness.model.method import Finding, Status
from harness.model.method_registry import load_method
from harness.model.reading import parse_wall, read_wall, wall_json
from harness.model.result import Result, result_of
from tests.fuzz import documents
from tests.fuzz.documents import Source, one_of
from tests.walls import running_bond, stack, wall_data

LONGEST = 20
"""Seconds that one document may take: the limit of a hang, not of speed."""
SOLVED = 40
"""One in so many walls that can be built is also solved and its answer judged."""


class Hang(Exception):
    """A document took too long."""


@contextmanager
def _in_time() -> Iterator[None]:
    def told(*_: Any) -> None:
        raise Hang(f"more than {LONGEST} s")

    before = signal.signal(signal.SIGALRM, told)
    signal.alarm(LONGEST)
    try:
        yield
    finally:
        signal.alarm(0)
        signal.signal(signal.SIGALRM, before)


def outcome(target: str, source: Source, folder: Path) -> str:
    """The outcome of one document: "answer", "built" or "sentence".

    Raises:
        Exception: whatever else came of it; that is a finding.
    """
    with _in_time():
        try:
            return TARGETS[target](source, folder)
        except InputError as error:
            sentence = str(error)
            assert sentence.strip(), "an error without a sentence"
            assert all(line.isprintable() for line in sentence.split("\n")), "control characters in a sentence"
            return "sentence"


def _wall(source: Source, folder: Path) -> str:
    path = folder / "wall.json"
    path.write_bytes(documents.spoiled_text(source, documents.spoiled(source, documents.wall(source))))
    built = read_wall(path)
    again = parse_wall(json.loads(wall_json(built.wall)), "again")
    assert again.document() == built.wall.document(), "the explicit form is read otherwise than it was written"
    if source.integer(1, SOLVED) > 1 or built.assembly.n_free > 12:
        return "built"
    return _solved(built)


def _solved(built: Built) -> str:
    result, judgement = answered(load_method("la-associated"), built.assembly)
    assert result.status is not Status.CRASHED, result.sentence
    result.model_copy(update={"judge": judgement}).model_dump_json()
    json.dumps(judgement.model_dump(mode="json"), allow_nan=False)
    return "answer"


def _case(source: Source, folder: Path) -> str:
    place = folder / "fuzzed"
    place.mkdir(exist_ok=True)
    text = _toml(documents.spoiled(source, documents.case_file(source)))
    if source.integer(0, 15) == 0:
        text = text[: source.integer(0, len(text))]
    (place / "case.toml").write_text(text, encoding="utf-8", errors="replace")
    (place / "wall.json").write_text(json.dumps(documents.wall(source)))
    case = read_case(place)
    assert isinstance(case.warnings, tuple)
    return "built"


def _toml(data: Any) -> str:
    if not isinstance(data, dict):
        return f"value = {_toml_value(data)}\n"
    return "".join(f"{json.dumps(str(name))} = {_toml_value(item)}\n" for name, item in data.items())


def _toml_value(value: Any) -> str:
    if value is None:
        return '""'
    if isinstance(value, dict):
        return "{" + ", ".join(f"{json.dumps(str(name))} = {_toml_value(item)}" for name, item in value.items()) + "}"
    if isinstance(value, list):
        return "[" + ", ".join(_toml_value(item) for item in value) + "]"
    return json.dumps(value)


@cache
def _small_wall() -> Built:
    return build(parse_wall(wall_data(running_bond(2, 2)), "small"))


def _result(source: Source, folder: Path) -> str:
    built = _small_wall()
    data = documents.result(source, built.assembly.n_blocks, built.assembly.n_interfaces)
    path = folder / "result.json"
    path.write_bytes(documents.spoiled_text(source, documents.spoiled(source, data)))
    answer = answer_from_file(read_json(path), built.assembly, str(path))
    judged = result_of(answer, built.assembly, case="fuzzed", method="foreign", family="foreign")
    judgement = judge(built.assembly, judged, 1e-9)
    json.dumps(judgement.model_dump(mode="json"), allow_nan=False)
    assert judgement.sentence
    return "answer"


@cache
def _whole_store() -> bytes:
    """A store with a comparison of one run, made by the code itself."""
    wall = parse_wall(wall_data(stack(2)), "small")
    case = Case(CaseFile(id="fuzzed", title="t", source="none"), wall, "fuzzed/wall.json")
    run = Run(case, "la", {}, Limits())
    result = Result(
        case="fuzzed", method="la", family="la", key=run.key, status=Status.OK, finding=Finding.COLLAPSES, sentence="",
        multiplier=0.5, blocks=case.assembly.n_free, interfaces=case.assembly.n_interfaces,
    )  # fmt: skip
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "s.sqlite"
        with open_store(path) as store:
            store.put(run.key, result, 1e-9)
            remember(store, comparison_run("t", "drystone", [case], [run], [result]), [run])
        return path.read_bytes()


def _store(source: Source, folder: Path) -> str:
    path = folder / "s.sqlite"
    for beside in ("-wal", "-shm", ""):
        path.with_name(path.name + beside).unlink(missing_ok=True)
    content = bytearray(_whole_store())
    if source.integer(0, 1):
        for _ in range(source.integer(0, 6)):
            content[source.integer(0, len(content) - 1)] = source.integer(0, 255)
        if source.integer(0, 7) == 0:
            del content[source.integer(0, len(content) - 1) :]
        path.write_bytes(content)
    else:
        path.write_bytes(content)
        _change_row(source, path)
    with open_store(path, read_only=source.integer(0, 1) == 0) as store:
        compared = recall(store)
    return "built" if compared is None or not compared.cases else "answer"


def _change_row(source: Source, path: Path) -> None:
    """A fault in the JSON that a row holds."""
    table, column = one_of(source, [("run", "result"), ("comparison", "content")])
    connection = sqlite3.connect(path)
    with connection:
        text = connection.execute(f"SELECT {column} FROM {table}").fetchone()[0]
        changed = documents.spoiled_text(source, documents.spoiled(source, json.loads(text)))
        value: str | bytes = changed if source.integer(0, 9) == 0 else changed.decode("utf-8", "replace")
        connection.execute(f"UPDATE {table} SET {column} = ?", (value,))
    connection.close()


TARGETS: dict[str, Callable[[Source, Path], str]] = {"wall": _wall, "case": _case, "result": _result, "store": _store}
"""Targets by name."""
SHARES = ["wall"] * 5 + ["case"] * 2 + ["result"] * 2 + ["store"]
"""How often each target is chosen by the number of the document."""
