"""A second checker of certificates, from the mathematics of docs/theory-bound.md alone: no import from `methods`.

It is slow and plain: a static form is {component: coefficient} of the contact forces, the multiplier "load" and the
number "one"; a motion form is {component: coefficient} of velocities, and of ("back", p), the backward slip of p. Every
step is written as the inequality that the page derives. The roundings of what is paid are those that the page gives.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Hashable
from dataclasses import replace
from fractions import Fraction
from typing import Any

from tests.bound.second_wall import (
    NIL,
    Form,
    Refused,
    Wall,
    binary,
    down,
    listed,
    need,
    plus,
    rational,
    rationals,
    up,
    value_of,
    whole,
)
from tests.bound.second_windows import Motion, Set, gain, raised, size_of


def check(document: Any, of: Any = None) -> tuple[Fraction, Fraction | None]:
    """(bound, multiplier of a state or None) that a certificate proves, of the wall of another document if given.

    Raises:
        Refused: it proves nothing.
    """
    try:
        text = json.dumps({k: v for k, v in document.items() if k != "digest"}, sort_keys=True)
        need(hashlib.sha256(text.encode()).hexdigest() == document["digest"], "digest")
        need(document["format"] == "drystone-bound/1", "format")
        wall = Wall(document)
        need(of is None or wall.same_as(Wall(of)), "another wall")
        bound = rational(document["bound"])
        need(bound >= 0, "nothing is said below zero")
        multiplier = rational(document["multiplier"]) if {"multiplier", "state"} & document.keys() else None
        if "state" in document:
            assert multiplier is not None
            _state(wall, multiplier, document["state"])
            need(bound <= multiplier, "bound above the state")
        else:
            multiplier = None
        if "windows" in document:
            need("leaves" not in document, "two proofs")
            need(bound <= _proved(wall, document), "the windows prove less")
        else:
            leaves = listed(document["leaves"])
            need(_covers([_halves(wall, leaf) for leaf in leaves]), "no cover")
            for leaf in leaves:
                _leaf(wall, bound, leaf)
    except (LookupError, TypeError, ValueError, ArithmeticError, AttributeError) as error:
        raise Refused(repr(error)) from error
    return bound, multiplier


def _state(wall: Wall, multiplier: Fraction, state: Any) -> None:
    forces, velocities = rationals(state["forces"], 3 * wall.m), rationals(state["velocities"], wall.n)
    for dof in range(wall.n):
        form = wall.equilibrium(dof)
        rest = value_of(form, forces) + form["load"] * multiplier + form["one"]
        need(rest == 0, "no equilibrium")
    need(sum((f * u for f, u in zip(wall.live, velocities, strict=True)), NIL) > 0, "no live work")
    for p in range(wall.m):
        first, second, slip = (value_of(strain, velocities) for strain in wall.strains[p])
        for k, rate in enumerate((first, second, max(slip, NIL), max(-slip, NIL))):
            slack = value_of(wall.slack(4 * p + k), forces)
            need(slack >= 0 and rate >= 0 and slack * rate == 0, "no yield, or no complementarity")


def _halves(wall: Wall, leaf: Any) -> dict[int, str]:
    """{contact: which of its halves a leaf lies in}."""
    found: dict[int, str] = {}
    for half in ("tight", "still"):
        for k in listed(leaf[half]):
            need(found.setdefault(whole(k, 0, 4 * wall.m - 1), half) == half, "both tight and still")
    return found


def _covers(leaves: list[dict[int, str]]) -> bool:
    if {} in leaves:
        return True
    shared = set.intersection(*(set(leaf) for leaf in leaves)) if leaves else set()
    if not shared:
        return False
    at = max(shared)
    parts = [
        [{k: h for k, h in leaf.items() if k != at} for leaf in leaves if leaf[at] == half]
        for half in ("tight", "still")
    ]
    return all(_covers(part) for part in parts)


def _leaf(wall: Wall, bound: Fraction, leaf: Any) -> None:
    need(("velocities" in leaf) != ("forces" in leaf), "two proofs, or none")
    dead = [d + bound * f for d, f in zip(wall.dead, wall.live, strict=True)]
    if "velocities" in leaf:
        u = rationals(leaf["velocities"], wall.n)
        at_zero, at_bound = (sum((f * v for f, v in zip(load, u, strict=True)), NIL) for load in (wall.dead, dead))
        need(at_zero < 0 and at_bound <= 0, "nothing excluded")
        for p in range(wall.m):
            strains = [value_of(strain, u) for strain in wall.strains[p]]
            works = [strains[end] + shear * strains[2] for end, shear in wall.rays(p, leaf["tight"])]
            need(max(works, default=NIL) <= 0, "forces gain work")
    else:
        forces, (a, b) = rationals(leaf["forces"], 3 * wall.m), rationals(leaf["parts"], 2)
        need(a >= 0 and b >= 0 and a + b > 0, "nothing excluded")
        for dof in range(wall.n):
            need(value_of(wall.equilibrium(dof), forces) + a * dead[dof] + b * wall.live[dof] == 0, "no equilibrium")
        for p in range(wall.m):
            n1, n2, s = forces[3 * p : 3 * p + 3]
            for k, force in enumerate((n1, n2, s, -s)):
                need(force >= 0 or 4 * p + k in leaf["still"], "work is lost")


def window_of(wall: Wall, window: Any) -> Set:
    """The states of a window, with what it shows of their forces and contacts."""
    low, high = rational(window["low"]), rational(window["high"])
    need(low < high, "no window")
    states = Set(wall, low, high).with_forces(window["forces"])
    still = [whole(k, 0, 4 * wall.m - 1) for k in listed(window["still"])]
    for k, v in zip(still, listed(window["still_velocities"], len(still)), strict=True):
        need(states.least_slack(k, v) > 0, "may move")
    joints = [whole(p, 0, wall.m - 1) for p in listed(window["loaded"])]
    least = [rational(v) for v in listed(window["least"], len(joints))]
    for p, v, u in zip(joints, least, listed(window["least_velocities"], len(joints)), strict=True):
        need(0 <= v <= states.least_normal([p], u), "less normal force")
    return replace(states, still=frozenset(still), loaded=dict(zip(joints, least, strict=True)))


def _proved(wall: Wall, document: Any) -> Fraction:
    proved = NIL
    last: Set | None = None
    for window in listed(document["windows"]):
        states = window_of(wall, window)
        need(states.low <= proved, "a gap below a window")
        motion = Motion(states, window)
        reach = motion.per_size(window["motions"])
        size = size_of(gain(motion, window["size"], True, reach, True))
        proved = max(proved, raised(states, gain(motion, window["multiplier"], False, reach, True), size))
        last = replace(states, low=proved, reach=tuple(up(reach[d] * size, 60) for d in range(wall.n)))
    if last is not None and "cases" in document:
        proved = max(proved, _case(last, document["cases"]))
    return proved


def _case(states: Set, node: Any) -> Fraction:
    for step in listed(node["steps"]):
        need(states.low < states.high, "a step of nothing")
        states = step_of(states, step)
    if "parts" not in node:
        return states.low
    first, second = listed(node["parts"], 2)
    few, many = halves_of(states, node)
    return min(_case(few, first), _case(many, second))


def halves_of(states: Set, node: Any) -> tuple[Set, Set]:
    """Both parts of a division at a contact or at a normal force."""
    if "contact" in node:
        k = whole(node["contact"], 0, 4 * states.wall.m - 1)
        return replace(states, tight=states.tight | {k}), replace(states, still=states.still | {k})
    p, normal = whole(node["interface"], 0, states.wall.m - 1), rational(node["normal"])
    need(normal >= 0, "a normal force below zero")
    least, most = states.sides.get(p, (NIL, None))
    few = {p: (least, normal if most is None else min(normal, most))}
    many = {p: (max(least, normal), most)}
    return replace(states, sides=states.sides | few), replace(states, sides=states.sides | many)


def step_of(states: Set, step: Any) -> Set:
    wall, shows = states.wall, step["shows"]
    if shows in ("still", "slow", "tight"):
        k = whole(step["contact"], 0, 4 * wall.m - 1)
        strain = wall.strains[k // 4][min(k % 4, 2)]
        rate: Form = {d: -v if k % 4 == 3 else v for d, v in strain.items()}
    if shows == "still":
        need(states.least_slack(k, step["velocities"]) > 0, "may move")
        return replace(states, still=states.still | {k})
    if shows == "loaded":
        p, least = whole(step["interface"], 0, wall.m - 1), rational(step["least"])
        need(0 <= least <= states.least_normal([p], step["velocities"]), "less normal force")
        return replace(states, loaded={**states.loaded, p: least})
    if shows == "slow":
        return replace(states, slow={**states.slow, k: up(max(NIL, _most_rate(states, rate, step)), 60)})
    if shows == "tight":
        need(_most_rate(states, {d: -v for d, v in rate.items()}, step) < 0, "may have no rate")
        return replace(states, tight=states.tight | {k})
    if shows == "no mechanism":
        need(_most_rate(states, {}, step) < 0, "may have a mechanism")
        return states.from_(states.high)
    if shows == "statics":
        least = _least_multiplier(states, step["velocities"])
        return states.from_(states.high if least is None else max(states.low, down(least, 60)))
    need(shows == "window", "no such step")
    low = rational(step["low"])
    need(low <= states.low, "a gap below a window")
    part = replace(states, low=low).with_forces(step["forces"])
    motion = Motion(part, step)
    reach: dict[Hashable, Fraction] = dict(enumerate(states.reach))
    reach |= {("back", p): _within(states, wall.strains[p][2]) for p in motion.back}
    size = size_of(gain(motion, step["size"], True, reach, False))
    return states.from_(max(states.low, raised(part, gain(motion, step["multiplier"], False, reach, False), size)))


def _least_multiplier(states: Set, velocities: Any) -> Fraction | None:
    """The least multiplier of the forces; None if there are no forces."""
    if any(least > 0 and not states.wall.rays(p, states.tight) for p, (least, _) in states.sides.items()):
        return None
    u = binary(velocities, states.wall.n, states.exponent)
    paid, worst = states.beyond({}, u)
    live, dead = states.works(u)
    most = paid + worst * states.total - dead
    if live < 0:
        return most / live if most / live <= states.high else None
    return states.low if states.low * live <= most else None


def _within(states: Set, form: Form) -> Fraction:
    return sum((abs(v) * states.reach[d] for d, v in form.items() if isinstance(d, int)), NIL)


def _most_rate(states: Set, form: Form, step: Any) -> Fraction:
    """form.u is at most this, by virtual forces on all strains, a multiple of the lift and one of the live work."""
    wall, places = states.wall, whole(step["exponent"], 0, 400)
    forces = binary(step["strains"], 3 * wall.m, places)
    lift, work = binary([step["lift"], step["work"]], 2, places)
    need(lift >= 0, "a multiple of the lift below zero")
    rest: Form = dict(form)
    for d, (f, g) in enumerate(zip(wall.live, wall.dead, strict=True)):
        rest[d] = rest.get(d, NIL) - work * f + lift * (states.high * f + g)
    most = work
    for p, strains in enumerate(wall.strains):
        for k, strain in enumerate(strains):
            plus(rest, strain, -forces[3 * p + k])
        spent = lift * wall.friction[p] * states.loaded.get(p, NIL)
        a, b, c = forces[3 * p : 3 * p + 3]
        for k, price in enumerate((a, b, c - spent, -c - spent)):
            contact = 4 * p + k
            if price > 0 and contact not in states.still:
                most += price * states.slow.get(contact, _within(states, strains[min(k, 2)]))
    return most + _within(states, rest)
