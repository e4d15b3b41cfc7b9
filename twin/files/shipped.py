"""Where the machines and programs that ship with the package lie, in a checkout or in a wheel."""

from pathlib import Path

from twin.errors import UsageError
from twin.files.looked_at import look_at

_PACKAGE = Path(__file__).resolve().parents[1]


def is_installed() -> bool:
    """Whether this package was installed from a wheel, rather than being run from its checkout."""
    return (_PACKAGE / "_resources").is_dir()


def resource_root(kind: str) -> Path:
    """Return the folder of the shipped ``models`` or ``programs``.

    Raises:
        UsageError: The installation lacks the folder.
    """
    candidates = (_PACKAGE / "_resources" / kind, _PACKAGE.parent / kind)
    for candidate in candidates:
        if candidate.is_dir():
            return candidate
    raise UsageError(f"this installation has no '{kind}' folder; looked in {candidates}")


def is_shipped(path: Path) -> bool:
    """Whether a path lies in what ships with the package."""
    roots = (resource_root(kind) for kind in ("models", "programs"))
    return any(path.resolve().is_relative_to(root.resolve()) for root in roots)


def shipped_program(name: str) -> Path | None:
    """A shipped program's job by its name, such as ``helix`` or ``mefi/helix``; None for no such.

    Raises:
        UsageError: Several are called so.
    """
    jobs = {
        path.relative_to(resource_root("programs")).with_suffix("").as_posix(): path
        for path in sorted(resource_root("programs").rglob("*.toml"))
        if any(path.with_suffix(suffix).is_file() for suffix in (".nc", ".h", ".mpf"))
    }
    found = [each for each in jobs if each == name or each.endswith(f"/{name}")]
    if len(found) > 1:
        raise UsageError(f"{name}: several shipped programs are called so: {', '.join(found)}")
    return jobs[found[0]] if found else None


def machine_names() -> tuple[str, ...]:
    """Names of the shipped machines, sorted."""
    return tuple(
        sorted(path.parent.name for path in resource_root("models").glob("*/machine.toml"))
    )


def variant_names() -> tuple[str, ...]:
    """Names of the shipped machines' variants, such as ``mill4/uncompensated``, sorted."""
    return tuple(
        sorted(
            f"{path.parent.name}/{path.stem}"
            for name in machine_names()
            for path in (resource_root("models") / name).glob("*.toml")
            if path.name != "machine.toml"
        )
    )


def machine_file(name: str, *, beside: Path | None = None) -> Path:
    """Find a machine file by its shipped name or by its path.

    Args:
        name: A shipped machine's name (``mill4``), that of a variant of it
            (``mill4/uncompensated``), a ``machine.toml``, or a folder that holds one.
        beside: Folder that a relative path is taken from; the working folder by default.

    Raises:
        UsageError: No such machine; the message lists the shipped ones.
    """
    shipped = resource_root("models") / name / "machine.toml"
    if "/" not in name and shipped.is_file():
        return shipped
    path = look_at((beside or Path()) / name)
    in_folder = look_at(path / "machine.toml")
    if path.is_dir():
        path = in_folder
    if path.is_file():
        return path
    if name in variant_names():
        return resource_root("models") / f"{name}.toml"
    raise UsageError(
        f"no machine '{name}': shipped machines are "
        f"{', '.join((*machine_names(), *variant_names()))}; or give the path of a machine.toml"
    )
