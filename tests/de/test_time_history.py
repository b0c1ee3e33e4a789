"""Walls on ground that accelerates: closed forms of a rocking block, a column that three programs shook, and refusals.

The closed forms share no code with the engine: periods and impacts of Housner (1963), and his equation of motion
integrated by scipy.
"""

from __future__ import annotations

import json
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
from tests.commands import drystone as command
from tests.walls import stack, wall_data

WIDTH, HEIGHT, GRAVITY = 0.4, 2.0, 9.81
ALPHA = np.arctan(WIDTH / HEIGHT)
RADIUS = 0.5 * np.hypot(WIDTH, HEIGHT)
P = np.sqrt(0.75 * GRAVITY / RADIUS)
IMPACT = 1.0 - 1.5 * np.sin(ALPHA) ** 2
PULSES = {0.1: 0.851527, 0.2: 0.481959, 0.4: 0.303748, 0.8: 0.226254}
"""Least rectangular pulse [g] that topples the block, by its duration [s]."""


def block(friction: float = 0.9, **more: Any) -> drystone.Wall:
    return drystone.build_wall(wall_data(stack(1, WIDTH, HEIGHT), friction, **({"loads": {}} | more)))


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


def column() -> drystone.Wall:
    """Seven tapered blocks of equal height and a cap, 5.95 high (the note; Temple of Apollo at Bassae)."""
    top, height = 5.95 - 0.21, 5.95

    def layer(name: str, low: float, high: float, below: float, above: float) -> dict[str, Any]:
        left, right = [[-below / 2, low], [below / 2, low]], [[above / 2, high], [-above / 2, high]]
        return {"id": name, "polygon": left + right}

    width = np.linspace(1.11, 0.9, 8)
    level = np.linspace(0.0, top, 8)
    ground = {"id": "ground", "fixed": True, "polygon": [[-10, -1], [10, -1], [10, 0], [-10, 0]]}
    drums = [layer(str(k + 1), *level[k : k + 2].tolist(), *width[k : k + 2].tolist()) for k in range(7)]
    blocks = [ground, *drums, layer("cap", top, height, 0.9, 0.9)]
    return drystone.build_wall({"format": "wall/1", "unit_weight": 20.0, "friction": 0.7, "blocks": blocks})


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


def test_means_keep_the_impulse():
    motion = GroundMotion(np.array([0.0, 1.0, 1.5, 4.0]), np.array([1.0, -2.0, 0.0]), np.array([3.0, -2.0, 5.0]))
    at = np.sort(np.concatenate([[0.0, 6.0], np.random.default_rng(1).uniform(0.0, 5.0, 50)]))
    assert np.sum(motion.means(at) * np.diff(at)) == pytest.approx(2.0 - 1.0 + 6.25)
    assert motion.means(np.array([0.0, 0.5]))[0] == pytest.approx(1.5)
    assert motion.means(np.array([4.0, 5.0]))[0] == 0.0
    assert motion.times(-2.0).peak == 10.0


@pytest.mark.parametrize(("length", "unit"), [(1000.0, "mm"), (1.0 / 0.3048, "ft")])
def test_units_of_the_file_do_not_matter(length: float, unit: str):
    units = {"length": unit, "force": "N", "unit_weight": "kN/m3"}
    scaled = drystone.build_wall(
        wall_data(stack(1, length * WIDTH, length * HEIGHT), 0.9, units=units, loads={}, unit_weight=20.0)
    )
    own, other = (drystone.shake(wall, "0.4:0.1") for wall in (block(), scaled))
    assert other.finding is own.finding
    assert other.furthest[1] == pytest.approx(length * own.furthest[1], rel=1e-3)


def test_mirrored_motion_and_heavier_stone_move_a_block_alike():
    own = drystone.shake(block(), "0.4:0.1")
    mirrored = drystone.shake(block(), "0.4:0.1", -1.0)
    heavier = drystone.shake(block(unit_weight=60.0), "0.4:0.1")
    for other, sign in ((mirrored, -1.0), (heavier, 1.0)):
        assert other.finding is Finding.STANDS
        extremes = [abs(found.places[:, 1, 2]).max() for found in (own, other)]
        assert extremes[1] == pytest.approx(extremes[0], rel=2e-3)
        early = own.places[:30, 1, 2]
        np.testing.assert_allclose(sign * other.places[:30, 1, 2], early, atol=2e-3 * abs(early).max())


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


@pytest.mark.slow
def test_multiples_are_bracketed():
    found = drystone.least_shaking(block(), "1:0.4", 2e-3)
    assert found.accepted, found.sentence
    assert found.lower < PULSES[0.4] < found.upper < 1.0021 * found.lower
    assert found.tried[0, 0] <= 0.25
    below = found.tried[found.tried[:, 0] <= found.lower]
    assert not below[:, 1].any()
    assert max(below[1:, 0] / below[:-1, 0]) < 1.1
    listed = json.loads(json.dumps(found.as_json()))
    assert listed["bracket"] == [found.lower, found.upper]
    with pytest.raises(InputError, match="accuracy"):
        drystone.least_shaking(block(), "1:0.4", 2.0)


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
    for row, column, shift in (
        (slice(None), (0, 0), 1e-2),
        (looked_at, (1, 1), -0.3),
        (-1, (1, 1), -5e-3),
        (0, (1, 0), 0.1),
        (5, (1, 0), np.nan),
    ):
        places = stood.places.copy()
        places[(row, *column)] += shift
        assert not accepted(stood, places=places), (row, column)
    tipped = fell.places.copy()
    tipped[-1] = [[0.0, 0.0, 0.0], [-0.8, 0.1, 1.2]]
    assert not accepted(fell, places=tipped)


@pytest.mark.parametrize(
    ("more", "words"),
    [
        ({"units": {"length": "1", "force": "1"}}, "no unit of length"),
        ({"cohesion": 2.0}, "joints with cohesion"),
        ({"friction": {"default": 0.5, "dilatancy": 0.2}}, "dilatancy"),
        ({"loads": {"gravity": [0.1, -1.0]}}, "not the weight of the blocks alone"),
        ({"loads": {"gravity": False}}, "not the weight"),
        ({"loads": {"dead": {"points": [{"block": "1", "at": [0, 1], "force": [1, 0]}]}}}, "not the weight"),
        ({"unit_weight": 0.0}, "has no weight"),
    ],
)
def test_walls_that_are_not_followed_are_refused(more: dict[str, Any], words: str):
    with pytest.raises(InputError, match=words):
        drystone.shake(block(**more), "0.5:0.1")


@pytest.mark.parametrize(
    "text", [*["1", "1:0", "1:-1", "a:1", "1:1,", "1:1:1", "nan:1", "inf:1", "0:1", "1:2000", "2000:1"], ""]
)
def test_pulses_that_are_none_are_refused(text: str):
    with pytest.raises(InputError):
        pulses_of(text)


HEAD = "time [s],acceleration [g]\n"


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", "line 1.*first line"),
        ("0,1\n1,2\n", "first line"),
        ("time,acceleration\n0,1\n1,2\n", "first line"),
        (HEAD, "0 samples"),
        (HEAD + "0,1\n", "1 samples"),
        (HEAD + "0,1\n,2\n", 'line 3.*",2"'),
        (HEAD + "0,1\n\n1,2\n", "line 3"),
        (HEAD + "0,1\n1\n", "line 3"),
        (HEAD + "0,1\n1,nan\n", "line 3"),
        (HEAD + "0,1\n1,2,3\n", "line 3"),
        (HEAD + "0,1\n2,1\n1,0\n", "line 4.*does not follow"),
        (HEAD + "0,1\n0,1\n", "does not follow"),
        (HEAD + "0,1\n2000,1\n", "at most 1000 s"),
        (HEAD + "0,1\n1,4000\n", "at most 1000 g"),
        (HEAD + "0,0\n1,0\n", "all its accelerations are zero"),
        (HEAD + "".join(f"{k / 1000},1\n" for k in range(200_002)), "200,002 samples"),
    ],
)
def test_records_with_faults_are_refused_by_file_and_line(text: str, words: str, tmp_path: Path):
    path = tmp_path / "ground.csv"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(InputError) as caught:
        read_motion(path)
    assert str(caught.value).startswith(str(path))
    caught.match(words)


def test_command(tmp_path: Path):
    path, table, chart = (tmp_path / name for name in ("wall.json", "motion.csv", "motion.svg"))
    path.write_text(json.dumps(wall_data(stack(1, WIDTH, HEIGHT), 0.9)), encoding="utf-8")
    done = command("shake", path, "--pulse", "0.9:0.1", "-o", table)
    assert done.returncode == 0, done.stderr
    assert "The wall falls" in done.stdout
    assert "Engine: pymunk" in done.stdout
    assert table.read_text(encoding="utf-8").startswith("time,1 ux,1 uy,1 rotation\n0.0,")
    done = command("shake", path, "--pulse", "0.8:0.1", "--multiple", "0.5", "--json", "-o", chart)
    listed = json.loads(done.stdout)
    assert (done.returncode, listed["finding"], listed["fallen"]) == (0, "stands", [])
    assert listed["engine"]["impact"] == pytest.approx(IMPACT, rel=1e-3)
    assert chart.read_text(encoding="utf-8").lstrip().startswith("<?xml")
    for words in (
        [],
        ["--pulse", "1:1", "--motion", "x.csv"],
        ["--pulse", "1"],
        ["--motion", tmp_path / "none.csv"],
        ["--pulse", "1:0.1", "--least", "--multiple", "2"],
        ["--pulse", "1:0.1", "--multiple", "0"],
        ["--pulse", "1:0.1", "--gravity", "-1"],
    ):
        done = command("shake", path, *words)
        assert (done.returncode, done.stdout) == (2, ""), words
        assert done.stderr.startswith("drystone: "), words
