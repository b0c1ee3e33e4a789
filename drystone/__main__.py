"""The command: `python -m drystone` and `drystone`."""

from __future__ import annotations

import sys

from drystone import in_the_way


def main() -> None:
    """Run the command. Exit code 2 where a file lies in the way of a package of ours."""
    obstacle = in_the_way()
    if obstacle:
        print(f"drystone: {obstacle}", file=sys.stderr)
        sys.exit(2)
    from drystone.cli.main import main as command

    command(prog_name="drystone")


if __name__ == "__main__":
    main()
