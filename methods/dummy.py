"""A method that misbehaves on order, so that the engine's promises can be tested with real child processes."""

from __future__ import annotations

import contextlib
import os
import sys
import time
from typing import Literal

import numpy as np

from harness.model.assembly import Assembly
from harness.model.errors import InputError
from harness.model.method import Answer, Finding, Method, OutOfTime, Settings, Status


class DummySettings(Settings):
    """What it shall do."""

    does: Literal[
        "answer",
        "nan",
        "nan_forces",
        "bad_shape",
        "raise",
        "refuse",
        "abort",
        "exit",
        "hang",
        "spawn",
        "tell",
        "eat",
        "print",
    ] = "answer"


class Dummy(Method):
    """Answers "stands" with no forces, or fails in the way it is asked to."""

    name = "dummy"
    family = "dummy"
    title = "misbehaves on order (tests of the engine)"
    tolerance = 1e-9
    Settings = DummySettings

    def solve(self, assembly: Assembly, settings: DummySettings) -> Answer:
        """Do what the settings say."""
        match settings.does:
            case "raise":
                raise RuntimeError("as ordered")
            case "refuse":
                raise InputError("it lacks a part", "Install the part")
            case "abort":
                print("about to abort", flush=True)
                os.abort()
            case "exit":
                os._exit(3)
            case "hang":
                while True:
                    with contextlib.suppress(OutOfTime):
                        time.sleep(3600)
            case "spawn":
                if os.fork() == 0:
                    time.sleep(3600)
                time.sleep(3600)
            case "tell":
                try:
                    time.sleep(3600)
                except OutOfTime:
                    return Answer(Status.NOT_CONVERGED, Finding.NONE, "It slept until its time was over.")
            case "eat":
                hoard = []
                while True:
                    hoard.append(np.ones(2**21))
            case "print":
                print("noise on standard output")
                print("noise on standard error", file=sys.stderr)
        return self._answer(assembly, settings)

    def _answer(self, assembly: Assembly, settings: DummySettings) -> Answer:
        answer = Answer(Status.OK, Finding.COLLAPSES, "An answer made up for a test.", multiplier=1.0)
        answer.forces = np.zeros((assembly.n_interfaces, 3))
        answer.mechanism = np.zeros((assembly.n_blocks, 3))
        answer.mechanism[assembly.free, 0] = 1.0
        match settings.does:
            case "nan":
                answer.multiplier = float("nan")
            case "nan_forces":
                answer.forces[0, 0] = float("nan")
            case "bad_shape":
                answer.forces = np.zeros((1, 2))
        return answer
