"""Numba: how kernels are declared, kept and announced."""
