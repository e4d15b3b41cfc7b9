"""A run as a picture for a notebook."""

import numpy as np
from matplotlib.figure import Figure

from twin.nc.canonical import Axes, FloatArray

MOST_POINTS = 20_000
"""Samples that are drawn; of more every n-th, and the greatest contour error of each group."""
_DOT, _WORST = 2.0, 15.0
"""Area of a dot without error [pt²], and how much larger that of the worst one is."""


def plot_run(
    time: FloatArray, path: FloatArray, error_um: FloatArray, joints: FloatArray, axes: Axes
) -> Figure:
    """The path in X and Y coloured by its contour error, and every axis over time.

    Args:
        time: Of the samples, shape (n,) [s].
        path: The tool's tip in program coordinates, shape (n, 3) [mm].
        error_um: Contour error, shape (n,) [µm].
        joints: Where the axes were, program coordinates, shape (n, k) [mm or deg].
    """
    figure = Figure(figsize=(11.0, 5.0), layout="compressed")
    left, right = figure.subplots(1, 2)
    firsts = np.arange(0, len(time), max(1, -(-len(time) // MOST_POINTS)))
    shown = np.maximum.reduceat(error_um, firsts)
    # The worst places lie above the others.
    order = np.argsort(shown, kind="stable")
    x, y = path[firsts][order, :2].T
    size = _DOT * (1.0 + _WORST * shown[order] / shown.max(initial=1e-9))
    dots = left.scatter(x, y, c=shown[order], s=size, cmap="viridis")
    figure.colorbar(dots, ax=left, label="contour error [µm]")
    left.set(aspect="equal", xlabel="X [mm]", ylabel="Y [mm]", title="path in the part")
    for column, (name, kind) in enumerate(zip(axes.names, axes.kinds, strict=True)):
        unit = "mm" if kind == "linear" else "deg"
        right.plot(time[firsts], joints[firsts, column], label=f"{name} [{unit}]")
    right.set(xlabel="time [s]", ylabel="program coordinate", title="axes")
    right.legend()
    return figure
