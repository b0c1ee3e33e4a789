"""The document of one window that `verify_window` checks: dual multipliers of the relaxation as binary fractions."""

from __future__ import annotations

import math
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from typing import Any

import numpy as np
import scipy.linalg

from harness.model.assembly import FloatArray, IntArray
from methods.proof.search.options import Precision
from methods.proof.search.relaxation import Relaxation
from methods.proof.search.slack_bounds import SlackProgramme
from methods.proof.search.window_search import WindowProof
from methods.proof.verify.cases import States
from methods.proof.verify.exact_wall import CertificateError, ExactWall, Form
from methods.proof.verify.force_limits import Forces
from methods.proof.verify.windows import WindowLimits


@dataclass(frozen=True, eq=False)
class Scales:
    """From the scaled wall of the search to the wall of a certificate, whose forces are per length of the interface.

    Attributes:
        length: (m,) lengths of interfaces; velocity: (3n,) velocities per scaled one; multiplier: per scaled one;
        blocks: number of free blocks, the live work of scaled mechanisms; it is one in a certificate.
        precision: of the numbers of the certificate.
    """

    length: FloatArray
    velocity: FloatArray
    multiplier: float
    blocks: float
    precision: Precision = Precision()

    def velocities(self, velocities: FloatArray) -> list[Any]:
        """Velocities (.., 3n) that prove a bound of slacks, as whole numbers over 2^`Precision.velocities`."""
        return whole_values(-velocities * self.velocity, self.precision.velocities)

    def scaled(self, multiplier: Fraction) -> float:
        """The scaled multiplier of the search, not above this one, whatever the conversion rounds."""
        return float(multiplier) / self.multiplier * (1.0 - 1e-15)

    def low(self, relaxation: Relaxation) -> Fraction:
        """The lower end of a window."""
        return below(relaxation.low * self.multiplier)


class WindowDocument:
    """A window in the numbers of a certificate.

    Args:
        wall: of the certificate.
        scales: from the search to it.
        proof: of the window, in floats.
        programme: of the slacks of the search.
        states: what is known of the states of a case, where the window is of those.
    """

    def __init__(
        self,
        wall: ExactWall,
        scales: Scales,
        proof: WindowProof,
        programme: SlackProgramme,
        states: States | None = None,
    ) -> None:
        self.wall, self.scales, self.proof, self.programme, self.states = wall, scales, proof, programme, states
        self.relaxation, self._precision = proof.relaxation, scales.precision
        self._rounding = self.relaxation.options.rounding
        m = wall.n_interfaces
        self.strains = np.array([[float(v) for v in row] for row in wall.rows]).reshape(3 * m, -1)
        self.friction = np.array([float(mu) for mu in wall.friction])
        self.dead = np.array([float(v) for v in wall.dead])
        self.live = np.array([float(v) for v in wall.live])
        self.low = scales.low(self.relaxation)
        self.high = -below(-self.relaxation.high * scales.multiplier) if states is None else states.high
        programme.window(self.relaxation.low, self.relaxation.high, self.relaxation.case)

    @cached_property
    def limits(self) -> WindowLimits:
        """What the window says of forces and mechanisms, checked.

        Raises:
            CertificateError: it says nothing of the kind.
        """
        if self.states is None:
            return WindowLimits(self.wall, self.parts)
        return self.states.window(self.parts)

    def document(self, needed: Fraction) -> tuple[dict[str, Any], Fraction]:
        """The shortest document that proves what is needed, else the best, and what it proves.

        Raises:
            CertificateError: none proves anything.
        """
        limits = self.limits
        size, greatest = self._shortest_size(limits)
        most, mine = Fraction(self.proof.bound) * Fraction(self.scales.multiplier), Fraction(0)
        exponent, best = self._precision.multipliers[0], self.parts
        before: Fraction | None = None
        while True:
            products = self._products(self.proof.multiplier, exponent, False)
            bound = limits.bound(products, greatest)
            if best is self.parts or bound > mine:
                best, mine = self.parts | {"size": size, "multiplier": products}, bound
            useless = before is not None and bound - before < (needed - bound) / 2
            if bound >= needed or useless or exponent == self._precision.multipliers[1]:
                return best, mine
            before = bound
            loss = float(most - bound) / max(float(most - needed), 1e-15 * float(most))
            exponent = min(exponent + max(2, math.ceil(math.log2(max(loss, 1.0)))), self._precision.multipliers[1])

    def _shortest_size(self, limits: WindowLimits) -> tuple[dict[str, Any], Fraction]:
        """The shortest multipliers that bound the size of mechanisms as the search does, else the longest."""
        enough = self._precision.enough_size * self.proof.greatest
        for exponent in self._precision.size:
            products = self._products(self.proof.size, exponent, True)
            try:
                greatest = limits.greatest_size(products)
            except CertificateError:
                if exponent == self._precision.size[-1]:
                    raise
                continue
            if greatest <= enough:
                break
        return products, greatest

    @cached_property
    def still(self) -> IntArray:
        """Contacts without a rate."""
        return np.flatnonzero(self.relaxation.bounds.least > self._rounding.margin)

    def _least(self, forces: dict[str, Any], velocities: list[Any]) -> list[str]:
        """Least normal forces of the interfaces that are loaded: of the search, or what their velocities show of them.

        What a programme of floats is wrong by costs as much of the sum of all normal forces, which may be large.

        Args:
            forces: the bounds of forces of the window; velocities: that show the least normal forces, in order.
        """
        normal, shown = self.relaxation.normal / self.scales.length, Forces(self.wall, self.low, self.high, forces)
        least = []
        for p, each in zip(self.relaxation.loaded.tolist(), velocities, strict=True):
            proved = below(-shown.greatest({p: Fraction(-1)}, each))
            least.append(max(Fraction(0), min(below(float(normal[p])), proved)))
        return [str(value) for value in least]

    @cached_property
    def parts(self) -> dict[str, Any]:
        """All but the multipliers of products."""
        bounds, scales, m = self.relaxation.bounds, self.scales, self.wall.n_interfaces
        by_interface = 1.0 / scales.length[:, None]
        total = self.programme.least(np.repeat(-1.0 / scales.length, 4) * np.tile([1.0, 1.0, 0.0, 0.0], m))
        if total[0] != "optimal":
            raise CertificateError("the normal forces of a window are not bounded")
        parts: dict[str, Any] = {
            "low": str(self.low),
            "forces": {
                "exponent": self._precision.velocities,
                "total": scales.velocities(total[2]),
                "greatest": scales.velocities(by_interface * bounds.greatest_velocities),
            },
            "weight_exponent": self._precision.weights,
            "weights": [int(w) for w in self._weights[0]],
            "lift_weight": self._weights[1],
        }
        if self.states is not None:
            return {"shows": "window"} | parts
        loaded = self.relaxation.loaded.tolist()
        least_velocities = scales.velocities((by_interface * bounds.least_velocities)[loaded])
        return parts | {
            "high": str(self.high),
            "still": self.still.tolist(),
            "still_velocities": scales.velocities(
                np.repeat(by_interface, 4, axis=0)[self.still] * bounds.still_velocities[self.still]
            ),
            "loaded": loaded,
            "least": self._least(parts["forces"], least_velocities),
            "least_velocities": least_velocities,
            "motions": self._motions(),
        }

    @cached_property
    def _weights(self) -> tuple[FloatArray, int]:
        """Whole weights (m,) of rates in the size of a mechanism, and of the lift, over 2^`Precision.weights`."""
        scales, unit, weights = self.scales, 2**self._precision.weights, self.relaxation.weights
        rates = scales.blocks / (scales.multiplier * scales.length) * weights[:-1]
        return np.round(rates * unit), round(float(weights[-1]) / scales.multiplier * unit)

    def _motions(self) -> dict[str, Any]:
        """Strains that give the velocities: bounded ones, then slips of courses."""
        m, n = self.wall.n_interfaces, len(self.dead)
        signed = 3 * self.relaxation.unloadable + 2
        bounded = np.setdiff1d(np.arange(3 * m), signed)
        _, triangle, order = scipy.linalg.qr(self.strains[bounded].T, pivoting=True, mode="economic")
        diagonal = abs(np.diag(triangle))
        rank = int((diagonal > self._rounding.tolerance * diagonal[0]).sum())
        chosen, courses = bounded[order[:rank]], []
        if rank < n:
            courses = self._courses(scipy.linalg.null_space(self.strains[bounded], rcond=self._rounding.tolerance))
            chosen = np.append(chosen, [3 * course["joints"][0] + 2 for course in courses]).astype(int)
        inverse = np.linalg.inv(self.strains[chosen])
        exponent = self._precision.motions
        return {
            "exponent": exponent,
            "strains": chosen.tolist(),
            "inverse": whole_values(inverse, exponent),
            "courses": courses,
        }

    def _courses(self, motions: FloatArray) -> list[dict[str, Any]]:
        """Interfaces that slide in proportion where (3n, e) motions open nothing: one course a motion, or an error."""
        unloadable, m = self.relaxation.unloadable, self.wall.n_interfaces
        slips = self.strains[3 * unloadable + 2] @ motions
        groups: list[tuple[FloatArray, list[int], list[float]]] = []
        for p, slip in zip(unloadable.tolist(), slips, strict=True):
            size = float(np.linalg.norm(slip))
            if size < self._rounding.tolerance or self.friction[p] <= 0.0:
                continue
            along = slip / size
            alike = (g for g in groups if min(abs(g[0] - along).max(), abs(g[0] + along).max()) < self._rounding.margin)
            same = next(alike, None)
            if same is None:
                groups.append((along, [p], [size]))
            else:
                same[1].append(p)
                same[2].append(size)
        courses, chosen = [], np.zeros((0, motions.shape[1]))
        for along, joints, sizes in sorted(groups, key=lambda group: -len(group[1])):
            if np.linalg.matrix_rank(np.vstack([chosen, along]), tol=self._rounding.margin) <= len(chosen):
                continue
            work = self.friction[joints] * np.array(sizes)
            weights = np.zeros((m, 4))
            weights[joints, :2] = (work / (work[0] * self.scales.length[joints]))[:, None]
            status, least, velocities = self.programme.least(weights.ravel())
            if status == "optimal" and least > self._rounding.margin:
                chosen = np.vstack([chosen, along])
                courses.append({"joints": joints, "velocities": self.scales.velocities(velocities)})
        if len(courses) < motions.shape[1]:
            raise CertificateError("a slip of interfaces that may be unloaded is not bounded")
        return courses

    @cached_property
    def _static(self) -> FloatArray:
        """(a, 3m + 2) static inequalities, those that are not local, over forces, multiplier and one."""
        m = self.wall.n_interfaces
        rows = np.zeros((self.relaxation.n_rows, 3 * m + 2))
        for p, mu in enumerate(self.friction):
            rows[4 * p, 3 * p] = rows[4 * p + 1, 3 * p + 1] = 1.0
            rows[4 * p + 2 : 4 * p + 4, 3 * p : 3 * p + 2] = mu
            rows[4 * p + 2 : 4 * p + 4, 3 * p + 2] = 1.0, -1.0
        rows[4 * m : 4 * m + 3, 3 * m :] = [[0.0, 1.0], [1.0, -float(self.low)], [-1.0, float(self.high)]]
        for row, (p, side, limit) in zip(rows[4 * m + 3 :], self.limits.forces.limits(), strict=True):
            row[3 * p : 3 * p + 2], row[3 * m + 1] = side, -side * float(limit)
        return rows

    @cached_property
    def _kinematic(self) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Rates, work and lift, signed slips, and still strains, over velocities and backward slips."""
        columns = self.limits.columns
        rates = [*columns.rates.values(), columns.work, columns.lift]
        signed = [dict(self.wall.sparse[3 * p + 2]) for p in columns.signed]
        forms = (rates, signed, [form for form, _ in columns.still])
        return _matrix(forms[0], columns.width), _matrix(forms[1], columns.width), _matrix(forms[2], columns.width)

    @cached_property
    def _inverses(self) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Pseudo-inverses of the static inequalities, transposed, of the rates and of the still strains."""
        rates, _, still = self._kinematic
        still_inverse = np.linalg.pinv(still) if len(still) else np.zeros((rates.shape[1], 0))
        return np.asarray(np.linalg.pinv(self._static.T)), np.asarray(np.linalg.pinv(rates)), np.asarray(still_inverse)

    @cached_property
    def _equilibrium(self) -> tuple[FloatArray, FloatArray]:
        """Equilibrium and slacks that are zero, as columns over forces, multiplier and one, and a basis of them."""
        equations = np.hstack(
            [np.vstack([self.strains, self.live, self.dead]), self._static[sorted(self.limits.forces.tight)].T]
        )
        return equations, scipy.linalg.orth(equations)

    @cached_property
    def _alone(self) -> FloatArray:
        """Directions of motions in which nothing but signed slips moves."""
        rates, _, still = self._kinematic
        return scipy.linalg.null_space(np.vstack([rates, still]), rcond=self._rounding.tolerance)

    def _products(self, products: FloatArray, exponent: int, of_size: bool) -> dict[str, Any]:
        """Multipliers of products, rounded, with the multiples of equations that leave next to nothing of the rest."""
        columns, m = self.limits.columns, self.wall.n_interfaces
        multipliers = self._unscaled(products, of_size)
        rates, signed, still = self._kinematic
        own = self._signed(products, of_size)
        static, (equations, basis) = self._static, self._equilibrium
        static_inverse, rate_inverse, still_inverse = self._inverses
        cost = np.zeros((len(static), rates.shape[0]))
        if of_size:
            cost[4 * m, :-2] = [-float(weight) for weight in columns.weights.values()]
            cost[4 * m, -1] = -float(columns.lift_weight)
        else:
            cost[4 * m + 1, -2] = 1.0
        unit = 2.0**exponent

        def rest_of(values: FloatArray, slips: FloatArray) -> FloatArray:
            rest = static.T @ (cost - values) @ rates
            for k, p in enumerate(columns.signed):
                rest[3 * p : 3 * p + 3] -= np.outer(slips[k], signed[k])
            return rest

        for _ in range(self._precision.refinements):
            rest = rest_of(multipliers, own)
            rest -= basis @ (basis.T @ rest)
            own = own + self._own_change(rest, basis, signed)
            rest = rest_of(multipliers, own)
            rest -= basis @ (basis.T @ rest)
            rest -= rest @ still_inverse @ still
            multipliers = multipliers + static_inverse @ rest @ rate_inverse
        multipliers, own = np.round(multipliers * unit) / unit, np.round(own * unit) / unit
        rest = rest_of(multipliers, own)
        fixed = np.round((rest - basis @ (basis.T @ rest)) @ still_inverse * unit) / unit
        rest = rest - fixed @ still
        balance: FloatArray = np.asarray(np.linalg.lstsq(equations, rest, rcond=None)[0], dtype=np.float64)
        return {
            "exponent": exponent,
            "columns": whole_values(multipliers.T, exponent),
            "signed": whole_values(own, exponent),
            "still": whole_values(fixed.T, exponent),
            "balance": whole_values(balance.T, exponent),
        }

    def _own_change(self, rest: FloatArray, basis: FloatArray, signed: FloatArray) -> FloatArray:
        """(q, 3) change of the signed slips' multipliers that takes what no other column can from the rest."""
        alone, q = self._alone, np.array(self.limits.columns.signed, dtype=np.int64)
        slips = signed @ alone
        if not alone.shape[1]:
            return np.zeros((len(q), 3))
        places = (3 * q[:, None] + np.arange(3)).ravel()
        complement = np.eye(len(basis))[:, places] - basis @ basis[places].T
        image = np.einsum("ik,ke->iek", complement, np.repeat(slips, 3, axis=0)).reshape(-1, len(places))
        return np.asarray(np.linalg.lstsq(image, (rest @ alone).ravel(), rcond=None)[0].reshape(-1, 3))

    def _unscaled(self, products: FloatArray, of_size: bool) -> FloatArray:
        """(a, f + 2) multipliers of products of the certificate's quantities."""
        scales, relaxation = self.scales, self.relaxation
        within = [scales.length[p] for p, _, _ in relaxation.limits]
        load = 1.0 / scales.multiplier
        row = np.concatenate([np.repeat(scales.length, 4), [1.0, load, load], within])
        rate = scales.blocks / (scales.multiplier * scales.length[relaxation.free // 4])
        column = np.concatenate([rate, [1.0, 1.0 / scales.multiplier]])
        given = products[: relaxation.n_rows, : len(column)] * row[:, None] * column
        place: dict[int | str, int] = {contact: k for k, contact in enumerate(relaxation.free.tolist())}
        names: list[int | str] = [*self.limits.columns.rates, "work", "lift"]
        place |= {"work": relaxation.work_column, "lift": relaxation.lift_column}
        used = np.zeros((relaxation.n_rows, len(names)))
        for k, name in enumerate(names):
            if name in place:
                used[:, k] = given[:, place[name]]
        return used if of_size else scales.multiplier * used

    def _signed(self, products: FloatArray, of_size: bool) -> FloatArray:
        """(q, 3) multipliers of n1, n2 and s times the slip of interfaces that may be unloaded."""
        relaxation, m, q = self.relaxation, self.wall.n_interfaces, self.relaxation.unloadable
        column, local = relaxation.lift_column + 1 + np.arange(len(q)), relaxation.n_rows + np.arange(len(q))
        plus, minus = products[4 * q + 2, column], products[4 * q + 3, column]
        first, second = products[local, column], products[local + len(q), column]
        mu = self.friction[q]
        forms = np.zeros((m, 3))
        forms[q] = np.column_stack(
            [mu * (plus + minus + first - second), mu * (plus + minus - first + second), plus - minus - first - second]
        )
        used = forms[self.limits.columns.signed] * (self.scales.blocks / (self.scales.multiplier if of_size else 1.0))
        return np.asarray(used)


def _matrix(forms: list[Form], width: int) -> FloatArray:
    """Forms as rows."""
    matrix = np.zeros((len(forms), width))
    for row, form in zip(matrix, forms, strict=True):
        for d, value in form.items():
            row[d] = float(value)
    return matrix


def below(value: float | Fraction) -> Fraction:
    """A binary fraction next to a number, below it or equal."""
    unit = 2**44
    return Fraction(math.floor(value * unit), unit)


def whole_values(values: FloatArray, exponent: int) -> list[Any]:
    """Whole numbers over 2^exponent, as nested lists."""
    if values.ndim > 1:
        return [whole_values(row, exponent) for row in values]
    return [round(v) for v in np.ldexp(values, exponent).tolist()]
