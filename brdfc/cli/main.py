"""`brdfc`: the group of commands, each imported only when it runs."""

from __future__ import annotations

import os
import sys
from importlib import import_module

import click

from brdfc import __version__
from brdfc.source.errors import BrdfcError

# One line a command here, so that `brdfc --help` imports none of them.
_COMMANDS = {
    "angles": "Compute the angles of every pixel from normals, a light and a camera.",
    "apply": "Evaluate an image of coefficients through profiles.",
    "calibrate": "Measure what calculator operators cost on this machine.",
    "chart": "Chart speed against accuracy for every form of a model.",
    "check": "Verify everything that can be verified about a model or a profile.",
    "compile": "Compile a reflectance model to profiles, or XML to a profile.",
    "data": "Summarise measured reflectance and what it covers.",
    "disasm": "Print the calculator text of a profile.",
    "eval": "Evaluate single pixels through profiles.",
    "export": "Write a model's formula for other tools, as FPCore.",
    "fit": "Fit a model's coefficients to measurements.",
    "fit-image": "Fit a model to every pixel of a stack of images.",
    "inspect": "Show what is in a profile, on one screen.",
    "measure": "Take measurements from photographs of a cylinder.",
    "models": "List the model library, or show one model.",
    "plot": "Draw curves, lobes, strips of colours, lit bodies.",
    "scene-chart": "Compare the models of the library in one scene.",
    "select": "Choose the smallest model that measurements support.",
    "stability": "Show where a model fails in float32, and by how much.",
    "xml": "Write a profile as the XML of the ICC's tools.",
}


class _Commands(click.Group):
    def list_commands(self, ctx: click.Context) -> list[str]:
        return list(_COMMANDS)

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        if cmd_name not in _COMMANDS:
            return None
        module = import_module(f"brdfc.cli.{cmd_name.replace('-', '_')}_command")
        command = module.command
        assert isinstance(command, click.Command)
        return command

    def resolve_command(
        self, ctx: click.Context, args: list[str]
    ) -> tuple[str | None, click.Command | None, list[str]]:
        from brdfc.source.diagnostics import did_you_mean

        if args and args[0] not in _COMMANDS and not args[0].startswith("-"):
            hint = did_you_mean(args[0], _COMMANDS) or f"the commands: {', '.join(_COMMANDS)}"
            ctx.fail(f"No such command '{args[0]}': {hint}")
        return super().resolve_command(ctx, args)

    def format_commands(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        with formatter.section("Commands"):
            formatter.write_dl(list(_COMMANDS.items()))


@click.group(cls=_Commands, context_settings={"help_option_names": ["-h", "--help"]})
@click.version_option(__version__, prog_name="brdfc")
def cli() -> None:
    """Compile reflectance models, written as formulas, to ICC.2 (iccMAX) profiles.

    \b
    Example:
      brdfc compile ward -o ward_mvis.icc
      brdfc apply ward_mid.icc ward_mvis.icc coefficients.tif -o xyz.tif \\
            --env incident=40deg --env reflection=10deg
    """


def main() -> None:
    """The console script: exit status 0, 1 with one message, or 2 for wrong usage."""
    try:
        cli.main(prog_name="brdfc", standalone_mode=False)
    except click.UsageError as error:
        error.show()
        sys.exit(2)
    except click.exceptions.Exit as stop:
        sys.exit(stop.exit_code)
    except (click.Abort, KeyboardInterrupt):
        click.echo("interrupted", err=True)
        sys.exit(130)
    except click.ClickException as error:
        error.show()
        sys.exit(1)
    except BrdfcError as error:
        text = str(error)
        # Findings in a model already say `file:line:column: error:`.
        click.echo(text if ": error: " in text.split("\n")[0] else f"error: {text}", err=True)
        sys.exit(1)
    except BrokenPipeError:
        sys.stderr.close()
        sys.exit(1)
    except OSError as error:
        if error.filename is not None:  # files have errors of their own
            raise
        click.echo(f"error: standard output: cannot be written: {error.strerror}", err=True)
        # What it holds still would be tried again at the end.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        sys.exit(1)
