"""A collapse as a moving picture: frames that a run followed, or the mechanism growing from rest. GIF, PNG or WebP."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from PIL import Image

from harness.model.assembly import Assembly, FloatArray
from harness.model.case import Case
from harness.model.displaced import carried, released
from harness.model.errors import InputError
from harness.model.result import Result
from harness.model.writing import replacing
from reports.drawing.display_list import Box, DisplayList, Frame
from reports.drawing.looks import COLOURS
from reports.drawing.mechanism_drawing import moved_wall
from reports.drawing.wall_drawing import displaced_drawing
from reports.figures import figures
from reports.figures.plot import plot
from reports.geometry import shapes
from reports.labels import labels, numbers

_FORMATS = (".gif", ".png", ".apng", ".webp")
FRAMES = 28
_FRAME_MILLISECONDS = 60
_PAUSE_MILLISECONDS = 900
_DOTS_PER_INCH = 160
_GREATEST = 2.0
"""Last displacement, as a multiple of the one the report draws."""


def check_ending(path: Path) -> None:
    """Refuse a file whose ending says no format of animations; raises InputError."""
    figures.check_ending(path, _FORMATS, "animation")


def animate(case: Case, result: Result, path: Path) -> None:
    """Draw the collapse of a result as an animation.

    Args:
        case: the case.
        result: a result with a mechanism.
        path: the file; its ending .gif, .png or .apng, or .webp says the format.

    Raises:
        InputError: another ending, or a result without a mechanism.
    """
    check_ending(path)
    suffix = path.suffix.lower()
    if result.mechanism is None and released(result, case.assembly.n_blocks) is None:
        raise InputError(
            f"{result.method} gave no mechanism to animate ({labels.STATUS[result.status][1]}: {result.sentence})",
            "Choose a method that ended with a collapse state",
            source=case.id,
        )
    images = frames(case, result)
    durations = [_FRAME_MILLISECONDS] * len(images)
    durations[0] = durations[-1] = _PAUSE_MILLISECONDS
    if suffix == ".gif":
        images = [image.quantize(colors=64, dither=Image.Dither.NONE) for image in images]
    name = {".gif": "GIF", ".webp": "WEBP"}.get(suffix, "PNG")
    options = {"lossless": True} if name == "WEBP" else {}
    with replacing(path) as draft:
        images[0].save(
            draft, format=name, save_all=True, append_images=images[1:], duration=durations, loop=0, **options
        )


def frames(case: Case, result: Result) -> list[Image.Image]:
    """The pictures of an animation: the collapse a run followed, else the mechanism from rest to twice its size."""
    assembly = case.assembly
    followed = released(result, assembly.n_blocks)
    if followed is not None:
        places = [carried(assembly, moved) for moved in followed]
        box = _box(assembly, places)
        return [_picture(case, result, displaced_drawing(assembly, case.id, outlines), box) for outlines in places]
    # The square of time lets the blocks move ever faster, as in a collapse.
    mechanism = np.asarray(result.mechanism, dtype=float)
    scale = _GREATEST * shapes.amplitude(assembly, mechanism)
    box = _box(assembly, [shapes.displaced(assembly, mechanism, scale)])
    times = np.linspace(0.0, 1.0, FRAMES).tolist()
    return [_picture(case, result, moved_wall(assembly, result, scale * time**2), box) for time in times]


def _box(assembly: Assembly, places: list[list[FloatArray]], room: float = 60.0) -> Box:
    """Left, top, width and height that all frames show: those of a drawing of the wall, with all places of its blocks.

    Args:
        assembly: the wall.
        places: outlines (k, 2) of the blocks [length], by frame.
        room: from the outermost corner to the edge, in drawing units.
    """
    frame = Frame.of(assembly)
    left, top, width, height = frame.box
    corners = np.concatenate([frame.place(np.concatenate(outlines)) for outlines in places])
    low = np.minimum(corners.min(axis=0) - room, (left, top))
    high = np.maximum(corners.max(axis=0) + room, (left + width, top + height))
    (x, y), (wide, tall) = low.tolist(), (high - low).tolist()
    return x, y, wide, tall


def _picture(case: Case, result: Result, drawn: DisplayList, box: Box) -> Image.Image:
    """One frame: a title and a drawing."""
    with figures.style():
        page, axes = figures.blank(case.assembly, 1, 1, box=box)
        value = "" if result.multiplier is None else f" at {numbers.multiplier(result.multiplier)}"
        axes[0][0].set_title(f"{case.id}, {result.method}{value}", pad=3, color=COLOURS["ink"])
        plot(axes[0][0], drawn)
        page.set_dpi(_DOTS_PER_INCH)
        canvas: Any = FigureCanvasAgg(page)
        canvas.draw()
        return Image.fromarray(np.asarray(canvas.buffer_rgba())).convert("RGB")
