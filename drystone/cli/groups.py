"""Groups of commands that answer mistakes of typing in words of users; apart, as `drystone --help` imports no more."""

from __future__ import annotations

from typing import Any

import click

from harness.model.errors import did_you_mean

_IN_WORDS = {
    "a valid float range": "a number",
    "a valid integer range": "a whole number",
    "a valid float": "a number",
    "a valid integer": "a whole number",
}
"""Kinds of values as click calls them, and as users do."""


class OneOf(click.Choice):  # type: ignore[type-arg]
    """A choice that answers an unknown word with the one that is near, if there is one."""

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        """As of click, with the question which word was meant."""
        try:
            return super().convert(value, param, ctx)
        except click.BadParameter as error:
            meant = did_you_mean(str(value), map(str, self.choices))
            raise click.BadParameter(f"{error.message} {meant}".strip(), ctx, param) from None


class AskingGroup(click.Group):
    """A group that answers an unknown command with the one that is near, if there is one."""

    def resolve_command(
        self, ctx: click.Context, args: list[str]
    ) -> tuple[str | None, click.Command | None, list[str]]:
        """As of click, with the question which command was meant."""
        try:
            return super().resolve_command(ctx, args)
        except click.UsageError as error:
            meant = did_you_mean(args[0], self.list_commands(ctx)) if args else ""
            raise click.UsageError(f"{error.message} {meant}".strip(), error.ctx or ctx) from None

    def invoke(self, ctx: click.Context) -> Any:
        """As of click, with the kind of value that was expected in words of users."""
        try:
            return super().invoke(ctx)
        except click.UsageError as error:
            text = error.format_message()
            for theirs, ours in _IN_WORDS.items():
                text = text.replace(theirs, ours)
            raise click.UsageError(text, error.ctx or ctx) from None
