"""Groups of commands that ask whether another command was meant."""

from __future__ import annotations

import click

from harness.model.errors import did_you_mean


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
