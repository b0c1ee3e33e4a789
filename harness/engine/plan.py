"""Which runs a comparison needs: every case with every method, and the settings that references ask for."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import replace
from pathlib import Path
from typing import Any

from harness.engine.run import Limits, Run
from harness.model.case import Case, case_folders, case_of_wall, id_of, read_case, shipped_cases
from harness.model.errors import InputError, did_you_mean, in_file, of_those_there
from harness.model.json_text import MOST_SHOWN
from harness.model.library import library
from harness.model.method import Method
from harness.model.method_registry import check_takes, listed_methods, load_method, method_names
from harness.model.reading import DRAWINGS


def plan_case(
    case: Case,
    methods: Sequence[str] | None,
    limits: Limits | None,
    settings: Mapping[str, dict[str, Any]] | None = None,
) -> list[Run]:
    """The runs of one case: each method with the settings chosen first, then those references ask settings for.

    Args:
        case: the case.
        methods: names given by the user, or None for the case's own choice.
        limits: of each run; None: none, in this process.
        settings: of methods by name, where they are not the defaults; references to other settings do not apply.
    """
    references = [item for item in case.file.references if item.tier == "quick"]
    if methods is None:
        asked = {method for item in references if item.gate for method in item.applies_to}
        base = case.file.methods if case.file.methods is not None else library().methods.compare
        check_methods(base, f'methods of case "{case.id}"')
        installed = method_names()
        methods = [*base, *sorted(name for name in asked if name not in base and name in installed)]
    runs: list[Run] = []
    for method in methods:
        mine = [item for item in references if method in item.applies_to]
        chosen = dict((settings or {}).get(method, {}))
        runs.append(Run(case, method, chosen, limits, tuple(item for item in mine if item.settings == chosen)))
        for item in mine:
            if item.settings and item.gate and not chosen:
                runs.append(Run(case, method, dict(item.settings), limits, (item,)))
    return runs


def check_methods(names: Sequence[str], element: str = "--methods") -> None:
    """Refuse a method that there is not; `element` is what named it.

    Raises:
        InputError: naming it and those there are.
    """
    known = method_names()
    for name in names:
        if name not in known:
            raise InputError(
                f'no method is called "{name[:MOST_SHOWN]}"', of_those_there(name, listed_methods()), element
            )


def check_taken(method: Method, case: Case, option: str = "") -> None:
    """Refuse a wall with joints, bars or supports that a method which is asked by name does not take.

    Args:
        method: asked; case: the wall; option: that names methods, where one was not given perhaps.

    Raises:
        InputError: naming the file, what is not taken, and the methods that take it.
    """
    try:
        with in_file(case.origin):
            check_takes(method, case.assembly)
    except InputError as error:
        able = takers(case, listed_methods()) if option else []
        error.remedy += f". The wall as it is: {option} {able[0]}" if able else ""
        raise


def takers(case: Case, names: Sequence[str]) -> list[str]:
    """Those of some methods that take a wall."""
    found = []
    for name in names:
        with suppress(InputError):  # one that cannot be loaded takes nothing
            check_takes(load_method(name), case.assembly)
            found.append(name)
    return found


def find_cases(
    words: Sequence[str], suite: str | None, folders: Sequence[Path], otherwise: str = "small"
) -> list[Case]:
    """The cases a user names: ids, wall files, case folders, or a whole suite.

    Args:
        words: ids of cases or paths.
        suite: name of a suite, "all" for every case.
        folders: further folders of cases besides those shipped; with no words and no suite, their cases are meant.
        otherwise: the suite that is meant with none of these.

    Raises:
        InputError: an unknown id or suite, or a file that cannot be read.
    """
    library = case_folders([shipped_cases(), *folders])
    if words and suite:
        raise InputError("cases and a suite are given", "Give one or the other", "compare")
    if words:
        found = [_find_case(word, library) for word in dict.fromkeys(words)]
        return _with_own_names(list({Path(case.origin).resolve(): case for case in reversed(found)}.values())[::-1])
    cases = [read_case(folder) for folder in library.values()]
    own = {path.resolve() for path in folders}
    wanted = suite or ("" if folders else otherwise)
    chosen = [
        case
        for case in cases
        if wanted == "all"
        or wanted in case.file.suites
        or (not wanted and Path(case.origin).parent.parent.resolve() in own)
    ]
    if not chosen:
        suites = sorted({name for case in cases for name in case.file.suites})
        there = f"Suites: all, {', '.join(suites)}"
        raise InputError(
            f'no case is in a suite "{wanted}"', f"{did_you_mean(wanted, suites)} {there}".strip(), "--suite"
        )
    return chosen


def _find_case(word: str, library: dict[str, Path]) -> Case:
    path = Path(word)
    if word in library:
        case = read_case(library[word])
        beside = [place for place in (path.with_name(f"{path.name}.json"), path / "case.toml") if place.is_file()]
        if not beside or beside[0].resolve().is_relative_to(library[word].resolve()):
            return case
        here = f"./{beside[0] if beside[0].suffix == '.json' else path}"
        return replace(case, notes=(f'"{word}" is the case of the library, not the file here: use {here}',))
    if path.is_dir():
        return read_case(path)
    if path.exists() or path.suffix.lower() in (".json", *DRAWINGS):
        return case_of_wall(path)
    lists = "`drystone list cases` shows the cases; name your own wall by its file, WALL.json"
    raise InputError(
        f'no case is called "{word}", and there is no such file', f"{did_you_mean(word, library)} {lists}".strip()
    )


def _with_own_names(cases: list[Case]) -> list[Case]:
    """Cases under ids of their own: files of one name take those of their folders before it, as many as it needs."""
    named = cases
    most = max(len(Path(case.origin).resolve().parts) for case in cases)
    for depth in range(1, most):
        twice = {name for name, count in Counter(case.id for case in named).items() if count > 1}
        if not twice:
            return named
        named = [
            case.called(id_of("-".join([*Path(case.origin).resolve().parent.parts[-depth:], case.id])))
            if now.id in twice
            else now
            for case, now in zip(cases, named, strict=True)
        ]
    seen: Counter[str] = Counter()
    numbered = []
    for case in named:
        seen[case.id] += 1
        numbered.append(case if seen[case.id] == 1 else case.called(f"{case.id}-{seen[case.id]}"))
    return numbered
