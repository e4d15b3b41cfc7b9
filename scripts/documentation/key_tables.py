"""Reference of files: every key of a TOML file, from the models that check it."""

import ast
import inspect
import textwrap
import types
import typing
from collections.abc import Iterator
from itertools import pairwise
from pathlib import Path
from typing import Annotated, Any, Literal, NamedTuple, get_args, get_origin

import pydantic
from pydantic.fields import FieldInfo
from pydantic_core import PydanticUndefined

from twin.job.job_file import JobFile
from twin.machine.description.machine_file import MachineFile
from twin.training.scene.scene_file import SceneFile


class _Key(NamedTuple):
    """A table of a file: how its keys are reached, and the model of its content."""

    heading: str
    model: type[pydantic.BaseModel]
    note: str


def job_page() -> str:
    """Keys of the job file."""
    return _page(
        "Job file",
        "A TOML file beside the program: on which machine it runs, where program zero lies, which stock "
        "and tools there are, and what the verdict holds the run to. Every key but `program` has a default. "
        "`twin init PROGRAM` writes a first one.\n\n"
        'A job may begin with `extends = "other.toml"`, and a `twin.toml` in its folder or above it '
        "is taken without being named: what the job does not say is taken from there, key by key.",
        JobFile,
    )


def machine_page() -> str:
    """Keys of the machine file."""
    return _page(
        "Machine file",
        '`machine.toml` of a machine\'s folder. With `base = "mill4"` a file says only what differs from '
        "that machine. `twin machine check` says whether a file holds together, `twin machine show` what it "
        "comes to.",
        MachineFile,
    )


def scene_page() -> str:
    """Keys of the training room's scene file."""
    return _page(
        "Scene file",
        "A scene of the training room: story, job, faults, tasks, hints, and two scripted operators. "
        "Texts are given by language: `{ en = ..., ru = ..., it = ..., cs = ... }`, or as one text.",
        SceneFile,
        without=(JobFile,),
    )


def _page(
    title: str, lead: str, model: type[pydantic.BaseModel], without: tuple[type, ...] = ()
) -> str:
    sections = [f"# {title}", lead, _table(model)]
    for key in _tables(model, "", without):
        sections += [f"## `{key.heading}`", key.note, _table(key.model)]
    return "\n\n".join(part for part in sections if part) + "\n"


def _tables(
    model: type[pydantic.BaseModel], place: str, without: tuple[type, ...]
) -> Iterator[_Key]:
    for name, field in model.model_fields.items():
        inner, form = _inner(field.annotation)
        if inner is None or inner in without:
            continue
        path = f"{place}{field.alias or name}"
        path += ".NAME" if form == "named" else ""
        heading = f"[[{path}]]" if form == "list" else f"[{path}]"
        yield _Key(heading, inner, _paragraphs(inner.__doc__ or ""))
        yield from _tables(inner, f"{path}.", without)


def _table(model: type[pydantic.BaseModel]) -> str:
    rows = ["| key | value | default | meaning |", "|---|---|---|---|"]
    meanings = _attribute_docstrings(model)
    for name, field in model.model_fields.items():
        meaning = _paragraphs(field.description or meanings.get(name, "")) or _leads_to(field)
        cells = (
            f"`{field.alias or name}`",
            _kind(field.annotation, field.metadata),
            _default(field),
            meaning,
        )
        rows.append(f"| {' | '.join(cell.replace('|', chr(92) + '|') for cell in cells)} |")
    return "\n".join(rows)


def _attribute_docstrings(model: type[pydantic.BaseModel]) -> dict[str, str]:
    """The texts below the keys of a table; Pydantic reads them too, at each start of each command."""
    found: dict[str, str] = {}
    for base in reversed(model.__mro__[: model.__mro__.index(pydantic.BaseModel)]):
        (tree,) = ast.parse(textwrap.dedent(inspect.getsource(base))).body
        assert isinstance(tree, ast.ClassDef)
        for key, text in pairwise(tree.body):
            if isinstance(key, ast.AnnAssign) and isinstance(key.target, ast.Name):
                match text:
                    case ast.Expr(value=ast.Constant(value=str(said))):
                        found[key.target.id] = said
    return found


def _leads_to(field: FieldInfo) -> str:
    inner, _ = _inner(field.annotation)
    return "" if inner is None else _paragraphs((inner.__doc__ or "").partition("\n\n")[0])


def _paragraphs(text: str) -> str:
    """A docstring as Markdown in one line, its code marked in Markdown's way."""
    return " ".join(text.replace("``", "`").split())


def _inner(annotation: Any) -> tuple[type[pydantic.BaseModel] | None, str]:
    """The table that a key holds, and whether it is one, a list of them, or one for each name."""
    if isinstance(annotation, type) and issubclass(annotation, pydantic.BaseModel):
        return annotation, "one"
    origin = get_origin(annotation)
    for part in get_args(annotation):
        found, _ = _inner(part)
        if found is not None:
            return found, "list" if origin is tuple else "named" if origin is dict else "one"
    return None, ""


_WORDS = {float: "number", int: "whole number", str: "text", bool: "true or false", Path: "path"}


def _kind(annotation: Any, metadata: list[Any]) -> str:
    """What may stand there, in words."""
    origin, args = get_origin(annotation), get_args(annotation)
    if origin is Annotated:
        return _kind(args[0], [*args[1:], *metadata])
    if origin in (types.UnionType, typing.Union):
        return " or ".join(
            dict.fromkeys(_kind(part, metadata) for part in args if part is not types.NoneType)
        )
    if origin is Literal:
        return ", ".join(
            f'`"{value}"`' if isinstance(value, str) else f"`{value}`" for value in args
        )
    if origin is tuple:
        if args[-1:] == (...,):
            inner = _kind(args[0], [])
            return (
                "list of tables"
                if _inner(annotation)[0]
                else f"list of {inner.replace('text', 'texts', 1)}"
                if inner.startswith("text")
                else f"list of {inner}s"
            )
        return f"[{', '.join(_kind(part, []) for part in args)}]"
    if origin is dict:
        if _inner(annotation)[0] is not None or get_origin(args[1]) is dict:
            return "table of tables"
        languages = get_origin(args[0]) is Literal
        return "text by language" if languages else f"table of {_kind(args[1], [])}s by name"
    if isinstance(annotation, type) and issubclass(annotation, pydantic.BaseModel):
        return "table"
    return _WORDS.get(annotation, "value") + _bounds(metadata)


def _bounds(metadata: list[Any]) -> str:
    told = {"gt": "above", "ge": "from", "lt": "below", "le": "to"}
    found: dict[str, str] = {}
    for item in metadata:
        # A Field within Annotated keeps its bounds in a list of its own.
        for each in getattr(item, "metadata", [item]):
            found |= {
                name: f"{word} {getattr(each, name):g}"
                for name, word in told.items()
                if hasattr(each, name)
            }
    return f" {' '.join(found[name] for name in told if name in found)}" if found else ""


def _default(field: FieldInfo) -> str:
    if field.is_required():
        return "required"
    value = field.default
    if value in (None, (), PydanticUndefined):
        return "none"
    if isinstance(value, pydantic.BaseModel):
        return ""
    if isinstance(value, tuple) and isinstance(value[0], pydantic.BaseModel):
        return "one, as its defaults say"
    if isinstance(value, bool):
        return f"`{str(value).lower()}`"
    if isinstance(value, tuple):
        return f"`{list(value)}`".replace("'", '"')
    return f'`"{value}"`' if isinstance(value, str) else f"`{value}`"
