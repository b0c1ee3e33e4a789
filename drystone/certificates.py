"""Certificates that stand beside cases, held to the case and to the least state that is found."""

from __future__ import annotations

import functools
import gzip
import json
import math
import time
from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np

from harness.engine.run import Limits, Run
from harness.model.assembly import Assembly
from harness.model.case import Case, read_case, shipped_cases
from harness.model.comparison import CaseResults, Certified, ComparisonRun, Gate
from harness.model.content import content_of
from harness.model.details import AnswerDetails
from harness.model.errors import InputError
from harness.model.json_text import json_of, read_bytes, require_format, text_of
from harness.model.library import library
from harness.model.proof import in_words, is_collapse_state
from harness.model.result import Result, Verdict
from harness.model.writing import write_whole
from methods.proof.same_wall import require_same_wall
from methods.proof.verify.checker import SECONDS, verify
from methods.proof.verify.document import FORMAT, MOST_BYTES, MOST_NESTED, MOST_VALUES, unpacked, written
from methods.proof.verify.exact_wall import CertificateError, number

CERTIFICATE = "certificate.json"
PACKED = ".gz"
"""Ending of the name of a certificate that is compressed, as those of windows are."""
ROUNDING = 1e-9
"""Relative amount by which the multiplier found, in floats, may lie below what is proved in fractions."""


def _certificate_of(case: Case) -> Path | None:
    """The certificate beside the wall of a case, if there is one."""
    folder = Path(case.origin).parent
    return _certificate_in(folder) if (folder / "case.toml").is_file() else None


def _certificate_in(folder: Path) -> Path | None:
    return next((path for path in (folder / CERTIFICATE, folder / (CERTIFICATE + PACKED)) if path.is_file()), None)


@functools.cache
def _library() -> dict[str, tuple[Path, ...]]:
    """The certificates of the case library, by the content of their walls."""
    found: dict[str, tuple[Path, ...]] = {}
    for folder in sorted(path.parent for path in shipped_cases().glob("*/case.toml")):
        path = _certificate_in(folder)
        if path is not None:
            key = content_of(read_case(folder).assembly)
            found[key] = (*found.get(key, ()), path)
    return found


def certificates_for(case: Case) -> list[Path]:
    """The certificates that may be of the wall of a case: the one beside it, else those of equal walls of the library.

    Whether one of the library is of this wall is decided by `_checked_case`: equal content is only how it is found.
    """
    beside = _certificate_of(case)
    if beside is not None:
        return [beside]
    try:
        return list(_library().get(content_of(case.assembly), ()))
    except InputError:  # a wall that cannot be built, which its row says
        return []


def read_certificate(path: Path) -> Any:
    """The content of a certificate, compressed or not.

    Raises:
        InputError: unreadable, not JSON, of another format, or more than a certificate may be, unpacked too.
    """
    try:
        content = unpacked(read_bytes(path, MOST_BYTES))
    except CertificateError as error:
        raise InputError(str(error), "Give the whole file, as `drystone bound` wrote it", source=str(path)) from None
    document = json_of(text_of(content, str(path)), str(path), MOST_VALUES, MOST_NESTED)
    return require_format(document, FORMAT, "a certificate", str(path))


def write_certificate(path: Path, document: dict[str, Any]) -> None:
    """Write a certificate, compressed if its name says so, the same bytes for the same document."""
    if path.suffix == PACKED:
        write_whole(path, gzip.compress(json.dumps(document, separators=(",", ":")).encode(), mtime=0))
    else:
        write_whole(path, written(document))


def proved(document: Any) -> str:
    """What a certificate that holds proves, as the main clause of a sentence: of a multiplier only with its state."""
    least = f"no collapse state lies from zero to below {in_words(number(document['bound']))}"
    if "state" not in document:
        return f"{least}, proved in fractions"
    return f"{least}, and one at {in_words(number(document['multiplier']))}, proved in fractions"


def _checked_case(case: Case, path: Path) -> Certified:
    """What the certificate of a case proves, checked in fractions and against the wall.

    Raises:
        CertificateError: it proves nothing, or of another wall.
        InputError: unreadable.
    """
    document, assembly, source = read_certificate(path), case.assembly, path.name
    if path != _certificate_of(case):
        assembly, source = _named_as(document, assembly), f"{path.parent.name}/{path.name}"
    return _checked(document, assembly, source)


def _checked(document: Any, assembly: Assembly, source: str, seconds: float = SECONDS) -> Certified:
    if not isinstance(document, dict):
        raise CertificateError("it is no certificate as `drystone bound` writes them")
    require_same_wall(document, assembly)
    return Certified(_not_above(verify(document, seconds)[0]), proved(document), source)


def _of_results(item: CaseResults, seconds: float) -> tuple[list[Certified], dict[str, str]]:
    """What certificates that methods handed on prove, each checked here, and why others are refused, by method.

    A method's word for its bound is none.

    Args:
        item: the results of a wall.
        seconds: of CPU time for all of them.
    """
    found: list[Certified] = []
    refused: dict[str, str] = {}
    until = time.process_time() + seconds
    for result in item.results:
        document = AnswerDetails(result.details).certificate
        if document is None:
            continue
        try:
            left = until - time.process_time()
            found.append(_checked(document, item.case.assembly, f"certificate of {result.method}", left))
        except (CertificateError, InputError) as error:
            refused[result.method] = str(error)
    return found, refused


def _named_as(document: Any, assembly: Assembly) -> Assembly:
    """A wall with its free blocks named as in a certificate of an equal one: names do not bear on a multiplier."""
    names = np.array(assembly.block_ids, dtype=object)
    names[assembly.free] = [block["id"] for block in document["blocks"]]
    return replace(assembly, block_ids=names.tolist())


def certificate_runs(cases: Sequence[Case], limits: Limits) -> list[Run]:
    """The runs whose multipliers the certificates of the cases are held to."""
    return [Run(case, library().methods.one, {}, limits) for case in cases if _certificate_of(case) is not None]


def certificate_line(run: Run, result: Result) -> dict[str, Any]:
    """A row as of a checked reference: the certificate proves its bound, of this wall, and nothing is found below.

    Args:
        run: one of `certificate_runs`.
        result: of the run.
    """
    assert isinstance(run.case, Case)
    path = _certificate_of(run.case)
    assert path is not None
    lower: float | None = None
    try:
        certified = _checked_case(run.case, path)
        lower = certified.bound
        verdict, sentence = _held(result, certified)
    except (CertificateError, InputError) as error:
        verdict, sentence = Verdict.VIOLATES_BOUND, f"the certificate is refused: {error}"
    return {
        "case": run.case.id,
        "reference": "certificate",
        "quantity": "certificate",
        "method": run.method,
        "settings": run.settings,
        "value": result.multiplier,
        "relation": "at_least",
        "expected": lower,
        "tolerance": 0.0 if lower is None else ROUNDING * abs(lower),
        "type": "exact",
        "source": path.name,
        "requirement": "No collapse state lies from zero to below the bound that the certificate proves in fractions.",
        "verdict": str(verdict),
        "sentence": sentence,
    }


def _held(result: Result, certified: Certified) -> tuple[Verdict, str]:
    if not result.finding.has_multiplier or result.multiplier is None:
        return Verdict.OUTSIDE_TOLERANCE, f"{certified.sentence}, and {result.method} gives no multiplier"
    found = f"{result.method} finds {result.multiplier:.9g}"
    if is_below(result, certified):
        return Verdict.VIOLATES_BOUND, f"{certified.sentence}, and {found}"
    return Verdict.AGREES, f"{certified.sentence}; {found}"


def with_certificates(run: ComparisonRun, seconds: float = 60.0) -> ComparisonRun:
    """The comparison with what the certificates beside its cases prove, each checked in fractions and against the wall.

    A gate says whether the least state that was found lies at or above the bound, or that the certificate is refused.
    Nothing that was checked before is taken for checked: what a store holds may have been edited.

    Args:
        run: the comparison.
        seconds: of CPU time for the certificates that methods hand on, by wall; one that takes more is refused.
    """
    return replace(run, cases=[_with_certificate(item, seconds) for item in run.cases])


def _with_certificate(item: CaseResults, seconds: float) -> CaseResults:
    statement = (
        "no collapse state lies from zero to below the bound that the certificate of the wall proves in fractions"
    )
    certified = None
    for path in certificates_for(item.case):
        try:
            certified = _checked_case(item.case, path)
        except (CertificateError, InputError) as error:
            if path != _certificate_of(item.case):
                continue  # of a wall of the library that is not quite this one
            gate = Gate(
                name="certificate", statement=statement, passed=False, sentence=f"{path.name} is refused: {error}"
            )
            return replace(item, gates=[*item.gates, gate])
    handed_on, refused = _of_results(item, seconds)
    item = replace(item, refused=refused)
    known = [*([] if certified is None else [certified]), *handed_on]
    if not known:
        return item
    certified = max(known, key=lambda each: each.bound)
    judged = [each for each in item.results if each.traits.seeks_least and each.judge.accepted]
    found = [each for each in judged if each.multiplier is not None]
    low = [each for each in found if is_below(each, certified)]
    states = ", ".join(f"{each.method} {each.multiplier:.9g}" for each in low or found) or "no method has a state"
    gate = Gate(
        name="certificate",
        statement=statement,
        passed=not low if found else None,
        sentence=f"{states}; bound {certified.bound:.9g} ({certified.source})",
    )
    return replace(item, gates=[*item.gates, gate], certified=certified)


def certified_results(case: Case, result: Result, seconds: float = 60.0) -> CaseResults:
    """One result of a wall, with what the certificate of the wall proves where one is known and there is a state.

    Args:
        case: the wall.
        result: of a method on it.
        seconds: of CPU time for a certificate that the method hands on.
    """
    item = CaseResults(case, [result])
    asked = is_collapse_state(result) or AnswerDetails(result.details).certificate is not None
    return _with_certificate(item, seconds) if asked else item


def is_below(result: Result, certified: Certified) -> bool:
    """Whether a multiplier is one that the certificate excludes; it says nothing of those below zero."""
    value, bound = result.multiplier, certified.bound
    return value is not None and 0.0 <= value < bound - ROUNDING * abs(bound)


def _not_above(bound: Fraction) -> float:
    """The greatest float that is not above a fraction: what is proved stays so when it is printed.

    Raises:
        CertificateError: it is beyond all floats.
    """
    value = nearest(bound)
    if value is None:
        raise CertificateError("its bound is larger than any multiplier of a wall")
    return value if Fraction(value) <= bound else math.nextafter(value, -math.inf)


def nearest(value: Fraction) -> float | None:
    """The float that is nearest to a fraction; None beyond all floats."""
    try:
        return float(value)
    except OverflowError:
        return None
