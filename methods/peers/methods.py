"""The peers: solvers of other people as methods, a row each; naming them imports none of their packages."""

from __future__ import annotations
