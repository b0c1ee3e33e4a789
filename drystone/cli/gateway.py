"""The command that makes a wall a model of UM-Bridge."""

from __future__ import annotations

from pathlib import Path

import click

from drystone.cli.options import (
    as_loaded,
    case_argument,
    cases_option,
    catching,
    known_methods,
    load_case_option,
    memory_option,
    say,
    seconds_option,
    settings_option,
    warn,
)
from drystone.cli.settings import settings_of
from drystone.gateway import NAME, OUTPUTS, TemplateWall, serve
from drystone.walls import Wall
from harness.engine.plan import check_methods, find_cases
from harness.engine.run import Limits
from harness.model.method_registry import load_method


@click.command()
@case_argument
@click.option("--vary", "names", multiple=True, required=True, metavar="NAME", help="A parameter; may be repeated.")
@click.option(
    "--method", shell_complete=known_methods, default="la", show_default=True, help="The method that answers."
)
@settings_option
@click.option("--port", type=click.IntRange(1, 65535), default=4242, show_default=True)
@load_case_option
@seconds_option
@memory_option
@cases_option
@catching
def gateway(
    case: str,
    names: tuple[str, ...],
    method: str,
    settings: tuple[str, ...],
    port: int,
    load_case: str | None,
    seconds: float,
    memory: int,
    folders: tuple[Path, ...],
) -> None:
    """Answer clients of UM-Bridge with the collapse multiplier of CASE, a template whose quantities they choose.

    The model is called "drystone". Its inputs are the values of all --vary, in their order; its outputs are the
    multiplier, the bound below which no collapse state lies (0 without a proof), and the judge's residual.
    """
    check_methods([method], "--method")
    (found,) = find_cases([case], None, folders)
    chosen = as_loaded(found, load_case, None, both_signs=False)
    for each in chosen:
        warn(each)
    limits = Limits(seconds, memory * 2**20)
    first = f"{OUTPUTS[0]} (upper bound)" if load_method(method).traits.bounds_above else OUTPUTS[0]
    template = TemplateWall(
        Wall(found if chosen[1:] else chosen[0]), names, method, limits, settings_of(method, settings)
    )
    serve(
        template,
        port,
        lambda sentence: say(f"drystone: {sentence}", err=True),
        lambda address: say(f'Model "{NAME}" at {address}: {", ".join(names)} -> {", ".join([first, *OUTPUTS[1:]])}'),
    )
