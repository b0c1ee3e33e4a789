"""The glossary and the report use one vocabulary: what the report calls a thing is explained, and nothing else is."""

from __future__ import annotations

import re
from pathlib import Path

from harness.model.breakpoints import CHANGES
from harness.model.method import Finding
from reports.findings import joints
from reports.labels import labels
from reports.page.sections import FLOW

ROOT = Path(__file__).resolve().parents[2]
ENTRY = re.compile(r"^([^\n:]+)\n: ", re.M)
WRITTEN = ("reports/templates", "reports/page", "reports/charts", "reports/findings", "reports/labels", "drystone")
"""Where words that the report prints are written."""
ELSEWHERE = {"gap point", "zero dilatancy"}
"""Terms of the pages on methods, which the report links to and does not use itself."""


def terms() -> list[str]:
    return ENTRY.findall((ROOT / "docs" / "glossary.md").read_text(encoding="utf-8"))


def said() -> str:
    files = [path for place in WRITTEN for path in (ROOT / place).rglob("*") if path.suffix in (".py", ".j2")]
    text = " ".join(path.read_text(encoding="utf-8") for path in files)
    return re.sub(r"\s+", " ", text).lower()


def test_every_state_change_finding_and_purpose_of_the_report_is_explained():
    named = {joints.SLIDE, joints.ROCK, joints.BOTH, joints.OPEN, joints.DILATANT, joints.STICK, *CHANGES}
    named |= {name.lower() for name in labels.PURPOSE}
    named |= {finding for key, finding in labels.FINDING.items() if key in (Finding.COLLAPSES, Finding.STANDS)}
    named |= {labels.FINDING[Finding.NONE], "falls", "at its limit", "unbounded"}
    assert named <= set(terms())


def test_every_kind_of_mechanism_of_the_report_is_made_of_explained_terms():
    listed = terms()
    for words in FLOW.values():
        assert any(re.search(rf"\b{re.escape(term)}\b", words) for term in listed), words


def test_every_explained_term_is_a_word_of_the_report():
    text = said()
    unused = [term for term in terms() if not re.search(rf"\b{re.escape(term.lower())}", text)]
    assert set(unused) <= ELSEWHERE


def test_terms_are_in_order_and_stand_once():
    listed = terms()
    assert listed == sorted(set(listed), key=str.lower)
    assert len(listed) > 50
