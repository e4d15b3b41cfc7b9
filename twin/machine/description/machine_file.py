"""The machine file ``machine.toml``: axes, drives, feeds, as data."""

from typing import Annotated, Literal

import pydantic
from pydantic import Field

from twin.files.toml import Table
from twin.job.builder import Coordinate, MachineFunctions, Positive, ToolChangeTable
from twin.job.fixture import FixtureTable
from twin.machine.description.geometry import GeometryTable
from twin.nc.canonical import SPATIAL_AXES, Axes
from twin.units import AxisKind

NonNegative = Annotated[float, Field(ge=0)]
Share = Annotated[float, Field(ge=0, le=1)]
Lateness = Annotated[float, Field(ge=0, le=0.1)]
ServoPeriod = Annotated[float, Field(ge=1e-4, le=0.02)]


class LuGreTable(Table):
    """Friction with a memory: bristles that bend before they slip (Canudas de Wit et al. 1995)."""

    stiffness: Positive
    """Of the bristles [N/mm or N m/deg]: the axis moves elastically before it breaks away."""
    damping: NonNegative = 0.0
    """Of the bristles [N s/mm or N m s/deg]."""
    static_friction: NonNegative = 0.0
    """Force at which the axis breaks away [N or N m]; at least ``dry_friction``, and that if 0."""
    stribeck_velocity: Positive = 1.0
    """Speed over which friction falls from static to dry [mm/s or deg/s]."""


class AxisTable(Table):
    """One axis: its joint, its travel, what it can do, and how its drive is tuned.

    What is not given is ideal: no friction, no backlash, a stiff screw, no limits.
    """

    joint: str
    """Joint in the MJCF model; the actuator has the axis's name."""
    kind: AxisKind
    """``linear`` [mm] or ``rotary`` [deg]."""
    direction: Literal[1, -1] = 1
    """Sign of the joint against the machine coordinate."""
    periodic: bool = False
    """Rotary only: turns without end and may be declared periodic to the control."""
    travel: tuple[Coordinate, Coordinate] | None = None
    """Lowest and highest machine coordinate [mm or deg]; none: endless."""
    limit_switches: tuple[Coordinate, Coordinate] | None = None
    """Where the axis runs onto its limit switches [mm or deg]; none: 2 beyond its travel."""
    velocity: Positive
    """Rapid velocity, never exceeded [mm/s or deg/s]."""
    acceleration: Positive
    """[mm/s² or deg/s²]."""
    jerk: Positive
    """[mm/s³ or deg/s³]."""
    motor_inertia: NonNegative = 0.0
    """Of the motor's rotor, coupling included [kg m²]; counts only where ``lead`` is given."""
    screw_inertia: NonNegative = 0.0
    """Of whatever turns with the motor: ball screw, worm, pulley [kg m²]."""
    lead: Positive | None = None
    """Axis travel per turn of the motor [mm or deg]; none: a direct drive, nothing is reflected."""
    mass: NonNegative = 0.0
    """What the motor moves, as it was measured: mass [kg] or inertia [kg m²], motor and screw
    included; 0: as bodies, inertias and lead say. The axis's own body, motor and screw are scaled."""
    viscous_friction: NonNegative = 0.0
    """Of guides and screw [N s/mm or N m s/deg]."""
    dry_friction: NonNegative = 0.0
    """Coulomb friction of guides and screw [N or N m]."""
    constant_force: float = 0.0
    """A force on the axis in either direction of travel, positive along + [N or N m]: weight that no
    counterbalance carries, a cable, a cover's spring."""
    lugre: LuGreTable | None = None
    """Refines ``dry_friction``; none: Coulomb's law."""
    backlash: NonNegative = 0.0
    """Free play between motor and axis [mm or deg]; the position loop closes at the motor. Nothing holds an
    axis within it but friction, load and its own inertia."""
    stiffness: NonNegative = 0.0
    """Of screw, nut and bearings between motor and axis [N/mm or N m/deg]; 0: rigid. With backlash
    rigid walls are springs that half a servo period just follows (1000 N/µm on the X of ``mill4``)."""
    counterbalance: Share | None = None
    """Share of the weight on the axis that a counterbalance takes; none: as the model says."""
    junction_velocity_step: NonNegative = 0.0
    """Largest step of the axis's velocity where an exact path goes through a knee [mm/s or deg/s];
    0: the axis stops there."""
    junction_acceleration_step: NonNegative = 0.0
    """Largest step of its acceleration where only the curvature of the path jumps [mm/s² or deg/s²]."""
    kv: Positive
    """Position-loop gain [(m/min)/mm; rotary (1000 deg/min)/deg]: lag = velocity / gain."""
    damping_ratio: Positive = 1.0
    """Of the position loop seen as a second-order system; 1 is the fastest that cannot overshoot."""
    reset_time_s: NonNegative = 0.0
    """Integral action of the velocity loop: takes what friction, weight and cut leave behind [s];
    0: none. With a ``force_limit`` it stops at what the drive can give."""
    loop_delay_s: Lateness = 0.0
    """Dead time from what the drive measures to the force that it gives [s]; 0: none."""
    velocity_filter_s: Lateness = 0.0
    """Time constant of the filter behind which the drive sees the axis's speed [s]; 0: none."""
    command_filter_s: Lateness = 0.0
    """Time constant of the filter that the setpoint passes before the drive sees it [s]; 0: none. The
    axis trails by velocity times this besides what the loop leaves, whatever the feed-forward."""
    velocity_feedforward: Share = 0.0
    """Share of the setpoint velocity that the drive is commanded; 1 removes the lag."""
    acceleration_feedforward: Share = 0.0
    """Share of the inertial force that the drive adds in advance."""
    force_limit: NonNegative = 0.0
    """Largest drive force [N or N m]; 0: no limit."""
    current_scale: NonNegative = 0.0
    """Force of the drive per ampere that its control shows [N/A or N m/A]; 0: not known."""
    current_at_rest: float = 0.0
    """What the control shows where the drive gives no force [A]."""
    saturation_time_s: NonNegative = 0.05
    """Alarm when the drive stays at its force limit for this long [s]."""
    following_error_limit: NonNegative = 0.0
    """Alarm above this lag [mm or deg]; 0: none."""

    @pydantic.model_validator(mode="after")
    def _friction_fits(self) -> "AxisTable":
        if self.lugre is not None and not self.dry_friction:
            raise ValueError("lugre refines dry_friction, which is 0")
        if self.lugre is not None and 0 < self.lugre.static_friction < self.dry_friction:
            raise ValueError("lugre.static_friction must not be below dry_friction")
        if self.stiffness and not self.lead:
            raise ValueError("stiffness lies between motor and axis: give motor_inertia and lead")
        if self.backlash and not self.lead:
            raise ValueError("backlash lies between motor and axis: give motor_inertia and lead")
        if self.mass and (self.stiffness or self.backlash):
            raise ValueError(
                "mass does not say what of it lies before a spring or a gap: give motor_inertia"
            )
        return self


class PathTable(Table):
    """Limits of the path of X Y Z, whatever the axes could do."""

    acceleration: Positive
    """[mm/s²]."""
    jerk: Positive
    """[mm/s³]."""
    rotary_acceleration: Positive | None = None
    """Acceleration of a path of rotary axes alone [deg/s²]; none: the axes decide."""
    rotary_jerk: Positive | None = None
    """[deg/s³]."""
    corner_tolerance: Positive = 0.01
    """How far a rounded corner may leave the path where the program does not say [mm]."""


class TableTable(Table):
    """What the model must say of the table that carries the part; not needed, and checked."""

    axis: str
    """Name of the rotary axis that turns the part."""
    center: tuple[Coordinate, Coordinate] = (0.0, 0.0)
    """Machine X and Y at which the tool is over the axis of rotation [mm]."""


class SpindleTable(Table):
    """What holds the tool."""

    flange_diameter: Positive = 63.0
    """Of the holder's flange [mm]; 63 is a BT40 taper's (JIS B 6339)."""
    tool_change_s: NonNegative = 0.0
    """Time of a tool change with the spindle at rest [s]; 0: none is counted."""
    acceleration: NonNegative = 0.0
    """How fast the spindle changes its speed [1/min per s]; 0: at once."""
    waits: bool = True
    """Whether the axes wait for the speed of the spindle; else a cut may begin too early."""
    power: tuple[tuple[Positive, Positive], ...] = ()
    """What the drive gives for long by speed: pairs of 1/min and W, rising in speed; below the first the
    torque is constant, above the last the power. None: nothing stalls it."""
    max_speed: Positive | None = None
    """Never exceeded [1/min]; none: not limited."""
    overload: Positive = 1.5
    """What it gives for a short time, as a share of what it gives for long."""
    overload_time_s: Positive = 5.0
    """Alarm when the load is above 100 % for this long [s]."""

    @pydantic.model_validator(mode="after")
    def _spindle_fits(self) -> "SpindleTable":
        speeds = [speed for speed, _ in self.power]
        if speeds != sorted(set(speeds)):
            raise ValueError("spindle.power must rise in speed")
        return self


class GrowthTable(Table):
    """One cause by which a warm machine grows: a state of first order, cold where a run begins.

    It tends to ``um`` times what drives it over ``at``.
    """

    source: str
    """What warms it: ``spindle``, by its speed, or an axis, by the power of its drive."""
    at: Positive
    """Speed [1/min] or power [W] that leads to ``um``."""
    um: tuple[float, float, float]
    """Where the tool goes in the end, along X, Y and Z [µm]."""
    time_constant_s: Positive
    """After which 63 % of it are there [s]."""


class CollisionTable(Table):
    """What the control watches between the tool's side and the part's."""

    near_miss: NonNegative = 5.0
    """Clearance below which a run reports a near miss [mm]."""


class ControlTable(Table):
    """What the control assumes where a program is silent."""

    default_feed: Positive = 1000.0
    """[mm/min]."""
    default_rotary_feed: Positive = 3600.0
    """For moves of rotary axes alone [deg/min]."""
    recalculate_on_rapid: bool = False
    """``gost``: G102 also relabels the start of G0 blocks."""
    module_rotary: bool = False
    """``fagor8070``, ``linuxcnc`` (WRAPPED_ROTARY): the sign of an absolute rotary target is the direction of rotation,
    by less than a turn."""
    rollover: Literal["shorter", "sign"] | None = None
    """``fanuc``, parameters 1006 and 1008 (ROT, ROA, RAB): absolute rotary targets are those of a turn, reached by the
    shorter path (RAB 0), or in the direction of their sign (RAB 1); missing: as they are written (ROA 0)."""
    decimal_point: Literal["calculator", "increments"] | None = None
    """``fanuc``, ``haas``: ``X10`` is 10 mm ("calculator"), or 0.010 mm ("increments")."""
    units: Literal["mm", "inch"] | None = None
    """In which units programs begin that name none: a setting of controls (9 of a Haas), or what was in force when
    they were switched off (Fanuc)."""
    helical_feed: Literal["arc", "path"] | None = None
    """``fanuc``, parameter 1403 #5 (HTG): F of a helix counts the arc in its plane (0, the control's default), or
    the path (1)."""
    rotary_diameter: Positive | None = None
    """``haas``, setting 34: diameter at which F counts the path of rotary axes [mm]; without it a degree counts
    1 mm together with linear axes, and F of rotary axes alone is deg/min."""
    feed_of_all_axes: bool = False
    """``fagor8070``, FEEDND: F counts rotary axes together with X, Y and Z, a degree as 1 mm; the control's default is No."""
    length_returns: Literal["by code", "next block"] = "by code"
    """``fanuc``, parameter 5001 #6 (EVO): a tool length that G28, G30 or G53 has cancelled counts again from G43,
    G44 or H (0, the control's default), or from the next block (1)."""
    m_functions: MachineFunctions = Field(default_factory=dict)
    """M codes of the machine's builder: ``M10 = "clamp the table"``."""


class MachineFile(Table):
    """The whole machine file."""

    schema_: Literal[1] = Field(alias="schema")
    """Version of this form."""
    name: str
    """What results, reports and recordings call the machine."""
    model: str
    """MJCF file, relative to the machine file (to that of ``base``, where it comes from there)."""
    servo_period_s: ServoPeriod = 0.001
    """Clock of setpoints, drives and recording [s], from 0.1 to 20 ms."""
    axes: dict[str, AxisTable]
    """By axis name; must hold X, Y and Z."""
    path: PathTable
    table: TableTable | None = None
    spindle: SpindleTable = SpindleTable()
    tool_change: ToolChangeTable = ToolChangeTable()
    fixtures: tuple[FixtureTable, ...] = ()
    collision: CollisionTable = CollisionTable()
    geometry: GeometryTable = GeometryTable()
    thermal: dict[str, GrowthTable] = Field(default_factory=dict)
    """How the machine grows as it warms, by names that a verdict uses; none: it does not."""
    control: ControlTable = ControlTable()

    @pydantic.model_validator(mode="after")
    def _consistent(self) -> "MachineFile":
        missing = [name for name in SPATIAL_AXES if name not in self.axes]
        if missing:
            raise ValueError(f"axes {', '.join(missing)} are missing")
        for name, axis in self.axes.items():
            if axis.travel is not None and axis.travel[0] >= axis.travel[1]:
                raise ValueError(f"axes.{name}.travel must rise from lowest to highest")
            if axis.limit_switches is not None and axis.limit_switches[0] >= axis.limit_switches[1]:
                raise ValueError(f"axes.{name}.limit_switches must rise from lowest to highest")
            if axis.periodic and axis.kind != "rotary":
                raise ValueError(f"axes.{name} is periodic but not rotary")
            if axis.periodic and axis.travel is not None:
                raise ValueError(f"axes.{name} is periodic, that is endless, but has a travel")
        if self.table is not None and self.table.axis not in self.axes:
            raise ValueError(f"table.axis '{self.table.axis}' is not an axis")
        if self.table is not None and self.axes[self.table.axis].kind != "rotary":
            raise ValueError(f"table.axis '{self.table.axis}' is not rotary")
        self.geometry.of(self.ordered_axes())
        for name, growth in self.thermal.items():
            if growth.source not in ("spindle", *self.axes):
                known = ", ".join(("spindle", *self.axes))
                raise ValueError(f"thermal.{name}.source '{growth.source}' is none of {known}")
        joints = [axis.joint for axis in self.axes.values()]
        fixtures = [fixture.name for fixture in self.fixtures]
        for what, names in (("joint", joints), ("fixture", fixtures)):
            twice = sorted({name for name in names if names.count(name) > 1})
            if twice:
                raise ValueError(f"{what} '{twice[0]}' is named twice")
        return self

    def ordered_axes(self) -> Axes:
        """Names and kinds in the order of every column: X, Y, Z, then the others as written."""
        names = (*SPATIAL_AXES, *(name for name in self.axes if name not in SPATIAL_AXES))
        return Axes(names, tuple(self.axes[name].kind for name in names))
