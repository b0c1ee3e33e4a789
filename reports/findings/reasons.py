"""Why two methods differ on one wall, from their mechanisms and forces: joints, blocks, the work of friction."""

from __future__ import annotations

import numpy as np

from harness.model.assembly import Assembly, FloatArray
from harness.model.comparison import CaseResults
from harness.model.details import AnswerDetails
from harness.model.method import Status
from harness.model.proof import least_known
from harness.model.result import Result, relative_velocities
from reports.findings.agreement import agreement, measure_of
from reports.findings.joints import motion
from reports.geometry import shapes, thrust_lines
from reports.labels import numbers

ONE_BODY, APART = 0.01, 0.2
"""Share of a motion that one rigid motion leaves, up to which it is one body's, and up to which it is mainly one's."""
_TOE = 0.05
"""Block sizes within which the centre of a rotation stands at the end of a joint: numerical fields are that near."""
_THRUST = 0.02
"""Share of the wall's weight by which thrusts through head joints differ worth a clause: the page prints hundredths."""
_SAME_VALUE = 1e-4
"""Relative difference of multipliers that is not worth a reason: the page prints five digits."""


def friction_share(assembly: Assembly, result: Result) -> float | None:
    """Work that sliding spends in friction over the work of the live load at collapse, the rest lifts weight.

    Args:
        assembly: the wall.
        result: a collapse state with forces (m, 3) and mechanism (n, 3).
    """
    if result.mechanism is None or result.forces is None or not result.multiplier or result.flow == "approximate":
        return None
    mechanism = np.asarray(result.mechanism, dtype=float)
    _, slip = relative_velocities(assembly, mechanism)
    shear = np.asarray(result.forces, dtype=float)[:, 2]
    live = result.multiplier * float((assembly.live * mechanism).sum())
    return None if live <= 0.0 else float(abs(shear * slip).sum()) / live


def mechanism_in_words(assembly: Assembly, mechanism: FloatArray, length: str) -> str:
    """Which share of the blocks moves and how: as one body that slides or turns about a point, mainly so, or apart.

    One rigid motion is fitted to the moving blocks by least squares over their areas; it is named where it holds 99 %
    of the motion, and called the main one where it holds four fifths. What it parts from along beds and heads by turns
    is a stepped crack.
    """
    moves = shapes.moving(assembly, mechanism)
    who = f"{int(moves.sum())} of {numbers.count(assembly.n_free, 'block')} {'moves' if moves.sum() == 1 else 'move'}"
    weights = np.sqrt(measure_of(assembly)[moves])
    rows = np.zeros((int(moves.sum()), 3, 3))
    rows[:] = np.eye(3)
    rows[:, 0, 2], rows[:, 1, 2] = -assembly.centroid[moves, 1], assembly.centroid[moves, 0]
    matrix = (weights[:, :, None] * rows).reshape(-1, 3)
    wanted = (weights * mechanism[moves]).ravel()
    if moves.sum() == 0 or not float(wanted @ wanted):
        return "no block moves"
    fitted = np.linalg.lstsq(matrix, wanted, rcond=None)[0]
    left = wanted - matrix @ fitted
    rest = float(left @ left) / float(wanted @ wanted)
    if rest > APART:
        return f"{who}, not as one body{_along(assembly, moves)}"
    mainly = "mainly " if rest > ONE_BODY else ""
    whole = "" if moves.sum() == 1 or mainly else " as one body"
    size = shapes.extent(assembly).longest
    if abs(fitted[2]) * size < 0.02 * float(np.hypot(*mechanism[moves, :2].T).max()):
        return f"{who}, {mainly}sliding{whole}{_along(assembly, moves)}"
    x, y = (value if abs(value) > 1e-9 * size else 0.0 for value in (-fitted[1] / fitted[2], fitted[0] / fitted[2]))
    ways = "clockwise" if fitted[2] < 0.0 else "anticlockwise"
    place = f"({numbers.plain(x, 3)}, {numbers.plain(y, 3)}) {length}".rstrip()
    toe = "the toe at " if _is_toe(assembly, x, y) else ""
    return f"{who}, {mainly}turning{whole} {ways} about {toe}{place}{_along(assembly, moves)}"


def _is_toe(assembly: Assembly, x: float, y: float) -> bool:
    """Whether a point is the end of a joint with a support."""
    held = assembly.fixed[assembly.block_a] | assembly.fixed[assembly.block_b]
    ends = np.concatenate([assembly.end1[held], assembly.end2[held]])
    return bool((np.hypot(*(ends - [x, y]).T) < _TOE * assembly.length_scale).any())


def _along(assembly: Assembly, moves: np.ndarray) -> str:
    """The crack between what moves and what does not, where it steps through at least two beds and two heads."""
    crack = moves[assembly.block_a] != moves[assembly.block_b]
    head = np.abs(assembly.normal[:, 0]) > thrust_lines.HEAD_JOINT
    steps = min(int((crack & head).sum()), int((crack & ~head).sum()))
    names = {assembly.joint[p] for p in np.flatnonzero(crack)}
    return ", along a stepped crack" if steps > 1 and names == {"bed", "head"} else ""


def reasons(item: CaseResults) -> list[str]:
    """Why every other collapse state of the case parts from the least accepted one, a sentence each."""
    states = [r for r in item.results if r.status is Status.OK and r.finding.has_multiplier]
    least = least_known(item)
    if least is None or least.mechanism is None:
        return []
    assembly = item.case.assembly
    measure = measure_of(assembly)
    apart: list[str] = []
    agree = [other.method for other in states if other is not least and _same_value(least, other)]
    for other in states:
        if other is least or other.mechanism is None or other.judge.accepted is False or _same_value(least, other):
            continue
        apart.append(_reason(assembly, least, other, measure) + _self_stress(item, least, other))
    sentences = [*apart, *_histories(states, several=bool(apart))]
    first = [f"At the multiplier of {least.method}: {', '.join(agree)}."] if agree and sentences else []
    return first + sentences


def _self_stress(item: CaseResults, least: Result, other: Result) -> str:
    """Thrust through head joints, which equilibrium leaves free, where two states differ in it."""
    assembly = item.case.assembly
    thrusts = [thrust_lines.head_thrust(assembly, result.forces) for result in (least, other)]
    if thrusts[0] is None or thrusts[1] is None or abs(thrusts[0] - thrusts[1]) < _THRUST:
        return ""
    said = (
        f" Head joints carry {thrusts[0]:.2f} of the wall’s weight in {least.method} "
        f"and {thrusts[1]:.2f} in {other.method}"
    )
    springs = next((r for r in item.mains if r.traits.elastic and r is not least and r.status is Status.OK), None)
    built = None if springs is None else thrust_lines.head_thrust(assembly, springs.forces)
    if springs is None or built is None or not other.traits.bounds_above or thrusts[1] - built < _THRUST:
        return f"{said}."
    return f"{said}, a self-stress that the load path does not produce: {springs.method} ends with {built:.2f}."


def _histories(states: list[Result], *, several: bool) -> list[str]:
    """Where histories of friction lead a method that follows several, if they part or there is anything to explain."""
    sentences = []
    for result in states:
        ends = AnswerDetails(result.details).plateaus
        if len(ends) < 2:
            continue
        low, high = numbers.multiplier(min(ends)), numbers.multiplier(max(ends))
        if max(ends) - min(ends) > _SAME_VALUE * abs(max(ends)):
            sentences.append(
                f"{result.method} ends between {low} and {high} over {len(ends)} histories of friction: "
                "which collapse state loading reaches depends on them."
            )
        elif several:
            sentences.append(f"{result.method} ends at {low} along each of {len(ends)} histories of friction.")
    return sentences


def _reason(assembly: Assembly, least: Result, other: Result, measure: FloatArray) -> str:
    pair = agreement(assembly, least, other, measure)
    head = f"{least.method} and {other.method} ({_difference(least, other)})"
    if pair.same_mechanism:
        return f"{head}: the same mechanism, other forces.{_friction(assembly, least, other)}"
    clauses: list[str] = []
    first, second = motion(assembly, least), motion(assembly, other)
    if first is not None and second is not None:
        for verb, a, b in (("slide", first.rubs, second.rubs), ("open", first.opens, second.opens)):
            clauses.extend(_in_one(verb, least.method, a & ~b))
            clauses.extend(_in_one(verb, other.method, b & ~a))
    for method, blocks in ((least.method, pair.only_first), (other.method, pair.only_second)):
        if blocks:
            verb = "moves" if len(blocks) == 1 else "move"
            clauses.append(f"{numbers.count(len(blocks), 'block')} {verb} in {method} only")
    cosine = "" if pair.cosine is None else f" (cosine {numbers.cosine(pair.cosine)})"
    what = f"mechanisms differ{cosine}"
    return f"{head}: {what}{': ' + '; '.join(clauses) if clauses else ''}.{_friction(assembly, least, other)}"


def _same_value(least: Result, other: Result) -> bool:
    """Whether two multipliers are one to the digits printed; a measured value is its whole bracket."""
    if least.multiplier is None or other.multiplier is None:
        return False
    pair = other.bracket if other.flow == "approximate" and other.bracket is not None else (other.multiplier,) * 2
    near = _SAME_VALUE * max(abs(least.multiplier), 1e-300)
    return pair[0] - near <= least.multiplier <= pair[1] + near


def _difference(least: Result, other: Result) -> str:
    """How far another multiplier is from the least, in percent; of a measured value, both ends of its bracket."""
    base = least.multiplier
    if not base or other.multiplier is None:
        return numbers.NOTHING
    if other.flow == "approximate" and other.bracket is not None:
        return " to ".join(numbers.percent(end / base - 1.0) for end in other.bracket)
    return numbers.percent(other.multiplier / base - 1.0)


def _in_one(verb: str, method: str, joints: np.ndarray) -> list[str]:
    number = int(joints.sum())
    if not number:
        return []
    return [f"{numbers.count(number, 'joint')} {verb + 's' if number == 1 else verb} in {method} only"]


def _friction(assembly: Assembly, first: Result, second: Result) -> str:
    shares = [friction_share(assembly, result) for result in (first, second)]
    if shares[0] is None or shares[1] is None:
        return ""
    return (
        f" Friction takes {100.0 * shares[0]:.0f} % of the live load’s work in {first.method} "
        f"and {100.0 * shares[1]:.0f} % in {second.method}."
    )
