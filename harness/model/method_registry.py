"""Methods by name: those that are installed, and the programs of `methods.toml`; and which walls one takes."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager, suppress

import numpy as np

from harness.model.assembly import Assembly
from harness.model.errors import InputError, MissingPackage, first_few
from harness.model.foreign.program_method import ProgramMethod, method_of
from harness.model.foreign.register import program_named, programs
from harness.model.method import OF_COMMANDS, UNLISTED, Method, method_points


def check_takes(method: Method, assembly: Assembly) -> None:
    """Refuse a wall with joints or supports that a method does not take.

    Dilatancy and each strength of joints, ties and props are taken by methods whose traits say so; supports that move
    by those that find a reaction in place of a multiplier.

    Raises:
        InputError: the wall has such joints or supports.
    """
    law = assembly.law

    def between(joint: int) -> str:
        return " and ".join(assembly.block_ids[side[joint]] for side in (assembly.block_a, assembly.block_b))

    if assembly.dilates and not method.traits.any_dilatancy:
        joint = int(np.argmax(law.dilatancy))
        raise InputError(
            f"{method.name} takes no dilatancy; the joint between {between(joint)} has the dilatancy "
            f"{law.dilatancy[joint]:g}",
            f"Take a method that follows dilatancy ({_that_take(assembly)}), or leave it out",
        )
    if assembly.strong and not method.traits.any_strength:
        raise InputError(
            f"{method.name} takes dry joints only; that between {between(int(np.argmin(law.dry)))} has cohesion or "
            "tensile strength",
            f"Take a method that follows the strength of joints ({_that_take(assembly)}), or leave "
            "cohesion and tensile strength out",
        )
    if assembly.breaks and not method.traits.any_brittle:
        raise InputError(
            f"{method.name} takes joints that keep their strength; that between "
            f"{between(int(np.argmax(assembly.brittle)))} is brittle",
            f'Take a method that follows brittle joints ({_that_take(assembly)}), or leave out "after": "residual"',
        )
    if assembly.breaks and method.traits.brittle_alone and (assembly.dilates or assembly.crushes):
        besides = "dilatancy" if assembly.dilates else "compressive strength"
        raise InputError(
            f"{method.name} takes brittle joints without {besides}; that between "
            f"{between(int(np.argmax(assembly.brittle)))} is brittle, and the wall has {besides}",
            f"Take a method that follows both ({_that_take(assembly)}), or leave out one of the two",
        )
    if len(assembly.bars) and not method.traits.any_bars:
        raise InputError(
            f"{method.name} takes no ties, props and passive fill; the wall has {first_few(assembly.bars.names, 4)}",
            f"Take a method that follows bars ({_that_take(assembly)}), or leave them out",
        )
    if assembly.crushes and not method.traits.any_crushing:
        raise InputError(
            f"{method.name} takes joints that do not crush; that between {between(int(np.argmin(assembly.crushing)))} "
            "has a compressive strength",
            f"Take a method that follows crushing ({_that_take(assembly)}), or leave it out",
        )
    if np.any(assembly.support_motion) and not method.traits.any_settlements:
        block = int(np.argmax(np.any(assembly.support_motion, axis=1)))
        raise InputError(
            f"{method.name} takes supports at rest only; {assembly.block_ids[block]} moves",
            "Ask `drystone reaction`, or leave the settlements out",
        )


def _that_take(assembly: Assembly) -> str:
    """Names of the installed methods that take all joints and bars of a wall, in words."""
    needed = {
        "any_dilatancy": assembly.dilates,
        "any_strength": assembly.strong,
        "any_brittle": assembly.breaks,
        "any_bars": len(assembly.bars) > 0,
        "any_crushing": assembly.crushes,
    }
    found = [set(methods_with(trait)) for trait, there in needed.items() if there]
    alone = set(methods_with("brittle_alone")) if assembly.breaks and (assembly.dilates or assembly.crushes) else set()
    return ", ".join(sorted(set.intersection(*found) - alone)) or "there is none for all of this wall"


def method_names() -> list[str]:
    """Names of all methods that users may name, sorted: the installed ones and the programs of `methods.toml`."""
    return sorted({point.name for point in method_points() if point.group != OF_COMMANDS} | set(programs()))


def listed_methods() -> list[str]:
    """Names of the methods that users choose from, sorted."""
    unlisted = {point.name for point in method_points() if point.group == UNLISTED}
    return [name for name in method_names() if name not in unlisted]


def methods_with(trait: str) -> list[str]:
    """Names of the installed methods, sorted, whose traits say that they take something, as "any_strength"."""
    found = []
    for name in method_names():
        with suppress(InputError):  # one that cannot be loaded takes nothing
            if getattr(load_method(name).traits, trait):
                found.append(name)
    return found


def load_method(name: str) -> Method:
    """The method of this name.

    Raises:
        KeyError: no method has this name; the message lists those there are.
        InputError: its package or program is there but cannot be loaded, or brings no method; or two packages bring it.
    """
    points = [point for point in method_points() if point.name == name]
    if len(points) > 1:
        brought_by = " and ".join(sorted(point.dist.name if point.dist else point.value for point in points))
        raise InputError(
            f"it is brought by {brought_by}, and which of them answers is not known",
            "Uninstall all but one, or give the method of yours a name of its own",
            f"method {name}",
        )
    for point in points:
        with _loading(name):
            brought = point.load()
            made = brought() if callable(brought) else brought
        return checked_method(made, f"method {name}")
    found = _method_named(name)
    if found is None:
        raise KeyError(f"no method is called {name!r}; there are: {', '.join(listed_methods())}")
    return found


def checked_method(found: object, element: str = "method") -> Method:
    """What a user gives as a method, which must be one; `element` is what named it.

    Raises:
        InputError: it does not inherit from `Method`, or lacks what that has no default of.
    """
    if not isinstance(found, Method):
        hint = "Give an object of a class that inherits from `harness.model.method.Method`"
        raise InputError(f"{found!r:.80} is no method", hint, element)
    if lacking := [name for name in Method.__annotations__ if not hasattr(found, name)]:
        hint = f"Give its class {', '.join(lacking)}; `harness.model.method.Method` says what each is"
        raise InputError(f"it has no {lacking[0]}", hint, element)
    return found


def prepared(method: Method) -> Method:
    """The method, after it has loaded what its runs need.

    Raises:
        InputError: that is not there.
    """
    with _loading(method.name):
        method.prepare()
    return method


@contextmanager
def _loading(name: str) -> Iterator[None]:
    """Whatever goes wrong inside is reported as a method that cannot be loaded, or as the package that it lacks."""
    try:
        yield
    except MissingPackage:  # says itself what to install
        raise
    except (Exception, SystemExit) as error:
        raise InputError(
            f"it cannot be loaded ({type(error).__name__}: {error})",
            "Install what it needs, or uninstall the package that brings it",
            f"method {name}",
        ) from error


def _method_named(name: str) -> ProgramMethod | None:
    """The method of the program of this name in the file of methods; None where there is none.

    Raises:
        InputError: as of `ProgramMethod`.
    """
    program = program_named(name)
    return None if program is None else method_of(program)
