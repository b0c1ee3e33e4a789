"""Motions of the ground: records and pulses, what units and impulses they keep, what is refused, and the command."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import drystone
from harness.model.errors import InputError
from harness.model.ground_motion import GroundMotion, pulses_of, read_motion
from harness.model.method import Finding
from tests.commands import drystone as command
from tests.de.shaken import HEIGHT, IMPACT, PULSES, WIDTH, block
from tests.walls import stack, wall_data


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
    assert table.read_text(encoding="utf-8").startswith("time [s],1 ux [m],1 uy [m],1 rotation [rad]\n0.0,")
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
