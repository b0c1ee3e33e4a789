"""What bounds the forces and the mechanisms of a window of a certificate, in fractions."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

from methods.bound.exact_wall import (
    ZERO,
    CertificateError,
    ExactWall,
    Form,
    Vector,
    integers,
    paired,
    whole,
    whole_numbers,
)


class Forces:
    """Bounds of normal forces in all states of a window, each from virtual velocities.

    Forces in equilibrium do no work, so any virtual velocities may be added to a sum of forces; what is then left at an
    interface is at most a multiple of its normal force.
    """

    def __init__(self, wall: ExactWall, low: Fraction, high: Fraction, document: Any) -> None:
        self.wall, self.low, self.high = wall, low, high
        self.unit = 2 ** whole(document["exponent"], 0, 200)
        m = wall.n_interfaces
        self._rows, self._row_unit = integers([dict(row) for row in wall.sparse])
        self._loads, self._load_unit = integers([dict(enumerate(wall.live)), dict(enumerate(wall.dead))])
        friction, self._friction_unit = integers([dict(enumerate(wall.friction))])
        self._friction = {p: friction[0].get(p, 0) for p in range(m)}
        self.total: Fraction | None = None
        base, worst = self._above({p: Fraction(1) for p in range(m)}, document["total"])
        if worst >= 1:
            raise CertificateError("the normal forces of a window are not bounded")
        self.total = max(ZERO, base / (1 - worst))
        alone = [self.greatest({p: Fraction(1)}, v) for p, v in paired(range(m), document["greatest"])]
        self.normal = [min(self.total, max(ZERO, normal)) for normal in alone]

    def greatest(self, weights: Form, velocities: Any) -> Fraction:
        """An upper bound of a weighted sum of normal forces; weights {interface: weight}."""
        base, worst = self._above(weights, velocities)
        return base + worst * (self.total or ZERO)

    def least_slack(self, contact: int, velocities: Any) -> Fraction:
        """A lower bound of a yield slack."""
        p, k = divmod(contact, 4)
        mu = self.wall.friction[p]
        one = Fraction(1)
        slack = ({0: -one}, {1: -one}, {0: -mu, 1: -mu, 2: -one}, {0: -mu, 1: -mu, 2: one})[k]
        base, worst = self._above_form({3 * p + i: v for i, v in slack.items()}, velocities)
        return -(base + worst * (self.total or ZERO))

    def _above(self, weights: Form, velocities: Any) -> tuple[Fraction, Fraction]:
        form = {3 * p + end: weight for p, weight in weights.items() for end in (0, 1)}
        return self._above_form(form, velocities)

    def _above_form(self, form: Form, velocities: Any) -> tuple[Fraction, Fraction]:
        """(a, b) such that the form of forces is at most a + b times the sum of normal forces."""
        v = whole_numbers(velocities, len(self.wall.dead))
        scale, mu_unit = self.unit * self._row_unit * self._friction_unit, self._friction_unit
        worst = 0
        for p, mu in self._friction.items():
            first, second, shear = (
                (int(form[k] * scale) if k in form else 0)
                - mu_unit * sum([value * v[d] for d, value in self._rows[k].items()])
                for k in range(3 * p, 3 * p + 3)
            )
            worst = max(worst, max(first, second) * mu_unit + mu * abs(shear))
        live, dead = (
            Fraction(-sum([value * v[d] for d, value in load.items()]), self.unit * self._load_unit)
            for load in self._loads
        )
        return dead + max(self.low * live, self.high * live), Fraction(worst, scale * mu_unit)


class Columns:
    """Kinematic quantities of a window as forms of the velocities and of the backward slips of loaded interfaces.

    Attributes:
        rates: {contact: form} of rates that may be positive; still: forms that are zero.
        signed: interfaces whose slip is multiplied with its own forces only.
        work, lift: forms of the live work and of the lift.
        weights: {contact: weight} of rates in the size of a mechanism, and of the lift.
    """

    def __init__(self, wall: ExactWall, forces: Forces, document: Any) -> None:
        self.wall, self.forces = wall, forces
        m, self.n = wall.n_interfaces, len(wall.dead)
        quantum = Fraction(1, 2 ** whole(document["weight_exponent"], 0, 200))
        weights = [quantum * w for w in whole_numbers(document["weights"], m)]
        self.lift_weight = quantum * whole(document["lift_weight"], 1)
        if min(weights) <= 0:
            raise CertificateError("a weight is above zero")
        still = [whole(k, 0, 4 * m - 1) for k in document["still"]]
        for k, velocities in paired(still, document["still_velocities"]):
            if forces.least_slack(k, velocities) <= 0:
                raise CertificateError("a contact that is held still may move")
        loaded = [whole(p, 0, m - 1) for p in document["loaded"]]
        least: Form = {}
        for (p, claimed), velocities in paired(list(paired(loaded, document["least"])), document["least_velocities"]):
            least[p] = Fraction(claimed)
            if -forces.greatest({p: Fraction(-1)}, velocities) < least[p]:
                raise CertificateError("a normal force may be less than is said")
        self._build(set(still), least, weights)

    def _build(self, still: set[int], least: Form, weights: Vector) -> None:
        wall, n = self.wall, self.n
        self.rates: dict[int, Form] = {}
        self.still: list[Form] = []
        self.signed = [p for p in range(wall.n_interfaces) if p not in least]
        self.backward: dict[int, int] = {}
        for p in range(wall.n_interfaces):
            for k in (4 * p, 4 * p + 1):
                strain = dict(wall.sparse[3 * p + k % 4])
                if k in still:
                    self.still.append(strain)
                else:
                    self.rates[k] = strain
            if p in least:
                self._slips(p, still, n)
        self.width = n + len(self.backward)
        self.weights = {k: weights[k // 4] for k in self.rates}
        self.work = {d: f for d, f in enumerate(wall.live) if f}
        self.lift = {d: self.forces.high * f + g for d, (f, g) in enumerate(zip(wall.live, wall.dead, strict=True))}
        for k, form in self.rates.items():
            if k % 4 >= 2:
                for d, value in form.items():
                    self.lift[d] = self.lift.get(d, ZERO) - wall.friction[k // 4] * least[k // 4] * value

    def _slips(self, p: int, still: set[int], n: int) -> None:
        slip = dict(self.wall.sparse[3 * p + 2])
        forward, backward = 4 * p + 2 not in still, 4 * p + 3 not in still
        if forward and backward:
            place = n + len(self.backward)
            self.backward[p] = place
            self.rates[4 * p + 2], self.rates[4 * p + 3] = slip | {place: Fraction(1)}, {place: Fraction(1)}
        elif forward:
            self.rates[4 * p + 2] = slip
        elif backward:
            self.rates[4 * p + 3] = {d: -value for d, value in slip.items()}
        else:
            self.still.append(slip)

    def strain_limits(self) -> dict[int, Fraction]:
        """{strain: greatest value in mechanisms of size one} of all strains but slips of signed interfaces."""
        limits: dict[int, Fraction] = {}
        for p in range(self.wall.n_interfaces):
            for k in range(3):
                if k < 2 or p not in self.signed:
                    moving = [c for c in ((4 * p + k,) if k < 2 else (4 * p + 2, 4 * p + 3)) if c in self.rates]
                    limits[3 * p + k] = max((1 / self.weights[c] for c in moving), default=ZERO)
        return limits


class Motions:
    """Greatest velocities of mechanisms of size one.

    The velocities are a matrix times some strains, up to rounding. A slip of interfaces that may be unloaded is bounded
    where it is that of a course: the normal forces of its joints have a sum above zero, and slip against friction.
    """

    def __init__(self, columns: Columns, document: Any) -> None:
        self.columns, wall = columns, columns.wall
        n, unit = columns.n, 2 ** whole(document["exponent"], 0, 200)
        strains = [whole(k, 0, 3 * wall.n_interfaces - 1) for k in document["strains"]]
        inverse = [whole_numbers(row, len(strains)) for row in document["inverse"]]
        if len(inverse) != n:
            raise CertificateError("the velocities of a window are not all there")
        self._inverse = [{k: Fraction(v, unit) for k, v in zip(strains, row, strict=True) if v} for row in inverse]
        errors = [self._error(d) for d in range(n)]
        limits = columns.strain_limits()
        courses = [Course(columns, course) for course in document["courses"]]
        leading = {course.joints[0]: course for course in courses}
        slips: Form = {}
        loose = ZERO
        for course in courses:
            slips[3 * course.joints[0] + 2], part = course.slip(self._inverse, limits, errors, leading)
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
    """Interfaces that slide together, up to strains that are bounded, and whose normal forces have a positive sum."""

    def __init__(self, columns: Columns, document: Any) -> None:
        self.columns = columns
        self.joints = [whole(p, 0, columns.wall.n_interfaces - 1) for p in document["joints"]]
        if len(set(self.joints)) != len(self.joints) or not set(self.joints) <= set(columns.signed):
            raise CertificateError("a course names joints that are not its own")
        forces = columns.forces
        self.least = -forces.greatest({p: Fraction(-1) for p in self.joints}, document["velocities"])
        self.friction = min(columns.wall.friction[p] for p in self.joints)
        if self.least <= 0 or self.friction <= 0:
            raise CertificateError("the friction of a course is not above zero")

    def slip(
        self, inverse: list[Form], limits: Form, errors: Vector, leading: dict[int, Course]
    ) -> tuple[Fraction, Fraction]:
        """(a, b): the slip of the first joint is at most a, plus b times the greatest velocity or slip of a course.

        The friction work of slips of signed interfaces is at most the lift.
        """
        columns = self.columns
        base, part = 1 / (self.friction * columns.lift_weight), ZERO
        for p in self.joints:
            form: Form = {}
            error = ZERO
            for d, value in columns.wall.sparse[3 * p + 2]:
                error += abs(value) * errors[d]
                for k, entry in inverse[d].items():
                    form[k] = form.get(k, ZERO) + value * entry
            own = form.pop(3 * self.joints[0] + 2, ZERO)
            error += abs(abs(own) - 1)
            bounded = ZERO
            for k, value in form.items():
                if k in limits:
                    bounded += abs(value) * limits[k]
                elif k // 3 in leading and k % 3 == 2:
                    error += abs(value)
                else:
                    raise CertificateError("a joint of a course depends on a slip that nothing bounds")
            base += columns.forces.normal[p] * bounded
            part += columns.forces.normal[p] * error
        return base / self.least, part / self.least
