"""`drystone bound` says how far it came and what stopped it, and what it expects of a large wall before it begins."""

from __future__ import annotations

import errno
import json
import math
from fractions import Fraction
from pathlib import Path
from typing import Any

import pytest
from click.testing import CliRunner, Result

from drystone.cli.main import main as drystone
from harness.model.proof import in_words
from methods.la.certify.window_certificate import equations_of
from methods.la.core.problem import make_problem
from methods.la.find_certificate import account
from methods.proof.search.bracket import bracket
from methods.proof.search.window_search import Bracket, Stop
from tests.la.bodies import running_bond as bond
from tests.walls import running_bond, stack, wall_data

DATA = Path(__file__).parents[1] / "data" / "walls"


def bound(tmp_path: Path, wall: dict[str, Any], *arguments: str) -> tuple[Result, Path]:
    file, output = tmp_path / "wall.json", tmp_path / "certificate.json"
    file.write_text(json.dumps(wall))
    return CliRunner().invoke(drystone, ["bound", str(file), "-o", str(output), *arguments]), output


def test_a_bound_without_time_says_so_and_writes_nothing(tmp_path: Path) -> None:
    wall = wall_data(running_bond(4, 3), 0.65)
    answer, output = bound(tmp_path, wall, "--seconds", "0", "--effort", "quick", "--nodes", "1")
    assert (answer.exit_code, output.exists()) == (1, False)
    assert "nothing is proved in fractions" in answer.output
    assert "the least state known is" in answer.output
    assert Stop.TIME in answer.output


def test_a_bound_by_two_processes_says_that_its_seconds_are_of_both(tmp_path: Path) -> None:
    wall = wall_data(running_bond(4, 3), 0.65)
    answer, _ = bound(tmp_path, wall, "--seconds", "0", "--effort", "quick", "--nodes", "1", "--jobs", "2")
    assert answer.exit_code == 1
    assert "s of 2 processes the bound is still at zero" in answer.output


def test_a_certificate_that_cannot_be_written_is_told_with_its_file_and_no_run_is_called_kept(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """No store is an option of `drystone bound`."""

    def full(*arguments: Any) -> None:
        raise OSError(errno.ENOSPC, "No space left on device")

    with monkeypatch.context() as patched:
        patched.setattr("pathlib.Path.write_bytes", full)
        answer, output = bound(tmp_path, wall_data(stack(2), 0.5))
    assert (answer.exit_code, output.exists()) == (2, False)
    assert f"{output}: No space left on device. Free room" in answer.output
    assert "kept" not in answer.output
    assert list(tmp_path.glob(".certificate*")) == []

    def interrupted(*arguments: Any) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr("methods.la.find_certificate.find_certificate", interrupted)
    answer, output = bound(tmp_path, wall_data(stack(2), 0.5))
    assert (answer.exit_code, answer.output) == (130, "drystone: interrupted\n")


@pytest.mark.parametrize("output", ["", "new/"])
def test_an_output_that_names_no_file_is_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, output: str) -> None:
    """A certificate was written to a file `new` for one who meant a folder."""
    monkeypatch.chdir(tmp_path)
    answer = CliRunner().invoke(drystone, ["bound", "slide", "-o", output])
    assert answer.exit_code == 2
    assert f'"{output}" names no file. Give the name of a file' in answer.output
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    "digits", ["311375536817721299999999999", "-311375536817721299999999999", "3000000000000000000000001"]
)
def test_a_state_is_not_shown_below_a_bound_that_it_is_above(digits: str) -> None:
    state = Fraction(int(digits), 10**24)
    bound = Fraction(math.floor(state * 10**12), 10**12)
    assert state - Fraction(in_words(bound)) < Fraction(1, 10**12)
    assert Fraction(in_words(bound)) <= Fraction(in_words(state)) <= state


def test_a_wall_that_no_live_load_moves_has_no_bound_and_is_told_why(tmp_path: Path) -> None:
    wall = wall_data(stack(3), 0.5, loads={"live": {"body": [{"per_weight": [0, -1]}]}})
    answer, output = bound(tmp_path, wall)
    assert (answer.exit_code, output.exists()) == (1, False)
    assert "cannot make the wall collapse" in answer.output


def test_of_a_wall_that_falls_no_bound_is_shown_though_a_load_would_hold_it(tmp_path: Path) -> None:
    """A block on a slope steeper than its friction: pushed up the slope it slides up at 7/10 + 1/2."""
    loads = {"gravity": [0.7, -1.0], "live": {"body": [{"per_weight": [-1, 0]}]}}
    answer, output = bound(tmp_path, wall_data(stack(1, 1.0, 0.5), 0.5, loads=loads))
    assert (answer.exit_code, output.exists()) == (1, False)
    assert "falls under its dead load" in answer.output


def test_a_wall_whose_supports_move_has_no_certificate_and_is_refused(tmp_path: Path) -> None:
    """One was written before, which `verify-bound --wall` refused."""
    wall = wall_data(stack(1), 0.5, settlements=[{"blocks": ["base"], "translation": [0, -1]}])
    answer, output = bound(tmp_path, wall)
    assert (answer.exit_code, output.exists()) == (2, False)
    assert "some supports move" in answer.output


def test_of_a_wall_too_large_no_search_is_begun(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def searched(*arguments: Any) -> None:
        raise AssertionError("the search was begun")

    monkeypatch.setattr("methods.la.find_certificate.least_known", searched)
    answer, _ = bound(tmp_path, wall_data(running_bond(14, 8), 0.65))
    assert answer.exit_code == 1
    assert "more than 300" in answer.output


def test_what_is_known_to_be_loose_is_said_before_the_search(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    class Begun(Exception):
        pass

    def searched(*arguments: Any) -> None:
        raise Begun

    monkeypatch.setattr("methods.la.find_certificate.least_known", searched)
    for courses, told in ((10, True), (4, False)):
        answer, _ = bound(tmp_path, wall_data(running_bond(courses, 6), 0.65))
        assert isinstance(answer.exception, Begun)
        assert ("lies well below" in answer.output) is told


STOPPED = {
    "the time": (Bracket(0.25, 0.5, stopped=Stop.TIME), Stop.TIME.value),
    "a window that exact arithmetic refuses": (Bracket(0.25, 0.25, refused="a weight is above zero"), "above zero"),
    "parts without a certificate": (Bracket(0.25, 0.25), "exact arithmetic gives a lower bound"),
}


@pytest.mark.parametrize("name", STOPPED)
def test_a_bound_that_stalls_says_how_far_it_came(name: str) -> None:
    found, reason = STOPPED[name]
    problem = make_problem(bond(2, 2, 0.2, 0.65))
    sentence = account(problem, 0.65, found, {"bound": "1/8"}, 3.0)
    assert f"at {0.25 * problem.unit_multiplier:.7g} in floating point, at 0.125 in fractions" in sentence
    assert "After 3.0 s of CPU time" in sentence
    assert "the least state known is 0.65. Reasons: " in sentence
    assert reason in sentence


def test_a_bound_that_meets_the_state_needs_no_account() -> None:
    problem = make_problem(bond(2, 2, 0.2, 0.65))
    assert account(problem, 0.65, Bracket(0.0, 0.65), {"bound": "649999/1000000"}, 3.0) == ""
    assert account(problem, 0.65, Bracket(0.0, 0.65), {"bound": "649/1000"}, 3.0) != ""


def test_a_bracket_that_closes_has_nothing_that_stopped_it() -> None:
    problem = make_problem(bond(2, 2, 0.2, 0.65))
    found = bracket(equations_of(problem), 0.65 / problem.unit_multiplier, 30.0)
    assert (found.closed, found.stopped, found.refused) == (True, None, "")


@pytest.mark.slow
def test_what_the_tree_and_the_windows_both_refused_is_proved_now(tmp_path: Path) -> None:
    for name in ("arch-five-voussoirs", "courses-unequal-joints"):
        answer, output = bound(tmp_path, json.loads((DATA / f"{name}.json").read_text()))
        assert answer.exit_code == 0
        assert "proved in fractions" in answer.output
        checked = CliRunner().invoke(drystone, ["verify-bound", str(output), "--wall", str(tmp_path / "wall.json")])
        assert checked.exit_code == 0
