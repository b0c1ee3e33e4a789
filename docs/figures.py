"""Figures of the documentation, drawn from the code under docs/generated/."""

from __future__ import annotations

import io
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from PIL import Image
from PIL.PngImagePlugin import PngInfo

from reports.drawing.looks import COLOURS

if TYPE_CHECKING:
    from playwright.sync_api import Browser

BLUE, GREY, INK, RUST = (COLOURS[name] for name in ("blue", "grey", "ink", "rust"))
ARROW = {"arrowstyle": "-|>", "linewidth": 1.4, "shrinkA": 0, "shrinkB": 0}
"""An arrow that begins and ends where it says."""
LOWEST, HIGHEST = 0.4, 0.6
"""Friction of the two halves below the paper's block."""


@contextmanager
def _drawing(path: Path, width: float, height: float, columns: int = 1) -> Iterator[Any]:
    """Axes of a new figure that is written at the end, the same bytes each time."""
    page = Figure(figsize=(width, height), layout="constrained")
    yield page.subplots(1, columns, squeeze=False)[0]
    page.savefig(path, metadata={"Date": None})


def _arrow(axes: Axes, start: tuple[float, float], step: tuple[float, float], colour: str) -> None:
    end = (start[0] + step[0], start[1] + step[1])
    axes.annotate("", end, start, arrowprops={**ARROW, "color": colour})


def _bare(axes: Axes, title: str, across: str, up: str) -> None:
    """Axes through the origin without numbers."""
    axes.set_title(title, fontsize=10)
    axes.set_xticks([])
    axes.set_yticks([])
    for side in ("top", "right"):
        axes.spines[side].set_visible(False)
    axes.spines["left"].set_position("zero")
    axes.spines["bottom"].set_position("zero")
    axes.annotate(
        across, (1.0, 0.0), xycoords=("axes fraction", "data"), xytext=(0, -12), textcoords="offset points", ha="right"
    )
    axes.annotate(up, (0.0, 1.0), xycoords=("data", "axes fraction"), xytext=(4, -9), textcoords="offset points")


def signs_figure(folder: Path) -> None:
    """Two blocks with the interface between them: ends, normal, tangent, and what acts on b."""
    with _drawing(folder / "signs.svg", 4.6, 3.4) as (axes,):
        axes.set_aspect("equal")
        axes.axis("off")
        for corners, name in ((((0, -1), (4, -1), (4, 0), (0, 0)), "a"), (((0, 0), (4, 0), (4, 1.6), (0, 1.6)), "b")):
            axes.fill(*zip(*corners, strict=True), facecolor="#eef2f6", edgecolor=INK, linewidth=0.8)
            axes.text(3.7, 0.5 * (corners[0][1] + corners[2][1]), name, fontsize=11, style="italic", va="center")
        for start, step, words, (x, y), colour in (
            ((0, 0), (0, 0.9), "$n_1$", (0.1, 0.8), BLUE),
            ((4, 0), (0, 0.7), "$n_2$", (4.1, 0.55), BLUE),
            ((1.0, 0.12), (0.9, 0), "$s$", (1.4, 0.2), BLUE),
            ((2.4, 0), (0, 0.6), "$n$", (2.5, 0.5), RUST),
            ((2.4, 0), (0.6, 0), "$t$", (2.9, -0.3), RUST),
        ):
            _arrow(axes, start, step, colour)
            axes.text(x, y, words, color=colour, fontsize=11)
        axes.plot([0, 4], [0, 0], "o", color=INK, markersize=4)
        axes.text(-0.3, -0.05, "1", va="center")
        axes.text(4.15, -0.2, "2", va="center")
        axes.plot([2], [1.2], "+", color=INK)
        axes.text(2.1, 1.2, "$c$", va="center")
        turn = {**ARROW, "color": INK, "connectionstyle": "arc3,rad=0.9"}
        axes.annotate("", (1.75, 1.35), (2.3, 0.95), arrowprops=turn)
        axes.text(1.35, 1.2, "$\\omega$", fontsize=11)


def laws_figure(folder: Path) -> None:
    """The law of a gap point in its two parts, and the yield domain of a joint with both flow rules."""
    with _drawing(folder / "laws.svg", 9.0, 3.0, 3) as (normal, shear, cone):
        _bare(normal, "gap point: compression", "opening $g$", "$N$")
        normal.plot([-1, 0, 1], [1, 0, 0], color=BLUE, linewidth=2)
        normal.text(-0.7, 0.8, "$N = -k_n g$", color=BLUE)
        normal.text(0.35, 0.06, "open", color=BLUE)
        _bare(shear, "gap point: shear at constant $N$", "slip $s$", "$T$")
        shear.plot([-1.2, -0.5, 0.5, 1.2], [-0.6, -0.6, 0.6, 0.6], color=BLUE, linewidth=2)
        shear.text(0.55, 0.66, "$\\mu N$", color=BLUE)
        shear.text(-1.2, -0.55, "$-\\mu N$", color=BLUE)
        shear.text(0.3, 0.2, "slope $k_t$", color=BLUE)
        shear.set_ylim(-0.9, 1.0)
        _bare(cone, "joint: yield domain and flow", "$N$, $-$opening", "$s$, $-$slip")
        cone.fill([0, 1.6, 1.6], [0, 0.96, -0.96], facecolor="#dfe8f1")
        for sign in (1, -1):
            cone.plot([0, 1.6], [0, sign * 0.96], color=INK)
        _arrow(cone, (1.0, 0.6), (0.0, 0.5), RUST)
        _arrow(cone, (1.0, 0.6), (-0.26, 0.43), GREY)
        cone.text(1.04, 1.0, "no dilatancy", color=RUST)
        cone.text(0.05, 0.95, "associated", color=GREY)
        cone.text(0.7, 0.1, "$|s| \\leq \\mu N$")
        cone.set_ylim(-1.1, 1.4)
        cone.set_aspect("equal")


def block_figure(folder: Path) -> None:
    """The paper's block: what share of weight each half bears and the multiplier of it, by every method."""
    import drystone

    wall = drystone.library_wall("single-block")
    answers = [drystone.analyse(wall, name) for name in ("la", "fe", "la-associated")]
    bracket = drystone.analyse(wall, "de").bracket
    with _drawing(folder / "single-block.svg", 9.0, 3.4, 2) as (base, chart):
        base.set_aspect("equal")
        base.axis("off")
        _base(base, answers)
        share = np.array([0.0, 1.0])
        chart.plot(share, LOWEST + (HIGHEST - LOWEST) * share, color=GREY, linewidth=1)
        if bracket is not None:
            chart.axhspan(*bracket, facecolor="#e6efe6")
            chart.text(0.98, bracket[0] + 0.004, "de: bracket over sweep orders", ha="right", color="#2e6b34")
        for answer in answers:
            forces = np.asarray(answer.forces)[:, :2].sum(axis=1)
            of_rough, value = forces[0] / forces.sum(), float(answer.multiplier or np.nan)
            chart.plot([of_rough], [value], "o", color=answer.traits.colour or INK)
            words = f"{answer.method}: {value:.4f}"
            side = "right" if of_rough > 0.5 else "left"
            step = (-8, 8) if of_rough > 0.5 else (8, -4)
            chart.annotate(words, (of_rough, value), step, textcoords="offset points", ha=side)
        chart.set_xlabel("share of the weight on the rough half")
        chart.set_ylabel("multiplier")
        chart.set_xlim(-0.03, 1.0)
        chart.set_ylim(0.38, 0.61)


def _base(axes: Axes, answers: list[Any]) -> None:
    """The block three times, with the compressions at the ends of its two halves as an answer has them."""
    for k, answer in enumerate(answers):
        left = 1.25 * k
        axes.fill([left, left + 1, left + 1, left], [0, 0, 0.5, 0.5], facecolor="#eef2f6", edgecolor=INK)
        axes.fill([left, left + 0.5, left + 0.5, left], [-0.62, -0.62, -0.55, -0.55], facecolor=GREY)
        axes.fill([left + 0.5, left + 1, left + 1, left + 0.5], [-0.62, -0.62, -0.55, -0.55], facecolor="#dde3e8")
        axes.text(left + 0.25, -0.68, f"$\\mu$ = {HIGHEST}", ha="center", va="top", fontsize=8)
        axes.text(left + 0.75, -0.68, f"$\\mu$ = {LOWEST}", ha="center", va="top", fontsize=8)
        places = np.asarray(wall_ends(answer)) + left
        for place, force in zip(places, np.asarray(answer.forces)[:, :2].ravel() / 0.5, strict=True):
            if force > 1e-9:
                _arrow(axes, (place, -0.55), (0.0, 0.55 * min(force / 0.8, 1.0)), BLUE)
        _arrow(axes, (left + 0.5, 0.25), (0.35, 0.0), RUST)
        axes.set_title("compressions below the block", fontsize=10)
        axes.text(left + 0.5, 0.56, answer.method, ha="center", fontsize=9)
    axes.set_xlim(-0.05, 3.6)
    axes.set_ylim(-0.9, 0.75)


def wall_ends(answer: Any) -> list[float]:
    """Abscissas of the contact points, two an interface, a little within their halves so that neighbours part."""
    assembly = answer.wall.assembly
    ends = np.stack([assembly.end1[:, 0], assembly.end2[:, 0]], axis=1)
    middle = ends.mean(axis=1, keepdims=True)
    return list((middle + 0.88 * (ends - middle)).ravel())


def friction_figure(folder: Path) -> None:
    """The 21-brick wall at seven frictions: the values that the last baseline recorded, method by method."""
    from harness.engine.baseline import read_baseline
    from harness.model.case import read_case, shipped_cases
    from harness.model.method_registry import load_method

    values = read_baseline(shipped_cases() / "baseline.json").values
    names = [name for name in values if name == "wall-21" or name.startswith("wall-21-friction-")]
    rows = sorted((float(read_case(shipped_cases() / name).assembly.friction.max()), name) for name in names)
    with _drawing(folder / "friction.svg", 6.0, 3.6) as (axes,):
        for method in ("la-associated", "fe", "de", "la"):
            traits = load_method(method).traits
            points = [(mu, values[name][method].multiplier) for mu, name in rows]
            axes.plot(*zip(*points, strict=True), color=traits.colour or INK, marker=traits.marker or ".", label=method)
        axes.set_xlabel("friction")
        axes.set_ylabel("multiplier")
        axes.legend(frameon=False)


def load_steps_figure(folder: Path) -> None:
    """The load steps of the paper's wall by distinct elements, in the order of the search."""
    import drystone
    from harness.model.details import AnswerDetails

    answer = drystone.analyse(drystone.library_wall("wall-21"), "de")
    loads, order = np.array(answer.path["multiplier"]), AnswerDetails(answer.details).reported_order
    number, held, moves = np.arange(1, len(loads) + 1), loads <= order.held, loads >= order.moving
    with _drawing(folder / "load-steps.svg", 6.0, 3.2) as (axes,):
        for name, shown, colour, marker in (
            ("held", held, BLUE, "o"),
            ("undecided", ~held & ~moves, GREY, "x"),
            ("moves", moves, RUST, "s"),
        ):
            if shown.any():
                axes.plot(number[shown], loads[shown], marker, color=colour, label=name, markersize=4)
        axes.set_xlabel("load step")
        axes.set_ylabel("multiplier")
        axes.legend(frameon=False)


def readme_figures(folder: Path) -> None:
    """What the README shows: mechanisms of the 21-brick wall, that of its minimum, and the first screen of the report.

    `python docs/figures.py` draws them again.
    """
    from playwright.sync_api import sync_playwright

    import drystone
    from reports.figures.figures import figure

    wall = drystone.library_wall("wall-21")
    answers: list[Any] = [drystone.analyse(wall, name) for name in ("fe", "la", "de")]
    figure(wall.case, answers, "comparison", folder / "wall-21.svg")
    figure(wall.case, [answers[1]], "mechanism", folder / "mechanism.svg")
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path="/usr/bin/chromium", args=["--no-sandbox"])
        words, picture = first_screen(browser)
        browser.close()
    about = PngInfo()
    about.add_text("Description", words)
    Image.open(io.BytesIO(picture)).quantize(128).save(folder / "first-screen.png", pnginfo=about, optimize=True)


def first_screen(browser: Browser, store: Path | None = None) -> tuple[str, bytes]:
    """The first screen of the report on the paper's block and wall: its words without those of CPU time, and a PNG.

    Args:
        browser: in which it is seen.
        store: where answers are kept, and looked for first; None: nowhere.
    """
    import drystone

    walls = [drystone.library_wall(name) for name in ("single-block", "wall-21")]
    with TemporaryDirectory() as folder:
        path = drystone.compare(walls, ["fe", "la", "la-associated", "de"], store=store).report(
            Path(folder) / "report.html"
        )
        page = browser.new_page(viewport={"width": 1280, "height": 900})
        page.goto(path.as_uri())
        page.locator("nav, .head p").evaluate_all("all => all.forEach((one) => one.remove())")
        words = page.locator(".glance > div:first-child").inner_text()
        end = page.locator(".glance").evaluate("e => e.getBoundingClientRect().bottom")
        picture = page.screenshot(clip={"x": 0, "y": 0, "width": 1280, "height": end + 12})
        page.close()
    return words, picture


ALL = (signs_figure, laws_figure, block_figure, friction_figure, load_steps_figure)
"""Every figure."""

if __name__ == "__main__":
    readme_figures(Path(__file__).parent)
