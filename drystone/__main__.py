"""The command: `python -m drystone` and `drystone`."""

from __future__ import annotations

import atexit
import os
import sys

from drystone.place import in_the_way


class _End:
    """The end of the process: taking an interpreter apart that is about to go costs a fourteenth of a small run."""

    code: int | None = None

    def __call__(self) -> None:
        """End at once with the exit code, if the command gave one and all that it wrote has gone out.

        What else happens at the end of a process has happened then: functions are called in reverse order of their
        registration, and this one was registered before all others.
        """
        if self.code is None:
            return
        try:
            sys.stdout.flush()
            sys.stderr.flush()
        except (OSError, ValueError):
            return  # the interpreter tells it
        os._exit(self.code)


def main() -> None:
    """Run the command. Exit code 2 where a file lies in the way of a package of ours."""
    end = _End()
    atexit.register(end)
    obstacle = in_the_way()
    if obstacle:
        print(f"drystone: {obstacle}", file=sys.stderr)
        sys.exit(2)
    from harness.cli import main as command

    try:
        command(prog_name="drystone")
    except SystemExit as leaving:
        end.code = leaving.code if isinstance(leaving.code, int) else None
        raise


if __name__ == "__main__":
    main()
