"""The HTML file: complete, self-contained, and safe against whatever stands in a user's files."""

from __future__ import annotations

import errno
import json
import re
from html.parser import HTMLParser
from pathlib import Path
from typing import Any

import pytest

from harness.model import columns
from harness.model.comparison import CaseResults, Certified, ComparisonRun
from harness.model.method import Status
from reports.page import build, page_drawings
from tests.reports import samples


class Page(HTMLParser):
    """Elements, attributes and texts of a page."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.source = text
        self.elements: list[tuple[str, dict[str, str | None]]] = []
        self.texts: list[str] = []
        self.scripts: list[str] = []
        self.open: list[str] = []
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.elements.append((tag, dict(attrs)))
        if tag == "script":
            self.scripts.append("")
            self.open.append(tag)

    def handle_endtag(self, tag: str) -> None:
        if tag == "script":
            self.open.pop()

    def handle_data(self, data: str) -> None:
        if self.open:
            self.scripts[-1] += data
        else:
            self.texts.append(data)

    @property
    def text(self) -> str:
        return re.sub(r"\s+", " ", " ".join(self.texts))

    @property
    def data(self) -> Any:
        return json.loads(self.scripts[0])


@pytest.fixture(scope="module")
def source() -> str:
    return build.render(samples.typical(), data_folder="report-data")


@pytest.fixture(scope="module")
def page(source: str) -> Page:
    return Page(source)


def test_names_from_a_file_never_become_markup(page: Page):
    names = [name for name, _ in page.elements]
    assert names.count("script") == 4, "the data, and the three scripts of the page"
    assert "img" not in names
    assert not [attrs for _, attrs in page.elements if any(key.startswith("on") for key in attrs)]
    assert samples.SCRIPT in page.text
    assert f"ValueError: {samples.CLOSING}" in page.text


def test_names_in_the_data_are_what_the_file_said(page: Page):
    assert page.data[2]["blocks"][0].startswith(f"block {samples.CLOSING}")


def test_data_cannot_end_its_script_element():
    text = build.script_json({"a": "</script><!--\u2028&"})
    assert not set("<>&\u2028") & set(text)
    assert json.loads(text) == {"a": "</script><!--\u2028&"}


def test_page_refers_to_nothing_outside_itself(source: str, page: Page):
    for name, attrs in page.elements:
        assert "src" not in attrs, name
        assert name not in ("link", "iframe", "object", "embed", "base")
        href = attrs.get("href")
        assert href is None or href.startswith("#"), href
    assert "@import" not in source
    assert re.findall(r"url\((?!#)", source) == []
    assert [address for address in re.findall(r"https?://[^\s\"'<)]+", source) if "www.w3.org" not in address] == []


def test_every_link_leads_somewhere(page: Page):
    ids = [attrs["id"] for _, attrs in page.elements if "id" in attrs]
    assert len(ids) == len(set(ids))
    links = {(attrs["href"] or "")[1:] for _, attrs in page.elements if "href" in attrs}
    assert links <= set(ids)


def test_failed_runs_stay_with_their_sentences(page: Page):
    assert "timeout" in page.text
    assert "The wall limit of 60 s was reached." in page.text
    assert "rejected by the judge" in page.text
    assert "equilibrium 0.2 is not small" in page.text
    rows = [attrs for name, attrs in page.elements if name == "tr" and "data-method" in attrs]
    assert len(rows) == 4 + 6 + 2


def test_findings_count_what_there_is(page: Page):
    assert "Of 12 runs on 3 cases, 10 ended with an answer; the judge accepted 9 and rejected 1." in page.text
    assert "Of 2 checked reference values, 2 are met." in page.text
    assert "Of 3 statements of theory that could be tested, 2 hold." in page.text


def test_references_stand_in_tables_by_what_a_disagreement_would_mean(page: Page):
    places = [page.text.index(f"requirement of {name}") for name in ("closed", "others", "tests", "before")]
    heads = [page.text.index(word) for word in ("Verification:", "Benchmark:", "Validation:", "Regression:")]
    for head, place, following in zip(heads, places, [*heads[1:], len(page.text)], strict=True):
        assert head < place < following
    assert heads[0] < page.text.index("requirement of bound") < heads[1], "a bound is verification"


def test_runs_are_counted_by_the_machine_that_made_them(source: str):
    assert "<dt>12 runs on</dt>" in source


def test_a_setting_that_a_reference_asks_for_is_told_beside_the_cost():
    asked = samples.reference("first", "exact", 0.5652, ["la"], settings={"starts": 4})
    case = samples.bond(references=[asked])
    item = CaseResults(case, [samples.solved(case, name, 0.5652) for name in ("fe", "la", "de")])
    told = re.findall(
        r'<td class="num">2</td><td>([^<]+)</td></tr>',
        build.render(ComparisonRun("a", "", "", [item]), data_folder="x"),
    )
    assert told == ["none", "starts", "none"]


def test_paper_values_stand_beside_ours(page: Page):
    assert "0.476 0.5/1.05 0.47619 0" in page.text
    assert "0.545 0.6/1.1 0.54545 0" in page.text
    assert "[0.41270, 0.54550]" in page.text
    assert "20 : 15 : 360" in page.text
    assert "20 : 10 : 400" in page.text, "0.2 s, 0.1 s and 4 s with FE set to 20"


def test_least_is_never_called_the_minimum(page: Page):
    assert "the minimum" not in page.text.lower()
    assert "least known" in page.text.lower()


def test_every_table_is_introduced_and_followed_by_how_to_read_it(page: Page):
    regions = sum(name == "table" for name, _ in page.elements)
    explained = page.text.count("How to read")
    # The four reference tables share one explanation.
    assert explained >= regions - 3


def test_numbers_carry_all_their_digits_in_the_hover_text(page: Page):
    titles = [attrs.get("title") or "" for _, attrs in page.elements]
    assert "0.5652173913043478" in titles


def test_command_that_repeats_a_row_is_printed(page: Page):
    assert "drystone run la wall-21" in page.text


def test_same_comparison_gives_the_same_bytes(source: str):
    assert build.render(samples.typical(), data_folder="report-data") == source


def test_wall_that_cannot_be_built_is_reported_and_not_a_crash():
    case = samples.unbuildable()
    run = ComparisonRun("broken", "drystone compare", "now", [CaseResults(case, [])])
    page = Page(build.render(run, data_folder="x"))
    assert "This wall cannot be built" in page.text
    assert "light" in page.text


def test_comparison_without_results_is_a_page():
    run = ComparisonRun("nothing", "drystone compare", "now", [])
    assert "Of 0 runs on 0 cases" in Page(build.render(run, data_folder="x")).text


def test_unknown_method_of_a_third_party_is_shown():
    case = samples.bond()
    run = ComparisonRun("other", "drystone compare", "now", [CaseResults(case, [samples.solved(case, "mine", 0.5)])])
    assert "drystone run mine wall-21" in Page(build.render(run, data_folder="x")).text


def test_only_values_that_are_proved_are_marked_as_proved():
    case = samples.bond()
    proved, known = samples.solved(case, "la", 0.5), samples.solved(case, "la-from-fe", 0.5)
    proved.details["proved_least"] = known.details["proved_least"] = True
    items = [CaseResults(case, [proved], certified=Certified(0.499999, "", "")), CaseResults(case, [known])]
    pages = [build.render(ComparisonRun("small", "", "", [item]), data_folder="x") for item in items]
    assert ["least, proved in fractions</span>" in page for page in pages] == [True, False]


def test_sixty_five_cases_by_eight_methods_stay_below_five_megabytes():
    assert len(build.render(samples.large(65), data_folder="x").encode()) < 5_000_000


def test_fields_are_cut_from_the_largest_cases_first(monkeypatch: pytest.MonkeyPatch):
    run = samples.typical()
    size = sum(sum(page_drawings.drawing_bytes(item)) for item in run.cases)
    monkeypatch.setattr(build, "DRAWING_BUDGET", size - 1)
    page = Page(build.render(run, data_folder="x"))
    assert "too large to draw its contact forces" in page.text
    kinds = [section.count('data-kind="forces"') for section in page.source.split('<section class="case')[1:]]
    assert kinds[0] > 0
    assert kinds[1] == 0


def test_wall_of_thousands_of_blocks_stays_a_small_page():
    case = samples.bond(courses=70, bricks=70)
    assert case.assembly.n_free > 4900
    results = [samples.solved(case, method, 0.5) for method in ("fe", "la", "la-associated", "de", "la-paper", "fe-qp")]
    page = build.render(ComparisonRun("large", "", "", [CaseResults(case, results)]), data_folder="x")
    assert len(page.encode()) < 5_000_000


def test_report_is_replaced_as_a_whole(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    path = tmp_path / "deep" / "report.html"
    build.write_report(samples.typical(), path)
    before = path.read_text(encoding="utf-8")
    monkeypatch.setattr("os.replace", _refuse)
    with pytest.raises(OSError, match="no space"):
        build.write_report(ComparisonRun("new", "", "", []), path)
    assert path.read_text(encoding="utf-8") == before
    assert sorted(item.name for item in path.parent.iterdir()) == ["report-data", "report.html"]


def _refuse(*_: object) -> None:
    raise OSError(errno.ENOSPC, "no space")


def test_failed_status_words_are_all_known():
    case = samples.bond()
    results = [samples.failed(case, f"method-{status}", status, "why") for status in Status if status is not Status.OK]
    page = Page(build.render(ComparisonRun("", "", "", [CaseResults(case, results)]), data_folder="x"))
    for word in ("not converged", "refused", "timeout", "out of memory", "crashed"):
        assert word in page.text


def test_policy_names_the_scripts_of_the_page_by_their_hash(source: str, page: Page):
    (policy,) = [
        attributes["content"]
        for tag, attributes in page.elements
        if tag == "meta" and attributes.get("http-equiv") == "Content-Security-Policy"
    ]
    assert policy is not None
    (scripts,) = re.findall(r"script-src ([^;]*)", policy)
    run = re.findall(r"<script>(.*?)</script>", source, flags=re.DOTALL)
    assert len(run) == 3
    assert scripts.split() == [build.script_hash(script) for script in run]
    assert "unsafe-inline" not in scripts


def test_heads_of_tables_are_those_of_the_declared_columns(source: str):
    table = source[source.index('id="runs-table"') :]
    heads = re.findall(r'<th scope="col"[^>]*>(?:<button[^>]*>)?([^<]*)', table[: table.index("</thead>")])
    assert [head.lower() for head in heads] == [column.label.lower() for column in columns.LISTED]
