"""What a user reads is plain technical English: private words of this project's past do not come back."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]

BANNED = {
    r"smoother unloaded joints": "reduced friction in unloaded joints",
    r"\brungs?\b": "step of the friction continuation",
    r"safe forces": "shifted associated forces",
    r"\bhangs? (?:up)?on\b": "depends on",
    r"\bpart by\b": "differ by",
    r"\bmethods part\b": "the methods differ",
    r"\bknew\b": "found, reached",
    r"\bknown after\b": "reached after",
    r"\btheory gates?\b": "statement of theory",
    r"\bgated references?\b": "checked reference",
    r"\bbroken gates?\b": "violated statement",
    r"\bbody orders?\b": "sweep order",
    r"\bdamped holds?\b": "damped load steps",
    r"\btold\b": "reported, printed, distinguished",
    r"\bladders?\b": "friction continuation",
    r"\bjoints that give\b": "deformable joints",
    r"\blift as they slide\b": "have dilatancy",
    r"\bslow motion\b": "pseudo-transient relaxation",
    r"\bslow-motion\b": "pseudo-transient relaxation",
    r"\bfootings?\b": "regularisation",
    r"\bpinned\b": "bordered",
    r"\bgiven up at\b": "stopped at",
    r"\bway to the answer\b": "search history, load path",
    r"\bsources? of states\b": "starting-point strategy",
    r"\b(?:hold|holds|held)\b(?: \w+){0,2} against\b": "compare with, check",
    r"\bnobody can know\b": "unknown",
    r"\bfor want of\b": "because ... is missing",
    r"\bwithout a word\b": "without a message",
    r"\bcooked\b": "constructed",
    r"\blook at each other\b": "face each other",
    r"\bbear on each other\b": "are in contact",
    r"\bwhat stopped it\b": "reasons",
    r"\bblocks? rubs?\b": "friction does work",
    r"\bthrown apart\b": "the blocks separate",
    r"\btracers?\b": "path follower",
}
"""What is not said, as a regular expression, and what is said in its place."""

PAGES = [
    ROOT / "README.md",
    ROOT / "CONTRIBUTING.md",
    *(path for path in (ROOT / "docs").rglob("*.md") if not {"notes", "generated", "decisions"} & set(path.parts)),
    *(ROOT / "reports" / "templates").rglob("*.j2"),
    *(ROOT / "reports" / "static").rglob("*.js"),
    *(ROOT / "cases").rglob("*.toml"),
    *(path for kind in ("*.md", "*.c", "*.mjs", "*.js") for path in (ROOT / "drystone" / "skeletons").rglob(kind)),
]
ROOMS = ("drystone", "harness", "methods", "reports", "cases", "examples", "benchmarks")
CODE = [*(ROOT / "docs").glob("*.py"), *(path for room in ROOMS for path in (ROOT / room).rglob("*.py"))]
CODED = re.compile(r"`[^`]*`|\]\([^)]*\)")
"""Names in code and targets of links."""


def _sentences(path: Path) -> Iterator[str]:
    """Strings of the code that a reader may meet, of two words and more. Docstrings are the help of commands too."""
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Constant) and isinstance(node.value, str) and " " in node.value.strip():
            yield node.value


def _found(text: str) -> list[str]:
    plain = " ".join(CODED.sub("", text).split())
    return [
        f"{plain[max(match.start() - 30, 0) : match.end() + 30]!r}: say {better!r}"
        for banned, better in BANNED.items()
        for match in re.finditer(banned, plain, re.IGNORECASE)
    ]


def test_a_private_word_is_found_across_lines_and_in_no_code():
    assert len(_found("The answer hangs\non the joint tolerance; they part by 3 %.")) == 2
    assert _found("The answer depends on `hangs_on`, [see](hangs on).") == []


@pytest.mark.parametrize("page", PAGES, ids=lambda path: str(path.relative_to(ROOT)))
def test_a_page_has_no_private_words(page: Path):
    assert _found(page.read_text(encoding="utf-8")) == []


@pytest.mark.parametrize("path", CODE, ids=lambda path: str(path.relative_to(ROOT)))
def test_a_sentence_of_the_code_has_no_private_words(path: Path):
    assert [fault for text in _sentences(path) for fault in _found(text)] == []
