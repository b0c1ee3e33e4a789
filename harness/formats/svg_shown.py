"""What an SVG shows: hidden elements left out, clones (`use` of shapes, groups and symbols) written out.

Display, visibility, opacity and paint are read from attributes, `style` attributes and style sheets with simple
selectors, and handed down as CSS 2.1 (section 6.2) and SVG 2 (sections 5.5 to 5.6) say.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from xml.etree.ElementTree import Element

from harness.formats.drawing import MOST_COPIES, Drawing, without_comments
from harness.model.errors import InputError

LABEL = "{http://www.inkscape.org/namespaces/inkscape}label"
_HREFS = ("href", "{http://www.w3.org/1999/xlink}href")
_SHAPES = {"rect", "circle", "ellipse", "line", "polyline", "polygon", "path"}
_GROUPS = {"g", "a", "svg", "switch"}
_WITHOUT_OUTLINE = {"text", "image", "foreignObject"}
_INHERITED = {"visibility": "visible", "fill": "black", "stroke": "none", "fill-opacity": "1", "stroke-opacity": "1"}
"""Properties that are handed down, with their initial values."""
_PROPERTIES = {"display", "opacity", *_INHERITED}
_MOST_DEEP = 100
"""Depth of elements within elements; a drawing has some ten."""
_MOST_MATCHES = 5_000_000
"""Elements times rules of style that are compared."""
_PIXELS = {"": 1.0, "px": 1.0, "mm": 96.0 / 25.4, "cm": 96.0 / 2.54, "in": 96.0, "pt": 96.0 / 72.0, "pc": 16.0}
_LENGTH = re.compile(r"\s*([-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)\s*(px|mm|cm|in|pt|pc|)\s*")
_COMPOUND = re.compile(r"(\*|[\w-]+)?((?:[.#][\w-]+)*)")

_Style = dict[str, str]
_Selector = list[tuple[str, list[str]]]


def shown(root: Element, drawing: Drawing) -> Element:
    """The picture as groups and shapes in its coordinates, without window, styles and what is not shown.

    Raises:
        InputError: elements nested too deeply, or clones that contain themselves or stand for too many elements.
    """
    above = _above(root)
    named = {element.get("id", ""): element for element in above}
    viewer = _Viewer(drawing, named, _styles(above, drawing), _box(root))
    picture = Element("{http://www.w3.org/2000/svg}svg")
    picture.extend(list(viewer.children(root, _INHERITED | viewer.style(root), ())))
    return picture


def _tag(element: Element) -> str:
    return element.tag.rpartition("}")[2] if isinstance(element.tag, str) else ""


def _above(root: Element) -> dict[Element, Element | None]:
    """Every element with the one it is in, in the order of the file."""
    above: dict[Element, Element | None] = {root: None}
    level, depth = [root], 0
    while level:
        depth += 1
        if depth > _MOST_DEEP:
            raise InputError(f"its elements are nested more than {_MOST_DEEP} deep", "Ungroup them")
        below = [(child, element) for element in level for child in element]
        above.update(below)
        level = [child for child, _ in below]
    return above


@dataclass(eq=False)
class _Viewer:
    """The look at one file: styles of elements of their own, elements by id, sizes of the window."""

    drawing: Drawing
    named: dict[str, Element]
    styles: dict[Element, _Style]
    window: tuple[float, float] | None
    copies: int = 0
    _cloning: list[Element] = field(default_factory=list)

    def style(self, element: Element) -> _Style:
        """What is said of an element itself."""
        return self.styles.get(element, {})

    def children(self, element: Element, state: _Style, deep: tuple[Element, ...]) -> Iterator[Element]:
        """The shown children of an element, for the properties that are handed down to them."""
        inner = list(element)
        if _tag(element) == "switch":
            inner = [child for child in inner if _tag(child) in _GROUPS | _SHAPES | {"use"}][:1]
        for child in inner:
            made = self.one(child, state, (*deep, element))
            if made is not None:
                yield made

    def one(self, element: Element, state: _Style, deep: tuple[Element, ...]) -> Element | None:
        """An element as it is shown, or nothing."""
        tag, own = _tag(element), self.style(element)
        if tag in _WITHOUT_OUTLINE:
            self.drawing.left_out[f"{tag}: no outline"] += 1
        if tag not in _GROUPS | _SHAPES | {"use"}:
            return None
        if len(deep) > _MOST_DEEP:
            raise InputError(f"its elements are nested more than {_MOST_DEEP} deep", "Ungroup them")
        if self._cloning:
            self._count()
        state = state | {name: value for name, value in own.items() if name in _INHERITED and value != "inherit"}
        for name in ("clip-path", "mask"):
            if element.get(name, "none") != "none" or f"{name}:" in element.get("style", "").replace(" ", ""):
                self.drawing.notes.append(f"a {name} is not evaluated: parts that it hides are read as shown")
        hidden = _hidden(tag, own, state)
        if hidden:
            number = sum(_tag(item) in _SHAPES | {"use"} for item in element.iter())
            self.drawing.left_out[f"shape: hidden ({hidden})"] += number
            return None
        if tag == "use":
            return self._clone(element, state, deep)
        if tag in _SHAPES:
            kept = {
                name: value for name, value in element.attrib.items() if name not in {"style", "class", *_PROPERTIES}
            }
            if self._cloning:
                kept.pop("id", None)  # a name is that of the original
            return Element(element.tag, kept)
        group = _group(element.get("transform", ""), element)
        if tag == "svg":
            group.set("transform", self._placed(element, element, element))
        group.extend(list(self.children(element, state, deep)))
        return group

    def _clone(self, use: Element, state: _Style, deep: tuple[Element, ...]) -> Element | None:
        """The element that a `use` refers to, in its place."""
        link = next((use.get(name, "") for name in _HREFS if use.get(name)), "")
        target = self.named.get(link.removeprefix("#")) if link.startswith("#") else None
        if target is None:
            raise InputError(
                f'it clones "{link}", which is not in it', "Unlink the clone, or give the file in one", "use"
            )
        if target in self._cloning or target in deep:
            raise InputError(f'the clone of "{link}" contains itself', "Unlink the clones", "use")
        group = _group(use.get("transform", ""))
        self._cloning.append(target)
        if _tag(target) in ("symbol", "svg"):
            self._count()
            inner = _group(self._placed(use, target, use))
            own = state | {name: value for name, value in self.style(target).items() if name in _INHERITED}
            inner.extend(list(self.children(target, own, deep)))
            group.append(inner)
        else:
            inner = _group(f"translate({_length(use, 'x')},{_length(use, 'y')})")
            made = self.one(target, state, deep)
            inner.extend([] if made is None else [made])
            group.append(inner)
        self._cloning.pop()
        return group

    def _count(self) -> None:
        self.copies += 1
        if self.copies > MOST_COPIES:
            raise InputError(
                f"its clones stand for more than {MOST_COPIES:,} elements",
                "Leave out what is no stone, or unlink the clones",
            )

    def _placed(self, place: Element, target: Element, sized: Element) -> str:
        """The transform of a window within the picture (SVG 2, section 8.2), which shows the viewBox of `target`."""
        move = f"translate({_length(place, 'x')},{_length(place, 'y')})"
        box = _numbers(target.get("viewBox", ""))
        if len(box) != 4 or min(box[2:]) <= 0.0:
            return move
        size = [
            _length(sized, name, _length(target, name, None if self.window is None else self.window[axis]))
            for axis, name in enumerate(("width", "height"))
        ]
        if size[0] is None or size[1] is None:
            raise InputError("it shows a viewBox in a window without a size", "Unlink the clone", _tag(place))
        ratio = [size[0] / box[2], size[1] / box[3]]
        fit = target.get("preserveAspectRatio", "xMidYMid meet").split()
        shift = [0.0, 0.0]
        if fit and fit[0] != "none":
            one = max(ratio) if fit[-1] == "slice" else min(ratio)
            for axis, letter in enumerate("xY"):
                part = {"Min": 0.0, "Mid": 0.5, "Max": 1.0}.get(fit[0].partition(letter)[2][:3], 0.5)
                shift[axis] = part * (size[axis] - one * box[2 + axis])  # type: ignore[operator]
            ratio = [one, one]
        return f"{move} translate({shift[0]},{shift[1]}) scale({ratio[0]},{ratio[1]}) translate({-box[0]},{-box[1]})"


def _group(transform: str, like: Element | None = None) -> Element:
    """A group with a transform, and the names of another."""
    group = Element("{http://www.w3.org/2000/svg}g", {"transform": transform} if transform else {})
    for name in ("id", LABEL):
        if like is not None and like.get(name):
            group.set(name, like.get(name, ""))
    return group


def _hidden(tag: str, own: _Style, state: _Style) -> str:
    """Why an element is not shown; empty where it is."""
    if own.get("display") == "none":
        return "display: none"
    if _nothing(own.get("opacity", "1")):
        return "opacity: 0"
    if tag not in _SHAPES:
        return ""
    if state["visibility"] in ("hidden", "collapse"):
        return f"visibility: {state['visibility']}"
    unpainted = (
        state[paint] in ("none", "transparent") or _nothing(state[f"{paint}-opacity"]) for paint in ("fill", "stroke")
    )
    return "neither filled nor stroked" if all(unpainted) else ""


def _nothing(opacity: str) -> bool:
    try:
        return float(opacity.strip().removesuffix("%")) <= 0.0
    except ValueError:
        return False


def _length(element: Element, name: str, otherwise: float | None = 0.0) -> float | None:
    """A length of an element in user units; `otherwise` where it gives none, or a share of its window."""
    text = element.get(name, "")
    found = _LENGTH.fullmatch(text)
    return float(found[1]) * _PIXELS[found[2]] if found else otherwise


def _numbers(text: str) -> list[float]:
    return [float(number) for number in text.replace(",", " ").split()]


def _box(root: Element) -> tuple[float, float] | None:
    """The size of the window in user units, where it is stated."""
    box = _numbers(root.get("viewBox", ""))
    if len(box) == 4:
        return box[2], box[3]
    width, height = _length(root, "width", None), _length(root, "height", None)
    return None if width is None or height is None else (width, height)


def _styles(above: dict[Element, Element | None], drawing: Drawing) -> dict[Element, _Style]:
    """What is said of every element itself: by attributes, style sheets and its `style`, the later first."""
    rules = _rules("\n".join(element.text or "" for element in above if _tag(element) == "style"), drawing)
    if len(rules) * len(above) > _MOST_MATCHES:
        raise InputError("it has too many rules of style", "Save it as plain SVG")
    styles = {}
    for element in above:
        own = {name: element.get(name, "").strip() for name in _PROPERTIES if name in element.attrib}
        for selector, said in rules:
            if _matches(selector, element, above):
                own |= said
        own |= _declared(element.get("style", ""))
        if own:
            styles[element] = own
    return styles


def _rules(text: str, drawing: Drawing) -> list[tuple[_Selector, _Style]]:
    """Rules of a style sheet that concern what is shown, the weakest first."""
    found: list[tuple[tuple[int, int, int], _Selector, _Style]] = []
    rules, conditions = _blocks(without_comments(text))
    for condition in conditions:
        drawing.notes.append(f'the style of "{condition[:40]}" is ignored: it may hide or show shapes')
    for selectors, body in rules:
        said = _declared(body)
        for words in selectors.split(",") if said else ():
            parts = [_COMPOUND.fullmatch(word) for word in words.split()]
            if not parts or not all(parts):
                drawing.notes.append(f'the style of "{words.strip()[:40]}" is ignored: it may hide or show shapes')
                continue
            selector = [(part[1] or "*", re.findall(r"[.#][\w-]+", part[2])) for part in parts if part is not None]
            marks = [mark for _, these in selector for mark in these]
            ids = sum(mark.startswith("#") for mark in marks)
            found.append(((ids, len(marks) - ids, sum(tag != "*" for tag, _ in selector)), selector, said))
    return [(selector, said) for _, selector, said in sorted(found, key=lambda rule: rule[0])]


def _blocks(text: str) -> tuple[list[tuple[str, str]], list[str]]:
    """Selectors and declarations of the rules of a style sheet, and its rules that begin with @, which hold others."""
    rules, conditions, within, word = [], [], list[str](), ""
    for token in re.split("([{};])", text):
        if token == "{":
            within.append(word.strip())
            word = ""
        elif token == "}":
            if len(within) == 1 and not within[0].startswith("@"):
                rules.append((within[0], word))
            within, word = within[:-1], ""
        elif token == ";":
            word = f"{word};" if within else ""
        else:
            word += token
            if not within and word.strip().startswith("@"):
                conditions.append(word.strip())
    return rules, conditions


def _declared(text: str) -> _Style:
    """The properties that a style declares, of those that concern what is shown."""
    pairs = (item.partition(":") for item in text.split(";"))
    said = {name.strip().lower(): value.replace("!important", "").strip() for name, _, value in pairs}
    return {name: value for name, value in said.items() if name in _PROPERTIES and value}


def _matches(selector: _Selector, element: Element, above: dict[Element, Element | None]) -> bool:
    """Whether a selector of descendants is met by an element: its last part there, the others on the way up."""
    *before, last = selector
    if not _is(last, element):
        return False
    here = above[element]
    while before and here is not None:
        if _is(before[-1], here):
            before.pop()
        here = above[here]
    return not before


def _is(part: tuple[str, list[str]], element: Element) -> bool:
    tag, marks = part
    has = {f"#{element.get('id', '')}", *(f".{name}" for name in element.get("class", "").split())}
    return tag in ("*", _tag(element)) and has.issuperset(marks)
