"""Walls on ground that accelerates: closed forms of a rocking block, and a column that three programs shook.

The closed forms share no code with the engine: periods and impacts of Housner (1963), and his equation of motion
integrated by scipy.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.integrate import quad, solve_ivp

import drystone
from harness.engine.motion_judge import judge_time_history
from harness.model.errors import InputError
from harness.model.ground_motion import GroundMotion, pulses_of, read_motion
from harness.model.method import Finding
from methods.de.engines.pymunk_blocks import PymunkBlocks
from methods.de.settings import TimeSteps
from methods.de.time.history import tuning
from methods.de.time.impact import HOUSNER, measured_impact
from tests.de.shaken import ALPHA, GRAVITY, HEIGHT, IMPACT, PULSES, WIDTH, P, block, column
from tests.walls import stack, wall_data


def rocked(motion: GroundMotion, until: float) -> tuple[np.ndarray, np.ndarray]:
    """Times and clockwise rotations of the block by Housner's equation, from impact to impact."""

    def pull(time: float) -> float:
        piece = int(np.searchsorted(motion.time, time, side="right")) - 1
        if time >= motion.duration:
            return 0.0
        share = (time - motion.time[piece]) / (motion.time[piece + 1] - motion.time[piece])
        return float(motion.first[piece] + share * (motion.last[piece] - motion.first[piece]))

    def rate(time: float, state: np.ndarray, sense: float) -> list[float]:
        angle = sense * ALPHA - state[0]
        return [state[1], -(P**2) * (np.sin(angle) + pull(time) * np.cos(angle))]

    def impact(_time: float, state: np.ndarray, sense: float) -> float:
        return float(sense * state[0])

    def fallen(_time: float, state: np.ndarray, _sense: float) -> float:
        return float(abs(state[0]) - 1.2)

    impact.terminal, impact.direction, fallen.terminal = True, -1.0, True  # type: ignore[attr-defined]
    lifts = next(t for t in np.arange(0.0, motion.duration, 1e-4) if abs(pull(t)) > WIDTH / HEIGHT)
    sense = -float(np.sign(pull(lifts)))
    time, state = lifts, np.array([sense * 1e-12, 0.0])
    times, angles = [np.array([0.0])], [np.array([0.0])]
    while time < until:
        ends = [t for t in motion.time if t > time + 1e-12][:1] or [until]
        way = solve_ivp(
            rate, (time, min(ends[0], until)), state, args=(sense,), events=(impact, fallen), rtol=1e-9, atol=1e-12
        )
        times.append(way.t)
        angles.append(way.y[0])
        time, state = way.t[-1], way.y[:, -1].copy()
        if len(way.t_events[1]):
            break
        if len(way.t_events[0]):
            sense, state = -sense, np.array([-sense * 1e-12, IMPACT * state[1]])
            if abs(state[1]) < 1e-3:
                break
    return np.concatenate(times), np.concatenate(angles)


def test_integral_of_housner_gives_the_least_pulses_of_the_note():
    for seconds, least in PULSES.items():
        for share, falls in ((0.9999, False), (1.0001, True)):
            _, angle = rocked(pulses_of(f"{share * least}:{seconds}"), 8.0)
            assert bool(abs(angle).max() > 1.0) is falls, (seconds, share)


@pytest.mark.parametrize("step", [3e-4, 1e-3])
def test_engine_loses_the_energy_of_an_impact(step: float):
    """pymunk keeps e of the angular velocity, to first order in the step: refused from 1 % of e^2 on."""
    assert pytest.approx(IMPACT) == HOUSNER
    assert pytest.approx([2.686005, 0.942308], abs=5e-7) == [P, IMPACT]
    assert measured_impact(TimeSteps(time_step=step)) == pytest.approx(HOUSNER, rel=0.8 * step)


def test_engine_that_does_not_is_refused():
    with pytest.raises(InputError, match="of the speed of a rocking block at an impact"):
        drystone.shake(block(), "0.5:0.1", steps=TimeSteps(time_step=1e-2))


@pytest.mark.parametrize(("share", "exact"), [(0.2, 1.034574), (0.5, 1.963458), (0.8, 3.415408)])
def test_period_of_rocking(share: float, exact: float):
    """Four times the time to the first impact, of a block released at rest; the integral of Housner gives it too."""

    def inverse_speed(u: float) -> float:
        angle = share * ALPHA * (1.0 - u * u)  # without the singularity where it starts
        gained = np.cos(ALPHA - share * ALPHA) - np.cos(ALPHA - angle)
        return float(2.0 * share * ALPHA * u / (P * np.sqrt(2.0 * gained)))

    assert 4.0 * quad(inverse_speed, 0.0, 1.0)[0] == pytest.approx(exact, abs=1e-6)
    wall = block(friction=10.0).assembly
    steps = TimeSteps(time_step=5e-4)
    space = PymunkBlocks(wall, iterations=steps.iterations, options=tuning(steps), weighed=True)
    (free,) = wall.free
    turn = share * ALPHA
    arm = np.array([0.5 * WIDTH, 0.5 * HEIGHT])
    tilt = np.array([[np.cos(turn), -np.sin(turn)], [np.sin(turn), np.cos(turn)]])
    places = np.zeros((wall.n_blocks, 3))
    places[free] = *(tilt @ arm - arm), turn
    places[free, 1] -= 3e-6 * wall.length_scale  # a corner that just touches has no normal
    space.put(places)
    made = 0
    while space.places()[free, 2] > 0.0:
        space.advance(1)
        made += 1
    step = steps.time_step * np.sqrt(wall.length_scale / GRAVITY)
    assert 4.0 * made * step == pytest.approx(exact, abs=8.0 * step)


@pytest.mark.parametrize("seconds", PULSES)
def test_least_pulse_that_topples_a_block(seconds: float):
    below, above = (drystone.shake(block(), f"{share * PULSES[seconds]}:{seconds}") for share in (0.998, 1.002))
    assert (below.finding, above.finding) == (Finding.STANDS, Finding.FALLS)
    assert below.accepted, below.judge.sentence
    assert above.accepted, above.judge.sentence


def test_record_from_a_file_moves_a_block_as_housner_integrates_it(tmp_path: Path):
    """A sine of 0.3 g and 1.5 Hz, to the left first: five impacts, then the block topples."""
    path = tmp_path / "sine.csv"
    time = np.linspace(3.0, 5.0, 401)
    rows = "\n".join(f"{t:.3f},{-0.3 * GRAVITY * np.sin(3.0 * np.pi * (t - 3.0)):.9f}" for t in time)
    path.write_text(f"time [s],acceleration [m/s2]\n{rows}\n", encoding="utf-8")
    motion = read_motion(path, GRAVITY)
    assert motion.duration == pytest.approx(2.0)
    assert motion.peak == pytest.approx(0.3, rel=1e-4)
    found = drystone.shake(block(), path)
    when, angle = rocked(motion, 6.0)
    assert abs(angle).max() > 1.0
    assert found.finding is Finding.FALLS
    until = found.time < 2.5
    own, exact = -found.places[until, 1, 2], np.interp(found.time[until], when, angle)
    tilted = exact[abs(exact) > 1e-3]
    assert np.sum(np.diff(np.sign(tilted)) != 0.0) == 5
    np.testing.assert_allclose(own, exact, atol=0.01 * abs(exact).max())


COLUMN = {
    0.1: (3.6, 4.3),
    0.2: (1.46, 1.48),
    0.3: (0.87, 0.88),
    0.33: (0.78, 0.79),
    0.34: (0.39, 0.46),
    0.4: (0.29, 0.31),
    0.5: (0.25, 0.27),
    0.8: (0.22, 0.22),
}
"""Least toppling acceleration [g], range of UDEC, LMGC90 and HybriDFEM, by the duration of the first pulse [s]."""


@pytest.mark.slow
@pytest.mark.parametrize("seconds", COLUMN)
def test_column_topples_as_in_three_other_programs(seconds: float):
    """Ground a for t, then -a/2 for 2 t: it falls within 10 % of their range, and stands 10 % below it."""
    least, most = COLUMN[seconds]
    motion = f"1:{seconds},-0.5:{2.0 * seconds}"
    falls = [drystone.shake(column(), motion, a) for a in np.geomspace(0.95 * least, 1.1 * most, 6)]
    assert Finding.FALLS in [found.finding for found in falls]
    assert all(found.accepted for found in falls), [found.sentence for found in falls if not found.accepted]
    assert drystone.shake(column(), motion, 0.9 * least).finding is Finding.STANDS


@pytest.mark.slow
def test_first_mode_of_the_column_sets_in_between_two_durations():
    """From 0.457 g on at 0.34 s, and not up to 0.7 g at 0.33 s."""
    for seconds, level, finding in (
        (0.33, 0.46, Finding.STANDS),
        (0.33, 0.5, Finding.STANDS),
        (0.33, 0.6, Finding.STANDS),
        (0.33, 0.7, Finding.STANDS),
        (0.34, 0.45, Finding.STANDS),
        (0.34, 0.46, Finding.FALLS),
    ):
        found = drystone.shake(column(), f"1:{seconds},-0.5:{2.0 * seconds}", level)
        assert found.finding is finding, (seconds, level)


def arch(thickness: float) -> drystone.Wall:
    ring = {"type": "ring", "inner_radius": 2.0 - thickness / 2.0, "outer_radius": 2.0 + thickness / 2.0, "count": 13}
    return drystone.build_wall(wall_data(ring | {"angles": [180, 0]}, 0.8, loads={}))


def test_arch_under_less_than_its_multiplier_does_not_move():
    """Thickness over radius 0.2: its multiplier is above 0.28; one of 0.08 is too thin to stand."""
    shaken = ((arch(0.4), "0.2:0.3"), (arch(0.4), "2:0.3"), (arch(0.16), "0.001:0.1"))
    still, falls, thin = (drystone.shake(wall, pulse) for wall, pulse in shaken)
    assert (still.finding, falls.finding, thin.finding) == (Finding.STANDS, Finding.FALLS, Finding.FALLS)
    assert still.furthest[1] < 1e-4
    for found in (still, falls, thin):
        assert found.accepted, found.judge.sentence


def test_block_slides_as_far_as_newmark_says():
    """Newmark (1965): d = (a - mu g) T^2 / 2 while the ground accelerates by a, and no tilt."""
    squat = drystone.build_wall(wall_data(stack(1, 1.0, 0.3), 0.3, loads={}))
    found = drystone.shake(squat, "0.5:0.2")
    distance = 0.5 * (0.5 - 0.3) * GRAVITY * 0.2**2
    way = abs(found.places[:, 1, 0])
    assert abs(found.places[: np.searchsorted(found.time, 0.2), 1, 2]).max() < 1e-4
    assert np.interp(0.2, found.time, way) == pytest.approx(distance, rel=2e-3)


def test_judge_rejects_what_the_places_do_not_show():
    stood, fell = (drystone.shake(block(), f"{a}:0.1") for a in (0.8, 0.9))
    wall = stood.wall.assembly

    def accepted(found: drystone.Shaking, finding: Finding | None = None, **wrong: Any) -> bool | None:
        given = {"time": found.time, "places": found.places, "at_rest": found.at_rest, "moves_until": 0.1} | wrong
        return judge_time_history(wall, found.finding if finding is None else finding, **given).accepted

    assert accepted(stood)
    assert accepted(fell)
    assert accepted(stood, Finding.NONE) is None
    assert not accepted(stood, Finding.FALLS)
    assert not accepted(fell, Finding.STANDS)
    early = 2 + int(np.argmax(np.sign(stood.places[20:, 1, 2]) != np.sign(stood.places[20, 1, 2]))) + 20  # an impact
    assert not accepted(stood, time=stood.time[:early], places=stood.places[:early])
    assert not accepted(stood, time=stood.time[:early], places=stood.places[:early], at_rest=False)
    assert not accepted(stood, time=stood.time[:1], places=stood.places[:1])  # before the ground has moved
    looked_at = int(np.linspace(0, len(stood.places) - 1, 50)[20])
    for row, entry, shift in (
        (slice(None), (0, 0), 1e-2),
        (looked_at, (1, 1), -0.3),
        (-1, (1, 1), -5e-3),
        (0, (1, 0), 0.1),
        (5, (1, 0), np.nan),
    ):
        places = stood.places.copy()
        places[(row, *entry)] += shift
        assert not accepted(stood, places=places), (row, entry)
    tipped = fell.places.copy()
    tipped[-1] = [[0.0, 0.0, 0.0], [-0.8, 0.1, 1.2]]
    assert not accepted(fell, places=tipped)
