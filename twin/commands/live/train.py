"""``twin train``: the training room."""

import contextlib
import dataclasses
import threading
from pathlib import Path

import typer

from twin.commands.live.interruption import stop_on_sigint
from twin.errors import ExitCode, UsageError
from twin.extras import require_extra
from twin.training.scene.scene_file import read_scene, scene_names, scene_path
from twin.training.scene.vocabulary import LANGUAGES, Language, in_language


def print_scenes(language: str | None) -> None:
    """List the shipped scenes, in English unless another language is asked for."""
    chosen = language_named(language) or "en"
    for name in scene_names():
        scene = read_scene(scene_path(name))
        title = in_language(scene.file.title, chosen)
        dialect = scene.preparation.dialect.name
        typer.echo(f"{name:26} {dialect:11} {scene.points:3} points  {title}")


def print_course(folder: Path, language: str | None) -> None:
    """List the score sheets of a course, and write the list beside them.

    Args:
        language: Of the list; None: that of most of the sheets.

    Raises:
        UsageError: There is no such folder, or the panel does not speak the language.
    """
    from twin.files.atomic import write_text
    from twin.training.score_sheets.course import course_of, course_page, language_of

    chosen = language_named(language)
    rows, unread = course_of(folder)
    for row in rows:
        alarms = ", ".join(row.alarms) or "-"
        points = f"{row.points}/{row.of}{'' if row.handed_in else ' open'}"
        typer.echo(f"{row.name or '-':20} {row.scene:24} {row.date:16} {points:>10}  {alarms}")
    for path in unread:
        typer.echo(f"{path}: no score sheet", err=True)
    write_text(folder / "course.html", course_page(rows, chosen or language_of(rows)))
    typer.echo(f"{len(rows)} sessions; {folder / 'course.html'}")


def rehearse_and_print(name: str) -> ExitCode:
    """Play a scene's scripted solution and mistake, and say whether they end as intended.

    Raises:
        TwinError: The scene is wrong, or a step of a script cannot be done.
    """
    from twin.compilation.announcement import announce_compilation
    from twin.training.session.script import rehearse

    announce_compilation()
    scene = read_scene(scene_path(name))
    rehearsals = rehearse(scene)
    for played in rehearsals:
        failed = ", ".join(map(str, played.failed)) or "none"
        typer.echo(
            f"{scene.name}: {played.what}: {played.score} of {scene.points} points, failed tasks: "
            f"{failed}: {'as intended' if played.intended else 'NOT as intended'}"
        )
    return ExitCode.OK if all(played.intended for played in rehearsals) else ExitCode.FAILED


def language_named(name: str | None) -> Language | None:
    """A language by its name.

    Raises:
        UsageError: The panel does not speak it.
    """
    for language in LANGUAGES:
        if name == language:
            return language
    if name is None:
        return None
    raise UsageError(f"no language '{name}': the panel speaks {', '.join(LANGUAGES)}")


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class PageAddress:
    """Where pages are served, and in which language.

    Attributes:
        language: By its name; None: the scene's.
        host: Where the server listens; None: on this computer alone.
        port: Its port; 0: the first free one.
    """

    language: str | None
    host: str | None
    port: int
    certificate: Path | None
    key: Path | None


def _require_folder(out: Path) -> None:
    """Refuse a place for results that is a file, or lies in one."""
    for place in (out, *out.parents):
        if place.exists():
            if not place.is_dir():
                within = "that" if place == out else str(place)
                raise UsageError(
                    f"--out {out}: {within} is a file; log and score sheet need a folder"
                )
            return


def train(name: str, place: PageAddress, out: Path | None) -> ExitCode:
    """Open a scene and play it until it is closed.

    Returns:
        ``FAILED`` where the scene was handed in with less than full points.

    Raises:
        TwinError: The scene, or how it shall be opened, is wrong.
    """
    from twin.compilation.announcement import announce_compilation

    require_extra("train", "the training room")
    from twin.training.server.launch import open_room
    from twin.web.server import LOOPBACK

    if out is not None:
        _require_folder(out)
    announce_compilation()
    scene = read_scene(scene_path(name))
    with contextlib.ExitStack() as stack:
        room = stack.enter_context(
            open_room(
                scene,
                language=language_named(place.language),
                host=place.host or LOOPBACK,
                port=place.port,
                certificate=place.certificate,
                key=place.key,
                out=out or Path("out") / "training",
                promptly=True,
            )
        )
        interrupted = stack.enter_context(stop_on_sigint(room.stop))
        typer.echo(f"{scene.name}: open {room.addresses['operator']} in a browser; Ctrl+C ends")
        typer.echo(f"the trainer's own page: {room.addresses['trainer']}")
        typer.echo(f"to look on: {room.addresses['watcher']}")
        room.serve()
        if interrupted:
            typer.echo("")  # the terminal has shown its ^C
        played, judge = room.session.scene, room.session.room.judge
    typer.echo(f"{played.name}: {judge.score} of {played.points} points; sheet in {room.folder}")
    return ExitCode.FAILED if judge.over and judge.score < played.points else ExitCode.OK


def teach(
    scene: str,
    roster: Path | None,
    seats: int | None,
    place: PageAddress,
    out: Path | None,
    cluster: str | None = None,
) -> None:
    """Open a class and keep it open until Ctrl+C.

    Args:
        roster: Who they are; None: they are only counted.
        seats: How many they are.
        out: The class's folder; None: one that is called as the roster.
        cluster: Address of the Ray cluster over which rooms are spread; None: they run on this computer.

    Raises:
        TwinError: The roster, the scene, or how the class shall be opened, is wrong.
    """
    from twin.compilation.announcement import announce_compilation

    require_extra("train", "the training room")
    from twin.training.classroom.launch import open_class
    from twin.training.classroom.roster import counted_seats, read_roster
    from twin.web.server import LOOPBACK

    if (roster is None) == (seats is None):
        raise UsageError("give --class ROSTER.csv, or --seats with how many there are")
    pupils = counted_seats(seats or 0) if roster is None else read_roster(roster)
    name = "seats" if roster is None else roster.stem
    folder = out or Path("out") / "class" / name
    _require_folder(folder)
    announce_compilation()
    over = threading.Event()
    with contextlib.ExitStack() as stack:
        opened = stack.enter_context(
            open_class(
                pupils, scene, folder, language=language_named(place.language),
                host=place.host or LOOPBACK, port=place.port, certificate=place.certificate,
                key=place.key, cluster=cluster,
            )
        )  # fmt: skip
        interrupted = stack.enter_context(stop_on_sigint(over.set))
        width = max(len(name) for name, _ in opened.pupils)
        for name, address in opened.pupils:
            typer.echo(f"{name:{width}}  {address}")
        typer.echo(f"the teacher's page: {opened.teacher}")
        typer.echo(f"marks are kept in {folder}; Ctrl+C ends the class, and not the links")
        while not over.wait(0.2):
            pass
        if interrupted:
            typer.echo("")  # the terminal has shown its ^C
    typer.echo(f"marks in {folder / 'class.sqlite'}")
