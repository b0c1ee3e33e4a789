"""Settings of the peers."""

from __future__ import annotations
