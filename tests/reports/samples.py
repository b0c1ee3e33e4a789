"""Comparisons made by hand for tests of the report: small walls, invented answers, failures, hostile names."""

from __future__ import annotations

from typing import Any

import numpy as np

from harness.model.assembly import Assembly, FloatArray
from harness.model.case import Case, CaseFile
from harness.model.comparison import CaseResults, ComparisonRun, Gate
from harness.model.method import Answer, Finding, Status, Traits
from harness.model.reading import parse_wall
from harness.model.result import Comparison, Judgement, Result, Verdict, result_of

SCRIPT = "<script>alert(1)</script>"
CLOSING = "</script><img src=x onerror=alert(2)>"
COMMENT = "<!--<script>"
FAMILY = {
    "fe": "fe",
    "la": "la",
    "la-associated": "la",
    "de": "de",
    "la-paper": "la",
    "la-tresca": "la",
    "fe-qp": "fe",
} | {"fe-newton": "fe"}
TRAITS = {
    "fe": Traits(caption="plateau of the traced path", elastic=True),
    "la": Traits(caption="least known collapse state", seeks_least=True, any_self_stress=True),
    "la-associated": Traits(caption="associated maximum", bounds_above=True, any_self_stress=True),
    "de": Traits(caption="between held and moving", brackets=True),
}


def bond(
    case_id: str = "wall-21",
    *,
    title: str = "A small wall",
    friction: float = 0.65,
    courses: int = 3,
    bricks: int = 2,
    prefix: str = "",
    length: float = 0.4,
    references: list[dict[str, Any]] | None = None,
    errata: list[str] | None = None,
    source: str = "invented for a test",
) -> Case:
    """A running-bond wall under a horizontal body force."""
    wall = {
        "format": "wall/1",
        "title": title,
        "unit_weight": 20.0,
        "friction": friction,
        "pattern": {
            "type": "running_bond",
            "block_length": length,
            "block_height": 0.2,
            "count": courses,
            "bricks": bricks,
            "prefix": prefix,
        },
        "loads": {"live": {"body": [{"per_weight": [1.0, 0.0]}]}},
    }
    file = CaseFile.model_validate(
        {
            "id": case_id,
            "title": title,
            "summary": f"Summary of {title}",
            "source": source,
            "references": references or [],
            "errata": [{"text": text} for text in errata or []],
        }
    )
    return Case(file, parse_wall(wall, "a test"), "a test")


def block(case_id: str = "single-block") -> Case:
    """The paper's block on two halves."""
    wall = {
        "format": "wall/1",
        "friction": {
            "default": 0.6,
            "rules": [{"between": ["right", "block"], "value": 0.4}],
        },
        "blocks": [
            {"id": "left", "polygon": [[0, -0.2], [0.5, -0.2], [0.5, 0], [0, 0]], "fixed": True},
            {"id": "right", "polygon": [[0.5, -0.2], [1, -0.2], [1, 0], [0.5, 0]], "fixed": True},
            {"id": "block", "polygon": [[0, 0], [1, 0], [1, 0.5], [0, 0.5]], "weight": 0.5},
        ],
        "loads": {"live": {"body": [{"per_weight": [1.0, 0.0]}]}},
    }
    file = CaseFile(id=case_id, title="The paper's block", source="Baggio & Trovalusci 1995")
    return Case(file, parse_wall(wall, "a test"), "a test")


def unbuildable() -> Case:
    """A wall whose block has no weight."""
    wall = {
        "format": "wall/1",
        "friction": 0.5,
        "blocks": [
            {"id": "ground", "polygon": [[0, -1], [1, -1], [1, 0], [0, 0]], "fixed": True},
            {"id": "light", "polygon": [[0, 0], [1, 0], [1, 1], [0, 1]]},
        ],
    }
    return Case(CaseFile(id="no-weight", title="No weight", source="a test"), parse_wall(wall, "no.json"), "no.json")


def sliding(assembly: Assembly, turn: float = 0.0) -> FloatArray:
    """The blocks whose centroid lies in the upper half move to the right, and turn."""
    middle = 0.5 * (assembly.centroid[:, 1].min() + assembly.centroid[:, 1].max())
    moves = (assembly.centroid[:, 1] >= middle) & ~assembly.fixed
    mechanism = np.zeros((assembly.n_blocks, 3))
    mechanism[moves] = (1.0, 0.0, turn)
    return mechanism


def pressing(assembly: Assembly) -> FloatArray:
    """Some compression and shear at every interface."""
    count = np.arange(1, assembly.n_interfaces + 1, dtype=float)
    normal = assembly.force_scale * count / count.sum()
    return np.column_stack([0.6 * normal, 0.4 * normal, -0.5 * assembly.friction * normal])


def solved(case: Case, method: str, multiplier: float, *, cpu: float = 0.5, turn: float = 0.0, **more: Any) -> Result:
    """A result that ended well and was accepted."""
    assembly = case.assembly
    answer = Answer(
        Status.OK,
        Finding.COLLAPSES,
        f"collapses at {multiplier:g}",
        multiplier=multiplier,
        forces=pressing(assembly),
        mechanism=sliding(assembly, turn),
        iterations=7,
        **more,
    )
    result = result_of(
        answer, assembly, case=case.id, method=method, family=FAMILY.get(method, method), traits=TRAITS.get(method)
    )
    result.judge = Judgement(
        residuals={"equilibrium": 3e-16, "yield": 0.0, "live_work": 0.4},
        tolerance=1e-8,
        accepted=True,
        sentence="The collapse state was recomputed from the equilibrium of the blocks and holds within 1e-08.",
    )
    measured(result, cpu)
    return result


def failed(case: Case, method: str, status: Status, sentence: str) -> Result:
    """A result that did not end well."""
    result = result_of(
        Answer(status, Finding.NONE, sentence),
        case.assembly,
        case=case.id,
        method=method,
        family=FAMILY.get(method, method),
        traits=TRAITS.get(method),
    )
    measured(result, 60.0)
    return result


def measured(result: Result, cpu: float) -> None:
    """Give a result the facts the engine takes."""
    result.cpu_seconds = cpu
    result.wall_seconds = 1.1 * cpu
    result.peak_memory_bytes = 123_456_789
    result.settings = {"tolerance": 1e-9, "seed": 1}
    result.limits = {"wall_seconds": 60.0}
    result.versions = {"python": "3.11", "commit": "abcdef123456"}
    result.machine = {"processor": "a processor", "cores": 2}
    result.started = "2026-01-02T03:04:05Z"
    result.key = "0123456789abcdef0123456789abcdef"


def held_against(case: Case, result: Result, reference: str, verdict: Verdict) -> None:
    """Hold a result against one of its case's references."""
    known = next(item for item in case.file.references if item.id == reference)
    result.comparisons.append(
        Comparison(
            reference=reference,
            quantity=known.quantity,
            value=result.multiplier,
            expected=list(known.value) if isinstance(known.value, tuple) else known.value,
            tolerance=known.tolerance,
            gate=known.gate,
            verdict=verdict,
            sentence="as computed for a test",
        )
    )
    result.verdict = verdict


def reference(identifier: str, kind: str, value: float, methods: list[str], **more: Any) -> dict[str, Any]:
    """A reference as it stands in case.toml."""
    return {
        "id": identifier,
        "type": kind,
        "value": value,
        "tolerance": 1e-3,
        "applies_to": methods,
        "source": f"source of {identifier}",
        "requirement": f"requirement of {identifier}",
    } | more


def typical() -> ComparisonRun:
    """Two of the paper's cases and a hostile one, with failures, gates, errata and every type of reference."""
    wall = bond(
        references=[
            reference("closed", "exact", 0.5652, ["fe"], gate=True),
            reference("bound", "bound", 0.6, ["la"], relation="at_most", gate=True),
            reference("others", "published", 0.558, ["la"]),
            reference("tests", "measured", 0.45, ["de"]),
            reference("before", "regression", 0.558, ["la"]),
        ],
        errata=["The proportions are not in the paper."],
    )
    path = {"multiplier": [0.0, 0.3, 0.5, 0.5652], "live_displacement": [0.0, 0.001, 0.003, 0.01]}
    finite = solved(wall, "fe", 0.5652173913043478, cpu=0.2, path=path, details={"peak": 0.5652173913043478})
    least = solved(
        wall,
        "la",
        0.5579978,
        cpu=0.1,
        turn=0.5,
        bracket=(0.5, 0.5579978),
        bracket_meaning="[proved lower bound, least known]",
        path={"cpu_seconds": [0.01, 0.02, 0.1], "multiplier": [0.6, 0.5652, 0.5579978]},
    )
    associated = solved(wall, "la-associated", 0.5844610, cpu=0.05, flow="associated")
    holds = solved(
        wall,
        "de",
        0.5650,
        cpu=4.0,
        flow="approximate",
        bracket=(0.564, 0.566),
        path={"multiplier": [0.0, 0.5, 0.6, 0.565], "residual": [1e-7, 1e-6, 1.0, 1e-4]},
        details={"orders": [{"order": "up", "held": 0.5, "moving": 0.6}], "reporting_order": "up"},
    )
    held_against(wall, finite, "closed", Verdict.AGREES)
    held_against(wall, least, "bound", Verdict.AGREES)
    held_against(wall, least, "others", Verdict.AGREES)
    held_against(wall, least, "before", Verdict.AGREES)
    held_against(wall, holds, "tests", Verdict.OUTSIDE_TOLERANCE)
    rejected = solved(wall, "la-paper", 0.3, cpu=2.0)
    rejected.judge = Judgement(
        residuals={"equilibrium": 0.2}, tolerance=1e-8, accepted=False, sentence="equilibrium 0.2 is not small"
    )
    stopped = failed(wall, "fe-qp", Status.TIMEOUT, "The wall limit of 60 s was reached.")
    single = block()
    return ComparisonRun(
        title="suite paper",
        command="drystone compare --suite paper",
        created="2026-01-02T03:04:05Z",
        cases=[
            CaseResults(
                single,
                [
                    solved(single, "fe", 0.5 / 1.05, cpu=0.01),
                    solved(single, "la", 0.4, cpu=0.02),
                    solved(single, "la-associated", 0.6 / 1.1, cpu=0.01, flow="associated"),
                    solved(single, "de", 0.47, cpu=0.4, bracket=(0.4127, 0.5455), flow="approximate"),
                ],
            ),
            CaseResults(
                wall,
                [holds, finite, least, associated, rejected, stopped],
                [
                    Gate(name="fe-below", statement="FE lies below", passed=True, sentence="0.56 <= 0.58"),
                    Gate(name="la-below", statement="LA lies below", passed=False, sentence="0.7 > 0.6"),
                    Gate(name="open", statement="not known", passed=None, sentence="a result is missing"),
                ],
            ),
            hostile(),
        ],
        provenance={"versions": {"drystone": "0.1.0", "commit": "abcdef"}, "limits": {"wall_seconds": 60}},
    )


def hostile() -> CaseResults:
    """A case whose every free text tries to become markup."""
    case = bond(
        "hostile",
        title=SCRIPT,
        prefix=CLOSING,
        source=f"{COMMENT} source {SCRIPT}",
        errata=[CLOSING],
        references=[reference("evil", "published", 0.5, ["la"], source=SCRIPT, requirement=CLOSING)],
    )
    good = solved(case, "la", 0.5)
    held_against(case, good, "evil", Verdict.AGREES)
    good.comparisons[0].sentence = f'"{SCRIPT}'
    good.settings = {"name": CLOSING}
    evil = failed(case, "de", Status.CRASHED, f"The method raised ValueError: {CLOSING}")
    gate = Gate(name=SCRIPT, statement=CLOSING, passed=True, sentence=COMMENT)
    return CaseResults(case, [good, evil], [gate])


def large(cases: int = 50, methods: int = 8) -> ComparisonRun:
    """Many cases and methods, on walls of 60 blocks."""
    names = ["fe", "fe-newton", "fe-qp", "la", "la-associated", "la-paper", "la-tresca", "de"][:methods]
    items = []
    for number in range(cases):
        case = bond(f"case-{number}", courses=10, bricks=5 + number % 3, friction=0.4 + 0.01 * number)
        results = [
            solved(case, name, 0.4 + 0.01 * number, cpu=0.1 * (k + 1), turn=0.1 * k) for k, name in enumerate(names)
        ]
        items.append(CaseResults(case, results))
    return ComparisonRun("large", "drystone compare", "2026-01-02T03:04:05Z", items)
