"""Every shipped case is well formed: it builds, its references can be held against an answer, its sources are said."""

import pytest

from cases.generate import ROOT
from harness.model.case import Case, ReferenceType, case_folders, read_case
from harness.model.method_registry import method_names

FOLDERS = case_folders([ROOT])
PUBLISHED = 38


@pytest.fixture(params=FOLDERS, scope="module")
def case(request: pytest.FixtureRequest) -> Case:
    return read_case(FOLDERS[request.param])


def test_case_builds_without_a_warning(case: Case) -> None:
    assert case.built.warnings == ()


def test_kind_of_case_goes_with_its_live_load(case: Case) -> None:
    assert case.assembly.has_live_load == (case.file.kind == "multiplier")


def test_references_are_many_and_tell_each_other_apart(case: Case) -> None:
    names = [item.id for item in case.file.references]
    assert names
    assert len(set(names)) == len(names)


def test_references_name_methods_that_exist(case: Case) -> None:
    known = set(method_names())
    for item in case.file.references:
        assert set(item.applies_to) <= known, item.id


def test_a_tolerance_has_a_reason(case: Case) -> None:
    for item in case.file.references:
        if item.tolerance:
            assert item.tolerance_reason, item.id


def test_quantity_fits_the_kind(case: Case) -> None:
    expected = {"multiplier": {"multiplier", "blocks", "interfaces", "unknowns"}, "stability": {"finding"}}
    for item in case.file.references:
        assert item.quantity in expected[case.file.kind], item.id
        if item.quantity == "finding":
            assert item.value in ("stands", "falls"), item.id


def test_requirement_is_a_sentence(case: Case) -> None:
    for item in case.file.references:
        assert item.requirement.endswith("."), item.id
        assert len(item.requirement) > 15, item.id


def test_exact_values_do_not_rest_on_ourselves(case: Case) -> None:
    for item in case.file.references:
        if item.type in (ReferenceType.EXACT, ReferenceType.BOUND):
            assert "Drystone" not in item.source, item.id


def test_published_suite_is_complete() -> None:
    members = [name for name, folder in FOLDERS.items() if "published" in read_case(folder).file.suites]
    # single-block is among them; wall-21 is in the suite "paper", as its numbers are not the paper's.
    assert len(members) == PUBLISHED


@pytest.mark.parametrize(
    "suite", ["paper", "small", "closed-form", "friction-family", "matera", "walls", "stability", "strength", "ties"]
)
def test_suite_has_members(suite: str) -> None:
    assert any(suite in read_case(folder).file.suites for folder in FOLDERS.values())


def test_suite_paper_is_the_paper() -> None:
    members = {name for name, folder in FOLDERS.items() if "paper" in read_case(folder).file.suites}
    assert members == {"single-block", "wall-21"}


def test_suite_small_is_small() -> None:
    for folder in FOLDERS.values():
        found = read_case(folder)
        if "small" in found.file.suites:
            assert found.assembly.n_free <= 60, found.id


def test_paper_wall_has_21_blocks_and_49_interfaces() -> None:
    assembly = read_case(FOLDERS["wall-21"]).assembly
    assert assembly.n_free == 21
    assert assembly.n_interfaces == 49
    assert 1 + 3 * (assembly.n_interfaces - assembly.n_free) + 4 * assembly.n_interfaces == 281
    assert sorted(assembly.joint).count("head") == 15
    on_ground = [p for p in range(49) if assembly.fixed[assembly.block_a[p]] or assembly.fixed[assembly.block_b[p]]]
    assert len(on_ground) == 4


def test_paper_block_has_its_two_frictions() -> None:
    assembly = read_case(FOLDERS["single-block"]).assembly
    assert sorted(assembly.friction.tolist()) == [0.4, 0.6]
    left = int(assembly.friction.argmax())
    assert assembly.face1[left, 0] + assembly.face2[left, 0] < 1.0


@pytest.mark.parametrize(
    ("name", "blocks", "interfaces"),
    [
        ("ferris-tin-loi-1", 33, 83),
        ("ferris-tin-loi-2", 55, 141),
        ("ferris-tin-loi-4", 55, 116),
        ("lact3-arch", 25, 26),
        ("arch-100-tilt", 100, 101),
        ("solfec-arch-27-stable", 27, 28),
        ("argiento-set-12", 54, 135),
        ("argiento-set-14", 150, 415),
        ("panel-4x4-3-f0", 14, 29),
        ("panel-4x4-7-f58", 14, 27),
        ("panel-4x4-classical-f0", 11, 23),
        ("carozzi-arch-61", 61, 62),
    ],
)
def test_published_wall_has_the_counts_of_its_source(name: str, blocks: int, interfaces: int) -> None:
    assembly = read_case(FOLDERS[name]).assembly
    assert (assembly.n_free, assembly.n_interfaces) == (blocks, interfaces)


def test_no_file_names_a_place_on_a_machine() -> None:
    for path in sorted(ROOT.rglob("*")):
        if path.suffix in (".toml", ".json", ".md"):
            text = path.read_text(encoding="utf-8")
            assert "../" not in text.replace("...", ""), path.name
            assert "/home/" not in text, path.name
