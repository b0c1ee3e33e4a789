"""A program that answers many walls by lines: one line of JSON in, one line of JSON out, on its standard streams."""

from __future__ import annotations

import atexit
import contextlib
import functools
import json
import os
import select
import subprocess
from typing import Any

from harness.model.answer_check import AnswerFault
from harness.model.errors import InputError, visible
from harness.model.foreign.register import Program
from harness.model.foreign.spawning import whole_address_space
from harness.model.json_text import LARGEST_FILE, json_of, text_of


class _Conversation:
    """The process of a program that answers by lines, started when it is needed and again after it was ended.

    It belongs to the process that started it: one that is forked from that starts another.

    Args:
        program: with `lines`.
    """

    def __init__(self, program: Program) -> None:
        self._program = program
        self._process: subprocess.Popen[bytes] | None = None
        self._owner = 0
        self._said = bytearray()

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
        self._owner, self._said = os.getpid(), bytearray()

    def ask(self, request: dict[str, Any]) -> Any:
        """The JSON value that answers a request.

        A process that fails or is interrupted is ended, so that no later request is answered by what it says then; the
        next request starts another.

        Raises:
            AnswerFault: the process ended, spoke before it was asked, or its line is no JSON.
        """
        self.start()
        process = self._process
        assert process is not None
        assert process.stdin is not None
        try:
            if self._said or self._ready():
                early = self._line() or bytes(self._said)
                raise AnswerFault(
                    f'The program wrote "{_shown(early)}" before it was asked' if early else self._no_line(process)
                )
            with contextlib.suppress(BrokenPipeError):
                process.stdin.write(json.dumps(request).encode() + b"\n")
                process.stdin.flush()
            line = self._line()
            if not line:
                raise AnswerFault(self._no_line(process))
            try:
                return json_of(text_of(line, "its result"), "its result")
            except InputError as error:
                said = f'The program wrote "{_shown(line)}" where one line of JSON was due'
                raise AnswerFault(f"{said}: {error}") from None
        except BaseException:
            self.end()
            raise

    def _ready(self) -> bool:
        """Whether the program has written what was not read."""
        assert self._process is not None
        assert self._process.stdout is not None
        return bool(select.select([self._process.stdout], [], [], 0.0)[0])

    def _line(self) -> bytes:
        """The next line of the program; empty where it ends before the line does, or the line does not end."""
        assert self._process is not None
        assert self._process.stdout is not None
        while b"\n" not in self._said:
            part = os.read(self._process.stdout.fileno(), 2**20)
            self._said += part
            if not part or len(self._said) > LARGEST_FILE:
                return b""
        line, _, rest = self._said.partition(b"\n")
        self._said = bytearray(rest)
        return bytes(line) or b" "

    def _no_line(self, process: subprocess.Popen[bytes]) -> str:
        if len(self._said) > LARGEST_FILE:
            return f"The program wrote more than {LARGEST_FILE:,} bytes in one line"
        with contextlib.suppress(subprocess.TimeoutExpired):
            code = process.wait(timeout=1.0)
            return f"The program ended with exit code {code} and gave no line of JSON"
        return "The program closed its output and gave no line of JSON"

    def end(self) -> None:
        """End the process, if it is of this process."""
        process, self._process = self._process, None
        self._said = bytearray()
        if process is None or self._owner != os.getpid():
            return
        process.kill()
        process.wait()
        for stream in (process.stdin, process.stdout):
            if stream is not None:
                with contextlib.suppress(OSError):
                    stream.close()


@functools.cache
def conversation_with(program: Program) -> _Conversation:
    """The conversation with a program, one in a process."""
    made = _Conversation(program)
    atexit.register(made.end)
    return made


def _shown(line: bytes) -> str:
    """The begin of a line, for a sentence."""
    return visible(line[:40].decode("utf-8", "replace").strip())
