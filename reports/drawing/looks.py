"""How each role of a display list looks, on screen, in files and on paper: colours, widths and dashes."""

from __future__ import annotations

from dataclasses import dataclass

COLOURS = {
    "ink": "#14202b",
    "paper": "#ffffff",
    "blue": "#17508c",
    "rust": "#a63c06",
    "plum": "#6d2077",
    "grey": "#8a96a1",
    "light": "#9aa5af",
    "moving": "#dfe8f1",
    "stone": "#f3f0e9",
    "faulty": "#f6ded2",
    "amber": "#b07a00",
    "crack": "#d9b8e0",
}
"""Names of colours; those of the page's style sheet follow its variables."""
_VARIABLES = ("ink", "paper", "blue", "rust", "plum")
HATCH = (
    '<pattern id="hatch" width="90" height="90" patternUnits="userSpaceOnUse" patternTransform="rotate(45)">'
    '<rect width="90" height="90" fill="#fff"/><path d="M0 0V90" stroke="#14202b" stroke-width="14"/></pattern>'
)


@dataclass(frozen=True)
class Look:
    """The look of a role.

    Attributes:
        stroke, fill: names of `COLOURS`; empty for none.
        width: of lines, in drawing units.
        dash: lengths of dash and gap in drawing units, or none.
        thin: whether lines are thinner where blocks are small.
        round: whether lines have round ends.
        hatched: whether the fill is hatched.
        opacity: so that what lies below shows.
    """

    stroke: str = ""
    fill: str = ""
    width: float = 0.0
    dash: tuple[float, float] | None = None
    thin: bool = True
    round: bool = False
    hatched: bool = False
    opacity: float = 1.0


LOOKS = {
    "held": Look("ink", "paper", 9, thin=False, hatched=True),
    "stone": Look("ink", "paper", 9),
    "still": Look("ink", "paper", 9),
    "moves": Look("ink", "moving", 9),
    "ghost": Look("light", "", 6, (22, 22)),
    "other": Look("rust", "", 14, (46, 30)),
    "outline": Look("grey", "paper", 6),
    "ground": Look("grey", "paper", 6, hatched=True),
    "joint": Look("ink", "", 16),
    "contact": Look("ink", "", 42, round=True),
    "tie": Look("plum", "", 20),
    "prop": Look("plum", "", 40),
    "fill": Look("plum", "", 60),
    "idle": Look("plum", "", 10, (40, 30)),
    "live": Look("blue", "blue", 16),
    "dead": Look("rust", "paper", 12, (30, 18)),
    "size": Look("grey", "grey", 8, thin=False),
    "slide": Look("rust"),
    "both": Look("rust"),
    "dilatant": Look("rust"),
    "core": Look("paper"),
    "rock": Look("blue"),
    "open": Look("plum"),
    "hinge": Look("", "blue"),
    "crack": Look("", "crack"),
    "force": Look("", "blue"),
    "full": Look("", "rust"),
    "ring": Look("rust", "", 10),
    "thrust": Look("blue", round=True),
    "force-scale": Look("blue"),
    "scale": Look("ink", "", 14, thin=False),
    "sound": Look("ink", "stone", 9, opacity=0.85),
    "sound-held": Look("ink", "stone", 9, hatched=True, opacity=0.85),
    "fault": Look("rust", "faulty", 9, opacity=0.85),
    "fault-held": Look("rust", "faulty", 9, hatched=True, opacity=0.85),
    "doubt": Look("amber", "stone", 9, opacity=0.85),
    "doubt-held": Look("amber", "stone", 9, hatched=True, opacity=0.85),
}
"""The look of every role but those of texts, which are written in ink: "said" stands over others, "" does not."""
_PAPER_ONLY = ("sound", "fault", "doubt", "size")
"""Beginnings of roles that no page shows."""


def css(thinner: float | None = None) -> str:
    """The looks as a style sheet.

    Args:
        thinner: factor of the widths of lines, in a file that programs without variables and sums read; None in a page,
            whose colours are variables and whose drawings carry the factor as the variable k.
    """
    rules = [f"svg .{role} {{ {_rule(look, thinner)} }}" for role, look in LOOKS.items() if _on_screen(role)]
    for role in ("live", "dead"):
        look = LOOKS[role]
        rules.append(f"svg .{role}.shaft {{ fill: none; }}")
        edge = "none" if look.dash is None else _colour(look.stroke, thinner)
        rules.append(f"svg .{role}.head {{ stroke: {edge}; stroke-dasharray: none; }}")
    hidden = "" if thinner else " visibility: var(--letters, visible);"
    letters, ink = ("Arial, sans-serif", COLOURS["ink"]) if thinner else ("var(--sans)", "var(--ink)")
    rules.append(f"svg.wall text {{ font-family: {letters}; fill: {ink}; text-anchor: middle;{hidden} }}")
    paper = _colour("paper", thinner)
    above = f"paint-order: stroke; stroke: {paper}; stroke-width: 24px; pointer-events: none;"
    rules.append(f"svg.wall text.said {{ {above} }}")
    rules.append("svg .thrust { display: none; }")
    return "\n".join(rules)


def _on_screen(role: str) -> bool:
    return not role.startswith(_PAPER_ONLY)


def _rule(look: Look, thinner: float | None) -> str:
    fill = "url(#hatch)" if look.hatched else _colour(look.fill, thinner)
    said = [f"fill: {fill};", f"stroke: {_colour(look.stroke, thinner)};"]
    if look.width and not (look.thin and thinner is None):
        said.append(f"stroke-width: {look.width * (thinner or 1.0 if look.thin else 1.0):.4g}px;")
    elif look.width:
        said.append(f"stroke-width: calc({look.width:g}px * var(--k, 1));")
    if look.dash:
        said.append(f"stroke-dasharray: {look.dash[0]:g} {look.dash[1]:g};")
    if look.round:
        said.append("stroke-linecap: round;")
    if look.round or look.fill:
        said.append("stroke-linejoin: round;")
    return " ".join(said)


def _colour(name: str, thinner: float | None) -> str:
    if not name:
        return "none"
    return f"var(--{name})" if thinner is None and name in _VARIABLES else COLOURS[name]
