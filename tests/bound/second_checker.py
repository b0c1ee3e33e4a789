"""A second checker of certificates, from the mathematics of docs/theory-bound.md alone: no import from `methods`.

It is slow and plain: a static form is {component: coefficient} of the contact forces, the multiplier "load" and the
number "one"; a motion form is {component: coefficient} of velocities, and of ("back", p), the backward slip of p. Every
step is written as the inequality that the page derives. The roundings of what is paid are those that the page gives.
"""

from __future__ import annotations

import hashlib
import json
import re
from collections.abc import Hashable, Iterable
from dataclasses import dataclass, field, replace
from fractions import Fraction
from itertools import product
from math import ceil, floor, lcm
from typing import Any

Form = dict[Hashable, Fraction]
NIL, ONE = Fraction(0), Fraction(1)


class Refused(Exception):
    """The certificate does not prove what it says."""


def need(condition: bool, reason: str) -> None:
    if not condition:
        raise Refused(reason)


def whole(value: Any, least: int | None = None, most: int | None = None) -> int:
    need(isinstance(value, int) and not isinstance(value, bool), "no whole number")
    need((least is None or value >= least) and (most is None or value <= most), "a whole number out of place")
    need(abs(value) <= 10**1000, "a number too long")
    return int(value)


def rational(value: Any) -> Fraction:
    if isinstance(value, str):
        need(re.fullmatch("-?[0-9]{1,1000}(/[0-9]{1,1000})?", value) is not None, "no fraction")
        return Fraction(value)
    return Fraction(whole(value))


def listed(values: Any, count: int | None = None) -> list[Any]:
    need(isinstance(values, list) and (count is None or len(values) == count), "no list of that length")
    return list(values)


def rationals(values: Any, count: int) -> list[Fraction]:
    found = [rational(v) for v in listed(values, count)]
    need(lcm(*(v.denominator for v in found)).bit_length() <= 100_000, "a common denominator too long")
    return found


def binary(values: Any, count: int, exponent: int) -> list[Fraction]:
    found = [Fraction(whole(v), 2**exponent) for v in listed(values, count)]
    need(all(abs(v.numerator).bit_length() <= 3000 for v in found), "a number too long")
    return found


def up(value: Fraction, places: int) -> Fraction:
    return Fraction(ceil(value * 2**places), 2**places)


def down(value: Fraction, places: int) -> Fraction:
    return Fraction(floor(value * 2**places), 2**places)


def plus(form: Form, other: Form, factor: Fraction = ONE) -> None:
    """Add a multiple of another form."""
    for name, value in other.items():
        form[name] = form.get(name, NIL) + factor * value


def value_of(form: Form, at: list[Fraction]) -> Fraction:
    return sum((value * at[k] for k, value in form.items() if isinstance(k, int)), NIL)


class Wall:
    """Blocks 0 to n - 1 and interfaces 0 to m - 1; strains[p] = (opening at end 1, at end 2, slip), per length."""

    def __init__(self, document: Any) -> None:
        blocks, joints = listed(document["blocks"]), listed(document["interfaces"])
        self.ids = [block["id"] for block in blocks]
        self.centres = [rationals(block["centroid"], 2) for block in blocks]
        self.dead = [v for block in blocks for v in rationals(block["dead"], 3)]
        self.live = [v for block in blocks for v in rationals(block["live"], 3)]
        need(any(self.live), "no live load")
        self.joints = []
        self.strains: list[tuple[Form, Form, Form]] = []
        self.friction: list[Fraction] = []
        for joint in joints:
            a, b = (None if joint[k] is None else whole(joint[k], 0, len(blocks) - 1) for k in "ab")
            need(a != b, "one block, or none, at an interface")
            ends, side = rationals(joint["ends"], 4), whole(joint["side"])
            need(side in (1, -1) and ends[:2] != ends[2:], "a side or a length that is none")
            mu = rational(joint["friction"])
            need(mu >= 0, "friction below zero")
            tangent = ends[2] - ends[0], ends[3] - ends[1]
            normal = -side * tangent[1], side * tangent[0]
            middle = (ends[0] + ends[2]) / 2, (ends[1] + ends[3]) / 2
            points = (ends[0], ends[1]), (ends[2], ends[3]), middle
            three = [self._relative(a, b, x, d) for x, d in zip(points, (normal, normal, tangent), strict=True)]
            self.strains.append((three[0], three[1], three[2]))
            self.friction.append(mu)
            self.joints.append((a, b, ends, side, mu))
        self.n, self.m = 3 * len(blocks), len(joints)

    def _relative(self, a: int | None, b: int | None, point: Any, direction: Any) -> Form:
        """Velocity of b less that of a at a point, in a direction."""
        form: Form = {}
        for block, sign in ((a, -1), (b, 1)):
            if block is not None:
                arm = [x - c for x, c in zip(point, self.centres[block], strict=True)]
                turn = arm[0] * direction[1] - arm[1] * direction[0]
                for k, v in enumerate((direction[0], direction[1], turn)):
                    form[3 * block + k] = sign * v
        return form

    def same_as(self, other: Wall) -> bool:
        mine, theirs = [*self.dead, *self.live], [*other.dead, *other.live]
        k = next(k for k, v in enumerate(theirs) if v)
        unit = mine[k] / theirs[k]
        alike = (self.ids, self.centres, self.joints) == (other.ids, other.centres, other.joints)
        return alike and unit > 0 and mine == [unit * v for v in theirs]

    def equilibrium(self, dof: int) -> Form:
        """The form of forces, multiplier and one that is zero."""
        form: Form = {"load": self.live[dof], "one": self.dead[dof]}
        for p, three in enumerate(self.strains):
            for k, strain in enumerate(three):
                if dof in strain:
                    form[3 * p + k] = strain[dof]
        return form

    def slack(self, contact: int) -> Form:
        p, k = divmod(contact, 4)
        if k < 2:
            return {3 * p + k: ONE}
        return {3 * p: self.friction[p], 3 * p + 1: self.friction[p], 3 * p + 2: ONE if k == 2 else -ONE}

    def rays(self, p: int, tight: Iterable[int]) -> list[tuple[int, Fraction]]:
        """Extreme forces of an interface with these slacks zero, per normal force: (end that presses, shear)."""
        found = []
        for end, side in product((0, 1), (-1, 1)):
            forces: dict[int, Fraction] = {3 * p + end: ONE, 3 * p + 2: side * self.friction[p]}
            slacks = [sum((v * forces.get(k, NIL) for k, v in self.slack(4 * p + c).items()), NIL) for c in range(4)]
            if not any(slacks[c] for c in range(4) if 4 * p + c in tight):
                found.append((end, side * self.friction[p]))
        return found


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
        multiplier = rational(document["multiplier"]) if {"multiplier", "state"} & document.keys() else None
        if "state" in document:
            assert multiplier is not None
            _state(wall, multiplier, document["state"])
            need(bound <= multiplier, "bound above the state")
        else:
            multiplier = None
        if "windows" in document:
            need("leaves" not in document, "two proofs")
            need(0 <= bound <= _proved(wall, document), "the windows prove less")
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
        live, rest = (sum((f * v for f, v in zip(load, u, strict=True)), NIL) for load in (wall.live, dead))
        need(live >= 0 and rest <= 0 and live - rest > 0, "nothing excluded")
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


@dataclass(frozen=True)
class Set:
    """Collapse states, of live work one, with multipliers from low to high; all that is known of every one of them."""

    wall: Wall
    low: Fraction
    high: Fraction
    tight: frozenset[int] = frozenset()
    sides: dict[int, tuple[Fraction, Fraction | None]] = field(default_factory=dict)
    still: frozenset[int] = frozenset()
    slow: dict[int, Fraction] = field(default_factory=dict)
    loaded: dict[int, Fraction] = field(default_factory=dict)
    normal: tuple[Fraction, ...] = ()
    total: Fraction = NIL
    reach: tuple[Fraction, ...] = ()
    exponent: int = 0

    def beyond(self, form: Form, u: list[Fraction]) -> tuple[Fraction, Fraction]:
        """(a, b): the form less the work of all forces on u is at most a + b times the sum of normal forces."""
        paid = worst = NIL
        for p in range(self.wall.m):
            rest = [form.get(3 * p + k, NIL) - value_of(strain, u) for k, strain in enumerate(self.wall.strains[p])]
            rays = self.wall.rays(p, self.tight)
            multiple = max((rest[end] + shear * rest[2] for end, shear in rays), default=NIL)
            least, most = self.sides.get(p, (NIL, None))
            if multiple <= 0:
                paid += multiple * least
            elif most is not None:
                paid += multiple * most
            else:
                worst = max(worst, multiple)
        return paid, worst

    def works(self, u: list[Fraction]) -> tuple[Fraction, Fraction]:
        live, dead = (sum((f * v for f, v in zip(g, u, strict=True)), NIL) for g in (self.wall.live, self.wall.dead))
        return live, dead

    def most(self, form: Form, velocities: Any) -> tuple[Fraction, Fraction]:
        """(a, b): a form of forces is at most a + b times the sum of normal forces."""
        u = binary(velocities, self.wall.n, self.exponent)
        paid, worst = self.beyond(form, u)
        live, dead = self.works(u)
        return paid - dead - min(self.low * live, self.high * live), worst

    def greatest(self, form: Form, velocities: Any) -> Fraction:
        base, part = self.most(form, velocities)
        return base + part * self.total

    def with_forces(self, document: Any) -> Set:
        """With bounds of the sum of normal forces, and of each."""
        m = self.wall.m
        found = replace(self, exponent=whole(document["exponent"], 0, 200))
        base, part = found.most({3 * p + end: ONE for p in range(m) for end in (0, 1)}, document["total"])
        need(part < 1, "no bound of normal forces")
        found = replace(found, total=max(NIL, base / (1 - part)))
        each = [found.greatest({3 * p: ONE, 3 * p + 1: ONE}, v) for p, v in enumerate(listed(document["greatest"], m))]
        return replace(found, normal=tuple(min(found.total, max(NIL, v)) for v in each))

    def least_slack(self, contact: int, velocities: Any) -> Fraction:
        return -self.greatest({k: -v for k, v in self.wall.slack(contact).items()}, velocities)

    def least_normal(self, joints: Iterable[int], velocities: Any) -> Fraction:
        return -self.greatest({3 * p + end: -ONE for p in joints for end in (0, 1)}, velocities)

    def from_(self, low: Fraction) -> Set:
        return replace(self, low=min(low, self.high))

    def limits(self) -> list[tuple[int, int, Fraction]]:
        found = []
        for p, (least, most) in sorted(self.sides.items()):
            found += [(p, 1, least)] * (least > 0)
            found += [] if most is None else [(p, -1, most)]
        return found


class Motion:
    """The kinematic quantities of a set that are multiplied: rates of contacts, live work, lift, slips."""

    def __init__(self, states: Set, document: Any) -> None:
        wall, self.states = states.wall, states
        places = whole(document["weight_exponent"], 0, 200)
        weights = binary(document["weights"], wall.m, places)
        need(min(weights) > 0, "a weight that is none")
        self.lift_weight = Fraction(whole(document["lift_weight"], 1), 2**places)
        self.rates: dict[int, Form] = {}
        self.held: list[tuple[Form, Fraction]] = []
        self.signed: list[int] = []
        self.back: list[int] = []
        for p in range(wall.m):
            for end in (0, 1):
                self._take(4 * p + end, wall.strains[p][end])
            if p not in states.loaded and not {4 * p + 2, 4 * p + 3} & (states.still | states.slow.keys()):
                self.signed.append(p)
            else:
                self._slips(p)
        self.work: Form = dict(enumerate(wall.live))
        self.lift: Form = {d: states.high * f + g for d, (f, g) in enumerate(zip(wall.live, wall.dead, strict=True))}
        for k, form in self.rates.items():
            if k % 4 > 1 and k // 4 in states.loaded:
                plus(self.lift, form, -wall.friction[k // 4] * states.loaded[k // 4])
        self.weights = {k: weights[k // 4] for k in self.rates}
        self.unknowns: list[Hashable] = [*range(wall.n), *(("back", p) for p in self.back)]

    def _take(self, contact: int, form: Form) -> None:
        if contact in self.states.still:
            self.held.append((form, NIL))
        elif contact in self.states.slow:
            self.held.append((form, self.states.slow[contact]))
        else:
            self.rates[contact] = form

    def _slips(self, p: int) -> None:
        slip, ahead, behind = self.states.wall.strains[p][2], 4 * p + 2, 4 * p + 3
        if {ahead, behind} <= self.states.still:
            self.held.append((slip, NIL))
        elif behind in self.states.still:
            self._take(ahead, slip)
        elif ahead in self.states.still:
            self._take(behind, {k: -v for k, v in slip.items()})
        else:
            self.back.append(p)
            self._take(ahead, {**slip, ("back", p): ONE})
            self._take(behind, {("back", p): ONE})

    def per_size(self, document: Any) -> dict[Hashable, Fraction]:
        """{unknown: its greatest value in mechanisms of size one}."""
        wall, states = self.states.wall, self.states
        known: dict[int, Fraction] = {}
        for p in range(wall.m):
            for k in range(3):
                if k < 2 or p not in self.signed:
                    free = [1 / self.weights[c] for c in range(4 * p + k, 4 * p + k + 1 + k // 2) if c in self.rates]
                    known[3 * p + k] = max(free, default=NIL)
        places = whole(document["exponent"], 0, 200)
        chosen = [whole(k, 0, 3 * wall.m - 1) for k in listed(document["strains"])]
        inverse = []
        for row in listed(document["inverse"], wall.n):
            parts = zip(chosen, binary(row, len(chosen), places), strict=True)
            inverse.append({k: v for k, v in parts if v})
        errors = []
        for d, row in enumerate(inverse):
            rest: Form = {d: -ONE}
            for k, v in row.items():
                plus(rest, wall.strains[k // 3][k % 3], v)
            errors.append(sum((abs(v) for v in rest.values()), NIL))
        courses = [([whole(p, 0, wall.m - 1) for p in listed(c["joints"])], c) for c in listed(document["courses"])]
        leaders = {3 * joints[0] + 2 for joints, _ in courses}
        slips: dict[int, tuple[Fraction, Fraction]] = {}
        loose = NIL
        for joints, course in courses:
            need(len(set(joints)) == len(joints) and set(joints) <= set(self.signed), "joints of no course")
            least, mu = states.least_normal(joints, course["velocities"]), min(wall.friction[p] for p in joints)
            need(least > 0 and mu > 0, "a course without friction")
            base, part = 1 / (mu * self.lift_weight), NIL
            for p in joints:
                form: dict[int, Fraction] = {}
                error = NIL
                for d, v in wall.strains[p][2].items():
                    assert isinstance(d, int)
                    error += abs(v) * errors[d]
                    for k, a in inverse[d].items():
                        form[k] = form.get(k, NIL) + v * a
                error += abs(abs(form.pop(3 * joints[0] + 2, NIL)) - 1)
                need(all(k in known or k in leaders for k in form), "a slip that nothing bounds")
                error += sum((abs(v) for k, v in form.items() if k not in known), NIL)
                base += states.normal[p] * sum((abs(v) * known[k] for k, v in form.items() if k in known), NIL)
                part += states.normal[p] * error
            slips[3 * joints[0] + 2] = base / least, part / least
            loose = max(loose, part / least)
        sizes = known | {k: base for k, (base, _) in slips.items()}
        need(all(k in sizes for row in inverse for k in row), "a velocity that nothing bounds")
        bases = [sum((abs(v) * sizes[k] for k, v in row.items()), NIL) for row in inverse]
        parts = [
            error + loose * sum((abs(v) for k, v in row.items() if k in slips), NIL)
            for row, error in zip(inverse, errors, strict=True)
        ]
        worst = max(*parts, loose)
        need(worst < 1, "velocities without bound")
        most = max([*bases, *(base for base, _ in slips.values())]) / (1 - worst)
        found: dict[Hashable, Fraction] = {
            d: base + part * most for d, (base, part) in enumerate(zip(bases, parts, strict=True))
        }
        return found | {("back", p): 1 / self.weights[4 * p + 3] for p in self.back}


def _gain(motion: Motion, document: Any, of_size: bool, reach: dict[Hashable, Fraction], per_size: bool) -> Any:
    """(value, lost, price): the cost is at least value - lost - price times the size of the mechanism."""
    states, wall = motion.states, motion.states.wall
    m, places = wall.m, whole(document["exponent"], 0, 400)
    tight = sorted(states.tight)
    rows: list[Form] = [wall.slack(k) for k in range(4 * m)]
    rows += [{"one": ONE}, {"load": ONE, "one": -states.low}, {"load": -ONE, "one": states.high}]
    most = [
        NIL if k in states.tight else (1 if k % 4 < 2 else 2 * wall.friction[k // 4]) * states.normal[k // 4]
        for k in range(4 * m)
    ]
    most += [ONE, states.high - states.low, states.high - states.low]
    for p, side, limit in states.limits():
        rows.append({3 * p: side * ONE, 3 * p + 1: side * ONE, "one": -side * limit})
        most.append(max(NIL, states.normal[p] - limit) if side > 0 else limit)
    most = [up(v, 20) for v in most]
    names: list[Any] = [*motion.rates, "work", "lift"]
    forms: list[Form] = [*motion.rates.values(), motion.work, motion.lift]
    columns = [binary(c, len(rows), places) for c in listed(document["columns"], len(names))]
    signed = [binary(three, 3, places) for three in listed(document["signed"], len(motion.signed))]
    held = [binary(form, 3 * m + 2, places) for form in listed(document["still"], len(motion.held))]
    balance = [binary(row, wall.n + len(tight), places) for row in listed(document["balance"], len(motion.unknowns))]
    components: list[Hashable] = [*range(3 * m), "load", "one"]
    sizes: dict[Hashable, Fraction] = {"load": max(abs(states.low), abs(states.high)), "one": ONE}
    for p in range(m):
        sizes |= {3 * p: states.normal[p], 3 * p + 1: states.normal[p], 3 * p + 2: wall.friction[p] * states.normal[p]}

    left: dict[Hashable, Form] = {name: {} for name in motion.unknowns}

    def subtract(static: Form, kinematic: Form) -> None:
        for name, v in kinematic.items():
            if v:
                plus(left[name], static, -v)

    price, losses = NIL, {}
    for name, form, column in zip(names, forms, columns, strict=True):
        static: Form = {}
        for row, v in zip(rows, column, strict=True):
            if v:
                plus(static, row, v)
        if of_size and name != "work":
            weight = motion.lift_weight if name == "lift" else motion.weights[name]
            need((weight * 2**places).denominator == 1, "too few places")
            plus(static, {"one": ONE}, weight)
        elif not of_size and name == "work":
            plus(static, rows[4 * m + 1], -ONE)
        subtract(static, form)
        free = 4 * m if name == "work" else name
        losses[name] = sum((-v * most[j] for j, v in enumerate(column) if v < 0 and j != free), NIL)
    missing = NIL
    for p, (a, b, c) in zip(motion.signed, signed, strict=True):
        subtract({3 * p: a, 3 * p + 1: b, 3 * p + 2: c}, wall.strains[p][2])
        mu = wall.friction[p]
        for end, side in product((0, 1), (1, -1)):
            if (mu == 0 and 4 * p + end not in states.tight) or (end, side * mu) in wall.rays(p, states.tight):
                short = mu * c + side * (b if end else a)
                need(mu > 0 or short <= 0, "a slip without friction")
                missing = max(missing, short / mu if mu else NIL)
    lost = losses["work"]
    for v, (form, rate) in zip(held, motion.held, strict=True):
        subtract(dict(zip(components, v, strict=True)), form)
        lost += rate * sum((abs(x) * sizes[i] for x, i in zip(v, components, strict=True)), NIL)
    price = max(
        [(losses["lift"] + missing) / motion.lift_weight, *(losses[k] / motion.weights[k] for k in motion.rates)]
    )
    vanishing = [wall.equilibrium(d) for d in range(wall.n)] + [wall.slack(k) for k in tight]
    remains = NIL
    for name, multiples in zip(motion.unknowns, balance, strict=True):
        form = left[name]
        for v, equation in zip(multiples, vanishing, strict=True):
            if v:
                plus(form, equation, -v)
        remains += reach[name] * sum((abs(v) * up(sizes[i], 20) for i, v in form.items()), NIL)
    value = columns[names.index("work")][4 * m]
    return (value, lost, price + remains) if per_size else (value, lost + remains, price)


def _size(gain: Any) -> Fraction:
    value, lost, price = gain
    need(price < 1, "mechanisms without bound")
    return max(NIL, (lost - value) / (1 - price))


def _raised(states: Set, gain: Any, size: Fraction) -> Fraction:
    value, lost, price = gain
    return min(states.high, states.low + value - lost - price * size)


def _proved(wall: Wall, document: Any) -> Fraction:
    proved = NIL
    last: Set | None = None
    for window in listed(document["windows"]):
        low, high = rational(window["low"]), rational(window["high"])
        need(low < high and low <= proved, "no window, or a gap below it")
        states = Set(wall, low, high).with_forces(window["forces"])
        still = [whole(k, 0, 4 * wall.m - 1) for k in listed(window["still"])]
        for k, v in zip(still, listed(window["still_velocities"], len(still)), strict=True):
            need(states.least_slack(k, v) > 0, "may move")
        joints = [whole(p, 0, wall.m - 1) for p in listed(window["loaded"])]
        least = [rational(v) for v in listed(window["least"], len(joints))]
        for p, v, u in zip(joints, least, listed(window["least_velocities"], len(joints)), strict=True):
            need(0 <= v <= states.least_normal([p], u), "less normal force")
        states = replace(states, still=frozenset(still), loaded=dict(zip(joints, least, strict=True)))
        motion = Motion(states, window)
        reach = motion.per_size(window["motions"])
        size = _size(_gain(motion, window["size"], True, reach, True))
        proved = max(proved, _raised(states, _gain(motion, window["multiplier"], False, reach, True), size))
        last = replace(states, low=proved, reach=tuple(up(reach[d] * size, 60) for d in range(wall.n)))
    if last is not None and "cases" in document:
        proved = max(proved, _case(last, document["cases"]))
    return proved


def _case(states: Set, node: Any) -> Fraction:
    for step in node["steps"]:
        need(states.low < states.high, "a step of nothing")
        states = _step(states, step)
    if "parts" not in node:
        return states.low
    first, second = listed(node["parts"], 2)
    if "contact" in node:
        k = whole(node["contact"], 0, 4 * states.wall.m - 1)
        halves = replace(states, tight=states.tight | {k}), replace(states, still=states.still | {k})
    else:
        p, normal = whole(node["interface"], 0, states.wall.m - 1), rational(node["normal"])
        need(normal >= 0, "a normal force below zero")
        least, most = states.sides.get(p, (NIL, None))
        few = {p: (least, normal if most is None else min(normal, most))}
        many = {p: (max(least, normal), most)}
        halves = replace(states, sides=states.sides | few), replace(states, sides=states.sides | many)
    return min(_case(halves[0], first), _case(halves[1], second))


def _step(states: Set, step: Any) -> Set:
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
    size = _size(_gain(motion, step["size"], True, reach, False))
    return states.from_(max(states.low, _raised(part, _gain(motion, step["multiplier"], False, reach, False), size)))


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
