"""A program that answers many walls by lines: one line of JSON in, one line of JSON out, on its standard streams."""

from __future__ import annotations

import atexit
import contextlib
import functools
import json
import os
import subprocess
from typing import Any

from harness.model.answer_check import AnswerFault
from harness.model.errors import InputError
from harness.model.foreign.register import Program
from harness.model.foreign.spawning import whole_address_space
from harness.model.reading import LARGEST_FILE


class Conversation:
    """The process of a program that answers by lines, started when it is needed and again after it was ended.

    It belongs to the process that started it: one that is forked from that starts another.

    Args:
        program: with `lines`.
    """

    def __init__(self, program: Program) -> None:
        self._program = program
        self._process: subprocess.Popen[bytes] | None = None
        self._owner = 0

    def processes(self) -> list[int]:
        """Its process, if it runs."""
        running = self._process is not None and self._owner == os.getpid() and self._process.poll() is None
        return [self._process.pid] if running and self._process is not None else []

    def start(self) -> None:
        """Start the program if it does not run.

        Raises:
            InputError: it cannot be started.
        """
        if self.processes():
            return
        words = self._program.command
        try:
            with whole_address_space():
                self._process = subprocess.Popen(words, stdin=subprocess.PIPE, stdout=subprocess.PIPE)
        except OSError as error:
            problem = f"the program {words[0]} cannot be started ({error.strerror or error})"
            raise InputError(problem, "Check the command", self._program.name) from None
        self._owner = os.getpid()

    def ask(self, request: dict[str, Any]) -> str:
        """The line that answers a request. A process that fails or is interrupted is ended; the next request starts it.

        Raises:
            AnswerFault: the process ended, or its line does not end.
        """
        self.start()
        process = self._process
        assert process is not None
        assert process.stdin is not None
        assert process.stdout is not None
        try:
            try:
                process.stdin.write(json.dumps(request).encode() + b"\n")
                process.stdin.flush()
                line = process.stdout.readline(LARGEST_FILE)
            except BrokenPipeError:
                line = b""
            if not line.endswith(b"\n"):
                raise AnswerFault(self._no_line(process, line))
        except BaseException:
            self.end()
            raise
        return line.decode("utf-8", "replace")

    def _no_line(self, process: subprocess.Popen[bytes], line: bytes) -> str:
        if len(line) >= LARGEST_FILE:
            return f"The program wrote more than {LARGEST_FILE:,} bytes in one line"
        with contextlib.suppress(subprocess.TimeoutExpired):
            code = process.wait(timeout=1.0)
            return f"The program ended with exit code {code} and gave no line of JSON"
        return "The program closed its output and gave no line of JSON"

    def end(self) -> None:
        """End the process, if it is of this process."""
        process, self._process = self._process, None
        if process is None or self._owner != os.getpid():
            return
        process.kill()
        process.wait()
        for stream in (process.stdin, process.stdout):
            if stream is not None:
                with contextlib.suppress(OSError):
                    stream.close()


@functools.cache
def conversation_with(program: Program) -> Conversation:
    """The conversation with a program, one in a process."""
    made = Conversation(program)
    atexit.register(made.end)
    return made
