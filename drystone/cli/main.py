"""The command `drystone`. Exit codes: 0 done, 1 a reference is not met or an answer rejected, 2 the input is wrong.

Nothing but click is imported until it is known which command is meant.
"""

from __future__ import annotations

import importlib
import os

import click

from drystone.cli.groups import AskingGroup
from harness import formats
from harness.engine.threads import pin

COMMANDS = {
    "run": ("run", "run", "Run METHOD on CASE and print what it finds."),
    "compare": ("compare", "compare", "Run methods on CASES or a suite, judge, store and report."),
    "study": ("sweep", "study", "List the studies of Drystone, or print one."),
    "sweep": ("sweep", "sweep_", "Run a study: many walls, many settings."),
    "store": ("sweep", "store_", "Merge result stores."),
    "learn": ("compare", "learn", "Make a page for teaching: a block with sliders, a wall over friction."),
    "bench": ("bench", "bench_", "Run methods on a frozen set of walls: success, error, CPU time."),
    "report": ("compare", "report", "Rebuild the report of the last comparison."),
    "check": ("check", "check", "Compare the methods with their checked references."),
    "conformance": ("conformance", "conformance", "Run the conformance suite on METHODS."),
    "diff": ("diff", "diff", "Compare the answers of two stores or baselines."),
    "baseline": ("check", "baseline", "Compare today's values with the recorded ones."),
    "list": ("walls", "list_", "List the cases, the methods, the suites or the formats there are."),
    "expand": ("walls", "expand", "Print WALL.json in explicit form."),
    "judge": ("walls", "judge", "Judge RESULT.json, an answer of any program."),
    "bound": ("proof", "bound", "Write a certificate that no collapse state lies lower."),
    "verify-bound": ("proof", "verify_bound", "Check a certificate in fractions."),
    "reaction": ("reaction", "reaction", "Print the reactions of the supports of CASE that move."),
    "schema": ("walls", "schema", "Print the JSON Schema of a format: of walls, results or descriptions."),
    "validate": (
        "drawings",
        "validate",
        "List the errors and warnings of WALL.json.",
    ),
    "repair": ("drawings", "repair", "Close the gaps and overlaps of a drawing, and list the displacements."),
    "show": ("drawings", "show", "Draw CASE to a file or in a window."),
    "factor": ("factor", "factor", "Find the factor of safety on friction of CASE."),
    "capacity": ("capacity", "capacity", "Find how far CASE can move before it falls, and what it bears on the way."),
    "shake": ("shake", "shake", "Find whether CASE stands or falls when the ground moves."),
    "domain": ("domain", "domain", "Find the pairs of multipliers of two live loads under which CASE stands."),
    "gateway": ("gateway", "gateway", "Answer clients of UM-Bridge with the multiplier of CASE."),
    "figure": ("walls", "figure", "Draw the answers of methods as a figure for a paper."),
    "import": ("files", "import_", "Convert a drawing to WALL.json."),
    "export": ("files", "export", "Write a wall and its answer for other programs."),
    "methods": ("methods", "methods", "Register programs in any language as methods."),
    "new": ("files", "new", "Make a parametric wall."),
    "animate": ("walls", "animate", "Animate the mechanism of a method."),
}
"""Every command: the module of this package it is in, its name there, and what the list of commands says of it."""


class Commands(AskingGroup):
    """A group whose commands are imported when they are called."""

    def list_commands(self, ctx: click.Context) -> list[str]:
        """Names of all commands."""
        return sorted(COMMANDS)

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        """The command of this name, imported; None if there is none."""
        if cmd_name not in COMMANDS:
            return None
        pin()
        module, name, _ = COMMANDS[cmd_name]
        formats.register()
        command: click.Command = getattr(importlib.import_module(f"drystone.cli.{module}"), name)
        return command

    def format_commands(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """The list of commands in the help, without importing them."""
        with formatter.section("Commands"):
            formatter.write_dl([(name, COMMANDS[name][2]) for name in self.list_commands(ctx)])


def _version(ctx: click.Context, _option: click.Parameter, wanted: bool) -> None:
    if wanted and not ctx.resilient_parsing:
        from importlib.metadata import version

        click.echo(f"drystone, version {version('drystone')}")
        ctx.exit()


def _methods_from(ctx: click.Context, _option: click.Parameter, path: str | None) -> None:
    if path is not None and not ctx.resilient_parsing:
        os.environ["DRYSTONE_METHODS"] = os.path.abspath(path)


@click.group(cls=Commands, context_settings={"help_option_names": ["-h", "--help"], "max_content_width": 100})
@click.option("--version", is_flag=True, expose_value=False, is_eager=True, callback=_version, help="Show the version.")
@click.option(
    "--methods-file",
    expose_value=False,
    callback=_methods_from,
    metavar="PATH",
    help="Programs that are methods.  [default: methods.toml in the working folder]",
)
def main() -> None:
    """Collapse multipliers of dry-jointed masonry by three families of methods, judged and compared.

    \b
    drystone show WALL.json -o wall.svg   draw a wall before anything is run
    drystone run la WALL.json             one method on one wall
    drystone compare WALL.json            FE, LA and DE side by side, with a report
    drystone list cases                   the walls that come with Drystone
    """


if __name__ == "__main__":
    main()
