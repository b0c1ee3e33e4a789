"""Every statement of a certificate with something false in its place: what was tried to fool the checker."""

from __future__ import annotations

import copy
import gzip
import json
import time
import tracemalloc
from collections.abc import Callable
from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from click.testing import CliRunner

from drystone.certificates import PACKED, proved, read_certificate
from drystone.cli.main import main as drystone
from harness.model.assembly import Assembly
from harness.model.build import build
from harness.model.case import read_case, shipped_cases
from harness.model.content import content_of
from harness.model.errors import InputError
from harness.model.wall import Wall
from methods.proof.same_wall import require_same_wall
from methods.proof.tree.certificate import wall_document
from methods.proof.verify import document as documents
from methods.proof.verify.checker import main, verify
from methods.proof.verify.document import digest
from methods.proof.verify.exact_wall import CertificateError, ExactWall
from tests.walls import wall_data

DATA = Path(__file__).parents[1] / "data" / "certificates"


def tree() -> dict[str, Any]:
    """Of a block on two joints of friction 4/5 and 1/5, which slides at 1/5."""
    document: dict[str, Any] = read_certificate(shipped_cases() / "two-frictions" / "certificate.json")
    return document


def windows() -> dict[str, Any]:
    """Of a block on an incline."""
    document: dict[str, Any] = read_certificate(shipped_cases() / "incline-up" / ("certificate.json" + PACKED))
    return document


def refused(document: dict[str, Any]) -> str:
    with pytest.raises(CertificateError) as raised:
        verify(document | {"digest": digest(document)})
    return str(raised.value)


@pytest.mark.parametrize(("name", "wall"), [("overlap-slide", "slide"), ("overlap-stack-10", "stack-10")])
def test_a_leaf_with_a_contact_both_tight_and_still_is_refused(name: str, wall: str) -> None:
    answer = CliRunner().invoke(drystone, ["verify-bound", str(DATA / f"{name}.json"), "--wall", wall])
    assert (answer.exit_code, "both tight and still" in answer.output) == (1, True)


def test_one_leaf_with_every_contact_in_both_sets_does_not_take_the_time_of_all_cases() -> None:
    """A cover of 2^40 nodes, if overlapping leaves counted for both halves."""
    document: dict[str, Any] = read_certificate(shipped_cases() / "stack-10" / "certificate.json")
    every = list(range(40))
    document["leaves"] = [leaf | {"tight": every, "still": every} for leaf in document["leaves"]]
    assert "both tight and still" in refused(document)


def test_a_wider_stone_far_from_the_origin_is_of_another_wall(tmp_path: Path) -> None:
    forged, wall, honest = DATA / "grid-5e+06.forged.json", DATA / "grid-5e+06.wall.json", tmp_path / "own.json"
    run = CliRunner()
    answer = run.invoke(drystone, ["verify-bound", str(forged), "--wall", str(wall)])
    assert (answer.exit_code, "another wall" in answer.output) == (1, True)
    assert run.invoke(drystone, ["bound", str(wall), "-o", str(honest)]).exit_code == 0
    answer = run.invoke(drystone, ["verify-bound", str(honest), "--wall", str(wall), "--json"])
    assert json.loads(answer.output)["multiplier"] == "1/4"


@pytest.mark.parametrize("far", [0.0, 1e3, 1e6 + 0.1])
@pytest.mark.parametrize("part", [1e-3, 1e-6, 1e-10])
def test_no_number_of_a_wall_counts_as_the_same_because_another_is_large(far: float, part: float) -> None:
    """A block of 1e6 times the weight stands beside, and both stand far from the origin."""
    polygons = [[[x, 0.0], [x + 0.25, 0.0], [x + 0.25, 0.5], [x, 0.5]] for x in (far + 1.0, far + 3.0)]
    ground = [[far, -0.5], [far + 5.0, -0.5], [far + 5.0, 0.0], [far, 0.0]]
    data = {name: value for name, value in wall_data({}, 0.5).items() if name != "pattern"}
    blocks = [
        {"id": "ground", "polygon": ground, "fixed": True},
        {"id": "light", "polygon": polygons[0], "weight": 1.0},
        {"id": "heavy", "polygon": polygons[1], "weight": 1e6},
    ]
    wall = build(Wall.model_validate(data | {"blocks": blocks})).assembly
    own = wall_document(wall, 7.0)
    require_same_wall(own, wall)
    number = 1 + Fraction(part)
    changes: list[Callable[[Any], None]] = [
        lambda d: d["blocks"][0]["dead"].__setitem__(1, str(Fraction(d["blocks"][0]["dead"][1]) * number)),
        lambda d: d["blocks"][0]["live"].__setitem__(0, str(Fraction(d["blocks"][0]["live"][0]) * number)),
        lambda d: d["interfaces"][0].__setitem__("friction", str(Fraction(d["interfaces"][0]["friction"]) * number)),
        lambda d: d["interfaces"][0]["ends"].__setitem__(0, str(Fraction(d["interfaces"][0]["ends"][0]) + number - 1)),
        lambda d: d["blocks"][0]["centroid"].__setitem__(1, str(Fraction(d["blocks"][0]["centroid"][1]) + number - 1)),
    ]
    for change in changes:
        document = copy.deepcopy(own)
        change(document)
        with pytest.raises(CertificateError, match="another wall"):
            require_same_wall(document, wall)


def test_no_multiplier_is_shown_without_its_state(tmp_path: Path) -> None:
    document = windows() | {"multiplier": "1000"}
    del document["state"]
    document["digest"] = digest(document)
    assert verify(document)[1] is None
    assert "1000" not in proved(document)
    file = tmp_path / "certificate.json"
    file.write_text(json.dumps(document))
    for form in ([], ["--json"]):
        answer = CliRunner().invoke(drystone, ["verify-bound", str(file), *form])
        assert (answer.exit_code, "1000" in answer.output, "multiplier" in answer.output) == (0, False, False)


def test_the_module_alone_shows_no_multiplier_without_its_state_either(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    document = tree() | {"multiplier": "1000"}
    del document["state"]
    document["digest"] = digest(document)
    file = tmp_path / "certificate.json"
    file.write_text(json.dumps(document))
    assert main([str(file)]) == 0
    assert "1000" not in capsys.readouterr().out


WRONG_NUMBERS = [True, False, None, 0.5, 1.0, "0.5", "1e1", "1e1000000000", " 1", "+1", "1_0", "\u0661", "1/0", "1/-2",
                 "", "nan", [], {}, ["1"], 10**1001, "9" * 1001]  # fmt: skip
"""What is no fraction in a certificate."""
NUMBERS: dict[str, Callable[[Any], tuple[Any, Any]]] = {
    "bound": lambda d: (d, "bound"),
    "multiplier": lambda d: (d, "multiplier"),
    "centroid": lambda d: (d["blocks"][0]["centroid"], 0),
    "dead": lambda d: (d["blocks"][0]["dead"], 1),
    "live": lambda d: (d["blocks"][0]["live"], 0),
    "friction": lambda d: (d["interfaces"][0], "friction"),
    "end": lambda d: (d["interfaces"][0]["ends"], 0),
    "side": lambda d: (d["interfaces"][0], "side"),
    "force": lambda d: (d["state"]["forces"], 0),
    "velocity": lambda d: (d["state"]["velocities"], 0),
    "contact": lambda d: (d["leaves"][1]["tight"], 0),
    "block": lambda d: (d["interfaces"][0], "b"),
}


@pytest.mark.parametrize("name", NUMBERS)
def test_what_is_no_number_of_its_kind_is_refused(name: str) -> None:
    for value in WRONG_NUMBERS:
        document = tree()
        place, key = NUMBERS[name](document)
        if name == "block" and value is None:
            continue
        place[key] = value
        assert refused(document)


WRONG_WALLS: dict[str, tuple[Callable[[Any], Any], str]] = {
    "negative friction": (lambda d: d["interfaces"][0].update(friction="-1/2"), "friction is zero or more"),
    "no side": (lambda d: d["interfaces"][0].update(side=0), "a side of 1 or -1"),
    "another side": (lambda d: d["interfaces"][0].update(side=2), "a side of 1 or -1"),
    "no length": (lambda d: d["interfaces"][0].update(ends=["1", "0", "1", "0"]), "two ends"),
    "a block on itself": (lambda d: d["interfaces"][0].update(a=0), "joins two blocks"),
    "between supports": (lambda d: d["interfaces"][0].update(b=None), "joins two blocks"),
    "a block that is not there": (lambda d: d["interfaces"][0].update(b=1), "may stand here"),
    "a block counted from the end": (lambda d: d["interfaces"][0].update(b=-1), "may stand here"),
    "no block": (lambda d: d.update(blocks=[], interfaces=[]), "free blocks"),
    "no live load": (lambda d: d["blocks"][0].update(live=["0", "0", "0"]), "without live load"),
    "another format": (lambda d: d.update(format="drystone-bound/2"), "format"),
    "two proofs": (lambda d: d.update(windows=[]), "leaves and windows"),
}


@pytest.mark.parametrize("name", WRONG_WALLS)
def test_what_is_no_wall_is_refused(name: str) -> None:
    change, reason = WRONG_WALLS[name]
    document = tree()
    change(document)
    assert reason in refused(document)


def _of_leaf(part: str, change: Callable[[Any], Any]) -> Callable[[Any], None]:
    return lambda d: [change(leaf) for leaf in d["leaves"] if part in leaf] and None


WRONG_PROOFS: dict[str, tuple[Callable[[Any], Any], str]] = {
    "no leaf": (lambda d: d.update(leaves=[]), "do not cover"),
    "a leaf less": (lambda d: d["leaves"].pop(), "do not cover"),
    "velocities that lift": (_of_leaf("velocities", lambda leaf: leaf.update(velocities=["0", "1", "0"])), "gain work"),
    "velocities at rest": (_of_leaf("velocities", lambda leaf: leaf.update(velocities=["0"] * 3)), "exclude nothing"),
    "velocities without tight contacts": (_of_leaf("velocities", lambda leaf: leaf.update(tight=[])), ""),
    "forces of nothing": (_of_leaf("forces", lambda f: f.update(forces=["0"] * 6, parts=["0", "0"])), "nothing"),
    "opposite parts": (_of_leaf("forces", lambda leaf: leaf.update(parts=["-1", "0"])), "exclude nothing"),
    "forces in no equilibrium": (_of_leaf("forces", lambda leaf: leaf["forces"].reverse()), "equilibrium"),
    "forces that lose work": (_of_leaf("forces", lambda leaf: leaf.update(still=[])), ""),
    "velocities and forces": (_of_leaf("forces", lambda f: f.update(velocities=["1", "0", "0"])), "either"),
    "a higher bound": (lambda d: d.update(bound=d["multiplier"]), "leaf"),
    "a bound above the state": (lambda d: d.update(bound="1"), "above the collapse state"),
    "opposite velocities": (
        lambda d: d["state"].update(velocities=[str(-Fraction(v)) for v in d["state"]["velocities"]]),
        "no work",
    ),
    "no velocities": (lambda d: d["state"].update(velocities=["0"] * 3), "no work"),
    "opposite forces": (
        lambda d: d["state"].update(forces=[str(-Fraction(v)) for v in d["state"]["forces"]]),
        "equilibrium",
    ),
    "a multiplier of no state": (lambda d: d.update(multiplier="2/5"), "equilibrium"),
    "a state that lifts": (lambda d: d["state"].update(velocities=["1", "1", "0"]), "violates yield or passes"),
    "a state that turns over": (lambda d: d["state"].update(velocities=["1", "0", "-1"]), "violates yield or passes"),
}


@pytest.mark.parametrize("name", WRONG_PROOFS)
def test_what_is_no_proof_is_refused(name: str) -> None:
    change, reason = WRONG_PROOFS[name]
    document = tree()
    change(document)
    assert reason in refused(document)


def _opposite(window: Any, *path: Any) -> None:
    *way, last = path
    for key in way:
        window = window[key]
    window[last] = _negative(window[last])


def _negative(value: Any) -> Any:
    return [_negative(v) for v in value] if isinstance(value, list) else -value


WRONG_WINDOWS: dict[str, Callable[[Any], Any]] = {
    "from above what is proved": lambda w: w.update(low="1/100"),
    "no width": lambda w: w.update(high=w["low"]),
    "upside down": lambda w: w.update(low="2", high="0"),
    "no bound of all forces": lambda w: _opposite(w, "forces", "total"),
    "more that is still": lambda w: (w["still"].append(3), w["still_velocities"].append([0, 0, 0])),
    "a force below zero": lambda w: w.update(loaded=[0], least=["-1/2"], least_velocities=[[0, 0, 0]]),
    "a force that may be less": lambda w: w.update(loaded=[0], least=["9"], least_velocities=[[0, 0, 0]]),
    "a weight of nothing": lambda w: w["weights"].__setitem__(0, 0),
    "no weight of the lift": lambda w: w.update(lift_weight=0),
    "opposite velocities of strains": lambda w: _opposite(w, "motions", "inverse"),
    "strains that are not there": lambda w: w["motions"].update(strains=[5, 6, 7]),
    "a course of no joints": lambda w: w["motions"]["courses"].append({"joints": [], "velocities": [0, 0, 0]}),
    "opposite products of the size": lambda w: _opposite(w, "size", "columns"),
    "opposite products": lambda w: _opposite(w, "multiplier", "columns"),
    "opposite multiples of equilibrium": lambda w: _opposite(w, "multiplier", "balance"),
    "products for nothing": lambda w: w["multiplier"]["columns"][-2].__setitem__(4, 2**60),
    "a column less": lambda w: w["multiplier"]["columns"].pop(),
    "an exponent below zero": lambda w: w["multiplier"].update(exponent=-1),
}


@pytest.mark.parametrize("name", WRONG_WINDOWS)
def test_what_is_no_window_is_refused(name: str) -> None:
    document = windows()
    for window in document["windows"]:
        WRONG_WINDOWS[name](window)
    assert refused(document)


def test_windows_say_nothing_of_multipliers_below_zero() -> None:
    document = windows() | {"bound": "-1"}
    assert "below zero" in refused(document)
    below = windows()
    below["windows"][0]["low"] = "-1"  # more states than were asked for: weaker, never stronger
    try:
        lower, upper = verify(below | {"digest": digest(below)})
    except CertificateError:
        return
    assert upper is not None
    assert lower <= upper


def test_a_check_ends_when_its_seconds_are_over() -> None:
    with pytest.raises(CertificateError, match="time limit"):
        verify(windows(), seconds=-1.0)


LARGE: dict[str, tuple[bytes, str]] = {
    "a small file of many bytes": (gzip.compress(b" " * (documents.MOST_BYTES + 1)), "bytes, unpacked"),
    "many values": (gzip.compress(b"[" + b"0," * documents.MOST_VALUES + b"0]"), "values"),
    "a long number": (b'{"bound": ' + b"1" * 5000 + b"}", "digits"),
    "deep lists": (b"[" * 100_000 + b"]" * 100_000, ""),
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

    content = b'{"a": [1, 2, 30]}'
    for name, most in (("MOST_BYTES", len(content)), ("MOST_VALUES", 5)):  # an object, a list and three numbers
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


def _turned(normal: Any, angle: float) -> Any:
    turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    return np.vstack([normal[:1] @ turn.T, normal[1:]])


NOT_DESCRIBED: dict[str, tuple[Callable[[Assembly], Assembly], str]] = {
    "cohesion": (lambda a: replace(a, constant=a.constant + np.array([0.0, 0.0, 0.1, 0.1])), "strength of their own"),
    "tensile strength of one joint": (
        lambda a: replace(a, constant=a.constant + np.outer([1.0, 0.0], [1e-9, 0.0, 0.0, 0.0])),
        "strength of their own",
    ),
    "dilatancy": (lambda a: replace(a, dilatancy=np.array([0.0, 1e-12])), "have dilatancy"),
    "a support that moves": (lambda a: replace(a, support_motion=np.outer(a.fixed, [0.0, 1e-9, 0.0])), "move"),
    "a normal that is not across its joint": (lambda a: replace(a, normal=_turned(a.normal, 1e-6)), "normals"),
    "a normal without a number": (lambda a: replace(a, normal=a.normal * np.nan), "normals"),
    "a load without a number": (lambda a: replace(a, dead=a.dead * np.nan), "NaN"),
}


@pytest.mark.parametrize("name", NOT_DESCRIBED)
def test_a_wall_that_no_certificate_describes_has_none(name: str) -> None:
    change, reason = NOT_DESCRIBED[name]
    wall = read_case(shipped_cases() / "two-frictions").assembly
    require_same_wall(tree(), wall)
    with pytest.raises(CertificateError, match=reason):
        require_same_wall(tree(), change(wall))


@pytest.mark.parametrize("name", ["cohesion", "a support that moves"])
def test_walls_of_other_joints_or_moving_supports_have_another_key(name: str) -> None:
    wall = read_case(shipped_cases() / "two-frictions").assembly
    assert content_of(NOT_DESCRIBED[name][0](wall)) != content_of(wall)


OTHER_WALLS: dict[str, Callable[[Any], Any]] = {
    "another unit of length": lambda d: _scaled(d, Fraction(1000)),
    "next to the unit of length": lambda d: _scaled(d, 1 + Fraction(1, 10**9)),
    "moved": lambda d: _moved(d, 1),
    "moved by next to nothing": lambda d: _moved(d, Fraction(1, 10**9)),
    "the live load doubled": lambda d: d["blocks"][0].update(live=_times(d["blocks"][0]["live"], Fraction(2))),
    "the live load reversed": lambda d: d["blocks"][0].update(live=_times(d["blocks"][0]["live"], Fraction(-1))),
    "all loads reversed": lambda d: d["blocks"][0].update(
        live=_times(d["blocks"][0]["live"], Fraction(-1)), dead=_times(d["blocks"][0]["dead"], Fraction(-1))
    ),
    "joints in another order": lambda d: d["interfaces"].reverse(),
    "ends in another order": lambda d: [
        item.update(ends=[*item["ends"][2:], *item["ends"][:2]]) for item in d["interfaces"]
    ],
    "the other side": lambda d: [item.update(side=-item["side"]) for item in d["interfaces"]],
    "blocks of a joint in another order": lambda d: [item.update(a=item["b"], b=item["a"]) for item in d["interfaces"]],
    "a joint less": lambda d: d["interfaces"].pop(),
    "a joint twice": lambda d: d["interfaces"].append(d["interfaces"][0]),
    "a block more": lambda d: d["blocks"].append(d["blocks"][0]),
    "another name": lambda d: d["blocks"][0].update(id="another"),
    "frictions in another order": lambda d: _exchanged(d),
}


def _times(values: list[str], number: Fraction) -> list[str]:
    return [str(number * Fraction(value)) for value in values]


def _scaled(document: Any, number: Fraction) -> None:
    for block in document["blocks"]:
        block["centroid"] = _times(block["centroid"], number)
        for name in ("dead", "live"):
            block[name] = [*block[name][:2], *_times(block[name][2:], number)]
    for item in document["interfaces"]:
        item["ends"] = _times(item["ends"], number)


def _moved(document: Any, far: Any) -> None:
    for values in (*(b["centroid"] for b in document["blocks"]), *(item["ends"] for item in document["interfaces"])):
        values[::2] = [str(Fraction(x) + far) for x in values[::2]]


def _exchanged(document: Any) -> None:
    first, second = document["interfaces"]
    first["friction"], second["friction"] = second["friction"], first["friction"]


@pytest.mark.parametrize("name", OTHER_WALLS)
def test_a_certificate_is_of_its_wall_number_by_number_and_in_its_order(name: str) -> None:
    document, wall = tree(), read_case(shipped_cases() / "two-frictions").assembly
    OTHER_WALLS[name](document)
    with pytest.raises(CertificateError, match="another wall"):
        require_same_wall(document, wall)


def beyond_floats() -> dict[str, Any]:
    """The block under a live load of 1e-400 of its weight: it slides at 2e399."""
    document, large = tree(), Fraction(10**400)
    for block in document["blocks"]:
        block["live"] = _times(block["live"], 1 / large)
    for leaf in document["leaves"]:
        if "parts" in leaf:
            leaf["parts"] = [leaf["parts"][0], str(large * Fraction(leaf["parts"][1]))]
    document |= {name: str(large * Fraction(document[name])) for name in ("bound", "multiplier")}
    return document | {"digest": digest(document)}


def test_a_multiplier_beyond_all_floats_is_shown_in_digits(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "certificate.json"
    file.write_text(json.dumps(beyond_floats()))
    assert main([str(file)]) == 0
    assert "= 1.999996e+399; one at 2" in capsys.readouterr().out
    answer = CliRunner().invoke(drystone, ["verify-bound", str(file), "--json"])
    assert (answer.exit_code, json.loads(answer.output)["value"]) == (0, None)


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


@pytest.mark.parametrize("change", [{"blocks": [None]}, {"leaves": [[]]}, {"leaves": [7]}, {"state": None}])
def test_parts_of_another_form_are_refused_in_words_of_a_certificate(change: dict[str, Any]) -> None:
    assert refused(tree() | change).startswith("a part of it is not of the form of a certificate")
