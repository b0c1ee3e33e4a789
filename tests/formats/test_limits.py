"""Drawings that would take for ever, or end a reader with an error of its own, are refused with a sentence."""

from __future__ import annotations

import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import pytest

from harness.formats.importing import import_drawing
from harness.model.errors import InputError
from tests.formats import spoiled
from tests.formats.drawings import DATA, boxes, csv, dxf, read, square, svg

REFUSED = {
    "bomb.dxf": "its blocks stand for more than 20,000 entities",
    "c-1e308.svg": "it has the coordinate",
    "compas-poly.json": "a face of it names a vertex that it does not have",
    "curve.wkt": "line 1: it is no WKT that is read",
    "deep5000.svg": "nested more than 100 deep",
    "g-big.geojson": "it has the coordinate 1e.300",
    "gj-degrees.geojson": "its coordinates are degrees",
    "gridlines.dxf": "its lines close 14,400 areas",
    "ins-82054.dxf": 'the block "S" cannot be placed',
    "kind13-csv.csv": 'polygon "a": it has the coordinate nan',
    "lact-Portal.json": "A wall needs no import",
    "lact-Test2.json": "A wall needs no import",
    "nan.csv": 'polygon "c": it has the coordinate nan',
    "noblock.dxf": 'it inserts the block "NOPE", which it does not define',
    "p-list.geojson": r"features\[0\].properties: it should be an object",
    "use-self.svg": 'the clone of "#a" contains itself',
    "xz-poly3d.dxf": "it lies in another plane",
    "zigzag-2000.svg": "its edges lie over each other in more than 300,000 pairs",
}


@pytest.mark.parametrize("name", REFUSED)
def test_drawings_that_cannot_be_read_are_refused_in_time(name: str) -> None:
    began = time.process_time()
    with pytest.raises(InputError, match=REFUSED[name]) as caught:
        import_drawing(DATA / name)
    assert str(DATA / name) in str(caught.value)
    assert time.process_time() - began < spoiled.SECONDS


def test_a_table_of_column_names_alone_is_refused_for_its_rows(tmp_path: Path) -> None:
    (tmp_path / "t.csv").write_text("block,x,y\n")
    with pytest.raises(InputError, match="no row stands below the names of its columns"):
        import_drawing(tmp_path / "t.csv")


def test_line_ends_of_old_computers_are_line_ends() -> None:
    assert boxes(import_drawing(DATA / "cr.csv")) == [(0, 0, 1, 1), (0, 1, 1, 2)]


def _columns(count: int) -> str:
    return "".join(f'<rect x="{k}" y="0" width="1" height="1"/>' for k in range(count))


def _clones(depth: int) -> str:
    groups = "".join(f'<g id="g{k}">{f"""<use href="#g{k - 1}"/>""" * 10}</g>' for k in range(1, depth))
    return f'<defs><rect id="g0" width="1" height="1"/>{groups}</defs><use href="#g{depth - 1}"/>'


@pytest.mark.parametrize(
    ("body", "words"),
    [
        (_clones(9), "its clones stand for more than 20,000 elements"),
        (_columns(1) + "<g>" * 120 + "</g>" * 120, "nested more than 100 deep"),
        ('<g id="a">' + "<g>" * 60 + "<use href='#b'/>" + "</g>" * 60 + '</g><g id="b">' + "<g>" * 60 + "</g>" * 61,
         "nested more than 100 deep"),
        ('<rect width="1" height="1"/>' * 2000, "its outlines lie over each other"),
        ('<path d="' + "M0 0 H9 V9 H0 z " * 2000 + '"/>', "the parts of an outline lie over each other"),
        ("".join(f'<path d="M0 {k} L1000 {1000 - k}"/>' for k in range(1000)), "lie over each other in more than"),
        ("<style>" + ".a {fill: red} " * 3000 + "</style>" + _columns(3000), "too many rules of style"),
    ],
)  # fmt: skip
def test_svg_that_grows_without_bound_is_refused_in_time(body: str, words: str, tmp_path: Path) -> None:
    began = time.process_time()
    with pytest.raises(InputError, match=words):
        read(tmp_path / "d.svg", svg(body))
    assert time.process_time() - began < spoiled.SECONDS


@pytest.mark.parametrize("text", ["/*", "@a ", "a", "{", "}", "Point ", "Point(1)={", '"(', " ", "A("])
@pytest.mark.parametrize("suffix", [".svg", ".geo"])
def test_long_texts_without_an_end_are_read_through_in_time(suffix: str, text: str, tmp_path: Path) -> None:
    began = time.process_time()
    body = text * (300_000 // len(text))
    with pytest.raises(InputError):
        read(tmp_path / f"d{suffix}", svg(f"<style>{body}</style>") if suffix == ".svg" else body)
    assert time.process_time() - began < spoiled.SECONDS


def test_many_stones_and_clones_within_the_limits_are_read(tmp_path: Path) -> None:
    clones = "".join(f'<use href="#one" x="{k}" y="1"/>' for k in range(900))
    one = '<defs><rect id="one" width="1" height="1"/></defs>'
    assert len(read(tmp_path / "d.svg", svg(_columns(900) + one + clones)).wall.blocks) == 1800


def test_blocks_that_contain_themselves_or_fill_the_plane_are_refused(tmp_path: Path) -> None:
    def chain(document: Any, space: Any) -> None:
        for k in range(30):
            document.blocks.new(f"B{k}").add_blockref(f"B{k + 1}", (0, 0))
        square(document.blocks.new("B30"), 0, 0)
        space.add_blockref("B0", (0, 0))

    def rows(document: Any, space: Any) -> None:
        square(document.blocks.new("B"), 0, 0)
        grid = {"row_count": 30000, "column_count": 30000, "row_spacing": 1.0, "column_spacing": 1.0}
        space.add_blockref("B", (0, 0), dxfattribs=grid)

    with pytest.raises(InputError, match="nested deeper than 16"):
        dxf(tmp_path / "d.dxf", chain)
    with pytest.raises(InputError, match="stand for more than 20,000 entities"):
        dxf(tmp_path / "d.dxf", rows)


def test_a_curve_of_a_thousand_kilometres_has_some_thousand_chords(tmp_path: Path) -> None:
    def draw(_: Any, space: Any) -> None:
        space.add_circle((0, 0), 1e6)

    assert 500 < len(dxf(tmp_path / "d.dxf", draw, units="m").wall.blocks[0].polygon) < 5000


@pytest.mark.parametrize("suffix", [".dxf", ".svg", ".geojson", ".wkt", ".shp", ".csv", ".msh", ".geo", ".json"])
@pytest.mark.parametrize(
    "content",
    [b"", b"\n", b"\0" * 100, b"\x89PNG\r\n\x1a\n" + b"\0" * 50, b"[]", b"{}", b"<svg/>", b"\xff\xfea\0",
     b"0\nSECTION\n", b'{"type": "FeatureCollection", "features": []}', b"POLYGON EMPTY", b"block,x,y\n",
     b"block,x,y\na\n", b"[" * 9999],
)  # fmt: skip
def test_empty_and_foreign_content_is_refused_with_a_sentence(suffix: str, content: bytes, tmp_path: Path) -> None:
    (tmp_path / f"d{suffix}").write_bytes(content)
    with pytest.raises(InputError) as caught:
        import_drawing(tmp_path / f"d{suffix}")
    assert "(None)" not in str(caught.value)
    assert len(str(caught.value)) > len(str(tmp_path)) + 20


def test_a_shapefile_without_its_table_is_read(tmp_path: Path) -> None:
    made = spoiled.seeds(tmp_path)[".shp"]
    with_table = boxes(import_drawing(made))
    made.with_suffix(".dbf").unlink()
    assert boxes(import_drawing(made)) == with_table


def test_spoiled_drawings_of_every_format_are_read_or_refused_in_time_and_memory(tmp_path: Path) -> None:
    # A process of its own, so that its memory is its own; `python -m tests.formats.spoiled 200 SEED` does more.
    words = [sys.executable, "-m", "tests.formats.spoiled", "40", "7"]
    done = subprocess.run(words, cwd=Path(__file__).parents[2], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr


def test_numbers_of_a_csv_are_named_with_their_row(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r'row 2 of block "a": x is "1,5"\. Give a number with a point'):
        read(tmp_path / "d.csv", csv((0.0, 0.0, 1.0, 1.0)).replace("a,1.0,0.0", 'a,"1,5",0.0'))
