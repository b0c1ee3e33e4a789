"""The command as a user meets it: exit codes, one JSON document, clear errors, nothing written on bad input."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

from tests.commands import drystone
from tests.walls import running_bond, stack, wall_data, wedge

PROMISED = {
    "status",
    "sentence",
    "multiplier",
    "bracket",
    "verdict",
    "judge",
    "cpu_seconds",
    "wall_seconds",
    "peak_memory_bytes",
    "blocks",
    "interfaces",
    "settings",
    "versions",
}


@pytest.fixture
def wall(tmp_path: Path) -> Path:
    path = tmp_path / "stack.json"
    path.write_text(json.dumps(wall_data(stack(3), 0.25)))
    return path


def test_run_prints_one_json_document_with_the_promised_names(wall: Path):
    done = drystone("run", "la", wall.name, "--json", cwd=wall.parent)
    assert done.returncode == 0, done.stderr
    row = json.loads(done.stdout)
    assert set(row) >= PROMISED
    assert row["multiplier"] == pytest.approx(0.25, abs=1e-9)
    assert row["judge"]["accepted"] is True
    assert "equilibrium" in row["judge"]["residuals"]
    assert "forces" not in row
    full = json.loads(drystone("run", "la", wall.name, "--json", "--fields", cwd=wall.parent).stdout)
    assert len(full["forces"]) == full["interfaces"] == 3
    assert len(full["mechanism"]) == 4


def test_answer_of_a_run_is_accepted_by_judge_and_a_spoiled_one_is_not(wall: Path):
    answer = json.loads(drystone("run", "la", wall.name, "--json", "--fields", cwd=wall.parent).stdout)
    path = wall.parent / "answer.json"
    path.write_text(json.dumps(answer))
    good = drystone("judge", wall.name, path.name, "--json", cwd=wall.parent)
    assert good.returncode == 0, good.stdout
    assert json.loads(good.stdout)["accepted"] is True
    answer["multiplier"] = answer["forces_multiplier"] = 0.3
    path.write_text(json.dumps(answer))
    bad = drystone("judge", wall.name, path.name, cwd=wall.parent)
    assert bad.returncode == 1
    assert "equilibrium" in bad.stdout


def test_compare_leaves_report_and_store_and_reuses_what_is_there(wall: Path):
    words = ("compare", wall.name, "--methods", "fe,la-associated,de", "--json")
    first = drystone(*words, cwd=wall.parent)
    assert first.returncode == 0, first.stderr
    document = json.loads(first.stdout)
    assert document["passed"] is True
    rows = {row["method"]: row for row in document["cases"][0]["results"]}
    assert rows["fe"]["multiplier"] == pytest.approx(0.25, abs=1e-8)
    assert rows["de"]["bracket"][0] <= 0.25 * 1.01
    page = (wall.parent / "out" / "report.html").read_text()
    assert "stack" in page
    second = json.loads(drystone(*words, cwd=wall.parent).stdout)
    assert [row["started"] for row in second["cases"][0]["results"]] == [
        row["started"] for row in document["cases"][0]["results"]
    ]
    (wall.parent / "out" / "report.html").unlink()
    again = drystone("report", cwd=wall.parent)
    assert again.returncode == 0, again.stderr
    assert (wall.parent / "out" / "report.html").is_file()


def test_methods_that_are_split_on_the_dead_load_are_named_with_the_reason(tmp_path: Path):
    (tmp_path / "wedge.json").write_text(json.dumps(wedge()))
    done = drystone("compare", "wedge.json", "--methods", "fe,la,de", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    reason = "the wall falls for fe, de and stands for la"
    assert reason in done.stdout.replace("\n", " ")
    assert reason in (tmp_path / "out" / "report.html").read_text()


def test_expanded_wall_gives_the_same_answer(tmp_path: Path):
    path = tmp_path / "bond.json"
    path.write_text(json.dumps(wall_data(running_bond(3, 2))))
    expanded = drystone("expand", path.name, "-o", "explicit.json", cwd=tmp_path)
    assert expanded.returncode == 0, expanded.stderr
    values = [
        json.loads(drystone("run", "la-associated", name, "--json", cwd=tmp_path).stdout)["multiplier"]
        for name in ("bond.json", "explicit.json")
    ]
    assert values[0] == values[1]


def test_lists_are_json_on_demand(tmp_path: Path):
    cases = json.loads(drystone("list", "cases", "--json", cwd=tmp_path).stdout)
    assert {"single-block", "wall-21"} <= {row["id"] for row in cases}
    methods = json.loads(drystone("list", "methods", "--json", cwd=tmp_path).stdout)
    assert {"fe", "la", "de"} <= {row["name"] for row in methods}
    suites = json.loads(drystone("list", "suites", "--json", cwd=tmp_path).stdout)
    assert "paper" in {row["name"] for row in suites}


def spoiled(**changes: Any) -> str:
    return json.dumps(wall_data(stack(2)) | changes)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("{", ["wall.json", "line 1"]),
        (spoiled(format="wall/2"), ["wall.json", "wall/2", "wall/1"]),
        (spoiled(friktion=1), ["friktion"]),
        (spoiled(friction=-1), ["friction", "-1"]),
        (spoiled(unit_weight=None), ['block "1"', "weight"]),
        (spoiled(loads={"live": {"points": [{"block": "9", "at": [0, 0], "force": [1, 0]}]}}), ['"9"']),
    ],
)
@pytest.mark.parametrize("command", [("run", "la"), ("compare",), ("expand",)])
def test_bad_walls_exit_with_2_one_message_and_nothing_written(
    command: tuple[str, ...], text: str, words: list[str], tmp_path: Path
):
    path = tmp_path / "wall.json"
    path.write_text(text)
    done = drystone(*command, path.name, cwd=tmp_path)
    assert done.returncode == 2
    assert "Traceback" not in done.stderr
    assert done.stdout == ""
    for word in words:
        assert word in done.stderr
    assert sorted(item.name for item in tmp_path.iterdir()) == ["wall.json"]


@pytest.mark.parametrize(
    "words",
    [
        ("run", "magic", "wall-21"),
        ("run", "la", "no-such-case"),
        ("run", "la", "absent.json"),
        ("run", "la", "wall-21", "--set", "speed=9"),
        ("compare", "--suite", "no-such-suite"),
        ("compare", "wall-21", "--suite", "paper"),
        ("compare", "--methods", "magic"),
        ("compare", "--methods", ","),
        ("compare", "--seconds", "-1"),
        ("compare", "--seconds", "nan"),
        ("run", "la", "wall-21", "--seconds", "inf"),
        ("compare", "--cases", "no-such-folder"),
        ("report",),
        ("judge", "absent.json", "absent.json"),
        ("list", "everything"),
    ],
)
def test_bad_words_exit_with_2_and_no_traceback(words: tuple[str, ...], tmp_path: Path):
    done = drystone(*words, cwd=tmp_path)
    assert done.returncode == 2
    assert "Traceback" not in done.stderr
    assert done.stderr.strip()
    assert not list(tmp_path.iterdir())


def test_wall_that_cannot_stand_is_a_result_and_no_crash(tmp_path: Path):
    path = tmp_path / "overhang.json"
    path.write_text(json.dumps(wall_data(stack(2) | {"offsets": [0.0, 0.2]})))
    done = drystone("compare", path.name, "--methods", "fe,la,la-associated,de", "--json", cwd=tmp_path)
    rows = json.loads(done.stdout)["cases"][0]["results"]
    assert {row["finding"] for row in rows} == {"falls"}
    assert all(row["multiplier"] is None for row in rows)
    assert done.returncode == 0


CASE = """
id = "my-block"
title = "A block of a user"
source = "a drawing"

[[references]]
id = "closed-form"
type = "exact"
value = {value}
tolerance = 1e-9
applies_to = ["la-associated"]
gate = true
source = "statics"
requirement = "It slides at mu."
"""


@pytest.mark.parametrize(("value", "code"), [(0.25, 0), (0.26, 1)])
def test_cases_of_a_user_are_compared_and_gated(value: float, code: int, tmp_path: Path):
    folder = tmp_path / "mine" / "my-block"
    folder.mkdir(parents=True)
    (folder / "wall.json").write_text(json.dumps(wall_data(stack(1), 0.25)))
    (folder / "case.toml").write_text(CASE.format(value=value))
    done = drystone("compare", "--cases", "mine", "--methods", "la-associated", cwd=tmp_path)
    assert done.returncode == code, done.stdout + done.stderr
    assert "my-block" in done.stdout
    assert ("Not met, of" in done.stdout) is bool(code)
    checked = drystone("check", "my-block", "--cases", "mine", "--json", cwd=tmp_path)
    assert checked.returncode == code
    assert json.loads(checked.stdout)["passed"] is not bool(code)


def test_methods_that_a_case_names_and_nobody_has_are_told(tmp_path: Path):
    """A gated reference that applies to a misspelt method was ignored without a message, a chosen one a traceback."""
    folder = tmp_path / "mine" / "my-block"
    folder.mkdir(parents=True)
    (folder / "wall.json").write_text(json.dumps(wall_data(stack(1), 0.25)))
    case = CASE.format(value=0.25)
    (folder / "case.toml").write_text(case.replace('["la-associated"]', '["la-associated", "al"]'))
    done = drystone("compare", "--cases", "mine", "--methods", "la-associated", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    assert 'reference "closed-form" applies to "al"' in done.stderr
    (folder / "case.toml").write_text('methods = ["al"]' + case)
    done = drystone("compare", "--cases", "mine", cwd=tmp_path)
    assert done.returncode == 2
    assert 'methods of case "my-block": no method is called "al"' in done.stderr


def test_a_method_that_crashes_costs_one_row_and_not_the_run(wall: Path):
    words = ("--methods", "dummy,la-associated", "--set", "dummy.does=raise", "--seconds", "30")
    done = drystone("compare", wall.name, *words, cwd=wall.parent)
    assert done.returncode == 0, done.stderr
    assert "dummy" in done.stdout
    assert (wall.parent / "out" / "report.html").is_file()


def test_compare_takes_settings_of_methods_and_writes_no_report_when_told(wall: Path):
    words = ("compare", wall.name, "--methods", "la-associated", "--no-report", "--json")
    done = drystone(*words, "--set", "la-associated.solver=interior", cwd=wall.parent)
    assert done.returncode == 0, done.stderr
    document = json.loads(done.stdout)
    assert document["report"] is None
    assert document["cases"][0]["results"][0]["settings"] == {"solver": "interior"}
    assert [path.name for path in (wall.parent / "out").iterdir()] == ["drystone.sqlite"]


@pytest.mark.parametrize("given", ["solver=interior", "magic.solver=interior", "la-associated.speed=9"])
def test_settings_that_no_method_has_are_refused(given: str, wall: Path):
    done = drystone("compare", wall.name, "--set", given, cwd=wall.parent)
    assert done.returncode == 2
    assert "--set" in done.stderr
    assert not (wall.parent / "out").exists()


SOLVERS = ("highspy", "numba", "scipy.optimize", "cvxpy", "pymunk", "ipyopt", "osqp", "mujoco")


@pytest.mark.parametrize(
    ("words", "foreign"),
    [(("--version",), ("numpy", "pydantic", *SOLVERS)), (("--help",), ("numpy", "pydantic", *SOLVERS))]
    + [((*words,), SOLVERS) for words in (("list", "cases"), ("show", "wall-21", "-o", "wall.svg"))],
)
def test_a_command_imports_no_more_than_it_needs(words: tuple[str, ...], foreign: tuple[str, ...], tmp_path: Path):
    program = (
        "import atexit, sys; from drystone.cli.main import main\n"
        f"atexit.register(lambda: print([name for name in {foreign!r} if name in sys.modules], file=sys.stderr))\n"
        f"sys.argv = ['drystone', *{words!r}]; main()"
    )
    done = subprocess.run(
        [sys.executable, "-c", program], cwd=tmp_path, capture_output=True, text=True, timeout=120, check=True
    )
    assert done.stderr.strip() == "[]"


def test_a_comparison_without_any_answer_is_a_failure(wall: Path):
    done = drystone("compare", wall.name, "--methods", "dummy", "--set", "dummy.does=raise", cwd=wall.parent)
    assert done.returncode == 1, done.stdout
    assert "no run ended with an answer" in done.stdout


def test_a_rejected_answer_is_a_failure_of_the_comparison(wall: Path):
    done = drystone("compare", wall.name, "--methods", "dummy,la-associated", cwd=wall.parent)
    assert done.returncode == 1, done.stdout
    assert "dummy: the judge rejects the answer" in " ".join(done.stdout.split())


def test_a_result_is_as_wide_as_the_terminal(wall: Path):
    done = drystone("run", "la-associated", wall.name, cwd=wall.parent, variables={"COLUMNS": "60"})
    lines = done.stdout.splitlines()
    assert max(map(len, lines)) <= 60
    column = lines[0].index(lines[0].split(maxsplit=1)[1])
    assert {line[:column].strip() for line in lines} >= {"wall", "units", "method", "finding", "status", "judge", ""}
    assert all(line[column - 1] == " " != line[column] for line in lines if line.strip())


@pytest.mark.parametrize(
    ("words", "code"), [(("list", "cases", "--json"), 0), (("run", "la-associated", "stack.json"), 0), (("run",), 2)]
)
def test_the_process_of_a_command_ends_with_its_exit_code_and_all_that_it_wrote(
    words: tuple[str, ...], code: int, wall: Path
):
    program = "import atexit, sys; from drystone.__main__ import main; sys.argv = ['drystone', *sys.argv[1:]]\n"
    program += "import drystone.cli.main; old = drystone.cli.main.main\n"
    program += "def late(**more): atexit.register(print, 'last words'); old(**more)\n"
    program += "drystone.cli.main.main = late; main()"
    for command in (["-m", "drystone"], ["-c", program]):
        run = [sys.executable, *command, *words]
        done = subprocess.run(run, cwd=wall.parent, capture_output=True, text=True, timeout=120, check=False)
        assert done.returncode == code, done.stderr
        assert done.stderr.count("Usage") == (code == 2)
        assert ("last words\n" in done.stdout) is (command[0] == "-c")
        if "--json" in words:
            assert len(json.loads(done.stdout.removesuffix("last words\n"))) > 50


@pytest.mark.parametrize(
    ("words", "offered"),
    [
        (("run", "la-b"), ["la-bound"]),
        (("run", "la", "wall-21-friction-1"), ["wall-21-friction-100"]),
        (("compare", "single"), ["single-block"]),
        (("compare", "--methods", "fe,la-b"), ["fe,la-bound"]),
        (("factor", "--method", "fe-q"), ["fe-qp"]),
        (("bench", "--methods", "fe-q"), ["fe-qp"]),
        (("bench", "--set", "co"), ["core"]),
        (("compare", "--suite", "sm"), ["small"]),
    ],
)
def test_a_shell_is_offered_methods_and_cases(words: tuple[str, ...], offered: list[str]):
    context = {"COMP_WORDS": " ".join(("drystone", *words)), "COMP_CWORD": str(len(words))}
    done = drystone(variables=context | {"_DRYSTONE_COMPLETE": "bash_complete"})
    assert [line.removeprefix("plain,") for line in done.stdout.split()] == offered
