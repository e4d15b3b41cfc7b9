"""Compiles the kernels of the language, for the next run that asks for them."""

from twin.compilation.beside import serve
from twin.compilation.folders import writable_folder
from twin.compilation.speed import Speed
from twin.nc.canonical import Axes
from twin.nc.control.settings import ControlSettings
from twin.nc.dialects import dialect_named
from twin.nc.interpreter import Interpretation
from twin.nc.text.source import source_from_text

_PROGRAM = "P1=2\nG0 X[P1+1.5]\nX[P1+2.5]\nX[P1+3.5]\nM30"
"""Comes to every kernel that is called from Python: lines that compute, and lines alike."""
_AXES = Axes(("X", "Y", "Z", "C"), ("linear", "linear", "linear", "rotary"))


def compile_all() -> None:
    """Compile them, or load them where they are kept."""
    source, settings = source_from_text(_PROGRAM), ControlSettings(axes=_AXES)
    dialect = dialect_named("fagor8070")
    for _ in Interpretation(source, dialect, settings, compiled_from=0, speed=Speed.HOT).chunks():
        pass


if __name__ == "__main__":
    serve(writable_folder())
    compile_all()
