"""What every start of a program has in common."""

from __future__ import annotations

import contextlib
import os
import resource
import selectors
import subprocess
import time
from collections.abc import Iterator


@contextlib.contextmanager
def whole_address_space() -> Iterator[None]:
    """Let a program that is started inside reserve any address space, as interpreters do that use little of it.

    Its resident memory is watched by the engine.
    """
    soft, hard = resource.getrlimit(resource.RLIMIT_AS)
    with contextlib.suppress(OSError, ValueError):
        resource.setrlimit(resource.RLIMIT_AS, (hard, hard))
    try:
        yield
    finally:
        with contextlib.suppress(OSError, ValueError):
            resource.setrlimit(resource.RLIMIT_AS, (soft, hard))


def output_of(words: list[str], seconds: float, most: int) -> tuple[int, bytes, bytes]:
    """Exit code, output and errors of a command, which is ended where it takes or writes too much.

    Args:
        words: the command; seconds: in which it must end; most: bytes of its output, and of its errors.

    Raises:
        OSError: it cannot be started.
        subprocess.TimeoutExpired: it did not end in time.
        OverflowError: it wrote more.
    """
    until = time.monotonic() + seconds
    with whole_address_space():
        process = subprocess.Popen(
            words, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE, bufsize=0
        )
    with process, selectors.DefaultSelector() as streams:
        said = {stream.fileno(): bytearray() for stream in (process.stdout, process.stderr) if stream is not None}
        for number in said:
            streams.register(number, selectors.EVENT_READ)
        try:
            while streams.get_map():
                ready = streams.select(max(0.0, until - time.monotonic()))
                if time.monotonic() >= until:
                    raise subprocess.TimeoutExpired(words, seconds)
                for key, _ in ready:
                    part = os.read(key.fd, 2**16)
                    said[key.fd] += part
                    if not part:
                        streams.unregister(key.fd)
                    if len(said[key.fd]) > most:
                        raise OverflowError
            code = process.wait(max(0.0, until - time.monotonic()))
        except BaseException:
            process.kill()
            raise
    output, errors = said.values()
    return code, bytes(output), bytes(errors)
