"""The errors that a user can meet, each with its exit code."""

import enum


class ExitCode(enum.IntEnum):
    """What every command returns to the shell."""

    OK = 0
    FAILED = 1
    """A tolerance, a baseline or a task was not met."""
    USAGE = 2
    """The command line, a machine file, a job file or a recording is wrong."""
    PROGRAM = 3
    """The NC program is wrong."""
    ALARM = 4
    """The machine raised an alarm."""
    CRASH = 70
    """The twin itself is at fault: a defect, or a process that was killed."""
    INTERRUPTED = 130


class TwinError(Exception):
    """The base of every error that the twin raises on purpose."""

    exit_code: ExitCode = ExitCode.USAGE


class UsageError(TwinError):
    """The command line, or a value given to the API, cannot be used."""


class EmptyProgramError(UsageError):
    """A program holds no block: nothing, or comments alone."""


class ConfigError(UsageError):
    """A machine file or a job file is wrong; the message names the file and the key."""


class RecordingError(UsageError):
    """A recording cannot be read: missing, torn, or of another form."""


class RenderError(UsageError):
    """Pictures cannot be made here: no OpenGL, no encoder; the message says what to install."""
