"""Holds: keep a load, let the wall settle, and say whether it is held or moves; the bracket that they lead to."""
