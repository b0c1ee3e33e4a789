"""Certificates of small walls, and the checker's word about what is false in one."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from drystone.certificates import PACKED, read_certificate
from harness.model.case import shipped_cases
from methods.proof.verify.checker import verify
from methods.proof.verify.document import digest
from methods.proof.verify.exact_wall import CertificateError

DATA = Path(__file__).parents[1] / "data" / "certificates"


def tree() -> dict[str, Any]:
    """Of a block on two joints of friction 4/5 and 1/5, which slides at 1/5."""
    document: dict[str, Any] = read_certificate(shipped_cases() / "two-frictions" / "certificate.json")
    return document


def windows() -> dict[str, Any]:
    """Of a block on an incline."""
    document: dict[str, Any] = read_certificate(shipped_cases() / "incline-up" / ("certificate.json" + PACKED))
    return document


def refused(document: dict[str, Any]) -> str:
    with pytest.raises(CertificateError) as raised:
        verify(document | {"digest": digest(document)})
    return str(raised.value)
