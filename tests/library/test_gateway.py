"""The gateway to UM-Bridge, by the client of that protocol, on the block that slides at its friction."""

from __future__ import annotations

import os
import socket
import subprocess
import sys
from collections.abc import Iterator

import pytest

import drystone
from drystone.gateway import TemplateWall
from harness.model.errors import InputError
from tests.commands import drystone as command

umbridge = pytest.importorskip("umbridge")


@pytest.fixture(scope="module")
def url() -> Iterator[str]:
    with socket.socket() as free:
        free.bind(("localhost", 0))
        port = free.getsockname()[1]
    words = ["gateway", "slide", "--vary", "friction", "--vary", "unit_weight", "--port", str(port)]
    environment = os.environ | {"PYTHONUNBUFFERED": "1"}
    with subprocess.Popen(
        [sys.executable, "-m", "drystone", *words], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
        env=environment,
    ) as server:  # fmt: skip
        found = f"http://localhost:{port}"
        assert server.stdout is not None
        for line in server.stdout:
            if line == f'Model "drystone" at {found}: friction, unit_weight -> multiplier, bound, residual\n':
                break
        with socket.socket() as tried:  # it is told when it answers, and not before
            assert tried.connect_ex(("localhost", port)) == 0
        yield found
        server.kill()
        assert server.stderr is not None
        said = server.stderr.read()
        assert "friction: it should be greater than or equal to 0 (given: -1.0)" in said
        assert "Traceback" not in said


def test_a_client_asks_for_multipliers_and_is_told_of_errors(url: str):
    model = umbridge.HTTPModel(url, "drystone")
    assert (model.get_input_sizes(), model.get_output_sizes()) == ([2], [1, 1, 1])
    for friction in (0.3, 0.25):  # the library has a certificate for .3
        (multiplier,), (bound,), (residual,) = model([[friction, 21.0]])
        assert multiplier == pytest.approx(friction, abs=1e-9)
        assert bound <= multiplier
        assert 0.0 <= residual < 1e-9
    with pytest.raises(Exception, match="InvalidOutput"):
        model([[-1.0, 20.0]])
    for wrong in ("a", None, [0.2], True):
        with pytest.raises(Exception, match="InvalidOutput"):
            model([[wrong, 20.0]])
    assert model([[0.2, 20.0]])[0] == [pytest.approx(0.2, abs=1e-9)]


@pytest.mark.parametrize(
    "names",
    [
        (),
        ("friction", "friction"),
        ("blocks[99].x",),
        ("settings.la.effort",),
        ("nosuch",),
        ("la.effort",),
        ("blocks",),
        ("format",),
        ("loads.live.body[0].per_weight",),
    ],
)
def test_parameters_that_the_wall_does_not_have_are_refused(names: tuple[str, ...]):
    with pytest.raises(InputError):
        TemplateWall(drystone.library_wall("slide"), names)


def test_a_bracket_is_its_multiplier_and_a_wall_that_falls_has_zero():
    leaning = TemplateWall(drystone.library_wall("slide"), ("friction",), "de")
    assert leaning([0.3])[0] == pytest.approx(0.3, rel=5e-3)
    box = [[0, 0], [1, 0], [1, 1], [0, 1]]
    ground = {"id": "g", "fixed": True, "polygon": [[0, -1], [1, -1], [1, 0], [0, 0]]}
    push = {"body": [{"per_weight": [0.0, 0.0]}]}
    wall = {"format": "wall/1", "unit_weight": 20, "friction": 0.5, "blocks": [ground, {"id": "a", "polygon": box}]}
    wall |= {"loads": {"dead": push, "live": {"body": [{"per_weight": [1, 0]}]}}}
    pushed = TemplateWall(drystone.build_wall(wall), ("loads.dead.body[0].per_weight[0]",), "la-associated")
    assert pushed([0.2])[0] == pytest.approx(0.3, abs=1e-9)
    assert pushed([0.7])[0] == 0.0


def test_a_command_refuses_before_it_listens():
    done = command("gateway", "slide", "--vary", "settings.la.effort")
    assert done.returncode == 2
    assert "is a setting of a method" in done.stderr


def test_a_port_that_another_process_has_is_refused():
    with socket.socket() as other:
        other.bind(("", 0))
        other.listen()
        port = other.getsockname()[1]
        done = command("gateway", "slide", "--vary", "friction", "--port", str(port))
    assert done.returncode == 2
    assert f"--port: it cannot listen on the port {port}" in done.stderr
    assert "Model" not in done.stdout
