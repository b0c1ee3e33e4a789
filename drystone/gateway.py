"""A wall as a model of UM-Bridge, so that tools of uncertainty quantification use Drystone unchanged.

UM-Bridge (Seelinger et al. 2023, Journal of Open Source Software 8, 4748) is a protocol over HTTP: a client sends
parameters, the model answers with vectors. It needs the package umbridge, which the extra of that name brings.
"""

from __future__ import annotations

import socket
import threading
import time
from collections.abc import Callable, Mapping, Sequence
from contextlib import closing
from dataclasses import dataclass, field
from http.client import HTTPConnection, HTTPException
from typing import Any

from drystone.analysis import Result
from drystone.comparing import compare
from drystone.walls import Wall, build_wall
from harness.engine.run import Limits
from harness.engine.sweep.paths import has_number, number_meant, setting_of, with_values
from harness.model.errors import InputError, optional
from harness.model.method import Finding

NAME = "drystone"
"""Of the model, by which clients ask for it."""
OUTPUTS = ("multiplier", "bound", "residual")


@dataclass(frozen=True)
class TemplateWall:
    """A wall some of whose quantities are parameters.

    Attributes:
        wall: the template.
        names: of the parameters, in their order, as of `drystone sweep --vary`; no settings of methods.
        method: that answers.
        limits: of each answer.
        settings: of the method, where not the defaults.

    Raises:
        InputError: a name under which the wall has no number, or several load cases.
    """

    wall: Wall
    names: tuple[str, ...]
    method: str = "la"
    limits: Limits = Limits()
    settings: Mapping[str, Any] = field(default_factory=dict)

    def __post_init__(self) -> None:
        if not self.names or len(set(self.names)) < len(self.names):
            raise InputError("parameters need a name each, at least one", "Give --vary NAME for each", "--vary")
        for name in self.names:
            if setting_of(name) is not None:
                raise InputError(f'"{name}" is a setting of a method', "Vary quantities of the wall", "--vary")
        if self.wall.load_cases:
            raise InputError("it has several load cases", "Choose one with --load-case NAME", "load_cases")
        document = self.wall.document()
        with_values(document, dict.fromkeys(self.names, 1.0))
        for name in self.names:
            if not has_number(document, name):
                remedy = number_meant(document, name) or "Write one in the wall, then vary it"
                raise InputError(f'the wall has no number "{name}"', remedy, "--vary")

    def __call__(self, values: Sequence[float]) -> tuple[float, float, float]:
        """What the method finds at these parameters.

        Args:
            values: (k,) of the parameters, in their order.

        Returns:
            The collapse multiplier: the middle of a bracket, 0 of a wall at its limit or that falls under its dead
            load; the bound: none is below it, proved in fractions, 0 without a proof; the judge's largest residual
            beside its tolerance.

        Raises:
            InputError: the values make no wall, or there is no accepted answer with a multiplier.
        """
        for name, value in zip(self.names, values, strict=True):
            if isinstance(value, bool) or not isinstance(value, int | float):
                raise InputError(f"{value!r} is no number", "Give one for each parameter", name)
        given = dict(zip(self.names, map(float, values), strict=True))
        wall = build_wall(with_values(self.wall.document(), given), self.wall.name)
        (found,) = compare(
            wall,
            [self.method],
            seconds=self.limits.seconds,
            memory_bytes=self.limits.memory_bytes,
            settings={self.method: dict(self.settings)},
        ).results
        worst = found.judge.worst
        return _multiplier(found), found.proof.bound or 0.0, 0.0 if worst is None else worst[1]


def _multiplier(found: Result) -> float:
    if not found.judge.accepted:
        raise InputError(f"{found.method}: {found.judge.sentence} {found.sentence}", "", "result")
    if found.finding in (Finding.FALLS, Finding.AT_LIMIT):
        return 0.0
    if found.multiplier is not None:
        return found.multiplier
    raise InputError(f"{found.method} finds no collapse multiplier: {found.sentence}", "", "result")


def serve(
    template: TemplateWall,
    port: int = 4242,
    report: Callable[[str], None] = print,
    ready: Callable[[str], None] = print,
) -> None:
    """Answer clients of UM-Bridge until the process is ended; a wall without an answer is an error of the protocol.

    Args:
        template: the wall. Its first input are all parameters, its outputs are `OUTPUTS`, a number each.
        port: of this machine, on which it listens.
        report: called with a sentence on each error.
        ready: called with the address once it answers there.

    Raises:
        MissingPackage: umbridge is not installed.
        InputError: it cannot listen on that port.
    """
    umbridge = optional("umbridge", "umbridge", "gateway")

    class Model(umbridge.Model):  # type: ignore[misc, name-defined]  # no types
        def get_input_sizes(self, config: Any) -> list[int]:
            return [len(template.names)]

        def get_output_sizes(self, config: Any) -> list[int]:
            return [1] * len(OUTPUTS)

        def supports_evaluate(self) -> bool:
            return True

        def __call__(self, parameters: list[list[float]], config: Any) -> list[list[float]] | None:
            try:
                return [[number] for number in template(parameters[0])]
            except InputError as error:
                report(str(error))
                return None  # umbridge answers with an error of the protocol, "InvalidOutput"

    try:
        with socket.socket() as tried:  # umbridge says nothing when it has bound the port, so a failure is met here
            tried.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
            tried.bind(("", port))
        threading.Thread(target=_when_it_answers, args=(port, ready), daemon=True).start()
        umbridge.serve_models([Model(NAME)], port)
    except OSError as error:
        problem = f"it cannot listen on the port {port} ({error.strerror or error})"
        raise InputError(problem, "End what listens there, or give another", "--port") from None


def _when_it_answers(port: int, ready: Callable[[str], None]) -> None:
    """Call `ready` with the address of a port of this machine when the server there answers."""
    while True:
        with closing(HTTPConnection("localhost", port, timeout=1.0)) as asked:
            try:
                asked.request("GET", "/Info")
                asked.getresponse()
            except (OSError, HTTPException):
                time.sleep(0.05)
                continue
        ready(f"http://localhost:{port}")
        return
