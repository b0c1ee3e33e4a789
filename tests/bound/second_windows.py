"""Sets of collapse states, their motions and products for the second checker: no import from `methods`."""

from __future__ import annotations

from collections.abc import Hashable, Iterable
from dataclasses import dataclass, field, replace
from fractions import Fraction
from itertools import product
from typing import Any

from tests.bound.second_wall import (
    NIL,
    ONE,
    Form,
    Wall,
    binary,
    listed,
    need,
    plus,
    up,
    value_of,
    whole,
)

Gain = tuple[Fraction, Fraction, Fraction]


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
        wall = self.states.wall
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
            base, part = self._slip_of_course(joints, course["velocities"], inverse, errors, known, leaders)
            slips[3 * joints[0] + 2] = base, part
            loose = max(loose, part)
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

    def _slip_of_course(
        self,
        joints: list[int],
        velocities: Any,
        inverse: list[dict[int, Fraction]],
        errors: list[Fraction],
        known: dict[int, Fraction],
        leaders: set[int],
    ) -> tuple[Fraction, Fraction]:
        """(a, b): the slip s of the first joint is at most a, plus b times what nothing bounds yet.

        Slips a_p s + b_p lose mu_p N_p |a_p s + b_p| by friction, which is at most the lift, so that |s| times the
        least sum of mu_p N_p |a_p| is at most the lift and the sum of mu_p N_p |b_p|, all by mu of the first joint.
        """
        states, friction, strains = self.states, self.states.wall.friction, self.states.wall.strains
        mu, leader = friction[joints[0]], 3 * joints[0] + 2
        need(mu > 0, "a course without friction")
        base, part, lost = 1 / (mu * self.lift_weight), NIL, {}
        for p in joints:
            form: dict[int, Fraction] = {}
            rest, share = NIL, friction[p] / mu
            for d, v in strains[p][2].items():
                assert isinstance(d, int)
                rest += abs(v) * errors[d]
                for k, a in inverse[d].items():
                    form[k] = form.get(k, NIL) + v * a
            lost[p] = share * abs(form.pop(leader, NIL))
            need(all(k in known or k in leaders for k in form), "a slip that nothing bounds")
            rest += sum((abs(v) for k, v in form.items() if k not in known), NIL)
            base += share * states.normal[p] * sum((abs(v) * known[k] for k, v in form.items() if k in known), NIL)
            part += share * states.normal[p] * rest
        least = -states.greatest({3 * p + end: -loss for p, loss in lost.items() for end in (0, 1)}, velocities)
        need(least > 0, "a course without friction")
        return base / least, part / least


def gain(motion: Motion, document: Any, of_size: bool, reach: dict[Hashable, Fraction], per_size: bool) -> Gain:
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


def size_of(found: Gain) -> Fraction:
    value, lost, price = found
    need(price < 1, "mechanisms without bound")
    return max(NIL, (lost - value) / (1 - price))


def raised(states: Set, found: Gain, size: Fraction) -> Fraction:
    value, lost, price = found
    return min(states.high, states.low + value - lost - price * size)
