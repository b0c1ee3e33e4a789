"""Spoiled drawings of every format: each is read, or refused with a sentence, in limited time and memory.

`python -m tests.formats.spoiled N SEED` spoils N drawings of every format and prints a row for each; the exit code is
the number of those that ended otherwise.
"""

from __future__ import annotations

import random
import re
import resource
import shutil
import signal
import sys
import tempfile
import time
import traceback
from collections import Counter
from collections.abc import Callable
from pathlib import Path
from typing import Any

import ezdxf
import meshio
import numpy as np
import shapefile
import shapely

from harness.formats.importing import import_drawing
from harness.formats.registry import format_written
from harness.model.build import Built, build
from harness.model.errors import InputError
from harness.model.inspection import inspect
from harness.model.wall import Wall
from tests.walls import running_bond, wall_data

SECONDS = 5
"""Limit of one drawing [s of CPU time]."""
MEGABYTES = 1024
"""Limit of memory of all of them in one process [MB]."""
NUMBERS = ["1e308", "-1e308", "1e-320", "nan", "inf", "", "0", "-1", "99999999999999999999", "1e", "0x1", "1e17", "²"]


def seeds(folder: Path) -> dict[str, Path]:
    """A sound drawing of every format."""
    built = build(Wall.model_validate(wall_data(running_bond(2, 3), 0.6)))
    made = {}
    for suffix in (".geojson", ".csv", ".json"):
        made[suffix] = folder / f"seed{suffix}"
        format_written(made[suffix]).write(built, None, made[suffix])
    for suffix, write in (
        (".dxf", _dxf), (".svg", _svg), (".wkt", _wkt), (".shp", _shp), (".msh", _msh), (".geo", _geo),
    ):  # fmt: skip
        made[suffix] = folder / f"seed{suffix}"
        write(built, made[suffix])
    return made


def _dxf(built: Built, path: Path) -> None:
    document = ezdxf.new("R2010")  # type: ignore[attr-defined]
    document.layers.add("OFF").off()
    space = document.modelspace()
    block = document.blocks.new("STONE")
    block.add_lwpolyline(built.assembly.polygons[0].tolist(), close=True)
    nested = document.blocks.new("TWO")
    nested.add_blockref("STONE", (0, 0))
    nested.add_blockref("STONE", (5, 0), dxfattribs={"xscale": -1.0, "rotation": 30.0, "column_count": 2})
    space.add_blockref("TWO", (0, 0), dxfattribs={"layer": "OFF"})
    space.add_blockref("TWO", (0, 9))
    space.add_circle((20, 20), 1.0)
    space.add_spline([(30, 0), (31, 1), (32, 0)])
    space.add_lwpolyline([(40, 0, 0, 0, 0.5), (41, 0, 0, 0, 0), (41, 1, 0, 0, -0.3)], close=True)
    for polygon in built.assembly.polygons[1:]:
        for start, end in zip(polygon, np.roll(polygon, -1, axis=0), strict=True):
            space.add_line(start.tolist(), end.tolist())
    hatch = space.add_hatch()
    hatch.paths.add_polyline_path([(50, 0), (52, 0), (52, 2), (50, 2)], is_closed=True, flags=1)
    document.saveas(path)


def _svg(built: Built, path: Path) -> None:
    paths = [
        f'<path class="s" d="M{" L".join(f"{x},{-y}" for x, y in polygon.tolist())} z"/>'
        for polygon in built.assembly.polygons
    ]
    path.write_text(
        '<svg xmlns="http://www.w3.org/2000/svg" width="100mm" viewBox="0 0 100 100"><style>.s {fill: #eee} '
        'g .t {display: none}</style><defs><symbol id="sym" viewBox="0 0 2 2"><rect width="2" height="2"/></symbol>'
        f'<g id="two"><rect id="r" x="9" width="1" height="1"/><use href="#r" x="1"/></g></defs>{"".join(paths)}'
        '<use href="#two" transform="rotate(30)"/><use href="#sym" x="20" width="4" height="2"/>'
        '<path d="M30 0 C 31 1 32 1 33 0 A 1 2 30 0 1 30 0 z"/><g style="visibility: hidden"><ellipse rx="1" ry="2"/>'
        '<circle r="1" visibility="visible"/></g></svg>'
    )


def _wkt(built: Built, path: Path) -> None:
    path.write_text("\n".join(shapely.to_wkt(shapely.Polygon(polygon)) for polygon in built.assembly.polygons))


def _shp(built: Built, path: Path) -> None:
    with shapefile.Writer(str(path)) as writer:
        writer.field("id", "C")
        for name, polygon in zip(built.assembly.block_ids, built.assembly.polygons, strict=True):
            writer.poly([polygon.tolist()])
            writer.record(name)


def _msh(built: Built, path: Path) -> None:
    points = np.concatenate(built.assembly.polygons)
    cells = np.arange(len(points)).reshape(-1, 4)
    tags = [np.arange(1, len(cells) + 1)]
    mesh = meshio.Mesh(
        np.hstack([points, np.zeros((len(points), 1))]),
        [("quad", cells)],
        cell_data={"gmsh:geometrical": tags, "gmsh:physical": tags},
    )
    mesh.write(path, file_format="gmsh22", binary=False)


def _geo(built: Built, path: Path) -> None:
    rows, number = [], 1
    for polygon in built.assembly.polygons:
        size = len(polygon)
        ids = range(number, number + size)
        rows += [f"Point({k}) = {{{x}, {y}, 0}};" for k, (x, y) in zip(ids, polygon.tolist(), strict=True)]
        rows += [f"Line({k}) = {{{k}, {number + (k + 1 - number) % size}}};" for k in ids]
        rows += [f"Curve Loop({number}) = {{{', '.join(map(str, ids))}}};", f"Plane Surface({number}) = {{{number}}};"]
        number += size
    path.write_text("\n".join(rows))


def spoiled(content: bytes, dice: random.Random) -> bytes:
    """The content with one or two faults."""
    for _ in range(dice.randint(1, 2)):
        content = dice.choice(FAULTS)(content, dice)
    return content


def _bytes(content: bytes, dice: random.Random) -> bytes:
    changed = bytearray(content)
    for _ in range(dice.randint(1, 2)):
        if changed:
            changed[dice.randrange(len(changed))] = dice.choice(
                [0, 1, 32, 34, 47, 60, 127, 128, 255, dice.randrange(256)]
            )
    return bytes(changed)


def _number(content: bytes, dice: random.Random) -> bytes:
    found = list(re.finditer(rb"-?\d+\.?\d*(?:e[-+]?\d+)?", content))
    if not found:
        return content
    one = dice.choice(found)
    return content[: one.start()] + dice.choice(NUMBERS).encode() + content[one.end() :]


def _word(content: bytes, dice: random.Random) -> bytes:
    found = list(re.finditer(rb"[A-Za-z]{2,}", content))
    if len(found) < 2:
        return content
    one, other = dice.choice(found), dice.choice(found)
    return content[: one.start()] + other.group() + content[one.end() :]


def _cut(content: bytes, dice: random.Random) -> bytes:
    a, b = sorted(dice.randrange(len(content) + 1) for _ in range(2))
    return content[:a] if dice.random() < 0.3 else content[:a] + content[min(b, a + 200) :]


def _repeated(content: bytes, dice: random.Random) -> bytes:
    a, b = sorted(dice.randrange(len(content) + 1) for _ in range(2))
    b = min(b, a + 400)
    return content[:b] + content[a:b] * dice.choice([1, 2, 50, 2000]) + content[b:]


def _extreme(content: bytes, dice: random.Random) -> bytes:
    """Four bytes of a binary number at its extremes."""
    at = 4 * dice.randrange(max(1, len(content) // 4))
    return (
        content[:at]
        + dice.choice([b"\xff\xff\xff\x7f", b"\x7f\xff\xff\xff", b"\0\0\0\x80", b"\0\0\xf0\x7f"])
        + content[at + 4 :]
    )


FAULTS: list[Callable[[bytes, random.Random], bytes]] = [_bytes, _number, _number, _word, _cut, _repeated, _extreme]


class TooLong(BaseException):
    """A drawing took too long; nothing that catches errors of readers catches this."""


def outcome(path: Path) -> str:
    """What comes of a drawing: "wall", "faults" or "sentence".

    Raises:
        BaseException: whatever else; that is a finding.
    """
    try:
        return "faults" if inspect(import_drawing(path).wall).faults else "wall"
    except InputError as error:
        sentence = str(error)
    assert len(str(path)) + 10 < len(sentence) < 20_000, "no sentence, or an endless one"
    assert all(line.isprintable() for line in sentence.split("\n")), "control characters"
    return "sentence"


def main(count: int, seed: int) -> int:
    """Spoil so many drawings of every format; the number of findings."""

    def late(*_: Any) -> None:
        raise TooLong(f"more than {SECONDS} s")

    signal.signal(signal.SIGPROF, late)
    findings = 0
    with tempfile.TemporaryDirectory() as folder:
        for suffix, sound in seeds(Path(folder)).items():
            assert outcome(sound) != "sentence", suffix
            dice, ends, slowest = random.Random(f"{seed}{suffix}"), Counter[str](), 0.0
            content = sound.read_bytes()
            for number in range(count):
                path = Path(folder) / f"spoiled{suffix}"
                path.write_bytes(spoiled(content, dice))
                began = time.process_time()
                signal.setitimer(signal.ITIMER_PROF, SECONDS)
                try:
                    ends[outcome(path)] += 1
                except BaseException as error:
                    if isinstance(error, KeyboardInterrupt):
                        raise
                    findings += 1
                    kept = Path(tempfile.gettempdir()) / f"finding-{seed}-{number}{suffix}"
                    shutil.copy(path, kept)
                    print(f"{kept}: {traceback.format_exc(limit=-3)}")
                finally:
                    signal.setitimer(signal.ITIMER_PROF, 0.0)
                slowest = max(slowest, time.process_time() - began)
            print(f"{suffix:9} {dict(ends)} slowest {slowest:.2f} s")
    used = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss // 1024
    print(f"{used} MB at most; {findings} findings")
    return findings + (used > MEGABYTES)


if __name__ == "__main__":
    sys.exit(main(int(sys.argv[1]), int(sys.argv[2])))
