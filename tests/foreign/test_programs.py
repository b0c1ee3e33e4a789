"""A program in any language is run, limited, judged and kept as any other method is, whatever it does."""

from __future__ import annotations

import json
import os
import sys
import time
from pathlib import Path

import psutil
import pytest

import drystone as library
from harness.engine.executors import Job, LocalExecutor
from harness.engine.worker import Task
from harness.model.foreign.register import VARIABLE, program_named
from harness.model.result import Result
from tests.commands import drystone
from tests.walls import assembly, stack

PROGRAM = str(Path(__file__).with_name("programs.py"))
CERTIFICATE = Path(__file__).parents[2] / "cases" / "slide" / "certificate.json"
ACTS = (
    *("answer", "exit", "abort", "nothing", "hang", "leave a child", "burn", "eat", "eat on", "multiplier", "nan"),
    *("begin a session", "begin a session and hang", "burn elsewhere"),
    *("wrong sign", "too few", "typing mistake", "text", "not converged", "words", "certificate", "forged"),
)


def listed() -> str:
    """A methods.toml with a method for each act, and one that answers by lines."""
    entries = []
    for what in ACTS:
        words = [sys.executable, PROGRAM, what, "{wall}", "{result}"]
        if what == "words":
            words += ["$HOME; touch pwned", "*", "{seconds}", "a b"]
        if what in ("certificate", "forged"):
            words += [str(CERTIFICATE)]
        entries.append(f"[methods.{what.replace(' ', '-')}]\ncommand = {json.dumps(words)}\nabout.tolerance = 1e-9\n")
    lines = [sys.executable, PROGRAM, "--lines"]
    entries.append(f"[methods.lines]\ncommand = {json.dumps(lines)}\nlines = true\ndescribe = true\n")
    entries.append(f"[methods.quick]\ncommand = {json.dumps([sys.executable, '-c', ''])}\nlines = true\n")
    return "\n".join(entries)


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    (tmp_path / "methods.toml").write_text(listed())
    monkeypatch.chdir(tmp_path)
    monkeypatch.delenv(VARIABLE, raising=False)
    return tmp_path


def ran(*names: str, seconds: float = 60.0, mebibytes: int = 2048, **settings: str) -> list[Result]:
    """Results of methods on one block that slides at 0.4, each in a process of its own."""
    wall = assembly(stack(1), 0.4)
    tasks = [Task(name, wall, settings, seconds, mebibytes * MEGABYTE, program=program_named(name)) for name in names]
    jobs = [Job(number, "block", task) for number, task in enumerate(tasks)]
    found = dict(LocalExecutor(1).map(iter(jobs), names))
    return [found[number].result for number in range(len(names))]


MEGABYTE = 2**20


def test_an_answer_is_judged_and_its_program_is_in_the_row():
    (found,) = ran("answer")
    assert (found.status, found.multiplier) == ("ok", 0.4)
    wall = library.library_wall("slide")
    judged = library.analyse(wall, "answer")
    assert judged.judge.accepted, judged.judge.sentence
    assert judged.multiplier == 0.3


@pytest.mark.parametrize(
    ("what", "status", "words"),
    [
        ("exit", "crashed", "exit code 3. It last printed: no licence found"),
        ("abort", "crashed", "SIGABRT"),
        ("nothing", "crashed", "wrote no result"),
        ("nan", "crashed", "NaN"),
        ("too-few", "crashed", "forces: it has 0 entries, and should have 1"),
        ("typing-mistake", "crashed", 'Did you mean "multiplier"'),
        ("text", "crashed", "JSON object"),
        ("not-converged", "not_converged", "It went round in circles."),
    ],
)
def test_what_a_program_does_wrong_is_said_of_it(what: str, status: str, words: str):
    (found,) = ran(what)
    assert (found.status, found.finding) == (status, "none")
    assert words in found.sentence


def test_a_program_that_hangs_is_stopped_and_ended():
    before = {child.pid for child in psutil.Process().children(recursive=True)}
    (found,) = ran("hang", seconds=1.5)
    assert found.status == "timeout"
    assert found.wall_seconds is not None
    assert found.wall_seconds < 10.0
    left = [child for child in psutil.Process().children(recursive=True) if child.pid not in before]
    assert not [child for child in left if PROGRAM in child.cmdline()]


@pytest.mark.parametrize(
    ("what", "status"),
    [("leave a child", "ok"), ("begin a session", "ok"), ("begin a session and hang", "timeout")],
)
def test_what_a_program_leaves_running_ends_with_its_run(what: str, status: str):
    """A process in a session of its own, and one whose parent has ended, are of no group that could be ended."""

    def running() -> set[int]:
        return {p.pid for p in psutil.process_iter(["cmdline"]) if what in (p.info["cmdline"] or [])}

    (found,) = ran(what.replace(" ", "-"), seconds=2.0)
    assert found.status == status
    until = time.monotonic() + 10.0
    while running() and time.monotonic() < until:
        time.sleep(0.05)
    assert running() == set()


def test_its_processor_time_and_memory_are_those_of_the_run():
    burned, ate = ran("burn", "eat")
    assert burned.cpu_seconds is not None
    assert ate.peak_memory_bytes is not None
    assert burned.cpu_seconds >= 0.45
    assert ate.peak_memory_bytes >= 390 * MEGABYTE


def test_processor_time_of_what_it_left_is_that_of_the_run():
    (found,) = ran("burn-elsewhere")
    assert found.cpu_seconds is not None
    assert found.cpu_seconds >= 0.45


def test_memory_between_two_looks_counts():
    """Processes that a worker started are looked at twice a second; this one needs less for all that it does."""
    (found,) = ran("lines", mebibytes=300, does="eat and go")
    assert found.status == "out_of_memory"


def test_a_program_that_eats_memory_is_stopped_at_the_limit():
    (found,) = ran("eat-on", mebibytes=500)
    assert found.status in ("out_of_memory", "crashed")  # its own interpreter may be told first
    assert found.peak_memory_bytes is None or found.peak_memory_bytes < 4000 * MEGABYTE


def test_arguments_reach_the_program_as_they_are_and_no_shell(folder: Path):
    (found,) = ran("words")
    words = found.details["words"]
    assert words[:2] == ["$HOME; touch pwned", "*"]
    assert float(words[2]) <= 60.0
    assert words[3] == "a b"
    assert not (folder / "pwned").exists()


def test_an_answer_without_forces_or_mechanism_is_not_judged_and_exits_with_3(folder: Path):
    done = drystone("run", "multiplier", "slide", cwd=folder)
    assert done.returncode == 3, done.stderr
    assert "0.3000000" in done.stdout
    compared = drystone("compare", "slide", "--methods", "multiplier", "--no-report", cwd=folder)
    assert compared.returncode == 0, compared.stdout


def test_a_wrong_sign_is_rejected(folder: Path):
    done = drystone("run", "wrong-sign", "slide", "--json", cwd=folder)
    assert done.returncode == 1
    assert json.loads(done.stdout)["judge"]["accepted"] is False


def test_a_certificate_is_checked_like_any_other_and_a_forged_one_refused(folder: Path):
    compared = library.compare(library.library_wall("slide").called("alone"), ["certificate", "forged"])
    good, bad = compared.results
    assert good.proof.standing == "minimum"
    assert "refused" in bad.proof.sentence
    assert bad.details["lower_bound"] == 0.3


def test_one_process_answers_many_walls_by_lines():
    first, second, third = ran("lines", "lines", "lines")
    assert first.status == "ok", first.sentence
    assert first.details["pid"] == second.details["pid"] == third.details["pid"]
    assert first.versions["lines"] == "2.5"
    burned = ran("lines", does="burn")[0]
    assert burned.cpu_seconds is not None
    assert burned.cpu_seconds >= 0.45


@pytest.mark.parametrize(
    ("does", "words"),
    [
        ("exit", 'wrote "no licence found"'),
        ("leave", "exit code 0"),
        ("chatter", 'wrote "I am thinking"'),
        ("typing mistake", 'Did you mean "multiplier"'),
        ("latin", "no UTF-8 text: byte 0xf6"),
    ],
)
def test_a_line_that_is_no_result_is_said_of_the_program(does: str, words: str):
    (found,) = ran("lines", does=does)
    assert found.status == "crashed"
    assert words in found.sentence


def test_what_a_program_says_unasked_answers_no_later_wall():
    """It answers twice: the second line must not be taken for the answer of the next wall."""
    first, second, third = ran("lines", "lines", "lines", does="twice")
    assert first.status == "ok"
    assert "before it was asked" in second.sentence
    assert third.status == "ok"


def test_a_program_by_lines_that_ends_at_once_is_said_to_have_ended():
    (found,) = ran("quick")
    assert "ended with exit code 0 and gave no line" in found.sentence


def test_lines_that_do_not_come_are_not_waited_for_and_the_next_run_is_made():
    (found,) = ran("lines", seconds=1.5, does="hang")
    assert found.status == "timeout"
    assert ran("lines")[0].status == "ok"


def test_a_program_describes_what_it_takes_and_its_settings(folder: Path):
    wrong = drystone("run", "lines", "slide", "--set", "does=dance", cwd=folder)
    assert wrong.returncode == 2
    assert "does" in wrong.stderr
    refused = drystone("run", "lines", "stack-10", "--json", cwd=folder)
    large = json.loads(refused.stdout)
    assert (refused.returncode, large["status"]) == (2, "refused")
    assert "up to 5 free blocks" in large["sentence"]
    (folder / "strong.json").write_text(json.dumps(wall_with(cohesion=1.0)))
    strong = drystone("run", "lines", "strong.json", "--json", cwd=folder)
    assert (strong.returncode, strong.stdout) == (2, "")
    assert "strong.json: lines takes dry joints only" in strong.stderr


@pytest.mark.parametrize("stream", [1, 2])
def test_a_description_without_end_is_cut_off(stream: int, folder: Path):
    """A program that prints as fast as it can is ended after a megabyte, long before its 30 s."""
    (folder / "prints.py").write_text(f"import os\nwhile True:\n    os.write({stream}, b'x' * 65536)\n")
    begun = time.monotonic()
    words = json.dumps([sys.executable, "prints.py", "{wall}", "{result}"])
    (folder / "methods.toml").write_text(f"[methods.prints]\ncommand = {words}\ndescribe = true\n")
    done = drystone("run", "prints", "slide", cwd=folder)
    assert time.monotonic() - begun < 20.0
    assert done.returncode == 2
    assert "prints more than a description" in done.stderr


def wall_with(**more: object) -> dict[str, object]:
    pattern = {"type": "stack", "width": 0.3, "height": 0.2, "count": 1}
    loads = {"live": {"body": [{"per_weight": [1, 0]}]}}
    return {"format": "wall/1", "unit_weight": 20.0, "friction": 0.4, "pattern": pattern, "loads": loads} | more


def test_a_changed_program_answers_anew(folder: Path):
    script = folder / "mine.py"
    script.write_text(Path(PROGRAM).read_text())
    words = f"{sys.executable} mine.py answer {{wall}} {{result}}"
    assert drystone("methods", "add", "mine", "--command", words, cwd=folder).returncode == 0
    run = ("compare", "slide", "--methods", "mine", "--no-report")
    assert "(stored)" not in drystone(*run, cwd=folder).stderr
    assert "(stored)" in drystone(*run, cwd=folder).stderr
    script.write_text(script.read_text() + "\n")
    assert "(stored)" not in drystone(*run, cwd=folder).stderr


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ('[methods.mine]\ncommand = ["prog"]\n', '"{wall}" and "{result}"'),
        ('[methods.mine]\ncomand = ["prog"]\n', 'Did you mean "command"'),
        ('[methods.la]\ncommand = ["prog", "{wall}", "{result}"]\n', "an installed method has this name"),
        ('[methods."My Method"]\ncommand = ["prog", "{wall}", "{result}"]\n', "no name of a method"),
        ("[methods", "valid TOML"),
        ("[methods.mine]\ntolerance = 1\n", "methods.mine.command: it is missing"),
    ],
)
def test_a_wrong_entry_is_told_with_its_file_and_field(folder: Path, text: str, words: str):
    (folder / "methods.toml").write_text(text)
    done = drystone("list", "methods", cwd=folder)
    assert done.returncode == 2
    assert "methods.toml" in done.stderr
    assert words in done.stderr


def test_a_program_that_is_not_there_is_a_row_and_methods_add_refuses_it(folder: Path):
    (folder / "methods.toml").write_text('[methods.gone]\ncommand = ["./gone", "{wall}", "{result}"]\n')
    done = drystone("compare", "slide", "--methods", "gone,la-associated", "--no-report", "--json", cwd=folder)
    rows = {row["method"]: row for row in json.loads(done.stdout)["cases"][0]["results"]}
    assert rows["la-associated"]["status"] == "ok"
    assert "cannot be started" in rows["gone"]["sentence"]
    added = drystone("methods", "add", "also", "--command", "./also {wall} {result}", cwd=folder)
    assert added.returncode == 2
    assert "cannot be started" in added.stderr


def test_a_file_of_methods_elsewhere_is_given_by_option(folder: Path, tmp_path_factory: pytest.TempPathFactory):
    elsewhere = tmp_path_factory.mktemp("elsewhere")
    words = ("--methods-file", os.path.relpath(folder / "methods.toml", elsewhere), "run", "answer", "slide")
    assert drystone(*words, cwd=elsewhere).returncode == 0
    assert drystone("run", "answer", "slide", cwd=elsewhere).returncode == 2
