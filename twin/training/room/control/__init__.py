"""The control that the operator works: panel, programs, tables, manual motion, auxiliaries."""
