"""The result store: one SQLite file that holds every run, failed ones too, under the hash of what was run."""

from __future__ import annotations

import json
import shutil
import sqlite3
import stat
import tempfile
import time
import zlib
from collections.abc import Collection, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from harness.engine.store_faults import OTHER_FILE, WAIT_SECONDS, cause
from harness.engine.store_seal import DAMAGE, digest_of, environment_of, opened, sealed, unpacked
from harness.model.errors import InputError
from harness.model.json_text import LARGEST_FILE, MOST_NESTED, json_of, near, nested_deeper
from harness.model.result import Result

SCHEMA_VERSION = 2
COLUMNS = {
    "run": (
        *("key", "case_id", "method", "started", "tolerance", "result"),
        *("status", "finding", "multiplier", "cpu_seconds", "environment", "fields"),
    ),
    "environment": ("id", "content"),
    "comparison": ("number", "created", "content"),
}
"""The tables of a store and their columns, in order."""
TABLE = ("key", "case_id", "method", "started", "status", "finding", "multiplier", "cpu_seconds")
"""Columns of a run to filter and count by."""
_SCHEMA = (
    "CREATE TABLE IF NOT EXISTS run (key TEXT PRIMARY KEY, case_id TEXT NOT NULL, method TEXT NOT NULL, "
    "started TEXT NOT NULL, tolerance REAL NOT NULL, result TEXT NOT NULL, status TEXT, finding TEXT, multiplier REAL, "
    "cpu_seconds REAL, environment TEXT, fields BLOB)",
    "CREATE TABLE IF NOT EXISTS environment (id TEXT PRIMARY KEY, content TEXT NOT NULL)",
    "CREATE TABLE IF NOT EXISTS comparison (number INTEGER PRIMARY KEY AUTOINCREMENT, created TEXT NOT NULL, "
    "content TEXT NOT NULL)",
    f"PRAGMA user_version = {SCHEMA_VERSION}",
)
_FROM_VERSION_1 = (
    *(
        f"ALTER TABLE run ADD COLUMN {column}"
        for column in (
            *("status TEXT", "finding TEXT", "multiplier REAL", "cpu_seconds REAL", "environment TEXT", "fields BLOB"),
        )
    ),
    *(
        f"UPDATE run SET {name} = json_extract(result, '$.{name}') WHERE json_valid(result)"
        for name in ("status", "finding", "multiplier", "cpu_seconds")
    ),
)
"""Brings a store of version 1 up to date; its results keep fields and environment inside `result`."""
_FIELDS = ("forces", "mechanism", "states", "path", "details")
"""Parts of a result that are kept compressed beside it; they are most of its size."""
_ENVIRONMENT = ("versions", "machine", "traits", "limits")
"""Parts of a result that many runs share, kept once: limits and traits in each of 100,000 rows of 21 bricks made the
file 210 MB instead of 140, as two of them filled a page instead of three."""
_SOME_KEYS = 500
"""Up to so many results are looked for one by one; above, the whole table is read."""


class Store:
    """An open result store. Every finished run is committed at once, so that killing the process loses none.

    A run is one row: a few columns to filter and count by, the result as JSON text without its `_FIELDS` and
    `_ENVIRONMENT`, the fields compressed beside it, and the environment once for all runs that share it.

    Args:
        path: the file; made if there is none, unless it is only read.
        read_only: nothing is written, not even beside the file: a store on a read-only disk can be read.

    Raises:
        InputError: the file is not there to be read, is no store, damaged, of another version, locked, or cannot be
            opened, with the cause.
    """

    def __init__(self, path: Path, *, read_only: bool = False) -> None:
        self.path = path
        self._copy: tempfile.TemporaryDirectory[str] | None = None
        self._connection: sqlite3.Connection | None = None
        if read_only and not path.exists():
            raise InputError("there is no such file", near(path) or OTHER_FILE, source=str(path))
        if not read_only:
            _make_folder(path)
        if path.exists() and not stat.S_ISREG(path.stat().st_mode):
            raise InputError("it is not a regular file", OTHER_FILE, source=str(path))
        try:
            with self._faults_named():
                self._connection = self._open_to_read() if read_only else _connect(path)
                self._check(self._connection, read_only)
                if not read_only:
                    _prepare(self._connection)
        except BaseException:
            self.close()
            raise

    def _open_to_read(self) -> sqlite3.Connection:
        """A connection that writes nothing.

        A store whose folder is read-only has no room for the index of its log. Without a log it is read as it is; with
        one, which a killed run left, through a copy of both.
        """
        connection = _connect(self.path, "?mode=ro")
        try:
            connection.execute("SELECT name FROM sqlite_master").fetchall()
            return connection
        except sqlite3.OperationalError:
            connection.close()
        log = self.path.with_name(self.path.name + "-wal")
        if not log.exists() or not log.stat().st_size:
            return _connect(self.path, "?mode=ro&immutable=1")
        self._copy = tempfile.TemporaryDirectory(prefix="drystone-store-")
        copied = Path(self._copy.name) / self.path.name
        shutil.copyfile(self.path, copied)
        shutil.copyfile(log, Path(self._copy.name) / log.name)
        return _connect(copied)

    def _check(self, connection: sqlite3.Connection, read_only: bool) -> None:
        """Refuse what another program, or a later release, wrote."""
        version = connection.execute("PRAGMA user_version").fetchone()[0]
        if version == 1 and read_only:
            raise InputError(
                "it is a store of version 1",
                f"Any command that writes it, as `drystone compare`, brings it to version {SCHEMA_VERSION}",
                source=str(self.path),
            )
        if version not in (0, 1, SCHEMA_VERSION):
            raise InputError(
                f"it is a store of version {version}",
                f"This release reads and writes version {SCHEMA_VERSION}: name another",
                source=str(self.path),
            )
        names = [row[0] for row in connection.execute("SELECT name FROM sqlite_master WHERE type = 'table'")]
        tables = [name for name in names if not name.startswith("sqlite_")]
        for table in tables:
            columns = tuple(row[1] for row in connection.execute("SELECT * FROM pragma_table_info(?)", (table,)))
            expected = COLUMNS.get(table, columns)
            if version == 1 and table == "run":
                expected = expected[:6]
            if columns != expected or (version == 0 and table not in COLUMNS):
                raise InputError(
                    f'it is not a result store: its table "{table}" is another program\'s',
                    OTHER_FILE,
                    source=str(self.path),
                )
        missing = [table for table in COLUMNS if table not in tables]
        if read_only and not tables:
            raise InputError("it is empty", OTHER_FILE, source=str(self.path))
        if version == SCHEMA_VERSION and missing:
            raise InputError(f'it is damaged: it has no table "{missing[0]}"', OTHER_FILE, source=str(self.path))

    @property
    def _open(self) -> sqlite3.Connection:
        assert self._connection is not None
        return self._connection

    @contextmanager
    def _faults_named(self) -> Iterator[None]:
        """Turn an error of the database into a sentence with its true cause."""
        try:
            yield
        except sqlite3.Error as error:
            problem, remedy = cause(error, self.path)
            raise InputError(problem, remedy, source=str(self.path)) from None
        except UnicodeDecodeError:  # of a name in the schema, or of an error that quotes one
            raise InputError("it is damaged (a name in it is no text)", OTHER_FILE, source=str(self.path)) from None

    def damaged(self, element: str, error: Exception) -> InputError:
        """The fault of something in it that another hand has changed."""
        reason = str(error).splitlines()[0] if str(error) else type(error).__name__
        return InputError(
            f"it is damaged ({reason})", f"Repeat the run with --fresh; the rest is whole. {OTHER_FILE}, or that",
            element, str(self.path),
        )  # fmt: skip

    def get(self, key: str) -> tuple[Result, float] | None:
        """The result stored under a key with the tolerance of its method, or None.

        Raises:
            InputError: the store or what it holds under the key is damaged.
        """
        with self._faults_named():
            query = (
                "SELECT method, case_id, length(result), result, tolerance, run.environment, environment.content, "
                "fields FROM run LEFT JOIN environment ON environment.id = run.environment WHERE key = ?"
            )
            row = self._open.execute(query, (key,)).fetchone()
        if row is None:
            return None
        method, case, size, text, tolerance, shared, environment, fields = row
        element = f"the result of {method} on {case} in it"
        try:
            if size > LARGEST_FILE:
                raise ValueError(f"{size:,} characters")
            text = opened(text, (key, method, case, tolerance, shared), fields or b"")
            whole = json.loads(text) | environment_of(shared, environment) | unpacked(fields)
            if nested_deeper(whole, MOST_NESTED):
                raise ValueError(f"it is nested more than {MOST_NESTED} deep")
            return Result.model_validate(whole, strict=False), float(tolerance)
        except DAMAGE as error:
            raise self.damaged(element, error) from None

    def missing(self, element: str) -> InputError:
        """The fault of a result that ought to be here: an index of the file is damaged, or the run was taken out."""
        with self._faults_named():
            verdict = str(self._open.execute("PRAGMA integrity_check(1)").fetchone()[0])
        if verdict != "ok":
            problem, remedy = cause(sqlite3.DatabaseError(f"malformed: {verdict}"), self.path)
            return InputError(problem, remedy, element, str(self.path))
        return InputError("it is not in it any more", "Run the comparison again", element, str(self.path))

    def put(self, key: str, result: Result, tolerance: float) -> None:
        """Store a result, in place of any under the same key.

        Raises:
            InputError: the store cannot be written, with the cause.
        """
        data = result.model_dump(mode="json")
        fields = {name: data.pop(name) for name in _FIELDS}
        shared = json.dumps({name: data.pop(name) for name in _ENVIRONMENT}, sort_keys=True)
        environment = digest_of(shared)[:16]
        packed = zlib.compress(json.dumps(fields, separators=(",", ":")).encode())
        text = json.dumps(data, ensure_ascii=False, allow_nan=False, separators=(",", ":"))
        with self._faults_named(), self._open:
            self._open.execute("INSERT OR IGNORE INTO environment (id, content) VALUES (?, ?)", (environment, shared))
            self._open.execute(
                f"INSERT OR REPLACE INTO run ({', '.join(COLUMNS['run'])}) VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)",
                (
                    *(key, result.case, result.method, result.started, tolerance),
                    sealed(text, (key, result.method, result.case, tolerance, environment), packed),
                    *(str(result.status), str(result.finding), result.multiplier, result.cpu_seconds, environment),
                    packed,
                ),
            )

    def summaries(self, keys: Collection[str]) -> dict[str, dict[str, Any]]:
        """Results under keys as JSON values, without `_FIELDS`; keys that are not there left out.

        Raises:
            InputError: the store or one of the results is damaged.
        """
        found: dict[str, dict[str, Any]] = {}
        environments: dict[str, dict[str, Any]] = {}
        with self._faults_named():
            some = sorted(keys) if len(keys) <= _SOME_KEYS else None
            query = (
                "SELECT key, method, case_id, tolerance, result, run.environment, environment.content "
                "FROM run LEFT JOIN environment ON environment.id = run.environment"
            )
            marks = f" WHERE key IN ({', '.join('?' * len(some))})" if some is not None else ""
            for key, method, case, tolerance, text, shared, content in self._open.execute(query + marks, some or ()):
                if key not in keys:
                    continue
                try:
                    if shared not in environments:
                        environments[shared] = environment_of(shared, content)
                    whole = opened(text, (key, method, case, tolerance, shared))
                    found[key] = json.loads(whole) | environments[shared]
                    if whole == text:  # without a seal: the word of a judge that is kept with it may be anybody's
                        found[key].pop("judge", None)
                except (ValueError, TypeError, RecursionError) as error:
                    raise self.damaged(f"the result of {method} on {case} in it", error) from None
        return found

    def table(self) -> list[tuple[str, str, str, str, str, str, float | None, float | None]]:
        """Key, case, method, start, status, finding, multiplier and CPU seconds of every run, as quick as can be."""
        with self._faults_named():
            return self._open.execute(f"SELECT {', '.join(TABLE)} FROM run").fetchall()

    def merge(self, other: Path) -> tuple[int, int]:
        """Take over the runs of another store that are not in this one; comparisons stay where they are.

        Returns:
            how many were taken over, and how many were here already.

        Raises:
            InputError: the other file is no store, or this one cannot be written.
        """
        with Store(other, read_only=True) as checked:
            count = len(checked.table())
        with self._faults_named():
            self._open.execute("ATTACH DATABASE ? AS other", (f"{other.absolute().as_uri()}?mode=ro",))
            try:
                with self._open:
                    self._open.execute("INSERT OR IGNORE INTO environment SELECT * FROM other.environment")
                    taken = self._open.execute("INSERT OR IGNORE INTO run SELECT * FROM other.run").rowcount
            finally:
                self._open.execute("DETACH DATABASE other")
        return taken, count - taken

    def __enter__(self) -> Store:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def remember(self, created: str, content: dict[str, Any]) -> None:
        """Store what a comparison consisted of, so that its report can be built again.

        Raises:
            InputError: the store cannot be written, with the cause.
        """
        with self._faults_named(), self._open:
            self._open.execute(
                "INSERT INTO comparison (created, content) VALUES (?, ?)",
                (created, sealed(json.dumps(content, allow_nan=False), (created,))),
            )

    def last_comparison(self) -> dict[str, Any] | None:
        """The content of the comparison made last, or None.

        Raises:
            InputError: the store or the comparison is damaged.
        """
        with self._faults_named():
            row = self._open.execute("SELECT content, created FROM comparison ORDER BY number DESC LIMIT 1").fetchone()
        if row is None:
            return None
        if not isinstance(row[0], str) or len(row[0]) > LARGEST_FILE:
            raise self.damaged("the last comparison in it", ValueError("it is no text of a usual size"))
        try:
            text = opened(row[0], (row[1],))
        except ValueError as error:
            raise self.damaged("the last comparison in it", error) from None
        content = json_of(text, f"{self.path}: the last comparison in it")
        if not isinstance(content, dict):
            raise self.damaged("the last comparison in it", ValueError("it is no object"))
        return content

    def close(self) -> None:
        """Close the file."""
        if self._connection is not None:
            self._connection.close()
        if self._copy is not None:
            self._copy.cleanup()


def _make_folder(path: Path) -> None:
    """Make the folder of a store. Raises InputError where one of its parents is a file."""
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
    except (FileExistsError, NotADirectoryError):
        raise InputError(f"{path.parent} is no folder", OTHER_FILE, source=str(path)) from None


def _connect(path: Path, how: str = "") -> sqlite3.Connection:
    connection = sqlite3.connect(path.absolute().as_uri() + how, timeout=WAIT_SECONDS, uri=True)
    # Damaged text is reported where it is understood, with the run it belongs to.
    connection.text_factory = lambda text: text.decode("utf-8", "replace")
    return connection


def _prepare(connection: sqlite3.Connection) -> None:
    """Make the tables in one transaction. The switch to a log does not wait for a lock by itself, so it is repeated."""
    deadline = time.monotonic() + WAIT_SECONDS
    while True:
        try:
            connection.execute("PRAGMA journal_mode=WAL")
            break
        except sqlite3.OperationalError as error:
            if "locked" not in str(error) or time.monotonic() > deadline:
                raise
            time.sleep(0.05)
    if connection.execute("PRAGMA user_version").fetchone()[0] != SCHEMA_VERSION:
        with connection:
            connection.execute("BEGIN IMMEDIATE")
            version = connection.execute("PRAGMA user_version").fetchone()[0]
            for statement in (*(_FROM_VERSION_1 if version == 1 else ()), *_SCHEMA):
                connection.execute(statement)


@contextmanager
def open_store(path: Path, *, read_only: bool = False) -> Iterator[Store]:
    """A store that is closed at the end.

    Args:
        path: the file.
        read_only: nothing is written, so that a store on a read-only disk can be read.

    Raises:
        InputError: the file is no store, damaged, of another version, or cannot be opened.
    """
    store = Store(path, read_only=read_only)
    try:
        yield store
    finally:
        store.close()
