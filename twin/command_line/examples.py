"""An example or two for each command, shown at the end of its help."""

EXAMPLES = {
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
    "export": ("twin export out/part/recording.h5 --every 10",),
    "train": ("twin train --list", "twin train mefi_helix_hold"),
    "linuxcnc": ("twin link linuxcnc --machine mill4 --out out/helix --headless mefi/helix",),
    "dialects": ("twin dialects", "twin dialects fagor8070"),
    "explain": ("twin explain arc-radius",),
    "doctor": ("twin doctor", "twin doctor --compile"),
}


def epilog(command: str) -> str | None:
    """The end of a command's help; None for a command without examples."""
    examples = EXAMPLES.get(command)
    return None if examples is None else "\n\n".join(("Examples:", *examples))
