"""No certificate takes more time or memory than the checker allows, and what is too large is refused at once."""

from __future__ import annotations

import gzip
import time
import tracemalloc
from fractions import Fraction
from pathlib import Path
from typing import Any

import pytest
from click.testing import CliRunner

from drystone.certificates import PACKED, read_certificate
from drystone.cli.main import main as drystone
from harness.model.case import shipped_cases
from harness.model.errors import InputError
from methods.proof.verify import document as documents
from methods.proof.verify.checker import verify
from methods.proof.verify.document import digest
from methods.proof.verify.exact_wall import CertificateError, ExactWall
from tests.bound.shown import DATA, refused, tree, windows


def test_one_leaf_with_every_contact_in_both_sets_does_not_take_the_time_of_all_cases() -> None:
    """A cover of 2^40 nodes, if overlapping leaves counted for both halves."""
    document: dict[str, Any] = read_certificate(shipped_cases() / "stack-10" / "certificate.json")
    every = list(range(40))
    document["leaves"] = [leaf | {"tight": every, "still": every} for leaf in document["leaves"]]
    assert "both tight and still" in refused(document)


def test_a_check_ends_when_its_seconds_are_over() -> None:
    with pytest.raises(CertificateError, match="time limit"):
        verify(windows(), seconds=-1.0)


LARGE: dict[str, tuple[bytes, str]] = {
    "a small file of many bytes": (gzip.compress(b" " * (documents.MOST_BYTES + 1)), "bytes, unpacked"),
    "many values": (gzip.compress(b"[" + b"0," * documents.MOST_VALUES + b"0]"), "values"),
    "many objects": (gzip.compress(b"[" + b"{}," * documents.MOST_OBJECTS + b"{}]"), "objects"),
    "a long number": (b'{"bound": ' + b"1" * 5000 + b"}", "digits"),
    "deep lists": (b"[" * 100_000 + b"]" * 100_000, ""),
    "another part": (gzip.compress(b"{}") + gzip.compress(b"{}"), "follows the end"),
    "cut short": (gzip.compress(b"{}")[:-5], "cut short"),
    "no gzip": (b"\x1f\x8bnothing", "unpacked"),
    "a name twice": (b'{"bound": "1", "bound": "2"}', "twice"),
    "no text": (b"\xff\xfe{}", ""),
}


@pytest.mark.parametrize("name", LARGE)
def test_what_is_too_much_to_be_read_is_refused_at_once(name: str, tmp_path: Path) -> None:
    content, reason = LARGE[name]
    file = tmp_path / ("certificate.json" + PACKED)
    file.write_bytes(content)
    with pytest.raises(InputError) as raised:
        read_certificate(file)
    assert reason in str(raised.value)
    with pytest.raises(CertificateError):
        documents.read(content)
    assert CliRunner().invoke(drystone, ["verify-bound", str(file)]).exit_code == 2


@pytest.mark.parametrize("packed", [False, True])
def test_a_certificate_of_exactly_the_limits_is_read_and_of_one_more_is_not(
    packed: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    def read(content: bytes) -> Any:
        return documents.read(gzip.compress(content) if packed else content)

    content = b'{"a": [1, 2, 30]}'  # an object, a list and three numbers
    for name, most in (("MOST_BYTES", len(content)), ("MOST_VALUES", 5), ("MOST_OBJECTS", 1)):
        with monkeypatch.context() as limited:
            limited.setattr(documents, name, most)
            assert read(content) == {"a": [1, 2, 30]}
            limited.setattr(documents, name, most - 1)
            with pytest.raises(CertificateError, match=f"more than {most - 1} "):
                read(content)
    digits = documents.MOST_DIGITS
    assert read(b"1" * digits) == int("1" * digits)
    with pytest.raises(CertificateError, match=f"more than {digits} digits"):
        read(b"1" * (digits + 1))


def test_a_number_in_powers_of_ten_is_refused_at_once() -> None:
    answer = CliRunner().invoke(drystone, ["verify-bound", str(DATA / "exp.json")])
    assert (answer.exit_code, "is not a fraction" in answer.output) == (1, True)


def test_denominators_that_have_no_short_multiple_are_refused_at_once() -> None:
    """Sums of such fractions would grow by a thousand digits each."""
    document = tree()
    block = document["blocks"][0]
    document["blocks"] += [
        block | {"dead": [f"1/{10**900 + 2 * k + j}" for j in range(3)]} for k in range(3, 3 * 200, 3)
    ]
    assert "denominator" in refused(document)


def test_a_wall_of_many_blocks_and_joints_takes_no_table_of_both() -> None:
    """4,000 more blocks, and as many joints of the first: 10^8 entries if rows were full."""
    document = tree()
    document["blocks"] += [document["blocks"][0]] * 4_000
    document["interfaces"] += [document["interfaces"][0]] * 4_000
    tracemalloc.start()
    reason = refused(document)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert "numbers are needed" in reason
    assert peak < 200 * 2**20


def test_every_sum_of_a_check_ends_when_its_seconds_are_over() -> None:
    seconds = 0.2
    wall = ExactWall(tree(), seconds)
    ones = [Fraction(1)] * 6
    end = time.process_time() + seconds
    while time.process_time() <= end:
        pass
    for sums in (lambda: wall.work(wall.live, ones[:3]), lambda: wall.resultant(ones), lambda: wall.strains(0, ones)):
        with pytest.raises(CertificateError, match="time limit"):
            sums()


def test_leaves_of_numbers_without_a_short_common_multiple_do_not_take_long() -> None:
    """3,000 leaves on 20 joints."""
    document = tree()
    del document["state"]
    document["interfaces"] = [document["interfaces"][0]] * 20
    forces = [f"1/{10**299 + 2 * k + 1}" for k in range(60)]
    document["leaves"] = [{"tight": [], "still": [], "forces": forces, "parts": ["1", "0"]}] * 3_000
    document["digest"] = digest(document)
    began = time.process_time()
    with pytest.raises(CertificateError):
        verify(document, seconds=2.0)
    assert time.process_time() - began < 4.0
