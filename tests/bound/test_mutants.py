"""Changed certificates: two checkers that share no line agree on each, and what both accept is true of the same wall.

`DRYSTONE_MUTANTS=2000 python -m pytest tests/bound/test_mutants.py` changes 2,000 of each kind; without it, fewer.
"""

from __future__ import annotations

import copy
import json
import math
import os
import random
from collections import Counter
from collections.abc import Callable, Iterator
from contextlib import suppress
from fractions import Fraction
from functools import cache
from typing import Any

import pytest

from drystone.certificates import CERTIFICATE, PACKED, read_certificate
from harness.model.assembly import Assembly
from harness.model.case import read_case, shipped_cases
from methods.proof.same_wall import require_same_wall
from methods.proof.verify.checker import verify
from methods.proof.verify.document import digest
from methods.proof.verify.exact_wall import CertificateError
from tests.bound import test_case_certificate as of_cases
from tests.bound import test_window_certificate as of_windows
from tests.bound.by_cases import certificate_of_cases
from tests.bound.second_checker import check
from tests.bound.second_wall import Refused
from tests.la.bodies import running_bond

MUTANTS = int(os.environ.get("DRYSTONE_MUTANTS", "40"))
"""Of each kind."""

Certificate = tuple[dict[str, Any], Assembly, Fraction]
"""A certificate, its wall, and the least multiplier of that wall."""


def of_library(name: str, ending: str = "") -> Certificate:
    folder = shipped_cases() / name
    document = read_certificate(folder / (CERTIFICATE + ending))
    return document, read_case(folder).assembly, Fraction(document["multiplier"])


@cache
def certificates_of(kind: str) -> list[Certificate]:
    """Certificates whose least multiplier is known apart from them, by closed forms or enumeration."""
    if kind == "tree":
        names = ("slide", "topple", "single-block", "two-frictions", "stack-2", "stack-10", "column-point-load")
        return [of_library(name) for name in names]
    if kind == "window":
        bond = (of_windows.of_bond(), running_bond(2, 2, 0.2, 0.65), of_windows.LEAST)
        return [bond, of_library("incline-up", PACKED), of_library("incline-down", PACKED)]
    small = [of_library("two-frictions"), of_library("single-block"), of_library("incline-up", PACKED)]
    divided = [(certificate_of_cases(wall), wall, least) for _, wall, least in small]
    return [
        *divided,
        *((at_a_normal_force(document), wall, least) for document, wall, least in divided),
        (of_cases.of_bond(), running_bond(2, 2, 0.2, 0.65), of_cases.LEAST),
    ]


def at_a_normal_force(document: dict[str, Any]) -> dict[str, Any]:
    """A certificate whose cases are divided at a normal force first: what proves the whole proves both parts."""
    cases = document["cases"]
    divided = document | {"cases": {"steps": [], "interface": 0, "normal": "1/2", "parts": [cases, cases]}}
    return divided | {"digest": digest(divided)}


Place = tuple[Any, Any]
"""A list or an object, and the index or name of what stands there."""


def places(node: Any) -> Iterator[Place]:
    for key in list(node) if isinstance(node, dict) else range(len(node)):
        yield node, key
        if isinstance(node[key], dict | list):
            yield from places(node[key])


def by_descent(document: Any, draw: random.Random) -> Place:
    """A place that is drawn level by level, so that short parts of a certificate are changed as often as long ones."""
    node = document
    while True:
        key = draw.choice([*node] if isinstance(node, dict) else range(len(node)))
        deeper = isinstance(node[key], dict | list) and len(node[key]) > 0
        if not deeper or draw.random() < 0.1:
            return node, key
        node = node[key]


def numeral(value: Any) -> Fraction | None:
    try:
        return None if isinstance(value, bool | float | None) else Fraction(value)
    except (ValueError, TypeError):
        return None


def like(value: Any, number: Fraction) -> Any:
    """A number as text or as a whole number, as the value is."""
    return str(number) if isinstance(value, str) else int(number)


def a_digit(value: Any, draw: random.Random) -> Any:
    text = json.dumps(value)
    digits = [k for k, sign in enumerate(text) if sign.isdigit()]
    if not digits:
        return None
    k = draw.choice(digits)
    try:
        return json.loads(text[:k] + draw.choice("0123456789") + text[k + 1 :])
    except json.JSONDecodeError:
        return None


def a_number(value: Any, draw: random.Random) -> Any:
    given = numeral(value)
    if given is None:
        return None
    step = Fraction(1, 2 ** draw.choice((0, 4, 10, 20, 30)))
    return like(value, draw.choice((-given, Fraction(0), given + step, given - step, given * (1 + step), 2 * given)))


def a_type(value: Any, draw: random.Random) -> Any:
    given = numeral(value)
    others: list[Any] = [None, True, False, [], {}, "", [value], "1e9", " 1", "1_0", "\u0661", "nan", 10**1001]
    if given is not None:
        others += [float(given), f"+{value}", f"{value}.0", bool(given), str(value), int(given)]
    return draw.choice(others)


def change_value(document: Any, draw: random.Random) -> None:
    node, key = by_descent(document, draw) if draw.random() < 0.7 else draw.choice(list(places(document)))
    kinds: tuple[Callable[[Any, random.Random], Any], ...] = (a_digit, a_number, a_number, a_type)
    node[key] = draw.choice(kinds)(node[key], draw)


def change_order(document: Any, draw: random.Random) -> None:
    node, key = by_descent(document, draw)
    other, place = by_descent(document, draw) if draw.random() < 0.3 else (node, draw.choice(list(_keys(node))))
    node[key], other[place] = copy.deepcopy(other[place]), copy.deepcopy(node[key])


def _keys(node: Any) -> Any:
    return node if isinstance(node, dict) else range(len(node))


def change_length(document: Any, draw: random.Random) -> None:
    node, key = by_descent(document, draw)
    if isinstance(node, list) and draw.random() < 0.4:
        node.insert(key, copy.deepcopy(draw.choice(node)))
    else:
        del node[key]


def change_contact(document: Any, draw: random.Random) -> None:
    """A contact more, less, or in the other set, of a leaf or of what is still, or of a step or a division."""
    contact = draw.randrange(4 * len(document["interfaces"]))
    found = [(node, key) for node, key in places(document) if key in ("tight", "still", "contact", "interface")]
    node, key = draw.choice(found)
    if not isinstance(node[key], list):
        node[key] = contact
    elif node[key] and draw.random() < 0.5:
        moved = node[key].pop(draw.randrange(len(node[key])))
        if "tight" in node and draw.random() < 0.7:
            node["still" if key == "tight" else "tight"].append(moved)
    else:
        node[key].append(contact)


def claim_more(document: Any, draw: random.Random) -> None:
    """A higher bound, with the state or without it, beside another change or alone."""
    bound = Fraction(document["bound"])
    document["bound"] = str(bound * (1 + Fraction(1, 10 ** draw.choice((0, 1, 3, 5, 6, 7, 9, 12)))))
    if draw.random() < 0.5:
        document.pop("state", None)
        document["multiplier"] = document["bound"]
    if draw.random() < 0.7:
        draw.choice((change_value, change_contact, change_length))(document, draw)


def change_structure(document: Any, draw: random.Random) -> None:
    """Parts of the proof in another place: a leaf or a part for another, what one shows for another, contacts moved."""
    nodes = [(node, key) for node, key in places(document) if isinstance(node[key], dict) and key not in ("state",)]
    alike = [(node, key) for node, key in nodes if {"tight", "steps", "shows", "low"} & node[key].keys()]
    (node, key), (other, place) = draw.choice(alike or nodes), draw.choice(alike or nodes)
    first, second = copy.deepcopy(node[key]), copy.deepcopy(other[place])
    kind = draw.randrange(4)
    if kind == 0:
        node[key] = second
    elif kind == 1:
        node[key], other[place] = second, first
    elif kind == 2:
        shared = sorted(first.keys() & second.keys())
        node[key] |= {name: second[name] for name in draw.sample(shared, draw.randint(0, len(shared)))}
    else:
        joints = document["interfaces"]
        p, q = draw.randrange(len(joints)), draw.randrange(len(joints))
        joints[p], joints[q] = joints[q], joints[p]


CHANGES = (change_value, change_value, change_order, change_length, change_contact, change_structure, claim_more)


def judged(document: dict[str, Any], wall: Assembly, of: dict[str, Any]) -> tuple[Any, Any]:
    """What both checkers prove, None where they refuse."""
    first: Any = None
    second: Any = None
    with suppress(CertificateError):
        require_same_wall(document, wall)
        first = verify(document)
    with suppress(Refused):
        second = check(document, of)
    return first, second


@pytest.mark.parametrize("kind", ["tree", "window", "case"])
def test_changed_certificates_are_refused_by_both_checkers_or_prove_what_is_true(kind: str) -> None:
    known = certificates_of(kind)
    for document, wall, least in known:
        first, second = judged(document, wall, document)
        assert first == second
        assert first[0] < least == first[1]
    shares = [1 / math.sqrt(len(json.dumps(document))) for document, _, _ in known]  # small ones are quicker
    counted: Counter[str] = Counter()
    seed = 0
    while counted.total() < MUTANTS:
        seed += 1
        draw = random.Random(f"{kind} {seed}")
        ((document, wall, least),) = draw.choices(known, shares)
        changed = copy.deepcopy(document)
        change = draw.choice(CHANGES)
        change(changed, draw)
        if json.dumps(changed, sort_keys=True) == json.dumps(document, sort_keys=True):
            continue
        changed["digest"] = digest(changed)
        first, second = judged(changed, wall, document)
        assert first == second, f"{kind} {seed}: {change.__name__}"
        if first is not None:
            lower, upper = first
            assert lower <= least, f"{kind} {seed}: {change.__name__}"
            assert upper is None or upper >= least, f"{kind} {seed}: {change.__name__}"
        counted["refused by both" if first is None else "true of the same wall"] += 1
    print(f"\n{kind}: {dict(counted)}")
    assert counted["refused by both"] > MUTANTS / 2
