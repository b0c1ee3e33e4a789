"""The result store: one SQLite file that holds every run, failed ones too, under the hash of what was run."""

from __future__ import annotations

import hashlib
import json
import sqlite3
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from harness.model.errors import InputError
from harness.model.result import Result

SCHEMA_VERSION = 1
_SCHEMA = """
CREATE TABLE IF NOT EXISTS run (
  key TEXT PRIMARY KEY, case_id TEXT NOT NULL, method TEXT NOT NULL, started TEXT NOT NULL,
  tolerance REAL NOT NULL, result TEXT NOT NULL);
CREATE TABLE IF NOT EXISTS comparison (
  number INTEGER PRIMARY KEY AUTOINCREMENT, created TEXT NOT NULL, content TEXT NOT NULL);
"""


def run_key(wall: str, method: str, settings: dict[str, Any], limits: dict[str, float], code: str) -> str:
    """Content hash that stands for one run: explicit wall, method, settings, limits and code version."""
    text = json.dumps([wall, method, settings, limits, code], sort_keys=True, allow_nan=False)
    return hashlib.sha256(text.encode()).hexdigest()[:32]


class Store:
    """An open result store. Every finished run is committed at once, so that killing the process loses none."""

    def __init__(self, path: Path) -> None:
        path.parent.mkdir(parents=True, exist_ok=True)
        self.path = path
        try:
            self._connection = sqlite3.connect(path, timeout=60.0)
            version = self._connection.execute("PRAGMA user_version").fetchone()[0]
            if version not in (0, SCHEMA_VERSION):
                raise InputError(
                    f"it is a store of version {version}",
                    f"This release writes version {SCHEMA_VERSION}: name another file with --store",
                    source=str(path),
                )
            self._connection.execute("PRAGMA journal_mode=WAL")
            self._connection.executescript(_SCHEMA)
            self._connection.execute(f"PRAGMA user_version = {SCHEMA_VERSION}")
            self._connection.commit()
        except sqlite3.DatabaseError as error:
            raise InputError(
                f"it is not a result store ({error})", "Name another file with --store", source=str(path)
            ) from None

    def get(self, key: str) -> tuple[Result, float] | None:
        """The result stored under a key with the tolerance of its method, or None."""
        row = self._connection.execute("SELECT result, tolerance FROM run WHERE key = ?", (key,)).fetchone()
        return None if row is None else (Result.model_validate_json(row[0]), float(row[1]))

    def put(self, key: str, result: Result, tolerance: float) -> None:
        """Store a result, in place of any under the same key."""
        with self._connection:
            self._connection.execute(
                "INSERT OR REPLACE INTO run (key, case_id, method, started, tolerance, result) "
                "VALUES (?, ?, ?, ?, ?, ?)",
                (key, result.case, result.method, result.started, tolerance, result.model_dump_json()),
            )

    def remember(self, created: str, content: dict[str, Any]) -> None:
        """Store what a comparison consisted of, so that its report can be built again."""
        with self._connection:
            self._connection.execute(
                "INSERT INTO comparison (created, content) VALUES (?, ?)",
                (created, json.dumps(content, allow_nan=False)),
            )

    def last_comparison(self) -> dict[str, Any] | None:
        """The content of the comparison made last, or None."""
        row = self._connection.execute("SELECT content FROM comparison ORDER BY number DESC LIMIT 1").fetchone()
        if row is None:
            return None
        content: dict[str, Any] = json.loads(row[0])
        return content

    def close(self) -> None:
        """Close the file."""
        self._connection.close()


@contextmanager
def open_store(path: Path) -> Iterator[Store]:
    """A store that is closed at the end.

    Raises:
        InputError: the file is no store, or one of another version.
    """
    store = Store(path)
    try:
        yield store
    finally:
        store.close()
