"""Ways to look at the same wall differently; the multiplier must not notice."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import pytest

from harness.engine.symmetry import VIEWS
from harness.model.assembly import Assembly


def turned_interfaces(wall: Assembly) -> Assembly:
    return replace(wall, block_a=wall.block_b, block_b=wall.block_a, normal=-wall.normal)


@pytest.fixture(params=[*VIEWS, "turned_interfaces"])
def view(request: pytest.FixtureRequest) -> Callable[[Assembly], Assembly]:
    return turned_interfaces if request.param == "turned_interfaces" else VIEWS[request.param]
