"""The command as a user types it, for tests: exit code, standard output and standard error.

A command that runs in an ordinary environment is forked from a process that has loaded all of Drystone once, so that
two hundred tests do not each pay a second for imports; its runs are forked from it in turn, as the product does where
there is one run only. Whatever asks for another environment has a fresh interpreter, whose runs have a fork server.
"""

from __future__ import annotations

import atexit
import functools
import json
import os
import selectors
import subprocess
import sys
import tempfile
import traceback
from pathlib import Path
from typing import Any

SECONDS = 300.0
"""Time limit of a command [s]."""
COMMAND = (sys.executable, "-m", "drystone.cli.main")


def drystone(
    *words: str | Path,
    cwd: Path | None = None,
    variables: dict[str, str] | None = None,
    prefix: tuple[str, ...] = (),
    **more: Any,
) -> subprocess.CompletedProcess[str]:
    """Run a command to its end.

    Args:
        words: of the command, without "drystone".
        cwd: the working directory.
        variables: of the environment, beside what there is, that nothing reads while Drystone is loaded.
        prefix: words before the command, such as those of `setpriv`.
        more: further arguments of `subprocess.run`; with any, or a prefix, the interpreter is a fresh one.
    """
    told = [str(word) for word in words]
    if prefix or more:
        given = {"capture_output": True, "text": True, "timeout": SECONDS} | more
        return subprocess.run([*prefix, *COMMAND, *told], cwd=cwd, check=False, **given)
    with tempfile.TemporaryDirectory() as folder:
        out, err = Path(folder) / "out", Path(folder) / "err"
        task = {"words": told, "cwd": str(cwd or Path.cwd()), "variables": variables or {}}
        code = _template().run(task | {"out": str(out), "err": str(err)})
        return subprocess.CompletedProcess(told, code, out.read_text(), err.read_text())


@functools.cache
def _template() -> _Template:
    return _Template()


class _Template:
    """A process that has loaded the commands and makes each in a fork of itself."""

    def __init__(self) -> None:
        # Not `-m`: children of a command would load the main module of such a process again.
        program = f"import sys; sys.path.insert(0, {str(Path(__file__).parents[1])!r}); "
        self._process = subprocess.Popen(
            [sys.executable, "-c", program + "from tests.commands import serve; serve()"],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
            bufsize=1,
        )
        atexit.register(self.end)

    def run(self, task: dict[str, Any]) -> int:
        """The exit code of a command; negative where a signal ended it, as for `subprocess`."""
        streams = self._process
        assert streams.stdin is not None
        assert streams.stdout is not None
        streams.stdin.write(json.dumps(task) + "\n")
        streams.stdin.flush()
        with selectors.DefaultSelector() as selector:
            selector.register(streams.stdout, selectors.EVENT_READ)
            if not selector.select(SECONDS):
                self.end()
                _template.cache_clear()
                raise subprocess.TimeoutExpired(task["words"], SECONDS)
        return int(streams.stdout.readline())

    def end(self) -> None:
        """End the process; a command under way ends with it."""
        self._process.kill()
        self._process.communicate()


def serve() -> None:
    """Make the commands that come on standard input, one after another; what they return goes to standard output."""
    from harness.engine.threads import pin

    pin()
    import drystone.cli.main
    from drystone import new_wall
    from drystone.certificates import certificates_for
    from harness.engine import executors, preload

    for module, _, _ in drystone.cli.main.COMMANDS.values():
        __import__(f"drystone.cli.{module}")
    import reports.page.build  # noqa: F401

    preload.load(("la", "la-associated", "fe", "de"))
    certificates_for(new_wall("stack").case)  # reads the walls of the library that have certificates, once
    serving = executors.start_context
    executors.start_context = lambda methods: executors.own_context(methods) or serving(methods)
    for line in sys.stdin:
        child = os.fork()
        if child == 0:
            _become(json.loads(line))
        print(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]), flush=True)


def _become(task: dict[str, Any]) -> None:
    """Be the command: its words, its folder, its streams; ends this process."""
    nothing = os.open(os.devnull, os.O_RDONLY)
    out, err = (os.open(task[name], os.O_WRONLY | os.O_CREAT | os.O_TRUNC, 0o600) for name in ("out", "err"))
    for source, target in ((nothing, 0), (out, 1), (err, 2)):
        os.dup2(source, target)
        os.close(source)
    os.chdir(task["cwd"])
    os.environ.update(task["variables"])
    sys.argv = ["drystone", *task["words"]]
    code: Any = 0
    try:
        from drystone.cli.main import main

        main()
    except SystemExit as ended:
        code = ended.code
    except BaseException:
        traceback.print_exc()
        code = 1
    if isinstance(code, str):
        print(code, file=sys.stderr)
    atexit._run_exitfuncs()
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(code if isinstance(code, int) else int(code is not None))
