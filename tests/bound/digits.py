"""Documents with one digit changed, which certificates must refuse or survive truly."""

from __future__ import annotations

import json
import re
from fractions import Fraction
from typing import Any

from hypothesis import reject
from hypothesis import strategies as st

from methods.proof.verify.checker import verify
from methods.proof.verify.document import digest
from methods.proof.verify.exact_wall import CertificateError


def one_digit_changed(data: st.DataObject, document: Any) -> Any:
    """The document with one digit changed anywhere; an example is dropped where it is no JSON any more."""
    text = json.dumps(document)
    found = re.compile(r"[0-9]").search(text, data.draw(st.integers(0, len(text) - 1)))  # a list of all is long
    where = found.start() if found else reject()
    digit = data.draw(st.sampled_from([d for d in "0123456789" if d != text[where]]))
    try:
        return json.loads(text[:where] + digit + text[where + 1 :])
    except json.JSONDecodeError:
        reject()


def refused_or_true(least: Fraction, document: dict[str, Any]) -> bool:
    """Whether a document, its digest made anew, is refused; what it proves otherwise must be true of this minimum."""
    try:
        lower, upper = verify(document | {"digest": digest(document)})
    except CertificateError:
        return True
    assert lower <= least <= upper
    return False
