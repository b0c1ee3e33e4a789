"""How much the tests assert: one-token mutants of a package, and those that survive its tests.

    python -m tests.mutants map PACKAGE...      find which tests run which lines; again after tests change
    python -m tests.mutants PACKAGE --count 60  a sample of mutants; survivors are printed
    python -m tests.mutants PACKAGE --ask TESTS --uncompiled  the same by these tests alone, which needs no map

A mutant changes one operator or doubles one number. It is held against the tests that run the changed line, quick ones
first, and a survivor of those against all tests of the package. Each is made in a copy of the checkout, never here.
"""

from __future__ import annotations

import ast
import contextlib
import itertools
import json
import os
import random
import shutil
import signal
import subprocess
import sys
import tempfile
from collections import defaultdict
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path
from queue import Queue
from xml.etree import ElementTree

import click
from coverage import CoverageData

ROOT = Path(__file__).parents[1]
KEPT = ROOT / "out" / "mutants"
PACKAGES = {
    "judge": (
        "harness/engine/judge*.py harness/engine/residuals.py harness/engine/meas*.py",
        "tests/engine/test_judge*.py tests/engine/test_measured_motion.py",
    ),
    "proof": (
        "methods/proof/verify/*.py methods/proof/same_wall.py",
        "tests/bound/test_attacks*.py tests/bound/test_*certificate.py tests/bound/test_courses.py "
        "tests/bound/test_leaves.py tests/bound/test_numbers.py tests/bound/test_mutants.py "
        "tests/bound/test_same_numbers.py",
    ),
    "proving": (
        "methods/proof/**/*.py methods/la/certify/*.py drystone/certificates.py",
        "tests/bound tests/la/test_proof.py",
    ),
    "contacts": (
        "harness/model/contacts.py harness/model/interfaces.py harness/model/joint_law.py harness/model/geometry.py "
        "harness/model/assembly.py",
        "tests/model/test_assembly.py tests/model/test_[cf]*.py tests/model/test_[g-hj]*.py "
        "tests/model/test_input_checks.py tests/model/test_wall_format.py",
    ),
    "model": ("harness/model/*.py", "tests/model"),
    "formats": ("harness/formats/*.py", "tests/formats"),
    "engine": ("harness/engine/*.py", "tests/engine tests/faults"),
    "studies": ("harness/engine/sweep/*.py drystone/studies.py", "tests/engine tests/reports"),
    "reports": ("reports/*.py reports/*/*.py", "tests/reports"),
    "fe": ("methods/fe/*.py methods/springs/**/*.py", "tests/fe tests/springs"),
    "la": ("methods/la/*.py methods/la/core/*.py methods/la/interior/*.py methods/la/sources/*.py", "tests/la"),
    "de": ("methods/de/**/*.py", "tests/de"),
}
"""Patterns of the sources of each package and of the tests that are its own."""
SECONDS = 300
"""After which a mutant counts as found, and is printed as such: on a busy machine it need not be."""
TIME_OVER = 99
"""What stands for the exit code of pytest where the time was over."""
CANNOT_START = (3, 4, 5)
"""Exit codes of pytest that say nothing of the tests: an internal error, wrong words, no test found."""
COMPARED = {
    ast.Lt: "<=", ast.LtE: "<", ast.Gt: ">=", ast.GtE: ">", ast.Eq: "!=", ast.NotEq: "==",
    ast.Is: "is not", ast.IsNot: "is", ast.In: "not in", ast.NotIn: "in",
}  # fmt: skip
COMPUTED = {ast.Add: "-", ast.Sub: "+", ast.Mult: "/", ast.Div: "*"}


@dataclass(frozen=True)
class Mutant:
    """One change of one token.

    Attributes:
        path: of the source, from the root of the checkout.
        line: its number, from one on.
        begin, end: bytes of the line that are replaced.
        new: what stands there instead.
    """

    path: str
    line: int
    begin: int
    end: int
    new: str

    def applied(self, source: str) -> str:
        """The source with the change."""
        lines = source.splitlines(keepends=True)
        line = lines[self.line - 1].encode()
        lines[self.line - 1] = (line[: self.begin] + self.new.encode() + line[self.end :]).decode()
        return "".join(lines)

    def shown(self, source: str) -> str:
        """The line before and after."""
        old, new = (text.splitlines()[self.line - 1].strip() for text in (source, self.applied(source)))
        return f"{self.path}:{self.line}  {old}  ->  {new}"


def mutants_of(path: str, source: str) -> Iterator[Mutant]:
    """All mutants of a source; annotations and texts have none."""
    lines = [line.encode() for line in source.splitlines()]

    def between(left: ast.expr, right: ast.expr, new: str) -> Iterator[Mutant]:
        begin, end = left.end_col_offset or 0, right.col_offset
        if left.end_lineno == right.lineno and not set(lines[right.lineno - 1][begin:end]) & set(b"()"):
            yield Mutant(path, right.lineno, begin, end, f" {new} ")

    tree = ast.parse(source)
    typed = {id(part) for node in ast.walk(tree) for field in ("annotation", "returns")
             if (kind := getattr(node, field, None)) is not None for part in ast.walk(kind)}  # fmt: skip
    for node in ast.walk(tree):
        if id(node) in typed:
            continue
        match node:
            case ast.Compare(left=left, ops=[operator], comparators=[right]) if type(operator) in COMPARED:
                yield from between(left, right, COMPARED[type(operator)])
            case ast.BinOp(left=left, op=operator, right=right) if type(operator) in COMPUTED:
                yield from between(left, right, COMPUTED[type(operator)])
            case ast.BoolOp(op=operator, values=[left, right]):
                yield from between(left, right, "or" if isinstance(operator, ast.And) else "and")
            case ast.Constant(value=int() | float() as value) if value and not isinstance(value, bool):
                if node.end_lineno == node.lineno:
                    yield Mutant(path, node.lineno, node.col_offset, node.end_col_offset or 0, repr(value * 2))


def sources(package: str) -> list[str]:
    """Paths of the sources of a package, from the root of the checkout."""
    found = {path for pattern in PACKAGES[package][0].split() for path in ROOT.glob(pattern)}
    return sorted(str(path.relative_to(ROOT)) for path in found if path.name != "__init__.py")


def own_tests(package: str, folder: Path = ROOT) -> list[str]:
    """Files and folders of the tests of a package in a copy of the checkout, from its root."""
    found = [path for pattern in PACKAGES[package][1].split() for path in folder.glob(pattern)]
    return sorted(str(path.relative_to(folder)) for path in found)


def sample(package: str, count: int, seed: int) -> list[Mutant]:
    """So many mutants of a package, drawn from all of them."""
    every = [mutant for path in sources(package) for mutant in mutants_of(path, (ROOT / path).read_text("utf-8"))]
    return random.Random(seed).sample(every, min(count, len(every)))


def copy_of_checkout(folder: Path) -> Path:
    """A copy of the files that git knows of here, and of the compiled loops that belong to them."""
    listed = subprocess.run(
        ["git", "ls-files", "-z", "-co", "--exclude-standard"], cwd=ROOT, capture_output=True, check=True
    )
    for name in listed.stdout.decode().split("\0"):
        if name and (ROOT / name).is_file():
            (folder / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy2(ROOT / name, folder / name)
    copy_loops(folder)
    return folder


def copy_loops(folder: Path) -> None:
    """Copy the code that numba keeps beside the sources of the methods; it holds for sources of the same date."""
    for kept in ROOT.glob("methods/**/__pycache__/*.nb[ic]"):
        place = folder / kept.relative_to(ROOT)
        place.parent.mkdir(exist_ok=True)
        shutil.copy2(kept, place)


def pytest(folder: Path, tests: list[str], *words: str, seconds: float | None = None, uncompiled: bool = False) -> int:
    """Exit code of tests in a copy of the checkout; `TIME_OVER` where the time was over."""
    command = [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", "-m", "not slow and not browser", *words]
    environment = os.environ | {"PYTHONPATH": str(folder), "OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}
    if uncompiled:
        environment["NUMBA_DISABLE_JIT"] = "1"
    environment.pop("PYTHONDONTWRITEBYTECODE", None)  # most of the time of a mutant would be that of compiling others
    process = subprocess.Popen(
        [*command, *tests], cwd=folder, env=environment, start_new_session=True,
        stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
    )  # fmt: skip
    try:
        return process.wait(seconds)
    except subprocess.TimeoutExpired:
        return TIME_OVER
    finally:
        with contextlib.suppress(ProcessLookupError):
            os.killpg(process.pid, signal.SIGKILL)
        process.wait()


def make_map(package: str) -> None:
    """Run the tests of a package once, and keep which lines each runs and how long it takes."""
    KEPT.mkdir(parents=True, exist_ok=True)
    settings = KEPT / f"{package}.coveragerc"
    data = KEPT / f"{package}.coverage"
    settings.write_text(f"[run]\ndata_file = {data}\ndynamic_context = test_function\nsource = .\nomit = tests/*\n")
    words = ["-m", "coverage", "run", f"--rcfile={settings}", "-m", "pytest", "-q", "-m", "not slow and not browser"]
    words.append(f"--junitxml={KEPT / package}.xml")
    if subprocess.run([sys.executable, *words, *own_tests(package)], cwd=ROOT, check=False).returncode != 0:
        raise click.ClickException(f"the tests of {package} fail without any mutant: mend them, then make its map")


class Map:
    """Which tests run which lines of the sources, the quick ones of them first.

    Args:
        package: whose map was made.
        most: of the tests that run a changed line, the quickest that take no longer than this together are asked [s].
    """

    def __init__(self, package: str, most: float) -> None:
        self.most = most
        self.seconds: defaultdict[str, float] = defaultdict(float)
        for case in ElementTree.parse(KEPT / f"{package}.xml").iter("testcase"):
            module, function = case.attrib["classname"].split(".")[-1], case.attrib["name"].split("[")[0]
            self.seconds[f"{module}.{function}"] += float(case.attrib["time"])
        self.data = CoverageData(str(KEPT / f"{package}.coverage"))
        self.data.read()

    def near(self, mutant: Mutant) -> list[str]:
        """Tests that run the line of a mutant; of a line that no test runs by itself (run at import, compiled) those
        of its file, or any."""
        lines = self.data.contexts_by_lineno(str(ROOT / mutant.path))
        of_line = {last_two(test) for test in lines.get(mutant.line, []) if test}
        of_file = {last_two(test) for tests in lines.values() for test in tests if test}
        ordered = sorted(of_line or of_file or self.seconds, key=lambda test: (self.seconds[test], test))
        sums = itertools.accumulate(self.seconds[test] for test in ordered)
        return [test for test, total in zip(ordered, sums, strict=True) if test == ordered[0] or total < self.most]


def last_two(test: str) -> str:
    """`module.function` of a test."""
    return ".".join(test.split(".")[-2:])


def node(test: str, folder: Path) -> list[str]:
    """What pytest calls the test `module.function`."""
    module, function = test.split(".")
    found = [path for path in folder.glob(f"tests/**/{module}.py") if f"def {function}(" in path.read_text("utf-8")]
    return [f"{path.relative_to(folder)}::{function}" for path in found]


def survives(
    package: str, mutant: Mutant, folder: Path, tests: Map | list[str], near_only: bool, uncompiled: bool
) -> bool:
    """Whether a mutant passes the tests that run its line, and then, unless those are enough, all of its package.

    Args:
        package: of the mutant; folder: a copy of the checkout.
        tests: the map of the package, or tests that are asked instead of those near the line.
        near_only: they are enough.
        uncompiled: whether a file with compiled loops is tried as Python.
    """
    place = folder / mutant.path
    source = place.read_text("utf-8")
    as_python = uncompiled and "@compiled" in source

    def passes(asked: list[str]) -> bool:
        """Whether the mutant passes these tests."""
        place.write_text(mutant.applied(source), "utf-8")
        forget()
        code = pytest(folder, asked, "-x", seconds=SECONDS, uncompiled=as_python)
        restore()
        if code == TIME_OVER:
            print("TIME OVER", mutant.shown(source), flush=True)
        # Tests that cannot be started tell of the mutant only if they can be without it.
        if code in CANNOT_START and pytest(folder, asked, "--collect-only") != 0:
            raise click.ClickException(f"pytest cannot start {' '.join(asked)} without any mutant")
        return code == 0

    def forget() -> None:
        for kept in place.parent.glob(f"__pycache__/{place.stem}.*.pyc"):  # two changes in one second look alike
            kept.unlink()

    def restore() -> None:
        shutil.copy2(ROOT / mutant.path, place)
        forget()
        if "@compiled" in source:
            copy_loops(folder)

    try:
        near = [name for test in tests.near(mutant) for name in node(test, folder)] if isinstance(tests, Map) else tests
        return passes(near) and (near_only or passes(own_tests(package, folder)))
    finally:
        restore()


@click.command()
@click.argument("words", nargs=-1, required=True)
@click.option("--count", default=60, show_default=True, help="Mutants a package.")
@click.option("--seed", default=1, show_default=True, help="Of the sample.")
@click.option("--jobs", default=1, show_default=True, help="Mutants tried at a time.")
@click.option("--near", is_flag=True, help="Ask only the tests that run the changed line, where there are any.")
@click.option("--ask", multiple=True, metavar="FILE", help="Ask these tests alone.")
@click.option(
    "--seconds", default=60.0, show_default=True, help="Of the tests that run a line, the quickest up to this."
)
@click.option("--uncompiled", is_flag=True, help="Run all loops as Python for mutants of files with compiled ones.")
def main(
    words: tuple[str, ...],
    count: int,
    seed: int,
    jobs: int,
    near: bool,
    ask: tuple[str, ...],
    seconds: float,
    uncompiled: bool,
) -> None:
    """Make the map of PACKAGES (`map PACKAGE...`), or try mutants of them."""
    if words[0] == "map":
        for package in words[1:]:
            make_map(package)
        return
    for package in words:
        tests, drawn = list(ask) or Map(package, seconds), sample(package, count, seed)
        with tempfile.TemporaryDirectory() as room, ThreadPoolExecutor(jobs) as pool:
            free: Queue[Path] = Queue()
            for number in range(jobs):
                folder = copy_of_checkout(Path(room, str(number)))
                first = list(ask) if ask else [] if near else own_tests(package, folder)
                if first and pytest(folder, first, "-x") != 0:  # compiles the loops of the copy, too
                    raise click.ClickException(f"the tests of {package} fail without any mutant")
                free.put(folder)

            def tried(
                mutant: Mutant, package: str = package, tests: Map | list[str] = tests, free: Queue[Path] = free
            ) -> bool:
                folder = free.get()
                alive = survives(package, mutant, folder, tests, near or bool(ask), uncompiled)
                free.put(folder)
                click.echo("." if not alive else "", nl=alive, err=True)
                if alive:
                    print("ALIVE", mutant.shown((ROOT / mutant.path).read_text("utf-8")), flush=True)
                return alive

            alive = sum(pool.map(tried, drawn))
        print(json.dumps({"package": package, "mutants": len(drawn), "seed": seed, "survivors": alive}), flush=True)


if __name__ == "__main__":
    main()
