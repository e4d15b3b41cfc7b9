"""An example or two for each command, shown at the end of its help."""

EXAMPLES = {
    "twin": ("twin run mefi/helix --video", "twin init part.nc", "twin check programs"),
    "machine": ("twin machine list", "twin machine show mill4"),
    "interpret": ("twin interpret part.nc", "twin interpret part.nc --format jsonl | head"),
    "plan": ("twin plan part.nc", "twin plan part.toml --format json"),
    "run": (
        "twin run part.nc --out out/part",
        "twin run part.toml --video",
        "twin run mefi/helix",
    ),
    "init": ("twin init part.nc",),
    "render": (
        "twin render out/part/recording.h5 --at 3.5 --camera tool",
        "twin render part.toml --event worst",
    ),
    "check": (
        "twin check programs --junit twin.xml",
        "twin check programs --baseline baselines --update-baseline",
        "twin check programs --baseline baselines --json -",
    ),
    "sweep": (
        "twin sweep part.toml --vary machine.axes.X.kv=5,7.5 --vary job.default_feed=500:3000:6",
    ),
    "compare": ("twin compare out/part/recording.h5 log.csv --tolerance 0.05",),
    "calibrate": ("twin calibrate log.csv --base mill4 --out mine.toml",),
    "export": (
        "twin export out/part/recording.h5 --every 10",
        "twin export --fmu mill4 --out mill4.fmu",
    ),
    "train": (
        "twin train --list",
        "twin train mefi_helix_hold",
        "twin train --class roster.csv",
    ),
    "linuxcnc": ("twin link linuxcnc --machine mill4 --out out/helix --headless mefi/helix",),
    "dialects": ("twin dialects", "twin dialects fagor8070"),
    "explain": ("twin explain arc-radius",),
    "view": ("twin view out/part/recording.h5", "twin view part.toml --port 8081"),
    "serve": (
        "twin serve part.toml",
        "twin serve part.toml --port 5001 --speed 10",
        "twin serve --scene fagor_first_steps",
        "twin serve part.toml --grbl 2323",
    ),
    "machine list": ("twin machine list", "twin machine list --format json"),
    "machine show": ("twin machine show mill4 --feed 3000", "twin machine show ./my_machine.toml"),
    "machine check": ("twin machine check mill4", "twin machine check ./my_machine.toml"),
    "machine circle": (
        "twin machine circle --machine mill4 --radius 50 --feed 3000",
        "twin machine circle --plane XYC --format json --plot circle.png",
    ),
    "doctor": ("twin doctor", "twin doctor --compile"),
}


def epilog(command: str) -> str | None:
    """The end of a command's help; None for a command without examples."""
    examples = EXAMPLES.get(command)
    return None if examples is None else "\n\n".join(("Examples:", *examples))
