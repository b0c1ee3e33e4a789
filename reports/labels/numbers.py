"""Numbers as a reader wants them: sensible digits, units, a true minus sign; every digit stays in the hover text."""

from __future__ import annotations

import math

_SUPERSCRIPT = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")
NOTHING = "–"
_ROUNDING = 1e-12
"""Share of the size of what is added up below which a sum is zero: doubles leave 1e-16 a term."""


def plain(value: float, digits: int = 5, size: float = 0.0) -> str:
    """A number with so many significant digits and a true minus sign; powers of ten beyond 1e-4 and 1e6.

    Sums of terms of a given size are zero where no more than their rounding is left.
    """
    if not math.isfinite(value):
        return "not finite"
    if abs(value) <= _ROUNDING * size:
        return "0"
    if not 1e-4 <= abs(value) < 10.0 ** max(digits, 6):
        return power(value, max(1, digits - 2))
    exponent = int(f"{value:.{digits - 1}e}".split("e")[1])  # of the rounded value: 0.99996 is 1.000 in four digits
    decimals = max(0, digits - 1 - exponent)
    text = f"{value:.{decimals}f}"
    return text.replace("-", "−")


def given(value: float, digits: int = 6) -> str:
    """A number as a source gives it: at most so many digits, no zeros added."""
    if value != 0.0 and not 1e-4 <= abs(value) < 1e6:
        mantissa = f"{value:.{digits - 1}e}".split("e")[0].rstrip("0").rstrip(".")
        return power(value, max(1, len(mantissa.lstrip("-").replace(".", ""))))
    text = f"{value:.{digits}g}"
    return (f"{float(text):.0f}" if "e+" in text else text).replace("-", "−")


def quantity(value: float, unit: str, digits: int = 3) -> str:
    """A value with its unit; the number alone where walls have none, which is the unit "1"."""
    return given(value, digits) if unit == "1" else f"{given(value, digits)} {unit}"


def power(value: float, digits: int = 1) -> str:
    """A number as mantissa times a power of ten, e.g. 3×10⁻¹⁶."""
    if value == 0.0:
        return "0"
    if not math.isfinite(value):
        return "not finite"
    mantissa, exponent = f"{value:.{digits - 1}e}".split("e")
    head = "" if mantissa in ("1", "-1") else mantissa.replace("-", "−") + "×"
    sign = "−" if mantissa == "-1" else ""
    return f"{sign}{head}10{str(int(exponent)).translate(_SUPERSCRIPT)}"


def multiplier(value: float | None, known: int | None = None) -> str:
    """A multiplier with five significant digits, or those of its `known` decimals where these are fewer, or a dash."""
    if value is None:
        return NOTHING
    if known is None or value == 0.0 or not math.isfinite(value):
        return plain(value)
    return plain(value, max(1, min(5, known + 1 + math.floor(math.log10(abs(value))))))


def cosine(value: float | None) -> str:
    """A cosine of velocity fields, rounded down so that none but that of equal fields is printed as 1, or a dash."""
    return NOTHING if value is None else f"{math.floor(1e4 * value + 1e-9) / 1e4:.4f}".replace("-", "−")


def at_point(text: str) -> tuple[str, str] | None:
    """What stands before the decimal point, and the rest from the point on; None of anything but a plain number."""
    whole, point, rest = text.partition(".")
    if not whole.removeprefix("−").isdigit() or (point and not rest.isdigit()):
        return None
    return whole, point + rest


def interval(pair: tuple[float, float] | list[float] | None) -> str:
    """Both ends of a bracket, or a dash."""
    return NOTHING if pair is None else f"[{plain(pair[0])}, {plain(pair[1])}]"


def residual(value: float | None) -> str:
    """A relative residual as a power of ten, or a dash."""
    return NOTHING if value is None else power(value)


def seconds(value: float | None) -> str:
    """A time with two or three digits and its unit."""
    if value is None:
        return NOTHING
    if value < 0.9995e-3:
        return f"{value * 1e6:.0f} µs"
    if value < 0.9995:
        return f"{value * 1e3:.0f} ms"
    if value < 99.5:
        return f"{value:.3g} s"
    if value < 5970:
        return f"{value / 60:.3g} min"
    return f"{value / 3600:.3g} h"


def memory(value: int | float | None) -> str:
    """A memory size in MB or GB (powers of ten)."""
    if value is None:
        return NOTHING
    return f"{value / 1e9:.3g} GB" if value >= 1e9 else f"{value / 1e6:.0f} MB"


def percent(value: float | None, digits: int = 2) -> str:
    """A fraction as a signed percentage."""
    if value is None or not math.isfinite(value):
        return NOTHING
    text = f"{100.0 * value:+.{digits}f}"
    if float(text) == 0.0:
        text = f"{0.0:.{digits}f}"
    return text.replace("-", "−") + " %"


def every_digit(value: object) -> str:
    """A value with all of its digits, for hover texts."""
    if isinstance(value, float):
        return repr(value)
    if isinstance(value, list | tuple):
        return "[" + ", ".join(every_digit(item) for item in value) + "]"
    return str(value)


def count(number: int, noun: str) -> str:
    """A count with its noun, e.g. "1 case", "3 cases"."""
    plural = noun + ("es" if noun.endswith(("s", "x")) else "s")
    return f"{number} {noun if number == 1 else plural}"


def met(held: int, tested: int, noun: str, of: str = "") -> str:
    """How many of what was tested are met, e.g. "2 of 3 references are met"; `of` follows the noun, as " of theory"."""
    return f"{held} of {count(tested, noun)}{of} {'is' if 1 in (held, tested) else 'are'} met"


def labelled(name: str, unit: str) -> str:
    """The name of an axis or a column with its unit in brackets, if it has one."""
    return f"{name} [{unit}]" if unit else name
