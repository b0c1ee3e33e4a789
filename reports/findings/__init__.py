"""Findings: what results have in common, where they differ and why."""
