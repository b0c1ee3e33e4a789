"""Multipliers of certificates in words."""

from __future__ import annotations

from fractions import Fraction

SHORT, SHOWN = 9, 40
"""Characters of a fraction up to which a sentence shows it alone, and beside its value."""


def in_words(value: Fraction) -> str:
    """A multiplier as a fraction where that is short, else as a decimal: all of it, or cut off after nine decimals.

    >>> in_words(Fraction(7, 11)), in_words(Fraction(499999, 1250000))
    ('7/11', '0.3999992')
    >>> in_words(Fraction(1567589759, 2809311829))
    '0.557997778 (1567589759/2809311829)'
    """
    if len(str(value)) <= SHORT:
        return str(value)
    exact = next((places for places in (9, 12) if 10**places % value.denominator == 0), None)
    places = 9 if exact is None else exact
    whole, part = divmod(value.numerator * 10**places // value.denominator, 10**places)
    decimal = f"{whole}.{part:0{places}d}".rstrip("0")
    return f"{decimal} ({value})" if exact is None and len(str(value)) <= SHOWN else decimal
