"""What bounds the mechanisms of a window of a certificate, in fractions."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

from methods.proof.verify.exact_wall import (
    ZERO,
    CertificateError,
    ExactWall,
    Form,
    Vector,
    listed,
    whole,
    whole_numbers,
)
from methods.proof.verify.force_limits import Forces, KnownLimits


class Columns:
    """Kinematic quantities of a window as forms of the velocities and of the backward slips of loaded interfaces.

    Attributes:
        rates: {contact: form} of rates that may be positive; still: the others, with the most that they come to.
        signed: interfaces whose slip is multiplied with its own forces only.
        work, lift: forms of the live work and of the lift.
        weights: {contact: weight} of rates in the size of a mechanism, and of the lift.
    """

    def __init__(self, forces: Forces, known: KnownLimits, document: Any) -> None:
        self.wall, self.forces, self.known = forces.wall, forces, known
        self.n = len(self.wall.dead)
        quantum = Fraction(1, 2 ** whole(document["weight_exponent"], 0, 200))
        weights = [quantum * w for w in whole_numbers(document["weights"], self.wall.n_interfaces)]
        self.lift_weight = quantum * whole(document["lift_weight"], 1)
        if min(weights) <= 0:
            raise CertificateError("a weight is above zero")
        self._build()
        self.width = self.n + len(self.backward)
        self.weights = {k: weights[k // 4] for k in self.rates}

    def _build(self) -> None:
        wall, least = self.wall, self.known.least
        self.rates: dict[int, Form] = {}
        self.still: list[tuple[Form, Fraction]] = []
        self.backward: dict[int, int] = {}
        held = self.known.still | self.known.slow.keys()
        self.signed = [
            p for p in range(wall.n_interfaces) if p not in least and held.isdisjoint({4 * p + 2, 4 * p + 3})
        ]
        for p in range(wall.n_interfaces):
            for k in (4 * p, 4 * p + 1):
                self._add(k, dict(wall.sparse[3 * p + k % 4]))
            if p not in self.signed:
                self._slips(p)
        self.work = {d: f for d, f in enumerate(wall.live) if f}
        self.lift = {d: self.forces.high * f + g for d, (f, g) in enumerate(zip(wall.live, wall.dead, strict=True))}
        for k, form in self.rates.items():
            if k % 4 >= 2 and k // 4 in least:
                for d, value in form.items():
                    self.lift[d] = self.lift.get(d, ZERO) - wall.friction[k // 4] * least[k // 4] * value

    def _add(self, contact: int, form: Form) -> None:
        if contact in self.known.still:
            self.still.append((form, ZERO))
        elif contact in self.known.slow:
            self.still.append((form, self.known.slow[contact]))
        else:
            self.rates[contact] = form

    def _slips(self, p: int) -> None:
        slip = dict(self.wall.sparse[3 * p + 2])
        forward, backward = (k in self.known.still for k in (4 * p + 2, 4 * p + 3))
        if forward and backward:
            self.still.append((slip, ZERO))
        elif backward:
            self._add(4 * p + 2, slip)
        elif forward:
            self._add(4 * p + 3, {d: -value for d, value in slip.items()})
        else:
            place = self.n + len(self.backward)
            self.backward[p] = place
            self._add(4 * p + 2, slip | {place: Fraction(1)})
            self._add(4 * p + 3, {place: Fraction(1)})

    def strain_limits(self) -> dict[int, Fraction]:
        """{strain: greatest value in mechanisms of size one} of all strains but slips of signed interfaces."""
        limits: dict[int, Fraction] = {}
        for p in range(self.wall.n_interfaces):
            for k in range(3):
                if k < 2 or p not in self.signed:
                    moving = [c for c in ((4 * p + k,) if k < 2 else (4 * p + 2, 4 * p + 3)) if c in self.rates]
                    limits[3 * p + k] = max((1 / self.weights[c] for c in moving), default=ZERO)
        return limits


class Reach:
    """Greatest velocities and backward slips where those of all states are bounded already.

    Attributes:
        limits: of velocities, and of backward slips of these columns; of_size: whether they are per size of mechanisms.
    """

    of_size = False

    def __init__(self, columns: Columns, reach: Vector) -> None:
        self.limits = list(reach)
        self.limits += [most_of(columns.wall, 3 * p + 2, reach) for p in columns.backward]


def most_of(wall: ExactWall, strain: int, reach: Vector) -> Fraction:
    """The greatest strain of velocities within limits."""
    return sum((abs(value) * reach[d] for d, value in wall.sparse[strain]), ZERO)


class Motions:
    """Greatest velocities of mechanisms of size one.

    The velocities are a matrix times some strains, up to rounding. A slip of interfaces that may be unloaded is bounded
    where it is that of a course: the normal forces of its joints have a sum above zero, and slip against friction.
    """

    of_size = True

    def __init__(self, columns: Columns, document: Any) -> None:
        self.columns, wall = columns, columns.wall
        n, unit = columns.n, 2 ** whole(document["exponent"], 0, 200)
        strains = [whole(k, 0, 3 * wall.n_interfaces - 1) for k in listed(document["strains"])]
        inverse = [whole_numbers(row, len(strains)) for row in listed(document["inverse"])]
        if len(inverse) != n:
            raise CertificateError("velocities of a window are missing")
        self._inverse = [{k: Fraction(v, unit) for k, v in zip(strains, row, strict=True) if v} for row in inverse]
        errors = [self._error(d) for d in range(n)]
        limits = columns.strain_limits()
        courses = [Course(columns, course, self._inverse) for course in listed(document["courses"])]
        leading = {course.joints[0]: course for course in courses}
        slips: Form = {}
        loose = ZERO
        for course in courses:
            slips[3 * course.joints[0] + 2], part = course.slip(limits, errors, leading)
            loose = max(loose, part)
        known = limits | slips
        base, part_of = [], []
        for row, error in zip(self._inverse, errors, strict=True):
            if not all(k in known for k in row):
                raise CertificateError("a velocity depends on a slip that nothing bounds")
            base.append(sum((abs(v) * known[k] for k, v in row.items()), ZERO))
            part_of.append(error + loose * sum((abs(v) for k, v in row.items() if k in slips), ZERO))
        worst = max([*part_of, loose])
        if worst >= 1:
            raise CertificateError("the velocities of a window are not bounded")
        most = max([*base, *slips.values()]) / (1 - worst)
        self.limits = [b + part * most for b, part in zip(base, part_of, strict=True)]
        self.limits += [1 / columns.weights[4 * p + 3] for p in columns.backward]

    def _error(self, d: int) -> Fraction:
        """Sum of absolute entries of a row of inverse times strains minus the unit matrix."""
        row: Form = {d: Fraction(-1)}
        for k, value in self._inverse[d].items():
            for j, strain in self.columns.wall.sparse[k]:
                row[j] = row.get(j, ZERO) + value * strain
        return sum((abs(v) for v in row.values()), ZERO)


class Course:
    """Interfaces whose slips are proportional, up to strains that are bounded, and that cannot all be unloaded.

    Let s be the slip of the first interface and a_p s + b_p that of interface p, with a_p a coefficient of the matrix
    of `Motions` and b_p bounded. Friction on signed slips loses at most the lift: sum mu_p N_p |a_p s + b_p| <= lift.
    So |s| times the least value of sum mu_p |a_p| N_p is at most the lift plus sum mu_p N_p |b_p|. That least value is
    shown by virtual velocities, and must be above zero. All is divided by mu of the first interface.
    """

    def __init__(self, columns: Columns, document: Any, inverse: list[Form]) -> None:
        self.columns, friction = columns, columns.wall.friction
        self.joints = [whole(p, 0, columns.wall.n_interfaces - 1) for p in listed(document["joints"])]
        if len(set(self.joints)) != len(self.joints) or not set(self.joints) <= set(columns.signed):
            raise CertificateError("a course names joints that are not its own")
        self._forms = [self._slip_of(p, inverse) for p in self.joints]
        if not friction[self.joints[0]] > 0:
            raise CertificateError("the friction of a course is not above zero")
        self.share = [friction[p] / friction[self.joints[0]] for p in self.joints]
        weights: Form = {}
        for p, share, form in zip(self.joints, self.share, self._forms, strict=True):
            weights[p] = -share * abs(form.get(3 * self.joints[0] + 2, ZERO))
        self.least = -columns.forces.greatest(weights, document["velocities"])
        if self.least <= 0:
            raise CertificateError("the friction of a course is not above zero")

    def _slip_of(self, p: int, inverse: list[Form]) -> Form:
        """The slip of an interface by the strains that give the velocities."""
        form: Form = {}
        for d, value in self.columns.wall.sparse[3 * p + 2]:
            for k, entry in inverse[d].items():
                form[k] = form.get(k, ZERO) + value * entry
        return form

    def slip(self, limits: Form, errors: Vector, leading: dict[int, Course]) -> tuple[Fraction, Fraction]:
        """(a, b): the slip of the first joint is at most a, plus b times the greatest velocity or slip of a course."""
        columns, first = self.columns, self.joints[0]
        base, part = 1 / (columns.wall.friction[first] * columns.lift_weight), ZERO
        for p, share, form in zip(self.joints, self.share, self._forms, strict=True):
            error = sum((abs(value) * errors[d] for d, value in columns.wall.sparse[3 * p + 2]), ZERO)
            bounded = ZERO
            for k, value in form.items():
                if k in limits:
                    bounded += abs(value) * limits[k]
                elif k // 3 in leading and k % 3 == 2:
                    error += abs(value) if k // 3 != first else ZERO
                else:
                    raise CertificateError("a joint of a course depends on a slip that nothing bounds")
            base += share * columns.forces.normal[p] * bounded
            part += share * columns.forces.normal[p] * error
        return base / self.least, part / self.least
