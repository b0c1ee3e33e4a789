"""A certificate is of its wall, number by number: walls that differ, are not described, or are not the same."""

from __future__ import annotations

import copy
import json
from collections.abc import Callable
from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from click.testing import CliRunner

from drystone.cli.main import main as drystone
from harness.model.assembly import Assembly
from harness.model.build import build
from harness.model.case import read_case, shipped_cases
from harness.model.content import content_of
from harness.model.wall import Wall
from methods.proof.same_wall import require_same_wall
from methods.proof.tree.certificate import wall_document
from methods.proof.verify.checker import main
from methods.proof.verify.document import digest
from methods.proof.verify.exact_wall import CertificateError
from tests.bound.shown import DATA, tree
from tests.walls import wall_data


def test_a_wider_stone_far_from_the_origin_is_of_another_wall(tmp_path: Path) -> None:
    forged, wall, honest = DATA / "grid-5e+06.forged.json", DATA / "grid-5e+06.wall.json", tmp_path / "own.json"
    run = CliRunner()
    answer = run.invoke(drystone, ["verify-bound", str(forged), "--wall", str(wall)])
    assert (answer.exit_code, "another wall" in answer.output) == (1, True)
    assert run.invoke(drystone, ["bound", str(wall), "-o", str(honest)]).exit_code == 0
    answer = run.invoke(drystone, ["verify-bound", str(honest), "--wall", str(wall), "--json"])
    assert json.loads(answer.output)["multiplier"] == "1/4"


@pytest.mark.parametrize("far", [0.0, 1e3, 1e6 + 0.1])
@pytest.mark.parametrize("part", [1e-3, 1e-6, 1e-10])
def test_no_number_of_a_wall_counts_as_the_same_because_another_is_large(far: float, part: float) -> None:
    """A block of 1e6 times the weight stands beside, and both stand far from the origin."""
    polygons = [[[x, 0.0], [x + 0.25, 0.0], [x + 0.25, 0.5], [x, 0.5]] for x in (far + 1.0, far + 3.0)]
    ground = [[far, -0.5], [far + 5.0, -0.5], [far + 5.0, 0.0], [far, 0.0]]
    data = {name: value for name, value in wall_data({}, 0.5).items() if name != "pattern"}
    blocks = [
        {"id": "ground", "polygon": ground, "fixed": True},
        {"id": "light", "polygon": polygons[0], "weight": 1.0},
        {"id": "heavy", "polygon": polygons[1], "weight": 1e6},
    ]
    wall = build(Wall.model_validate(data | {"blocks": blocks})).assembly
    own = wall_document(wall, 7.0)
    require_same_wall(own, wall)
    number = 1 + Fraction(part)
    changes: list[Callable[[Any], None]] = [
        lambda d: d["blocks"][0]["dead"].__setitem__(1, str(Fraction(d["blocks"][0]["dead"][1]) * number)),
        lambda d: d["blocks"][0]["live"].__setitem__(0, str(Fraction(d["blocks"][0]["live"][0]) * number)),
        lambda d: d["interfaces"][0].__setitem__("friction", str(Fraction(d["interfaces"][0]["friction"]) * number)),
        lambda d: d["interfaces"][0]["ends"].__setitem__(0, str(Fraction(d["interfaces"][0]["ends"][0]) + number - 1)),
        lambda d: d["blocks"][0]["centroid"].__setitem__(1, str(Fraction(d["blocks"][0]["centroid"][1]) + number - 1)),
    ]
    for change in changes:
        document = copy.deepcopy(own)
        change(document)
        with pytest.raises(CertificateError, match="another wall"):
            require_same_wall(document, wall)


def _turned(normal: Any, angle: float) -> Any:
    turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    return np.vstack([normal[:1] @ turn.T, normal[1:]])


NOT_DESCRIBED: dict[str, tuple[Callable[[Assembly], Assembly], str]] = {
    "cohesion": (lambda a: replace(a, constant=a.constant + np.array([0.0, 0.0, 0.1, 0.1])), "strength of their own"),
    "tensile strength of one joint": (
        lambda a: replace(a, constant=a.constant + np.outer([1.0, 0.0], [1e-9, 0.0, 0.0, 0.0])),
        "strength of their own",
    ),
    "dilatancy": (lambda a: replace(a, dilatancy=np.array([0.0, 1e-12])), "have dilatancy"),
    "a support that moves": (lambda a: replace(a, support_motion=np.outer(a.fixed, [0.0, 1e-9, 0.0])), "move"),
    "a normal that is not across its joint": (lambda a: replace(a, normal=_turned(a.normal, 1e-6)), "normals"),
    "a normal without a number": (lambda a: replace(a, normal=a.normal * np.nan), "normals"),
    "a load without a number": (lambda a: replace(a, dead=a.dead * np.nan), "NaN"),
}


@pytest.mark.parametrize("name", NOT_DESCRIBED)
def test_a_wall_that_no_certificate_describes_has_none(name: str) -> None:
    change, reason = NOT_DESCRIBED[name]
    wall = read_case(shipped_cases() / "two-frictions").assembly
    require_same_wall(tree(), wall)
    with pytest.raises(CertificateError, match=reason):
        require_same_wall(tree(), change(wall))


@pytest.mark.parametrize("name", ["cohesion", "a support that moves"])
def test_walls_of_other_joints_or_moving_supports_have_another_key(name: str) -> None:
    wall = read_case(shipped_cases() / "two-frictions").assembly
    assert content_of(NOT_DESCRIBED[name][0](wall)) != content_of(wall)


OTHER_WALLS: dict[str, Callable[[Any], Any]] = {
    "another unit of length": lambda d: _scaled(d, Fraction(1000)),
    "next to the unit of length": lambda d: _scaled(d, 1 + Fraction(1, 10**9)),
    "moved": lambda d: _moved(d, 1),
    "moved by next to nothing": lambda d: _moved(d, Fraction(1, 10**9)),
    "the live load doubled": lambda d: d["blocks"][0].update(live=_times(d["blocks"][0]["live"], Fraction(2))),
    "the live load reversed": lambda d: d["blocks"][0].update(live=_times(d["blocks"][0]["live"], Fraction(-1))),
    "all loads reversed": lambda d: d["blocks"][0].update(
        live=_times(d["blocks"][0]["live"], Fraction(-1)), dead=_times(d["blocks"][0]["dead"], Fraction(-1))
    ),
    "joints in another order": lambda d: d["interfaces"].reverse(),
    "ends in another order": lambda d: [
        item.update(ends=[*item["ends"][2:], *item["ends"][:2]]) for item in d["interfaces"]
    ],
    "the other side": lambda d: [item.update(side=-item["side"]) for item in d["interfaces"]],
    "blocks of a joint in another order": lambda d: [item.update(a=item["b"], b=item["a"]) for item in d["interfaces"]],
    "a joint less": lambda d: d["interfaces"].pop(),
    "a joint twice": lambda d: d["interfaces"].append(d["interfaces"][0]),
    "a block more": lambda d: d["blocks"].append(d["blocks"][0]),
    "another name": lambda d: d["blocks"][0].update(id="another"),
    "frictions in another order": lambda d: _exchanged(d),
}


def _times(values: list[str], number: Fraction) -> list[str]:
    return [str(number * Fraction(value)) for value in values]


def _scaled(document: Any, number: Fraction) -> None:
    for block in document["blocks"]:
        block["centroid"] = _times(block["centroid"], number)
        for name in ("dead", "live"):
            block[name] = [*block[name][:2], *_times(block[name][2:], number)]
    for item in document["interfaces"]:
        item["ends"] = _times(item["ends"], number)


def _moved(document: Any, far: Any) -> None:
    for values in (*(b["centroid"] for b in document["blocks"]), *(item["ends"] for item in document["interfaces"])):
        values[::2] = [str(Fraction(x) + far) for x in values[::2]]


def _exchanged(document: Any) -> None:
    first, second = document["interfaces"]
    first["friction"], second["friction"] = second["friction"], first["friction"]


@pytest.mark.parametrize("name", OTHER_WALLS)
def test_a_certificate_is_of_its_wall_number_by_number_and_in_its_order(name: str) -> None:
    document, wall = tree(), read_case(shipped_cases() / "two-frictions").assembly
    OTHER_WALLS[name](document)
    with pytest.raises(CertificateError, match="another wall"):
        require_same_wall(document, wall)


def beyond_floats() -> dict[str, Any]:
    """The block under a live load of 1e-400 of its weight: it slides at 2e399."""
    document, large = tree(), Fraction(10**400)
    for block in document["blocks"]:
        block["live"] = _times(block["live"], 1 / large)
    for leaf in document["leaves"]:
        if "parts" in leaf:
            leaf["parts"] = [leaf["parts"][0], str(large * Fraction(leaf["parts"][1]))]
    document |= {name: str(large * Fraction(document[name])) for name in ("bound", "multiplier")}
    return document | {"digest": digest(document)}


def test_a_multiplier_beyond_all_floats_is_shown_in_digits(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "certificate.json"
    file.write_text(json.dumps(beyond_floats()))
    assert main([str(file)]) == 0
    assert "= 1.999996e+399; one at 2" in capsys.readouterr().out
    answer = CliRunner().invoke(drystone, ["verify-bound", str(file), "--json"])
    assert (answer.exit_code, json.loads(answer.output)["value"]) == (0, None)
