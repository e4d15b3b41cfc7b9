"""The MuJoCo model of a machine: its MJCF file, its drives, the tool in its spindle."""

from functools import cached_property

import mujoco
import numpy as np

from twin.errors import ConfigError
from twin.job.fixture import Weight
from twin.job.job_file import ToolTable
from twin.machine.description.config import Blank, MachineConfig
from twin.machine.description.kinematics import SPINDLE_NOSE, TABLE_TOP
from twin.machine.description.measured_mass import set_measured_masses
from twin.machine.model.drive_actuators import add_drives
from twin.machine.model.drives import Drive, tune
from twin.machine.model.fixture_shape import add_fixture
from twin.machine.model.head_shape import HeadShape
from twin.machine.model.supplied import supply
from twin.machine.model.tool_shape import (
    CLAMPED_SIDE,
    COLLISION_GROUP,
    FRAME_SIDE,
    PART_SIDE,
    STOCK_SIDE,
    TOOL_SIDE,
    VISUAL_GROUP,
    add_materials,
    add_tool,
    default_tool,
)
from twin.machine.model.transmission import add_inertia
from twin.machine.model.work_holding import supports
from twin.nc.canonical import FloatArray
from twin.units import MM

BLANK = "stock"
"""Geom of the stock, as an alarm calls it."""

_WEIGHTLESS = "must be larger than mjMINVAL"
"""What MuJoCo says of a moving body without mass."""

_TUNED_FOR = "moved at tuning"
"""Number field of a model: what the motors moved when their drives were tuned."""

_JOINT_TYPES = {"linear": mujoco.mjtJoint.mjJNT_SLIDE, "rotary": mujoco.mjtJoint.mjJNT_HINGE}


class MachineModel:
    """A machine with what is clamped on its table and a tool in its spindle.

    Drives are tuned once, whatever tool comes. The compiled forms are made when they are first asked for: MuJoCo
    steps a model without geoms in less time, and distances need those that may not meet.

    Attributes:
        spec: The editable model, which compiles.
    """

    def __init__(
        self, machine: MachineConfig, tool: ToolTable | None = None, blank: Blank | None = None
    ) -> None:
        """Build the model.

        Args:
            tool: What the spindle holds; a 10 mm end mill by default.

        Raises:
            ConfigError: The model cannot be read, or lacks what the machine file or the twin names.
        """
        self.machine, self.blank = machine, blank
        self._without_tool = _without_tool(machine, blank)
        self.tool = tool or default_tool(machine.file.spindle.flange_diameter)
        self.spec = self._with_tool()

    def with_tool(self, tool: ToolTable) -> "MachineModel":
        """The same model with another tool in its spindle."""
        other = object.__new__(MachineModel)
        other.machine, other.blank = self.machine, self.blank
        other._without_tool = self._without_tool
        other.tool = tool
        other.spec = other._with_tool()
        return other

    @cached_property
    def physics(self) -> mujoco.MjModel:
        """What moves, without geoms."""
        return physics_model(self.machine, self.spec)

    @cached_property
    def solids(self) -> mujoco.MjModel:
        """Only those geoms that may not meet."""
        return clearance_model(self.machine, self.spec)

    @cached_property
    def head(self) -> HeadShape:
        """What is around and above the spindle."""
        return HeadShape(self.machine, self.solids)

    def _with_tool(self) -> mujoco.MjSpec:
        spec = self._without_tool.copy()
        try:
            add_tool(spec, self.tool, self.machine.file.spindle.flange_diameter)
        except ValueError as error:
            raise _incomplete(self.machine, error) from error
        return spec


def build_spec(
    machine: MachineConfig, tool: ToolTable | None = None, blank: Blank | None = None
) -> mujoco.MjSpec:
    """The editable model of a ``MachineModel``: machine, lights, cameras, drives, tool.

    Returns:
        A specification that compiles; others may add to it, to the body of the site ``table_top`` above all.

    Raises:
        ConfigError: As for ``MachineModel``.
    """
    return MachineModel(machine, tool, blank).spec


def _read(machine: MachineConfig) -> mujoco.MjSpec:
    try:
        spec = mujoco.MjSpec.from_file(str(machine.model_path))
    except ValueError as error:
        raise ConfigError(f"{machine.model_path}: is not an MJCF model: {error}") from error
    _require(machine, "site", SPINDLE_NOSE, [site.name for site in spec.sites])
    _require(machine, "site", TABLE_TOP, [site.name for site in spec.sites])
    return spec


def _without_tool(machine: MachineConfig, blank: Blank | None) -> mujoco.MjSpec:
    """The model with an empty spindle."""
    spec = _read(machine)
    _require_mesh_files(spec, machine)
    try:
        _complete(spec, machine, blank)
    except ValueError as error:
        raise _incomplete(machine, error) from error
    return spec


def _incomplete(machine: MachineConfig, error: ValueError) -> ConfigError:
    return ConfigError(f"{machine.model_path}: cannot be completed: {error}")


def _complete(spec: mujoco.MjSpec, machine: MachineConfig, blank: Blank | None) -> None:
    supply(spec, machine)
    add_materials(spec)
    _set_clock(spec, machine)
    _set_inertia(spec, machine)
    # Gains follow from what MuJoCo's inertia matrix says of the empty machine, which is why it is compiled here.
    empty = drives(machine, compiled(_without(spec, VISUAL_GROUP), machine))
    add_drives(spec, machine, empty)
    spec.add_numeric(name=_TUNED_FOR, data=[drive.moved for drive in empty])
    _hold_against_clamped(spec)
    _add_fixtures(spec, machine)
    if blank is not None:
        _add_blank(spec, blank)


def _require(machine: MachineConfig, what: str, name: str, known: list[str]) -> None:
    if name not in known:
        raise ConfigError(
            f"{machine.model_path}: has no {what} '{name}'; it has {', '.join(filter(None, known))}"
        )


def _require_mesh_files(spec: mujoco.MjSpec, machine: MachineConfig) -> None:
    """The lean model that is compiled first looks at no mesh that is only seen."""
    folder = machine.model_path.parent / spec.meshdir
    for mesh in spec.meshes:
        if mesh.file and not (folder / mesh.file).is_file():
            raise ConfigError(f"{machine.model_path}: there is no mesh '{folder / mesh.file}'")


def _set_clock(spec: mujoco.MjSpec, machine: MachineConfig) -> None:
    """RK4 at the servo period: ``sampling`` says why, and its tests hold it to 0.1 µm.

    Drives that are faster than that make the step shorter (``drive_actuators``).
    """
    spec.option.timestep = machine.file.servo_period_s
    spec.option.integrator = mujoco.mjtIntegrator.mjINT_RK4
    spec.option.jacobian = mujoco.mjtJacobian.mjJAC_DENSE


def _set_inertia(spec: mujoco.MjSpec, machine: MachineConfig) -> None:
    for name in machine.axes.names:
        axis = machine.axis(name)
        _require(machine, "joint", axis.joint, [joint.name for joint in spec.joints])
        if spec.joint(axis.joint).type != _JOINT_TYPES[axis.kind]:
            raise ConfigError(
                f"{machine.model_path}: joint '{axis.joint}' does not move as axis {name}, "
                f"which is {axis.kind}, must"
            )
        add_inertia(spec, axis)
    set_measured_masses(spec, machine)


def _add_fixtures(spec: mujoco.MjSpec, machine: MachineConfig) -> None:
    taken = [geom.name for geom in spec.geoms]
    for fixture in machine.file.fixtures:
        if fixture.name in taken:
            raise ConfigError(
                f"{machine.path}: fixture '{fixture.name}' has the name of a part of the machine"
            )
        add_fixture(spec, spec.site(TABLE_TOP), fixture)
        _add_weight(spec, fixture.weight.moved(fixture.position))


def _add_weight(spec: mujoco.MjSpec, weight: Weight) -> None:
    """Clamp a weight to the table; it is placed from the middle of the work-holding surface."""
    if not weight.mass:
        return
    top = spec.site(TABLE_TOP)
    body = top.parent.add_body(pos=list(top.pos + np.array(weight.center) * MM))
    body.explicitinertial = True
    body.mass = weight.mass
    body.ipos = np.zeros(3)
    body.fullinertia = np.array(weight.inertia)


def _add_blank(spec: mujoco.MjSpec, blank: Blank) -> None:
    """To be held against the frame; what is on the tool's side is held against what is left of it."""
    if blank.weight is not None:
        _add_weight(spec, blank.weight)
    top, half = spec.site(TABLE_TOP), np.array(blank.size) / 2.0 * MM
    along = blank.direction
    top.parent.add_geom(
        name=BLANK,
        type=mujoco.mjtGeom.mjGEOM_CYLINDER if blank.round else mujoco.mjtGeom.mjGEOM_BOX,
        size=[half[along - 1], half[along], 0.0] if blank.round else list(half),
        quat=_Z_TURNED_TO[along],
        pos=list(top.pos + np.array(blank.center) * MM),
        group=COLLISION_GROUP,
        contype=STOCK_SIDE | CLAMPED_SIDE,
        conaffinity=FRAME_SIDE,
        mass=0.0,
    )
    _add_work_holding(spec, blank)


_Z_TURNED_TO = ([0.5, 0.5, 0.5, 0.5], [0.5, -0.5, -0.5, -0.5], [1.0, 0.0, 0.0, 0.0])
"""Turns in which Z points along X, Y and Z: X, Y and Z change places in their order."""


def _add_work_holding(spec: mujoco.MjSpec, blank: Blank) -> None:
    """What is drawn under the stock is as solid as a fixture."""
    top = spec.site(TABLE_TOP)
    x, y, z = blank.center
    gap = z - blank.size[2] / 2.0 - blank.relief
    for support in supports(blank.size, gap, box=not blank.on_post):
        half = [size * MM for size in support.half]
        top.parent.add_geom(
            name=support.name,
            type=mujoco.mjtGeom.mjGEOM_CYLINDER if support.round else mujoco.mjtGeom.mjGEOM_BOX,
            size=[half[0], half[2], 0.0] if support.round else half,
            pos=list(top.pos + np.array([x, y + support.aside, gap / 2.0]) * MM),
            group=COLLISION_GROUP,
            contype=PART_SIDE | CLAMPED_SIDE,
            conaffinity=TOOL_SIDE | FRAME_SIDE,
            mass=0.0,
        )


def _hold_against_clamped(spec: mujoco.MjSpec) -> None:
    """Let all that does not turn with the table be met by what is clamped on it.

    The table's own faceplate is built so as to pass what carries it; the tool's side meets fixtures as
    it is, and the stock as it is cut.
    """
    carrier = spec.site(TABLE_TOP).parent.name
    for geom in spec.geoms:
        turns = geom.parent.name == carrier
        if geom.group == COLLISION_GROUP and not turns and not geom.contype & TOOL_SIDE:
            geom.conaffinity |= CLAMPED_SIDE


def compiled(spec: mujoco.MjSpec, machine: MachineConfig) -> mujoco.MjModel:
    """Compile a specification.

    Raises:
        ConfigError: It does not compile; the message names the model.
    """
    try:
        return spec.compile()
    except ValueError as error:
        needed = (
            '; give it <inertial pos="0 0 0" mass="..." diaginertia="... ... ..."/> or a shape with a mass'
            * (_WEIGHTLESS in str(error))
        )
        raise ConfigError(f"{machine.model_path}: does not compile: {error}{needed}") from error
    except RuntimeError as error:
        # MuJoCo tells what is wrong with a model by ValueError.
        raise ConfigError(
            f"{machine.model_path}: MuJoCo could not compile it, and does not say why ({error}); "
            "so it is where memory runs out"
        ) from error


def drives(machine: MachineConfig, model: mujoco.MjModel) -> tuple[Drive, ...]:
    """Derive every axis's position loop from the masses of the compiled model at home.

    They are those of the empty table: what a job clamps there changes no gain, as no control is
    tuned again for each part.

    Returns:
        One drive per axis, in the order of ``machine.axes``.
    """
    numbers = [model.numeric(index).name for index in range(model.nnumeric)]
    tuned_for = model.numeric(_TUNED_FOR).data if _TUNED_FOR in numbers else moved(machine, model)
    return tuple(
        tune(machine.axis(name), float(size))
        for name, size in zip(machine.axes.names, tuned_for, strict=True)
    )


def moved(machine: MachineConfig, model: mujoco.MjModel) -> FloatArray:
    """What the motors feel of a compiled model at home, with all that is on the table.

    Returns:
        Mass [kg] or moment of inertia [kg m²] of every axis, shape (k,).
    """
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    inertia = np.zeros((model.nv, model.nv))
    mujoco.mj_fullM(model, data, inertia)
    joints = [model.joint(machine.axis(name).joint) for name in machine.axes.names]
    return np.array([inertia[dof, dof] for dof in (int(joint.dofadr[0]) for joint in joints)])


def physics_model(machine: MachineConfig, spec: mujoco.MjSpec) -> mujoco.MjModel:
    """Compile the model without its geoms: the same motion, in less time.

    Every moving body has its own inertial, so that geoms weigh nothing; what may not meet is
    watched by ``clearance``, and a run ends where it meets. Bodies that do not move against each
    other, as spindle and head, are one; and to sort a few axes into islands costs more than it
    saves the solver.

    Raises:
        ConfigError: The specification does not compile.
    """
    lean = _without(spec, VISUAL_GROUP, COLLISION_GROUP)
    lean.compiler.fusestatic = True
    lean.option.disableflags |= mujoco.mjtDisableBit.mjDSBL_ISLAND
    return compiled(lean, machine)


def clearance_model(machine: MachineConfig, spec: mujoco.MjSpec) -> mujoco.MjModel:
    """Compile the model with only those geoms that may not meet.

    Raises:
        ConfigError: The specification does not compile.
    """
    lean = _without(spec, VISUAL_GROUP)
    # Pairs that the model excludes are pairs of its own bodies.
    lean.compiler.fusestatic = not spec.excludes
    lean.option.ccd_tolerance = _DISTANCE_TOLERANCE
    lean.option.ccd_iterations = _DISTANCE_ITERATIONS
    return compiled(lean, machine)


_DISTANCE_TOLERANCE = 1e-9
"""What distances are measured to [m]: the planes that clear a run between two looks rely on it."""
_DISTANCE_ITERATIONS = 200


def _without(spec: mujoco.MjSpec, *groups: int) -> mujoco.MjSpec:
    """A copy whose compiled form lacks the geoms of some groups, and all that is only seen.

    MuJoCo leaves out what collides with nothing; deleting geom by geom takes six times as long.
    """
    lean = spec.copy()
    for geom in lean.geoms:
        if geom.group in groups:
            geom.contype = geom.conaffinity = 0
    for unseen in (*lean.cameras, *lean.lights):
        lean.delete(unseen)
    lean.compiler.discardvisual = True
    lean.option.disableflags |= mujoco.mjtDisableBit.mjDSBL_CONTACT
    return lean
