"""Reference of the recording that a run writes, from its declarations."""

from twin.recording.form import (
    COLUMNS,
    CONTOUR,
    JOINT_COLUMNS,
    LATER_ATTRIBUTES,
    STEPS,
    TEXT_ATTRIBUTES,
    RecordingHeader,
)

_LEAD = (
    "`recording.h5` is plain HDF5: n samples at the servo period, axes in the order of the attribute `axes`. "
    "Sample i of every dataset belongs to the instant `time[i]`."
)
_MORE = (
    "How it is read while it grows, from MATLAB and from pandas: "
    "[what the verdict rests on](../packages/compare.md#the-recording)."
)
_MEANINGS = {
    "time": "end of the sample",
    "line": "source line of the program, 0 before the first",
    "move": "number of the move, from 0",
    "fraction": "share of that move's length",
    "setpoint/position": "commanded position, machine coordinates, continuous",
    "setpoint/velocity": "its rate",
    "setpoint/acceleration": "its rate",
    "joint/position": "simulated position, of the same instant",
    "joint/velocity": "its rate",
    "drive/force": "force or torque of the drive",
    CONTOUR: "distance from the commanded path, seen from the part",
}
_ATTRIBUTES = {
    "axes": "names of the axes, in the order of the columns",
    "kinds": "`linear` or `rotary`, one for each axis",
    "period_s": "time between samples [s]",
    "part_zero": "machine coordinates of program zero [mm or deg]",
    "table_axis": "the axis that turns the part; empty where none does",
    "table_center": "machine X and Y of its centre [mm]",
    "table_zero": "its angle at which the part stands as programmed [deg]",
    "kinematics": "the chain of joints from tool to part, as text",
    "geometry": "errors of the machine's geometry (ISO 230), as text; empty where it has none",
    "program": "the program's name",
    "program_sha256": "checksum of its text",
    "dialect": "its dialect",
    "machine": "name of the machine",
    "twin_version": "version of the twin",
    "mujoco_version": "version of MuJoCo",
    "job": "the job as JSON",
    "machine_file": "where the machine file lay",
    "alarms": "what the machine raised, as JSON: pairs of time [s] and text",
    "complete": "true where the run was written to its end",
}


def recording_page() -> str:
    """Columns and attributes of a recording."""
    columns = {**COLUMNS, **JOINT_COLUMNS, CONTOUR: (CONTOUR, "um")}
    rows = []
    for path, (_, unit) in columns.items():
        shape = "(n, axes)" if "/" in path else "(n,)"
        step = f"{STEPS[path]:.2g}" if path in STEPS else "whole" if path != "time" else "exact"
        rows.append(f"| `{path}` | {shape} | {unit or '–'} | {step} | {_MEANINGS[path]} |")
    attributes = [f"| `{name}` | {meaning} |" for name, meaning in _ATTRIBUTES.items()]
    assert {*TEXT_ATTRIBUTES, *LATER_ATTRIBUTES} <= set(_ATTRIBUTES), RecordingHeader
    return (
        "\n\n".join(
            (
                "# Recording",
                _LEAD,
                "| dataset | shape | unit | kept to | meaning |\n|---|---|---|---|---|\n"
                + "\n".join(rows),
                f"`{CONTOUR}` is missing where nobody compared. A dataset has its unit as the attribute `unit`.",
                "## Attributes of the file",
                "| attribute | meaning |\n|---|---|\n" + "\n".join(attributes),
                _MORE,
            )
        )
        + "\n"
    )
