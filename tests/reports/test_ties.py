"""Ties and props in what people see: terminal, report, appendix, data, drawings and files for other programs."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import drystone
from harness.model.bar_forces import bar_forces_of
from harness.model.bars import state_of
from harness.model.details import BAR_FORCES
from harness.model.result import Result
from harness.model.support_reactions import out_of_balance, reactions_of
from reports.drawing.display_list import Lines
from reports.drawing.force_drawing import force_drawing
from reports.drawing.mechanism_drawing import mechanism_drawing
from reports.drawing.wall_drawing import wall_drawing
from tests.commands import drystone as command
from tests.tied_walls import bar, block

PROP = {"id": "raker", "prestress": 0.5}
TENSIONS = [2.0, -1.5]


def document() -> dict[str, Any]:
    """The tied block with a raking prop too: lambda = .2 + .225 + 1.5 x .6656.../16, by moments about its edge."""
    ties = [bar(("left", [-0.6, 1.8]), ("block", [0.0, 1.8]), 2.0)]
    props = [bar(("right", [1.2, 0.0]), ("block", [0.4, 1.2]), 1.5, **PROP)]
    return block(0.7, ties=ties, props=props)


@pytest.fixture(scope="module")
def wall() -> drystone.Wall:
    return drystone.build_wall(document(), "tied")


@pytest.fixture(scope="module")
def answer(wall: drystone.Wall) -> Result:
    return drystone.analyse(wall, "la")


def test_forces_of_bars_with_their_states(wall: drystone.Wall, answer: Result):
    arm = 1.2 * 0.8 / np.hypot(0.8, 1.2)
    assert answer.multiplier == pytest.approx(0.425 + 1.5 * arm / 16.0, rel=1e-9)
    listed = bar_forces_of(wall.case, answer)
    assert [(bar.bar, bar.kind, bar.start, bar.end, bar.state) for bar in listed] == [
        ("tie 1", "tie", "left", "block", "yields"),
        ("raker", "prop", "right", "block", "yields"),
    ]
    assert [bar.tension for bar in listed] == pytest.approx(TENSIONS, rel=1e-9)
    assert [(bar.least, bar.greatest) for bar in listed] == [(0.0, 2.0), (-1.5, -0.5)]


@pytest.mark.parametrize(
    ("kind", "tension", "least", "greatest", "state"),
    [
        ("tie", 2.0, 0.0, 2.0, "yields"),
        ("tie", 1.0, 0.0, 2.0, "bears"),
        ("tie", 0.0, 0.0, 2.0, "slack"),
        ("tie", 0.5, 0.5, 2.0, "at its prestress"),
        ("prop", -2.0, -2.0, 0.0, "yields"),
        ("prop", 0.0, -2.0, 0.0, "slack"),
        ("prop", -0.5, -2.0, -0.5, "at its prestress"),
    ],
)
def test_states_of_bars(kind: str, tension: float, least: float, greatest: float, state: str):
    assert state_of(kind, tension, least, greatest) == state


def test_reactions_with_bars_balance_the_loads(wall: drystone.Wall, answer: Result):
    """The tie pulls at the left support to the right, so the support pulls at the wall by 2 to the left."""
    listed = reactions_of(wall.case, answer)
    by_support = {reaction.support: reaction for reaction in listed}
    assert (by_support["left"].fx, by_support["left"].fy) == pytest.approx((-2.0, 0.0), abs=1e-12)
    assert by_support["right"].fy == pytest.approx(1.5 * 1.2 / np.hypot(0.8, 1.2), rel=1e-9)
    assert answer.multiplier is not None
    assert out_of_balance(wall.assembly, listed, answer.multiplier) < 1e-12


def test_tables_of_bars(wall: drystone.Wall):
    table = drystone.analyse(wall, "la").bars_to_pandas()
    assert table["tension"].tolist() == pytest.approx(TENSIONS, rel=1e-9)
    assert table.attrs["units"] == {"tension": "kN", "least": "kN", "greatest": "kN"}


def test_terminal_and_json(tmp_path: Path):
    path = tmp_path / "tied.json"
    path.write_text(json.dumps(document()), encoding="utf-8")
    shown = command("run", "la", path).stdout
    assert "tie 1, from left to block: tension 2 kN, yields" in shown
    assert "raker, from right to block: compression 1.5 kN, yields" in shown
    done = command("run", "la", path, "--json", "--fields")
    told = json.loads(done.stdout)
    assert [bar["tension"] for bar in told["bars"]] == pytest.approx(TENSIONS, rel=1e-9)
    result = tmp_path / "result.json"
    result.write_text(done.stdout, encoding="utf-8")
    assert command("judge", path, result).returncode == 0
    told["details"][BAR_FORCES] = [1.9, -1.5]
    result.write_text(json.dumps(told), encoding="utf-8")
    assert command("judge", path, result).returncode == 1
    told["details"][BAR_FORCES] = [2.0]
    result.write_text(json.dumps(told), encoding="utf-8")
    wrong = command("judge", path, result)
    assert wrong.returncode == 2
    assert "it has 1 entries, and should have 2" in wrong.stderr


def test_report_and_its_data(tmp_path: Path):
    path = tmp_path / "tied.json"
    path.write_text(json.dumps(document()), encoding="utf-8")
    report = tmp_path / "report.html"
    asked = ("--methods", "fe,de-soft,la", "--report", report, "--store", tmp_path / "store.sqlite")
    done = command("compare", path, *asked)
    assert done.returncode == 0, done.stderr
    assert "de-soft takes no ties, props and passive fill; the wall has tie 1, raker" in " ".join(done.stdout.split())
    page = report.read_text(encoding="utf-8")
    assert "Forces of ties and props" in page
    assert "1 tie, yield force 2 kN; 1 prop, yield force 1.5 kN" in page
    rows = (tmp_path / "report-data" / "bars.csv").read_text(encoding="utf-8").splitlines()
    assert rows[0] == '"case","method","bar","kind","from","to","tension","least","greatest","state","units"'
    assert all(row.endswith(',"kN"') for row in rows[1:])
    for method in ("fe", "la"):
        assert any(row.startswith(f'"tied","{method}","raker","prop","right","block",-1.5') for row in rows)


def roles(drawing: Any) -> list[str]:
    return [part.role for part in drawing.parts if isinstance(part, Lines) and part.role in ("tie", "prop", "idle")]


def test_drawings_show_bars(wall: drystone.Wall, answer: Result):
    """In the mechanism the ends of the tie move with its blocks: that on the support rests."""
    for drawing in (wall_drawing(wall.case), force_drawing(wall.case, answer), mechanism_drawing(wall.case, answer)):
        assert roles(drawing) == ["tie", "prop"]
    before, after = (
        next(part for part in drawing.parts if isinstance(part, Lines) and part.role == "tie").points[0]
        for drawing in (wall_drawing(wall.case), mechanism_drawing(wall.case, answer))
    )
    np.testing.assert_allclose(before[0], after[0])
    assert after[1, 0] > before[1, 0] + 1.0
    slack = answer.model_copy(update={"details": answer.details | {BAR_FORCES: [0.0, -0.5]}})
    assert roles(force_drawing(wall.case, slack)) == ["idle", "prop"]


@pytest.mark.parametrize("ending", ["vtu", "dxf", "svg", "geojson", "npz", "mat"])
def test_exports_hold_bars(tmp_path: Path, ending: str):
    path, output = tmp_path / "tied.json", tmp_path / f"tied.{ending}"
    path.write_text(json.dumps(document()), encoding="utf-8")
    done = command("export", path, "--method", "la", "-o", output)
    assert done.returncode == 0, done.stderr
    if ending == "vtu":
        meshio = pytest.importorskip("meshio")
        tension = np.concatenate(meshio.read(output).cell_data["tension"])
        assert tension[np.isfinite(tension)] == pytest.approx(TENSIONS, rel=1e-9)
    elif ending == "dxf":
        ezdxf = pytest.importorskip("ezdxf")
        lines = [item for item in ezdxf.readfile(output).modelspace() if item.dxf.layer in ("TIES", "PROPS")]
        assert [(item.dxf.start.x, item.dxf.end.x) for item in lines] == [(-0.6, 0.0), (1.2, 0.4)]
    elif ending == "svg":
        assert 'inkscape:label="ties and props"' in output.read_text(encoding="utf-8")
    elif ending == "geojson":
        listed = json.loads(output.read_text(encoding="utf-8"))["features"]
        found = [item["properties"] for item in listed if {"tie", "prop"} & set(item["properties"])]
        assert [item["tension"] for item in found] == pytest.approx(TENSIONS, rel=1e-9)
    else:
        _balances(output)


def _balances(path: Path) -> None:
    """C' r - B' (T - T0) + dead + lambda live = 0 in the arrays of a file."""
    if path.suffix == ".npz":
        arrays: Any = np.load(path, allow_pickle=True)
        matrix = np.zeros(arrays["C_shape"])
        np.add.at(matrix, (arrays["C_row"], arrays["C_col"]), arrays["C_data"])
    else:
        arrays = pytest.importorskip("scipy.io").loadmat(path)
        matrix = arrays["C"].toarray()
    flat = {name: np.ravel(arrays[name]) for name in ("forces", "dead", "live", "bar_tension", "bar_prestress")}
    at = float(np.ravel(arrays["forces_multiplier"])[0])
    forces = np.asarray(arrays["forces"]).reshape(-1, 3).ravel()
    beyond = flat["bar_tension"] - flat["bar_prestress"]
    left = matrix.T @ forces - np.asarray(arrays["B"]).T @ beyond + flat["dead"] + at * flat["live"]
    assert abs(left).max() < 1e-12 * 16.0
