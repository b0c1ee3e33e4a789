"""Certificates prove what they say in fractions, and a changed one is refused."""

from __future__ import annotations

import copy
import json
from dataclasses import replace
from fractions import Fraction
from functools import cache
from pathlib import Path
from typing import Any

import pytest
from click.testing import CliRunner
from hypothesis import given, settings
from hypothesis import strategies as st

from drystone.certificates import CERTIFICATE, read_certificate
from drystone.cli.main import main as drystone
from harness.model.case import read_case, shipped_cases
from methods.la.bounds import BoundedLimitAnalysis
from methods.la.find_certificate import certificate
from methods.la.settings import BoundSettings
from methods.proof.same_wall import require_same_wall
from methods.proof.verify.checker import main, verify
from methods.proof.verify.document import digest
from methods.proof.verify.exact_wall import CertificateError
from tests.bound.digits import one_digit_changed
from tests.la import bodies
from tests.walls import assembly, stack, wall_data


@cache
def of_column() -> dict[str, Any]:
    document = certificate(assembly(stack(2), 0.5))
    assert document is not None
    return document


def test_the_certificate_of_a_column_proves_its_least_multiplier(tmp_path: Any) -> None:
    """A column of two blocks .3 wide and .4 high in all on friction .5 slides at 1/2, below its rocking at 3/4."""
    lower, upper = verify(of_column())
    assert upper == Fraction(1, 2)
    assert 0 < upper - lower <= Fraction(2, 10**6) * upper
    file = tmp_path / "certificate.json"
    file.write_text(json.dumps(of_column()))
    assert main([str(file)]) == 0


def test_a_bound_above_the_least_multiplier_is_refused() -> None:
    document = copy.deepcopy(of_column())
    document |= {"bound": "499/1000", "multiplier": "499/1000"}
    document["digest"] = digest(document)
    with pytest.raises(CertificateError):
        verify(document)
    document = copy.deepcopy(of_column()) | {"bound": "501/1000"}
    document["digest"] = digest(document)
    with pytest.raises(CertificateError):
        verify(document)


@settings(max_examples=60, deadline=None, derandomize=True)
@given(st.data())
def test_a_certificate_never_proves_another_thing_with_one_digit_changed(data: st.DataObject) -> None:
    """Its fractions refuse it even with the digest made anew, or show the same multiplier."""
    changed = of_column() | one_digit_changed(data, {key: of_column()[key] for key in ("multiplier", "state")})
    try:
        _, upper = verify(changed | {"digest": digest(changed)})
    except CertificateError:
        return
    assert upper == Fraction(1, 2)  # another collapse state at the same multiplier


@settings(max_examples=60, deadline=None, derandomize=True)
@given(st.data())
def test_a_certificate_with_one_digit_changed_anywhere_is_refused(data: st.DataObject) -> None:
    with pytest.raises(CertificateError):
        verify(one_digit_changed(data, of_column()))


def test_the_certificates_of_library_walls_hold() -> None:
    files = sorted(shipped_cases().glob(f"*/{CERTIFICATE}"))
    assert len(files) >= 8
    for file in files:
        document = read_certificate(file)
        require_same_wall(document, read_case(file.parent).assembly)
        lower, upper = verify(document)
        assert 0 < upper - lower <= Fraction(2, 10**6) * upper


def test_the_commands_write_and_check_a_certificate(tmp_path: Path) -> None:
    wall, file = tmp_path / "wall.json", tmp_path / "certificate.json"
    wall.write_text(json.dumps(wall_data(stack(2), 0.5)))
    run = CliRunner()
    assert run.invoke(drystone, ["bound", str(wall), "-o", str(file)]).exit_code == 0
    assert json.loads(run.invoke(drystone, ["verify-bound", str(file), "--json"]).output)["multiplier"] == "1/2"
    file.write_text(file.read_text().replace('"bound": "', '"bound": "1'))
    assert run.invoke(drystone, ["verify-bound", str(file)]).exit_code == 1
    file.write_text("[]")
    assert run.invoke(drystone, ["verify-bound", str(file)]).exit_code == 2, "it is no certificate"


@pytest.mark.parametrize("changed", [wall_data(stack(2), 0.6), wall_data(stack(3), 0.5)])
def test_a_certificate_of_another_wall_is_refused(tmp_path: Path, changed: dict[str, Any]) -> None:
    wall, file = tmp_path / "wall.json", tmp_path / "certificate.json"
    file.write_text(json.dumps(of_column()))
    wall.write_text(json.dumps(wall_data(stack(2), 0.5)))
    run = CliRunner()
    assert run.invoke(drystone, ["verify-bound", str(file), "--wall", str(wall)]).exit_code == 0
    wall.write_text(json.dumps(changed))
    answer = run.invoke(drystone, ["verify-bound", str(file), "--wall", str(wall)])
    assert (answer.exit_code, "another wall" in answer.output) == (1, True)


@pytest.mark.parametrize("key", ["centroid", "dead", "live"])
def test_one_number_of_the_wall_tells_it_from_another(key: str) -> None:
    document = copy.deepcopy(of_column())
    value = Fraction(document["blocks"][1][key][1])
    document["blocks"][1][key][1] = str(value + Fraction(1, 10**6))
    with pytest.raises(CertificateError, match="another wall"):
        require_same_wall(document, assembly(stack(2), 0.5))


def test_the_full_check_shows_a_certificate_of_another_wall_in_red(tmp_path: Path) -> None:
    """The case of one wall with the certificate of another; then with its own."""
    case = tmp_path / "cases" / "mine"
    case.mkdir(parents=True)
    library = shipped_cases()
    (case / "wall.json").write_text((library / "stack-2" / "wall.json").read_text())
    text = (library / "stack-2" / "case.toml").read_text()
    (case / "case.toml").write_text(text.replace('id = "stack-2"', 'id = "mine"', 1))
    asked = ["check", "mine", "--tier", "full", "--cases", str(case.parent), "--store", str(tmp_path / "s"), "--json"]
    for of, code, verdict in (("stack-10", 1, "violates_bound"), ("stack-2", 0, "agrees")):
        (case / CERTIFICATE).write_text((library / of / CERTIFICATE).read_text())
        answer = CliRunner().invoke(drystone, asked)
        line = json.loads(answer.output)["references"][-1]
        assert (line["quantity"], line["verdict"]) == ("certificate", verdict)
        assert code == 0 or answer.exit_code == 1


def test_the_bound_hands_over_a_certificate_and_says_so() -> None:
    wall = assembly(stack(2), 0.5)
    answer = BoundedLimitAnalysis().solve(wall, BoundSettings(bound_seconds=20.0))
    document = answer.details["certificate"]
    require_same_wall(document, wall)
    assert verify(document) == (Fraction(499999, 10**6), Fraction(1, 2))
    assert answer.details["certified_bound"] == 0.499999
    assert "proved in fractions" in answer.sentence
    hurried = BoundedLimitAnalysis().solve(wall, BoundSettings(bound_seconds=1e-9))
    assert "certificate" not in hurried.details
    assert "proved in fractions" not in hurried.sentence


def test_symmetrical_hinges_that_are_none_in_fractions_are_proved_all_the_same() -> None:
    """Vertices of leaves contradict themselves by 1e-15; least by a linear programme (tests/cases/test_thrusts.py)."""
    wall = read_case(shipped_cases() / "arch-thrust-least").assembly
    document = certificate(wall)
    assert document is not None
    lower, upper = verify(document)
    assert upper is not None
    assert 0 < upper - lower <= Fraction(2, 10**6) * upper
    assert float(upper) == pytest.approx(0.0457551613, abs=2e-10)


@pytest.mark.parametrize(
    ("height", "friction", "least"),
    [(0.5, 1.0, Fraction(5, 6)), (0.5, 1.25, Fraction(25, 29)), (1.0, 1.5, Fraction(5, 6))],
)
def test_leaves_with_forces_at_zero_take_no_velocities_without_work_of_the_dead_load(
    height: float, friction: float, least: Fraction
) -> None:
    """A block one wide on two halves, lifted by its weight and pushed by a fifth of it.

    It slides at mu (1 - x) = x / 5 and rocks at (1 - x) / 2 = x h / 10.
    """
    wall = bodies.stack([1.0], [height], friction, halves=2)
    lifted = replace(wall, live=wall.live * 0.2 - wall.dead)
    document = certificate(lifted)
    assert document is not None
    lower, upper = verify(document)
    assert upper == least
    assert 0 < upper - lower <= Fraction(2, 10**6) * upper
