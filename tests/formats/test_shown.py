"""What a drawing hides is not read, what it shows is, copies too; what is left out is told by every command."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from harness.formats.importing import import_drawing
from harness.model.errors import InputError
from tests.commands import drystone
from tests.formats.drawings import DATA, boxes, dxf, read, square, svg

GROUND = '<rect x="0" y="90" width="100" height="10"/>'
STONE = '<rect id="s" x="40" y="80" width="10" height="10"/>'
GROUND_BOX, STONE_BOX = (0.0, -100.0, 100.0, -90.0), (40.0, -90.0, 50.0, -80.0)
TOP_BOX = (40.0, -80.0, 50.0, -70.0)


@pytest.mark.parametrize(
    "hidden",
    [
        '<rect x="40" y="70" width="10" height="10" visibility="hidden"/>',
        '<rect x="40" y="70" width="10" height="10" style="visibility:collapse"/>',
        '<rect x="40" y="70" width="10" height="10" display="none"/>',
        '<rect x="40" y="70" width="10" height="10" opacity="0"/>',
        '<rect x="40" y="70" width="10" height="10" style="opacity: 0.0"/>',
        '<rect x="40" y="70" width="10" height="10" style="fill: none; stroke: none"/>',
        '<rect x="40" y="70" width="10" height="10" fill-opacity="0"/>',
        '<g visibility="hidden"><g><rect x="40" y="70" width="10" height="10"/></g></g>',
        '<g style="display: none"><rect x="40" y="70" width="10" height="10" style="display: inline"/></g>',
        '<g opacity="0"><rect x="40" y="70" width="10" height="10" opacity="1"/></g>',
        '<g fill="none"><rect x="40" y="70" width="10" height="10"/></g>',
        '<style>.off {display: none !important}</style><rect class="a off" x="40" y="70" width="10" height="10"/>',
        '<style>g .x, q {visibility: hidden}</style><g><rect class="x" x="40" y="70" width="10" height="10"/></g>',
        '<style>#h {opacity: 0}</style><rect id="h" opacity="1" x="40" y="70" width="10" height="10"/>',
        '<style>/* a *//* b */.x{display:none}/**/</style><rect class="x" x="40" y="70" width="10" height="10"/>',
        '<style>.y{}.x{display:none}/* .x{display:inline}</style><rect class="x" x="40" y="70" width="10" '
        'height="10"/>',
        '<defs><rect x="40" y="70" width="10" height="10"/></defs>',
        '<symbol id="q"><rect x="40" y="70" width="10" height="10"/></symbol>',
        '<clipPath id="q"><rect x="40" y="70" width="10" height="10"/></clipPath>',
        '<use href="#s" y="-10" visibility="hidden"/>',
        '<g display="none"><use href="#s" y="-10"/></g>',
    ],
)
def test_what_an_svg_hides_is_not_there(hidden: str, tmp_path: Path) -> None:
    imported = read(tmp_path / "d.svg", svg(GROUND + STONE + hidden))
    assert boxes(imported) == [GROUND_BOX, STONE_BOX]
    told = any("left out of the drawing: 1 x shape: hidden" in doubt for doubt in imported.wall.doubts)
    assert told == (not hidden.startswith(("<defs", "<symbol", "<clipPath")))


@pytest.mark.parametrize(
    "shown",
    [
        '<rect x="40" y="70" width="10" height="10" opacity="0.01"/>',
        '<g visibility="hidden"><rect x="40" y="70" width="10" height="10" visibility="visible"/></g>',
        '<g fill="none"><rect x="40" y="70" width="10" height="10" stroke="black"/></g>',
        '<g fill="none"><g style="fill: red"><rect x="40" y="70" width="10" height="10"/></g></g>',
        '<style>g .x {visibility: hidden}</style><rect class="x" x="40" y="70" width="10" height="10"/>',
        '<style>.x {display: none} #k {display: inline}</style><rect id="k" class="x" x="40" y="70" width="10" '
        'height="10"/>',
        '<style>rect {display: inline}</style><rect display="none" x="40" y="70" width="10" height="10"/>',
        '<style>@import "a.css"; @media print {.x {display: none} g {opacity: 0}}</style><rect class="x" x="40" y="70" '
        'width="10" height="10"/>',
        '<use href="#s" y="-10"/>',
        '<use xmlns:xlink="http://www.w3.org/1999/xlink" xlink:href="#s" x="0" y="-10"/>',
        '<use href="#s" transform="translate(0,-10)"/>',
        '<g id="pair"><use href="#s" y="-10"/></g>',
        '<defs><g id="one"><rect width="10" height="10"/></g></defs><use href="#one" x="40" y="70"/>',
        '<defs><rect id="one" width="1" height="1"/></defs><use href="#one" transform="translate(40,70) scale(10)"/>',
        '<defs><rect id="m" width="10" height="10"/></defs><use href="#m" transform="translate(50,70) scale(-1,1)"/>',
        '<defs><rect id="m" width="10" height="10"/></defs><use href="#m" transform="translate(50,70) rotate(90)"/>',
        '<symbol id="sym" viewBox="0 0 2 2"><rect width="2" height="2"/></symbol>'
        '<use href="#sym" x="40" y="70" width="10" height="10"/>',
        '<symbol id="sym" viewBox="1 1 2 4" preserveAspectRatio="none"><rect x="1" y="1" width="2" height="4"/>'
        "</symbol>"
        '<use href="#sym" x="40" y="70" width="10" height="10"/>',
        '<symbol id="sym"><rect width="10" height="10"/></symbol><use href="#sym" x="40" y="70"/>',
        '<svg x="40" y="70" width="10" height="20" viewBox="0 0 1 1" preserveAspectRatio="xMidYMin"><rect width="1" '
        'height="1"/></svg>',
        '<g visibility="hidden"><rect id="h" x="40" y="70" width="10" height="10"/></g><use href="#h"/>',
        '<switch><foreignObject/><rect x="40" y="70" width="10" height="10"/><rect x="40" y="60" width="10" '
        'height="10"/></switch>',
    ],
)
def test_what_an_svg_shows_is_there(shown: str, tmp_path: Path) -> None:
    assert boxes(read(tmp_path / "d.svg", svg(GROUND + STONE + shown))) == [GROUND_BOX, STONE_BOX, TOP_BOX]


def test_a_clone_has_a_name_of_its_own(tmp_path: Path) -> None:
    imported = read(tmp_path / "d.svg", svg(GROUND + STONE + '<use href="#s" y="-10"/>'))
    assert sorted(block.id for block in imported.wall.blocks) == ["1", "2", "s"]


def test_a_selector_that_is_not_followed_is_told(tmp_path: Path) -> None:
    text = "<style>rect:hover {display: none} rect:hover {color: red}</style>"
    imported = read(tmp_path / "d.svg", svg(text + GROUND + STONE))
    assert [doubt for doubt in imported.wall.doubts if "rect:hover" in doubt] == [
        'the style of "rect:hover" is ignored: it may hide or show shapes'
    ]


@pytest.mark.parametrize(
    ("clones", "words"),
    [
        ('<g id="a"><use href="#a"/></g>', "contains itself"),
        ('<g id="a"><use href="#b"/></g><g id="b"><use href="#a"/></g>', "contains itself"),
        ('<use href="#nowhere"/>', 'it clones "#nowhere", which is not in it'),
        ('<use href="other.svg#a"/>', "which is not in it"),
    ],
)
def test_clones_that_cannot_be_written_out_are_refused(clones: str, words: str, tmp_path: Path) -> None:
    with pytest.raises(InputError, match=words):
        read(tmp_path / "d.svg", svg(GROUND + STONE + clones))


HOW = ["off", "frozen", "invisible", "insert invisible", "insert frozen", "insert off, layer 0", "within, frozen"]


@pytest.mark.parametrize("how", HOW)
def test_what_a_dxf_hides_is_not_there(how: str, tmp_path: Path) -> None:
    def draw(document: Any, space: Any) -> None:
        square(space, 0, 0)
        square(space, 0, 1)
        layer = document.layers.add("HIDDEN")
        if how.endswith("frozen"):
            layer.freeze()
        elif "off" in how:
            layer.off()
        if "insert" in how or "within" in how:
            square(document.blocks.new("B"), 0, 0, layer="HIDDEN" if "within" in how else "0")
            space.add_blockref("B", (0, 2), dxfattribs={"layer": "0" if "within" in how else "HIDDEN"})
            space[-1].dxf.invisible = int("invisible" in how)
        else:
            square(space, 0, 2, layer="HIDDEN").dxf.invisible = int(how == "invisible")

    imported = dxf(tmp_path / "d.dxf", draw)
    assert boxes(imported) == [(0, 0, 1, 1), (0, 1, 1, 2)]
    assert any("hidden, because" in doubt for doubt in imported.wall.doubts)


def test_what_lies_on_its_own_layer_in_a_block_is_shown_where_the_layer_of_the_insert_is_off(tmp_path: Path) -> None:
    def draw(document: Any, space: Any) -> None:
        square(space, 0, 0)
        document.layers.add("OFF").off()
        square(document.blocks.new("B"), 0, 0, layer="STONES")
        space.add_blockref("B", (0, 1), dxfattribs={"layer": "OFF"})

    assert boxes(dxf(tmp_path / "d.dxf", draw)) == [(0, 0, 1, 1), (0, 1, 1, 2)]


def test_inserts_in_rows_and_columns_mirrored_and_nested_are_where_they_are_shown(tmp_path: Path) -> None:
    def draw(document: Any, space: Any) -> None:
        block = document.blocks.new("B")
        block.add_lwpolyline([(1, 0), (2, 0), (2, 1), (1, 1)], close=True)
        nest = document.blocks.new("N")
        nest.add_blockref("B", (0, 0), dxfattribs={"xscale": -1.0})
        space.add_blockref("N", (0, 0))
        grid = {"row_count": 2, "column_count": 2, "row_spacing": 1.0, "column_spacing": 3.0}
        space.add_blockref("B", (0, 0), dxfattribs=grid)
        space.add_blockref("N", (10, 0), dxfattribs={"rotation": 180.0, "yscale": -2.0})

    # The last: N is the square from -2 to -1; scaled by -2 in y, turned by 180 degrees, moved by 10.
    right = [(-2, 0, -1, 1), (1, 0, 2, 1), (1, 1, 2, 2), (4, 0, 5, 1), (4, 1, 5, 2), (11, 0, 12, 2)]
    assert boxes(dxf(tmp_path / "d.dxf", draw)) == right


def test_what_lies_in_another_file_is_told_to_be_left_out(tmp_path: Path) -> None:
    def draw(document: Any, space: Any) -> None:
        square(space, 0, 0)
        square(space, 0, 1)
        document.add_xref_def("other.dxf", "OTHER")
        space.add_blockref("OTHER", (0, 2))

    doubts = dxf(tmp_path / "d.dxf", draw).wall.doubts
    assert any('INSERT of "OTHER": it lies in another file' in doubt for doubt in doubts)


@pytest.mark.parametrize(
    ("name", "right"),
    [("svg-use-stack.svg", 1 / 3), ("dxf-off.dxf", 0.6), ("turned.csv", 0.3), ("mirror.dxf", 0.6),
     ("lact-Portal.json", 0.5163656), ("lact-Test2.json", 0.2731896)],
)  # fmt: skip
def test_drawings_have_the_multiplier_of_what_they_show(name: str, right: float) -> None:
    done = drystone("run", "la-associated", DATA / name, "--json")
    assert done.returncode == 0, done.stderr
    assert json.loads(done.stdout)["multiplier"] == pytest.approx(right, abs=1e-7)  # digits that are given


def test_what_is_left_out_is_told_by_run_compare_validate_the_json_and_the_wall(tmp_path: Path) -> None:
    drawing, words = DATA / "dxf-off.dxf", "hidden, because the layer is off"
    run = drystone("run", "la-associated", drawing, "--json", cwd=tmp_path)
    assert words in run.stderr
    assert any(words in text for text in json.loads(run.stdout)["warnings"])
    assert words in drystone("validate", drawing, cwd=tmp_path).stdout
    assert any(words in item["text"] for item in json.loads(drystone("validate", drawing, "--json").stdout)["doubts"])
    compared = drystone("compare", drawing, "--methods", "la-associated", cwd=tmp_path)
    assert words in compared.stderr
    assert words in (tmp_path / "out" / "report.html").read_text()
    drystone("import", drawing, "-o", "wall.json", cwd=tmp_path)
    assert words in drystone("run", "la-associated", "wall.json", cwd=tmp_path).stderr
    assert any(words in doubt for doubt in json.loads((tmp_path / "wall.json").read_text())["doubts"])


def test_nothing_is_doubted_of_a_drawing_that_says_all(tmp_path: Path) -> None:
    said = {"units": "mm", "friction": 0.5, "unit_weight": 20.0, "thickness": 100.0, "live": (1.0, 0.0)}
    imported = read(tmp_path / "d.svg", svg(GROUND + STONE), supports="lowest-course", tolerance=0.1, **said)
    assert imported.wall.doubts == []
    assert import_drawing(tmp_path / "d.svg").wall.doubts != []
