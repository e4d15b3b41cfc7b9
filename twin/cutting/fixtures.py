"""The cutter against what holds the part: jaws and clamps must not be cut."""

from collections.abc import Sequence

import numpy as np

from twin.cutting.events import SCRAPE_MM, CutEvent
from twin.cutting.height_map import HeightMap
from twin.cutting.outline import Outline
from twin.cutting.sweep_kernels import Removal, sweep
from twin.cutting.thin_kernels import thin
from twin.cutting.tools import ToolPlan, profile
from twin.job.fixture import FixtureTable
from twin.nc.canonical import FloatArray
from twin.recording.reader import Samples
from twin.toolpath.part_frame import PartFrame

CELL_MM = 0.5
"""Grid on which fixtures are looked at [mm]: a touch is seen within half of it."""
STRAIGHT_MM = 0.02
LONGEST_MM = 2.0
MOST_JOINED = 64


class FixtureGuard:
    """Finds the first sample at which the cutter touches a fixture.

    A fixture counts as solid down to the table, and turns with it.
    """

    def __init__(
        self,
        fixtures: Sequence[FixtureTable],
        tools: ToolPlan,
        part_frame: PartFrame,
        table_height: float,
    ) -> None:
        """Lay the fixtures' heights on a grid.

        Args:
            fixtures: At least one.
            tools: What is in the spindle when.
            part_frame: How table and fixtures turn under the tool.
            table_height: Machine Z at which the first tool's tip is on the table [mm].
        """
        self._fixtures = fixtures
        self._tools = tools
        self._part_frame = part_frame
        self._last: tuple[int, FloatArray] | None = None
        places = np.array([fixture.position for fixture in fixtures])
        half = 0.5 * np.array([fixture.extent for fixture in fixtures])
        # Fixtures are measured with the table at zero, where the part's frame is turned back.
        angle = -np.deg2rad(part_frame.turn_zero)
        self._turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
        self._places = places[:, :2] @ self._turn.T
        reach = np.hypot(half[:, 0], half[:, 1])[:, None] + CELL_MM
        low, high = (self._places - reach).min(axis=0), (self._places + reach).max(axis=0)
        columns, rows = np.ceil((high - low) / CELL_MM).astype(int) + 1
        heights = np.full((rows, columns), table_height)
        self._map = HeightMap(
            origin=(float(low[0]), float(low[1])),
            cell=CELL_MM,
            bottom=table_height,
            heights=heights,
            top=table_height,
            outline=Outline(tuple(0.5 * (low + high)), tuple(0.5 * (high - low)), round=False),
            uncut=heights,
        )
        grid = np.stack(np.meshgrid(self._map.x, self._map.y), axis=-1)
        for fixture, place in zip(fixtures, self._places, strict=True):
            across = np.abs((grid - place) @ self._turn)
            size = 0.5 * np.array(fixture.extent[:2])
            inside = np.all(across <= size, axis=-1)
            if fixture.diameter is not None:
                inside = np.hypot(across[..., 0], across[..., 1]) <= size[0]
            top = table_height + fixture.position[2] + fixture.extent[2]
            heights[inside] = np.maximum(heights[inside], top)
        self._map.top = float(heights.max())

    def look(self, samples: Samples) -> tuple[int, CutEvent, str] | None:
        """Look at samples that follow the last ones.

        Returns:
            Number of the first sample that touches a fixture, what happened, and the fixture's
            name; None where nothing is touched.
        """
        points = self._part_frame.position(samples.joint_position)
        for run, tool in self._tools.runs(samples.setpoint.move):
            tip = points[run] - [0.0, 0.0, self._tools.longer(tool)]
            if self._last is not None and self._last[0] == tool.number:
                before = self._last[1]
            else:
                before = tip[:1]
            self._last = (tool.number, tip[-1:])
            tip = np.concatenate([before, tip])
            if tip[:, 2].min() >= self._map.top:
                continue
            group = np.zeros(len(tip), np.int64)
            chosen = thin(tip, group, STRAIGHT_MM, LONGEST_MM, MOST_JOINED)
            way, edge = tip[chosen], profile(tool)
            found = np.zeros((3, len(way) - 1))
            sweep(
                self._map.heights, self._map.grid, way,
                (edge.radius, edge.flat, edge.corner, edge.slope), Removal(*found),
                np.zeros((0, 0)), found[0],
            )  # fmt: skip
            depth = found[1]
            touched = np.flatnonzero(depth > SCRAPE_MM)
            if not len(touched):
                continue
            first = int(touched[0])
            sample = run.start + int(chosen[first + 1]) - 1
            place = way[first + 1]
            event = CutEvent(
                line=int(samples.setpoint.line[sample]),
                time_s=float(samples.setpoint.time[sample]),
                depth_mm=float(depth[first]),
                position=(float(place[0]), float(place[1]), float(place[2])),
                what="fixture",
            )
            return sample, event, self._nearest(place)
        return None

    def _nearest(self, place: FloatArray) -> str:
        """Name of the fixture whose side is nearest to a place."""
        off = np.abs((place[:2] - self._places) @ self._turn)
        sizes = 0.5 * np.array([fixture.extent[:2] for fixture in self._fixtures])
        distance = np.hypot(*np.maximum(off - sizes, 0.0).T)
        return self._fixtures[int(np.argmin(distance))].name
