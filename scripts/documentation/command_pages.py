"""Reference of the command line: every command, from its declaration."""

import html
from collections.abc import Iterator
from typing import Any

from typer.main import get_command

from twin.cli import app

_LEAD = (
    "Every command explains itself: `twin --help`, `twin run -h`. `twin --install-completion` lets the shell "
    "complete commands and options. What commands return to the shell: [exit codes](codes.md#exit-codes)."
)
_HEADER = "| option | default | meaning |\n|---|---|---|"


def commands_page() -> str:
    """Every command with its arguments, options and examples."""
    sections = [
        "# Commands",
        _LEAD,
    ]
    for path, command in commands():
        sections += [f"## `{path}`", *_described(path, command)]
    return "\n\n".join(section for section in sections if section) + "\n"


def commands() -> Iterator[tuple[str, Any]]:
    """Every command by what is typed, those of groups too."""
    root: Any = get_command(app)
    for name, command in root.commands.items():
        inner = getattr(command, "commands", None)
        if inner is None:
            yield f"twin {name}", command
        else:
            for second, part in inner.items():
                yield f"twin {name} {second}", part


def _described(path: str, command: Any) -> Iterator[str]:
    yield command.help
    context = command.context_class(command, info_name=path)
    yield f"```text\n{' '.join([path, *command.collect_usage_pieces(context)])}\n```"
    arguments = [each for each in command.params if each.param_type_name == "argument"]
    if arguments:
        rows = (
            f"| `{each.metavar or each.name.upper()}` | {_cell(each.help)} |" for each in arguments
        )
        yield "\n".join(("| argument | meaning |\n|---|---|", *rows))
    options = [each for each in command.params if each.param_type_name == "option"]
    if options:
        yield "\n".join((_HEADER, *(_row(each) for each in options)))
    lines = (command.epilog or "").split("\n\n")[1:]
    if lines:
        yield "\n".join(("```sh", *lines, "```"))


def _row(option: Any) -> str:
    names = ", ".join(f"`{name}`" for name in (*option.opts, *option.secondary_opts))
    default = option.default
    if callable(default) or default is None or repr(default).startswith("Sentinel"):
        shown = ""
    elif isinstance(default, bool):
        shown = "" if not default else "on"
    else:
        shown = f"`{default}`"
    return f"| {names} | {shown} | {_cell(option.help)} |"


def _cell(text: str | None) -> str:
    return html.escape(text or "", quote=False).replace("|", "\\|")
