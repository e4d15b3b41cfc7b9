"""The two kernels of the language, and nothing else of it, have a compiled form of their own."""

from twin.compilation.kernel import array_kernel, kernel
from twin.nc.compiled.kernels import program

run_program = kernel(program.run_program)
unread_lines = array_kernel(program.unread_lines)
