"""Refusals of questions about walls that move name the file, as errors of the file do."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

import drystone
from drystone.held_reactions import held_reactions
from drystone.reactions import least_known_reactions, reactions
from drystone.settling import settled_until_collapse
from drystone.support_paths import reaction_paths

DOWN = {"blocks": ["ground"], "translation": [0, -1]}
ASIDE = {"blocks": ["other"], "translation": [1, 0]}
PUSH = {"live": {"body": [{"per_weight": [1, 0]}]}}
DILATANT = {"default": 0.7, "dilatancy": 0.1}
MORTAR = {"default": 0.7, "cohesion": 5}


def shaken(wall: drystone.Wall) -> object:
    return drystone.shake(wall, "0.1:0.1")


def soft_paths(wall: drystone.Wall) -> object:
    return reaction_paths(wall, "de-soft")


def file(tmp_path: Path, **more: Any) -> Path:
    """A block on two supports."""
    blocks = [
        {"id": "ground", "polygon": [[-1, -0.2], [0.2, -0.2], [0.2, 0], [-1, 0]], "fixed": True},
        {"id": "other", "polygon": [[0.2, -0.2], [2, -0.2], [2, 0], [0.2, 0]], "fixed": True},
        {"id": "block", "polygon": [[0, 0], [0.4, 0], [0.4, 2], [0, 2]]},
    ]
    path = tmp_path / "wall.json"
    content = {"format": "wall/1", "unit_weight": 20, "friction": 0.7, "units": {"length": "m"}, "blocks": blocks}
    path.write_text(json.dumps(content | more), encoding="utf-8")
    return path


@pytest.mark.parametrize(
    ("ask", "more", "said"),
    [
        (shaken, {"settlements": [DOWN]}, "settlements: the wall has settlements"),
        (shaken, {"units": {"length": "1"}}, "units: the wall has no unit"),
        (shaken, {"friction": DILATANT}, "friction: the wall has joints with dil"),
        (shaken, {"unit_weight": 0}, "block: the free block block has no weight"),
        (drystone.capacity, {}, "loads.live: the wall has no live load"),
        (drystone.capacity, {"loads": PUSH, "settlements": [DOWN]}, "settlements: the wall has settlements"),
        (lambda wall: drystone.capacity(wall, "blok"), {"loads": PUSH}, '--block: no block is called "blok"'),
        (reactions, {}, "settlements: no support with a joint"),
        (soft_paths, {"settlements": [DOWN], "friction": DILATANT}, "de-soft takes no dilatancy"),
        (held_reactions, {"settlements": [DOWN, ASIDE]}, "settlements: ground and other do not move as one"),
        (least_known_reactions, {"settlements": [DOWN, ASIDE]}, "settlements: ground and other do not move as one"),
        (settled_until_collapse, {"settlements": [DOWN], "friction": MORTAR}, "the wall has joints with cohesion"),
    ],
)
def test_a_refusal_of_a_wall_that_moves_names_its_file(ask: Any, more: dict[str, Any], said: str, tmp_path: Path):
    path = file(tmp_path, **more)
    with pytest.raises(drystone.InputError) as refused:
        ask(drystone.read_wall(path))
    assert str(refused.value).startswith(f"{path}: {said}")
