"""Seals of what a store keeps: a text that another hand has changed is distinguished from one that is whole."""

from __future__ import annotations

import hashlib
import json
import re
import zlib
from typing import Any

from pydantic import ValidationError

from harness.model.json_text import LARGEST_FILE

_SEAL = re.compile(r',"seal":"([0-9a-f]{32})([0-9a-f]{32})"\}\Z')
"""End of a text that is kept: the digest of what lies beside it, and that of both. It tells an edit, not a forger."""


DAMAGE = (ValidationError, ValueError, TypeError, RecursionError, zlib.error)
"""What reading a result raises where another hand has changed it."""


_EDITED = "it was changed after it was stored: its digest is another"


def digest_of(text: str | bytes) -> str:
    """SHA-256 of a text or of bytes, in hexadecimal digits."""
    return hashlib.sha256(text if isinstance(text, bytes) else text.encode("utf-8", "replace")).hexdigest()


def sealed(text: str, row: tuple[Any, ...], fields: bytes = b"") -> str:
    """A JSON object as text with the digests of what lies beside it in its row, and of all."""
    beside = digest_of(fields)[:32]
    return f'{text[:-1]},"seal":"{beside}{digest_of(repr((row, beside, text)))[:32]}"}}'


def opened(text: Any, row: tuple[Any, ...], fields: bytes | None = None) -> str:
    """The text that was sealed. A text without a seal is of an earlier release.

    Args:
        text: as it is kept; row: what is beside it; fields: what is kept compressed beside it, where that is read too.

    Raises:
        ValueError: the text or what is beside it was changed since.
    """
    if not isinstance(text, str):
        raise ValueError("it is no text")
    seal = _SEAL.search(text)
    if seal is None:
        return text
    beside, all_of_it = seal.groups()
    whole = f"{text[: seal.start()]}}}"
    if digest_of(repr((row, beside, whole)))[:32] != all_of_it or (
        fields is not None and digest_of(fields)[:32] != beside
    ):
        raise ValueError(_EDITED)
    return whole


def environment_of(name: str | None, content: str | None) -> dict[str, Any]:
    """The environment that runs share, as JSON values. A run of an earlier release names none.

    Args:
        name: what the run calls it, of its digest; content: as it is kept, None where it is not.

    Raises:
        ValueError: it is not there, or was changed since.
    """
    if name is None:
        return {}
    if content is None:
        raise ValueError("the environment it was made in is not there any more")
    if digest_of(content)[:16] != name:
        raise ValueError(_EDITED)
    values: dict[str, Any] = json.loads(content)
    return values


def unpacked(fields: bytes | None) -> dict[str, Any]:
    """Compressed fields as JSON values.

    Raises:
        ValueError: they are larger than any wall's.
    """
    if fields is None:
        return {}
    unpacking = zlib.decompressobj()
    text = unpacking.decompress(fields, LARGEST_FILE)
    if unpacking.unconsumed_tail:
        raise ValueError(f"more than {LARGEST_FILE:,} characters")
    values: dict[str, Any] = json.loads(text)
    return values
