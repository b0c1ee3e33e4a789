"""Every statement of a certificate with something false in its place: what was tried to fool the checker."""

from __future__ import annotations

import json
from collections.abc import Callable
from fractions import Fraction
from pathlib import Path
from typing import Any

import pytest
from click.testing import CliRunner

from drystone.certificates import proved
from drystone.cli.main import main as drystone
from methods.proof.verify.checker import main, verify
from methods.proof.verify.document import digest
from methods.proof.verify.exact_wall import CertificateError
from tests.bound.shown import DATA, refused, tree, windows


@pytest.mark.parametrize(("name", "wall"), [("overlap-slide", "slide"), ("overlap-stack-10", "stack-10")])
def test_a_leaf_with_a_contact_both_tight_and_still_is_refused(name: str, wall: str) -> None:
    answer = CliRunner().invoke(drystone, ["verify-bound", str(DATA / f"{name}.json"), "--wall", wall])
    assert (answer.exit_code, "both tight and still" in answer.output) == (1, True)


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


@pytest.mark.parametrize("change", [{"blocks": [None]}, {"leaves": [[]]}, {"leaves": [7]}, {"state": None}])
def test_parts_of_another_form_are_refused_in_words_of_a_certificate(change: dict[str, Any]) -> None:
    assert refused(tree() | change).startswith("a part of it is not of the form of a certificate")
