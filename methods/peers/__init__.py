"""Peers: solvers and programs of other people as methods, each by its own package."""
