"""Peers beside ours on a set of walls: answered, correct, error, CPU, failures, and the bounds that they claim.

Run as `python -m benchmarks peers [--methods NAMES] [--set core] [--seconds 60] [--store FILE]`. Without names it runs
`la`, `fe`, `de`, `la-associated` and every peer whose package is installed, all of them on one wall before the next.
Counts are of all walls of the set. The last lines hold every bound that a method claims against the states that are
known and the certificates of the walls; none of these bounds is called proved.
"""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from dataclasses import dataclass
from importlib.util import find_spec
from pkgutil import resolve_name

import numpy as np

from drystone.bench import Bench, machine_speed, rows_of, set_names, wall_set
from drystone.cli.options import say
from drystone.comparing import compare
from harness.model.comparison import CaseResults, Certified
from harness.model.method import Listed, Status
from harness.model.method_registry import load_method, method_names
from harness.model.proof import is_collapse_state
from harness.model.result import Result

OURS = ("la", "fe", "de", "la-associated")
SAME = 1e-6
"""Relative height of a claimed bound above a state up to which it is that of the state: what solvers round off."""
TIGHT = 1e-4
"""Relative distance below a state at which a claimed bound is said to reach it."""


@dataclass(frozen=True)
class Claim:
    """A bound that a method claims, beside what is known of the wall.

    Attributes:
        bound: the claim; least: multiplier of the least accepted state, of this run; verdict: how they stand.
    """

    bound: float
    least: float | None
    verdict: str


def claim_of(result: Result, least: float | None, certified: Certified | None) -> Claim | None:
    """How the bound stands that a result claims; None where it claims none.

    Args:
        result: of a peer, with `claimed_bound` in its details.
        least: multiplier of the least state that the judge accepts, whichever method found it.
        certified: what the certificate of the wall proves.
    """
    bound = result.details.get("claimed_bound")
    if not isinstance(bound, float | int):
        return None
    proved = 0.0 if certified is None else certified.bound
    optimal = bool(result.details.get("claimed_optimal"))
    value = result.details.get("programme_value")
    if least is None:
        verdict = "nothing to compare with"
    elif bound > least + SAME * max(least, SAME):
        verdict = f"wrong: a state is known at {least:.7g}"
    elif optimal and isinstance(value, float) and value < proved - SAME * proved:
        verdict = f"its state at {value:.7g} is none: the certificate excludes it"
    elif bound < least - TIGHT * least:
        verdict = "holds, not tight" if bound > 0.0 else "says nothing"
    else:
        verdict = "agrees with the certificate" if proved >= least - TIGHT * least else "agrees with the least known"
    return Claim(float(bound), least, verdict)


def installed_peers() -> list[str]:
    """Names of the peers whose package is there."""
    found = []
    for name in method_names():
        method = load_method(name)
        if method.family == "peers" and isinstance(method, Listed):
            package = getattr(resolve_name(method.solver), "package", None)
            if package is None or find_spec(package) is not None:
                found.append(name)
    return found


def main(arguments: Sequence[str] | None = None) -> int:
    """Print the table of methods, the failures and the claimed bounds."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks peers", description=__doc__)
    parser.add_argument("--methods", help="names, separated by commas")
    parser.add_argument("--set", default="core", choices=set_names())
    parser.add_argument("--seconds", type=float, default=60.0, help="limit of a run, of the wall clock")
    parser.add_argument("--store", help="file in which results are kept, and found again")
    given = parser.parse_args(arguments)
    methods = given.methods.split(",") if given.methods else [*OURS, *installed_peers()]
    chosen = wall_set(given.set)
    compared = compare(chosen.walls, methods, seconds=given.seconds, store=given.store)
    bench = Bench(rows_of(chosen, compared, machine_speed()))
    say(f"{len(chosen.walls)} walls of the set {chosen.name}, version {chosen.version}; {given.seconds:g} s a run")
    _print_summary(bench)
    for item in compared.run.cases:
        _print_failures(item)
    for item in compared.run.cases:
        _print_claims(item)
    return 0


def _print_summary(bench: Bench) -> None:
    heads = f"{'method':<16}{'walls':>6}{'answered':>10}{'correct':>9}{'at least':>10}{'worst above':>13}"
    say(f"{heads}{'CPU s':>9}{'x best':>9}")
    for row in bench.summary().to_dict("records"):
        walls = int(row["walls"])
        counts = [round(walls * row[name]) for name in ("answered", "correct", "at_least_known")]
        worst = "-" if not np.isfinite(row["worst_above_least"]) else f"{100.0 * row['worst_above_least']:.2f} %"
        say(
            f"{row['method']:<16}{walls:>6}{counts[0]:>10}{counts[1]:>9}{counts[2]:>10}{worst:>13}"
            f"{row['cpu_seconds']:>9.1f}{row['cpu_of_best']:>9.1f}"
        )


def _print_failures(item: CaseResults) -> None:
    for result in item.results:
        if result.status is not Status.OK or result.judge.accepted is not True:
            why = result.sentence if result.status is not Status.OK else result.judge.sentence
            say(f"{item.case.id}: {result.method}: {result.status}: {why}")


def _print_claims(item: CaseResults) -> None:
    states = [
        result.multiplier for result in item.results if is_collapse_state(result) and result.multiplier is not None
    ]
    least = min(states, default=None)
    for result in item.results:
        claim = claim_of(result, least, item.certified)
        if claim is not None:
            known = "none" if claim.least is None else f"{claim.least:.7f}"
            say(f"{item.case.id:<26}{result.method:<10}claims {claim.bound:.7f}, least known {known}: {claim.verdict}")
