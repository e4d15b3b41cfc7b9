"""The machine as the page draws it: a model of its own, with the stock as columns.

A browser is sent the model once and then only states. So the stock that is being cut travels as
state too: it is drawn as square columns, each a mocap body that stands as high as the material below
it. The drawn columns are coarser than the height map that is cut.
"""

import mujoco
import numpy as np

from twin.cutting.height_map import HeightMap
from twin.machine.model import build_spec
from twin.machine.tool_shape import COLLISION_GROUP, VISUAL_GROUP
from twin.nc.canonical import FloatArray
from twin.render.scene.placement import ROTARY_TABLE, Joints, place
from twin.render.scene.work_holding import add_work_holding
from twin.training.session.room import Room
from twin.units import MM

STOCK_GROUP = 1
"""Geom group of the columns, so that the stock can be switched off."""
PLAIN_COLUMNS = 16
"""Most columns along the stock's longer side where every body that is drawn costs time."""
_SUNK = -10.0
"""Where columns without material are put [m]: below the floor."""
_STEEL = (0.62, 0.68, 0.74, 1.0)
_SHADE = 0.04
"""How much lighter and darker columns lie in turns, so that steps can be seen."""


class Display:
    """The drawn model of a room.

    Attributes:
        model: What is sent to the page.
        data: Its state.
        frame: Where the part's frame lies on the turning table.
    """

    def __init__(self, room: Room, *, plain: bool) -> None:
        """Build the drawn machine.

        Args:
            room: The room.
            plain: Draw the machine by its collision bodies and without shadows, for computers
                without a graphics card.
        """
        machine, tables = room.machine.machine, room.tables
        spec = build_spec(machine, tables.tool)
        tool_length = tables.tool.length
        turn_zero = room.part_frame.turn_zero
        self.frame = place(machine, spec.compile(), tool_length, turn_zero)
        self._columns: _Columns | None = None
        stock = room.scene.preparation.job.file.stock
        if room.work is not None and stock is not None:
            corner = tables.true_zero[:3] - np.array([*machine.part_frame.center, 0.0])
            add_work_holding(spec, stock, self.frame, corner)
            along = room.scene.file.picture.columns
            self._columns = _Columns(room.work.map, min(along, PLAIN_COLUMNS) if plain else along)
            self._columns.add_to(spec)
        if plain:
            _make_plain(spec)
        self.model: mujoco.MjModel = spec.compile()
        self.model.opt.disableflags |= int(mujoco.mjtDisableBit.mjDSBL_CONTACT)
        self.data = mujoco.MjData(self.model)
        self._joints = Joints(machine, self.model)
        self._table = int(self.model.body(ROTARY_TABLE).id)
        self._version = -1
        self.update(room)

    def update(self, room: Room) -> None:
        """Bring the drawn machine to where the room's stands."""
        self._joints.set(self.data, room.machine.position)
        mujoco.mj_kinematics(self.model, self.data)
        columns = self._columns
        if columns is None or room.work is None:
            return
        if room.work.version != self._version:
            self._version = room.work.version
            columns.measure(room.work.map)
        rotation = self.data.xmat[self._table].reshape(3, 3)
        places = self.frame.points(columns.tops) @ rotation.T + self.data.xpos[self._table]
        places[columns.empty, 2] = _SUNK
        turned = np.zeros(4)
        mujoco.mju_mat2Quat(turned, (rotation @ self.frame.rotation).ravel())
        self.data.mocap_pos[:] = places
        self.data.mocap_quat[:] = turned

    def camera(self, name: str) -> int:
        """Number of a named camera, -1 where there is none."""
        return mujoco.mj_name2id(self.model, mujoco.mjtObj.mjOBJ_CAMERA, name)


class _Columns:
    """The stock as square columns of its full height that sink as material is cut.

    Attributes:
        tops: Middle of each column, in the part's frame, shape (n, 3) [mm].
        empty: Columns that hold no material, shape (n,).
    """

    def __init__(self, stock: HeightMap, along: int) -> None:
        rows, across = stock.heights.shape
        self._every = max(1, -(-max(rows, across) // along))
        self._height = stock.top - stock.bottom
        self._bottom = stock.bottom
        size = self._every * stock.cell
        count = (-(-rows // self._every), -(-across // self._every))
        x = stock.origin[0] - 0.5 * stock.cell + size * (np.arange(count[1]) + 0.5)
        y = stock.origin[1] - 0.5 * stock.cell + size * (np.arange(count[0]) + 0.5)
        grid = np.meshgrid(x, y)
        self.tops = np.stack([grid[0].ravel(), grid[1].ravel(), np.zeros(grid[0].size)], axis=1)
        self._half = 0.5 * size
        self._shade = np.indices(count).sum(axis=0).ravel() % 2
        self.empty = np.zeros(len(self.tops), np.bool_)
        self.measure(stock)

    def add_to(self, spec: mujoco.MjSpec) -> None:
        """Put one mocap body per column into the world."""
        for number, shade in enumerate(self._shade):
            body = spec.worldbody.add_body(name=f"column {number}", mocap=True)
            tint = 1.0 - _SHADE * float(shade)
            body.add_geom(
                type=mujoco.mjtGeom.mjGEOM_BOX,
                size=[self._half * MM, self._half * MM, 0.5 * self._height * MM],
                rgba=[_STEEL[0] * tint, _STEEL[1] * tint, _STEEL[2] * tint, 1.0],
                contype=0,
                conaffinity=0,
                group=STOCK_GROUP,
            )

    def measure(self, stock: HeightMap) -> None:
        """Take over the heights: the lowest below each column, so that every groove is seen."""
        every, heights = self._every, stock.heights
        rows = -(-heights.shape[0] // every) * every - heights.shape[0]
        across = -(-heights.shape[1] // every) * every - heights.shape[1]
        padded: FloatArray = np.pad(heights, ((0, rows), (0, across)), mode="edge")
        blocks = padded.reshape(padded.shape[0] // every, every, padded.shape[1] // every, every)
        solid = blocks > self._bottom
        filled = np.where(solid, blocks, np.inf).min(axis=(1, 3)).ravel()
        # A column at the rim counts when half of it is material.
        self.empty = solid.mean(axis=(1, 3)).ravel() < 0.5
        self.tops[:, 2] = np.where(self.empty, self._bottom, filled) - 0.5 * self._height


def _make_plain(spec: mujoco.MjSpec) -> None:
    """Leave the collision bodies and the tool; drop meshes and every kind of shadow."""
    for geom in list(spec.geoms):
        if geom.type == mujoco.mjtGeom.mjGEOM_MESH:
            spec.delete(geom)
        elif geom.group == COLLISION_GROUP:
            geom.group = VISUAL_GROUP
    for unseen in [*spec.meshes]:
        spec.delete(unseen)
    for light in spec.lights:
        light.castshadow = False
    # Studio's renderer reads this; it saves a second pass over everything that is drawn.
    spec.add_numeric(name="filament.ao.enabled", data=[0.0], size=1)
    spec.visual.quality.shadowsize = 0
    spec.visual.quality.offsamples = 0
