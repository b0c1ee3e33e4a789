"""Numbers of certificates at the ends of what may stand there, and how they are put together."""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction
from typing import Any

import numpy as np
import pytest

from methods.proof.same_wall import load_sizes
from methods.proof.verify.exact_wall import (
    MOST_BITS,
    MOST_DIGITS,
    CertificateError,
    common_denominator,
    contacts,
    fractions_of,
    integers,
    number,
    paired,
    whole,
    whole_numbers,
)

HALF, THIRD = Fraction(1, 2), Fraction(1, 3)
WITHIN: dict[str, tuple[Callable[[], Any], Any]] = {
    "digits": (lambda: number("9" * MOST_DIGITS), Fraction("9" * MOST_DIGITS)),
    "digits below": (lambda: number("-1/" + "9" * MOST_DIGITS), Fraction("-1/" + "9" * MOST_DIGITS)),
    "a whole number": (lambda: number(-7), Fraction(-7)),
    "ends": (lambda: [whole(k, -2, 3) for k in (-2, 3)], [-2, 3]),
    "bits": (lambda: whole_numbers([2 ** (3 * MOST_DIGITS) - 1], 1), [2 ** (3 * MOST_DIGITS) - 1]),
    "contacts": (lambda: contacts([0, 7], 2), frozenset([0, 7])),
    "pairs": (lambda: paired("ab", [1, 2]), [("a", 1), ("b", 2)]),
    "fractions": (lambda: fractions_of(["1/2", 3], 2), [HALF, Fraction(3)]),
    "denominators": (lambda: common_denominator([HALF, Fraction(1, 6), Fraction(1, 4)]), 12),
    "least denominators": (lambda: [common_denominator(v) for v in ([], [THIRD], [Fraction(5)])], [1, 3, 1]),
    "many bits": (lambda: common_denominator([Fraction(1, 2 ** (MOST_BITS - 1))]), 2 ** (MOST_BITS - 1)),
    "forms": (lambda: integers([{0: HALF, 5: Fraction(0)}, {3: -THIRD}]), ([{0: 3}, {3: -2}], 6)),
}
BEYOND: dict[str, Callable[[], Any]] = {
    "digits": lambda: number("1" + "0" * MOST_DIGITS),
    "digits below": lambda: number("1/1" + "0" * MOST_DIGITS),
    "below": lambda: whole(-3, -2, 3),
    "above": lambda: whole(4, -2, 3),
    "true": lambda: whole(True, 0, 3),
    "bits": lambda: whole_numbers([2 ** (3 * MOST_DIGITS)], 1),
    "one true of whole numbers": lambda: whole_numbers([1, True], 2),
    "one whole number less": lambda: whole_numbers([1], 2),
    "contact after the last": lambda: contacts([8], 2),
    "contact before the first": lambda: contacts([-1], 2),
    "one less": lambda: paired("ab", [1]),
    "text as a list": lambda: paired("ab", "ab"),
    "one fraction more": lambda: fractions_of(["1/2", 3], 1),
    "many bits": lambda: common_denominator([Fraction(1, 2**MOST_BITS)]),
}


@pytest.mark.parametrize("name", WITHIN)
def test_what_may_stand_there_is_read(name: str) -> None:
    read, value = WITHIN[name]
    assert read() == value


@pytest.mark.parametrize("name", BEYOND)
def test_what_is_beyond_is_refused(name: str) -> None:
    with pytest.raises(CertificateError):
        BEYOND[name]()


def test_how_many_digits_a_number_may_have_is_said_in_the_refusal():
    for name, words in (("digits", "at most 1000 digits"), ("bits", "more than 3000 bits")):
        with pytest.raises(CertificateError, match=words):
            BEYOND[name]()
    with pytest.raises(CertificateError, match="more than 20,000 bits"):
        BEYOND["many bits"]()


def test_a_moment_is_measured_by_the_forces_at_the_farthest_vertex():
    """A moment of 10 on a block whose farthest vertex is .5 away is that of a force of 20 there, above 3 and 4."""
    assert load_sizes(np.array([3.0, -4.0, 10.0]), 0.5).tolist() == [20.0, 20.0, 10.0]
    assert load_sizes(np.array([3.0, -4.0, 1.0]), 0.5).tolist() == [4.0, 4.0, 2.0]
