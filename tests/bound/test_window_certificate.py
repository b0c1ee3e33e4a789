"""Certificates of the relaxation's windows prove what they say in integers, and nothing that is false."""

from __future__ import annotations

import copy
import json
from fractions import Fraction
from functools import cache
from pathlib import Path
from typing import Any

import pytest
from click.testing import CliRunner
from hypothesis import given, settings
from hypothesis import strategies as st

from drystone.certificates import CERTIFICATE, PACKED, read_certificate
from drystone.cli.main import main as drystone
from harness.model.assembly import Assembly
from harness.model.case import read_case, shipped_cases
from methods.la.bounds import BoundedLimitAnalysis
from methods.la.certify.window_certificate import certified_bracket
from methods.la.core.newton_matrix import NewtonMatrix
from methods.la.core.problem import make_problem
from methods.la.settings import BoundSettings
from methods.la.sources.search import Search
from methods.proof.same_wall import require_same_wall
from methods.proof.verify.checker import verify
from methods.proof.verify.document import digest
from methods.proof.verify.exact_wall import CertificateError
from tests.bound.digits import one_digit_changed, refused_or_true
from tests.la.bodies import running_bond
from tests.walls import stack, wall_data

LEAST = Fraction(13, 20)
"""Least multiplier of 2 courses of 2 bricks .4 x .2 on friction 13/20: the top course slides."""


def certificate_of(wall: Assembly, seconds: float = 30.0) -> dict[str, Any]:
    problem = make_problem(wall)
    state = Search(problem, NewtonMatrix(problem)).interior()
    assert state is not None
    multiplier = state.multiplier * problem.unit_multiplier
    document = certified_bracket(problem, multiplier, problem.to_mechanism(state.velocities), seconds)[1]
    assert document is not None
    return document


@cache
def of_bond() -> dict[str, Any]:
    return certificate_of(running_bond(2, 2, 0.2, 0.65))


def test_a_bonded_wall_is_proved_to_a_millionth() -> None:
    wall = running_bond(2, 2, 0.2, 0.65)
    require_same_wall(of_bond(), wall)
    lower, upper = verify(of_bond())
    assert upper == LEAST
    assert 0 < upper - lower <= Fraction(1, 10**6) * upper


@settings(max_examples=40, deadline=None, derandomize=True)
@given(st.data())
def test_one_digit_changed_anywhere_is_refused(data: st.DataObject) -> None:
    with pytest.raises(CertificateError):
        verify(one_digit_changed(data, of_bond()))


@settings(max_examples=40, deadline=None, derandomize=True)
@given(st.data())
def test_one_digit_changed_proves_nothing_false_even_with_the_digest_made_anew(data: st.DataObject) -> None:
    """Changed in its last places a multiplier is only a slightly worse proof; nothing above the least is proved."""
    part = {key: of_bond()[key] for key in ("windows", "bound", "multiplier", "state")}
    refused_or_true(LEAST, of_bond() | one_digit_changed(data, part))


@pytest.mark.parametrize("friction", ["7/10", "16/25"])
def test_the_windows_of_one_wall_prove_nothing_of_another(friction: str) -> None:
    document = copy.deepcopy(of_bond())
    for item in document["interfaces"]:
        item["friction"] = friction
    with pytest.raises(CertificateError):
        verify(document | {"digest": digest(document)})


def test_a_bound_above_that_of_the_windows_is_refused() -> None:
    document = of_bond() | {"bound": str(LEAST)}
    with pytest.raises(CertificateError, match="windows prove"):
        verify(document | {"digest": digest(document)})


def test_windows_that_leave_a_gap_are_refused() -> None:
    assert of_bond()["windows"][0]["low"] == "0"
    for gone in range(len(of_bond()["windows"])):
        document = of_bond() | {"windows": [w for k, w in enumerate(of_bond()["windows"]) if k != gone]}
        with pytest.raises(CertificateError):
            verify(document | {"digest": digest(document)})


CHANGES: dict[str, Any] = {
    "a still contact too many": lambda w: (w["still"].append(0), w["still_velocities"].append([0] * 15)),
    "more normal force": lambda w: w["least"].__setitem__(0, str(Fraction(w["least"][0]) + Fraction(1, 1000))),
    "no bound of a force": lambda w: w["forces"]["total"].__setitem__(0, 0),
    "forces bounded by less": lambda w: w["forces"].__setitem__("exponent", w["forces"]["exponent"] + 1),
    "velocities of other strains": lambda w: w["motions"]["strains"].reverse(),
    "a higher value": lambda w: w["multiplier"]["columns"][-2].__setitem__(40, 2**60),
    "no equilibrium": lambda w: w["multiplier"]["balance"][0].__setitem__(0, 2**60),
    "negative weights": lambda w: w["weights"].__setitem__(0, -1),
}


@pytest.mark.parametrize("name", CHANGES)
def test_a_window_that_claims_more_is_refused(name: str) -> None:
    document = copy.deepcopy(of_bond())
    for window in document["windows"]:
        if name != "more normal force" or window["least"]:
            CHANGES[name](window)
    assert refused_or_true(LEAST, document)


BRACKET = "ferris-tin-loi-1"
"""The library wall whose windows do not close: its certificate leaves .002 % open."""

WITHOUT_STATE = {"arch-thrust-greatest": Fraction("0.0553105847"), "borri-arch-13": Fraction("0.133539189")}
"""Library walls whose least state is none in fractions, with their references as they are rounded."""


@pytest.mark.parametrize(
    "file",
    [pytest.param(file, id=file.parent.name, marks=[pytest.mark.slow] * (file.stat().st_size > 200_000))
     for file in sorted(shipped_cases().glob(f"*/{CERTIFICATE}{PACKED}"))],
)  # fmt: skip
def test_the_packed_certificates_of_library_walls_hold(file: Path) -> None:
    document = read_certificate(file)
    require_same_wall(document, read_case(file.parent).assembly)
    lower, shown = verify(document)
    assert (shown is None) == (file.parent.name in WITHOUT_STATE)
    upper = WITHOUT_STATE[file.parent.name] if shown is None else shown
    left_open = Fraction(21, 10**6) if file.parent.name == BRACKET else Fraction(2, 10**6)
    rounded = Fraction(5, 10**10) if shown is None else 0
    assert 0 < upper - lower <= left_open * upper + rounded


@pytest.mark.slow
@pytest.mark.parametrize(
    ("courses", "bricks", "least"), [(3, 2, Fraction(7, 11)), (4, 2, Fraction(3, 5)), (3, 3, Fraction(7, 11))]
)
def test_larger_bonds_are_proved(courses: int, bricks: int, least: Fraction) -> None:
    answer = BoundedLimitAnalysis().solve(running_bond(courses, bricks, 0.2, 0.65), BoundSettings(bound_seconds=120.0))
    assert answer.multiplier == pytest.approx(float(least), rel=1e-9)
    assert float(least) * (1 - 1e-6) <= answer.details["certified_bound"] <= least
    assert answer.sentence.startswith(f"The minimum collapse multiplier is {least}")


def test_the_commands_write_and_read_a_compressed_certificate(tmp_path: Path) -> None:
    pattern = {"type": "running_bond", "block_length": 0.4, "block_height": 0.2, "count": 2, "bricks": 2}
    wall, file = tmp_path / "wall.json", tmp_path / "certificate.json.gz"
    wall.write_text(json.dumps(wall_data(pattern | {"start": "half"}, 0.65)))
    run = CliRunner()
    assert (
        run.invoke(drystone, ["bound", str(wall), "-o", str(file), "--nodes", "1", "--effort", "quick"]).exit_code == 0
    )
    answer = run.invoke(drystone, ["verify-bound", str(file), "--wall", str(wall), "--json"])
    assert json.loads(answer.output)["multiplier"] == "13/20"
    file.write_bytes(file.read_bytes()[:-9])
    assert run.invoke(drystone, ["verify-bound", str(file)]).exit_code == 2


def test_a_wall_whose_joints_lift_as_they_slide_gets_no_certificate(tmp_path: Path) -> None:
    wall, file = tmp_path / "wall.json", tmp_path / "certificate.json"
    wall.write_text(json.dumps(wall_data(stack(2), {"default": 0.5, "dilatancy": 0.2})))
    answer = CliRunner().invoke(drystone, ["bound", str(wall), "-o", str(file)])
    assert (answer.exit_code, file.exists()) == (2, False)
    assert "have dilatancy" in answer.output
