"""Help and diagnosis: ``twin dialects``, ``explain`` and ``doctor``."""

from typing import Annotated

import typer


def dialects(
    name: Annotated[
        str | None, typer.Argument(help="Dialect to describe.", show_default=False)
    ] = None,
) -> None:
    """Print the dialects, or what one of them understands, refuses and decided."""
    from twin.nc.dialects import dialect_named
    from twin.nc.dialects.pages import describe, overview

    typer.echo(overview() if name is None else describe(dialect_named(name)))


def explain(
    code: Annotated[
        str | None, typer.Argument(help="Code of a message, or a material.", show_default=False)
    ] = None,
) -> None:
    """Explain the code of an error, a warning or an alarm; without a code list them all."""
    from twin.commands import explain as explanations

    typer.echo(explanations.overview() if code is None else explanations.explain(code))


def doctor(
    compile_now: Annotated[
        bool,
        typer.Option(
            "--compile", help="Compile all kernels into the installation first, as for images."
        ),
    ] = False,
) -> None:
    """Report what this computer can do: libraries, compiled kernels, off-screen pictures, video."""
    from twin.commands.doctor import print_doctor

    raise typer.Exit(print_doctor(compile_now=compile_now))
