"""`python -m harness.conformance METHOD...`: the suite without the command line of Drystone."""

from __future__ import annotations

import sys

from harness.conformance.suite import conforms, suite
from harness.model.method import listed_methods, load_method, method_names, prepared


def main() -> None:
    """Run the suite on the methods named on the command line; exit code 1 if one does not conform, 2 if unknown."""
    names = sys.argv[1:]
    if not names or not set(names) <= set(method_names()):
        print(
            f"usage: python -m harness.conformance METHOD...; methods: {', '.join(listed_methods())}", file=sys.stderr
        )
        sys.exit(2)
    bad = 0
    for name in names:
        method = prepared(load_method(name))
        rows = []
        for check in suite():
            rows.append(row := check.row(method))
            print(f"{name:20s} {row.check:18s} {row.outcome}{': ' * bool(row.sentence)}{row.sentence}", flush=True)
        bad += not conforms(rows)
    sys.exit(1 if bad else 0)


if __name__ == "__main__":
    main()
