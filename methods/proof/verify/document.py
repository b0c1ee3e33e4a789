"""A certificate as a document: its bytes, unpacked and read within limits, and its digest."""

from __future__ import annotations

import hashlib
import json
import re
import zlib
from typing import Any

from methods.proof.verify.exact_wall import MOST_DIGITS, CertificateError

FORMAT = "drystone-bound/1"
MOST_BYTES = 256 * 2**20
"""Of a certificate, unpacked: some 450 windows of 49 interfaces."""
MOST_VALUES = 32_000_000
"""Numbers, texts, lists and objects of a certificate: what it holds takes about 60 bytes each when it is read."""
MOST_OBJECTS = 100_000
"""Of a certificate: blocks, interfaces, leaves and steps. An object takes four times what another value does."""
MOST_NESTED = 400
"""Levels of a certificate: a division of states has two."""
_LONG = re.compile(rb"[0-9]{%d}" % (MOST_DIGITS + 1))
_GZIP = b"\x1f\x8b"


def unpacked(content: bytes) -> bytes:
    """The text of a certificate from the bytes of its file, which may be compressed, within limits.

    Raises:
        CertificateError: it is cut short, or is too much to be checked: nothing of it is read then.
    """
    if content.startswith(_GZIP):
        unpacker = zlib.decompressobj(wbits=zlib.MAX_WBITS | 16)
        try:
            content = unpacker.decompress(content, MOST_BYTES + 1)
        except zlib.error as error:
            raise CertificateError(f"it cannot be unpacked ({error})") from None
        if not unpacker.eof and len(content) <= MOST_BYTES:
            raise CertificateError("it is cut short")
        if unpacker.unused_data:
            raise CertificateError("something follows the end of what is packed in it")
    if len(content) > MOST_BYTES:
        raise CertificateError(f"it has more than {MOST_BYTES:,} bytes, unpacked")
    if _values(content) > MOST_VALUES:
        raise CertificateError(f"it has more than {MOST_VALUES:,} values")
    if content.count(b"{") > MOST_OBJECTS:
        raise CertificateError(f"it has more than {MOST_OBJECTS:,} objects")
    if _LONG.search(content):
        raise CertificateError(f"it has a number of more than {MOST_DIGITS} digits")
    return content


def read(content: bytes) -> Any:
    """A certificate from the bytes of its file, with the standard library alone.

    Raises:
        CertificateError: it is too much to be checked, no JSON, or gives a name twice.
    """

    def unique(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
        if len(dict(pairs)) != len(pairs):
            raise CertificateError("a name is given twice in one object")
        return dict(pairs)

    try:
        return json.loads(unpacked(content), object_pairs_hook=unique)
    except CertificateError:
        raise
    except (ValueError, RecursionError) as error:
        raise CertificateError(f"it is not readable JSON ({error})") from None


def written(document: dict[str, Any]) -> str:
    """The text of a certificate: on a line where it is of windows, which hold long lists of numbers."""
    return json.dumps(document, indent=None if "windows" in document else 1)


def share_of_largest(text: str) -> float:
    """How much of the largest certificate that is checked this text of one, or of a part of one, takes."""
    content = text.encode()
    return max(len(content) / MOST_BYTES, _values(content) / MOST_VALUES, content.count(b"{") / MOST_OBJECTS)


def _values(content: bytes) -> int:
    return 1 + sum(content.count(sign) for sign in (b",", b"[", b"{"))


def digest(document: Any) -> str:
    """SHA-256 of all that a certificate holds but the digest itself: it shows accidents, the fractions show errors."""
    content = {name: value for name, value in document.items() if name != "digest"}
    return hashlib.sha256(json.dumps(content, sort_keys=True).encode()).hexdigest()
