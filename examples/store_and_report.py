"""How do I keep results, and report them, without running anything twice?

The second comparison takes every result from the store. The block slides at its friction 0.3.

Expected:

    la-associated 0.300000
    from the store: 1 of 1
    references and statements of theory not met: 0
    report written: True
"""

import drystone


def main() -> None:
    """Print the answer."""
    wall = drystone.library_wall("slide")
    stored: list[bool] = []
    for progress in (None, lambda _run, _result, kept: stored.append(kept)):
        compared = drystone.compare(wall, ["la-associated"], store="results.sqlite", progress=progress)
    print(f"la-associated {compared.results[0].multiplier:.6f}")
    print(f"from the store: {sum(stored)} of {len(stored)}")
    print(f"references and statements of theory not met: {len(compared.violations)}")
    print(f"report written: {compared.report('report.html').is_file()}")


if __name__ == "__main__":
    main()
