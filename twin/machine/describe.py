"""What a machine can do, as figures: ``twin machine list`` and ``twin machine show``."""

import dataclasses
import math

from twin.files.shipped import machine_file, machine_names, variant_names
from twin.machine.description.config import MachineConfig
from twin.machine.load import read_machine
from twin.machine.model.drives import reflected_inertia
from twin.machine.model.model import build_spec, drives, physics_model
from twin.units import SECONDS_PER_MINUTE, AxisKind, kv_per_second


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class AxisFacts:
    """One axis in figures."""

    name: str
    kind: AxisKind
    travel: tuple[float, float] | None
    """[mm or deg]; none: endless."""
    velocity: float
    """Rapid [mm/min or deg/min]."""
    acceleration: float
    """[mm/s² or deg/s²]."""
    jerk: float
    """[mm/s³ or deg/s³]."""
    kv: float
    """Loop gain [(m/min)/mm or (1000 deg/min)/deg]."""
    moved: float
    """What the motor moves, reflected inertia included [kg or kg m²]."""
    reflected: float
    """Motor and screw, reflected to the axis [kg or kg m²]."""
    natural_frequency_hz: float
    """Of the position loop [Hz]."""
    lag: float
    """Following error at the asked feed, without friction [mm or deg]."""


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class MachineFacts:
    """A machine in figures."""

    name: str
    axes: tuple[AxisFacts, ...]
    feed: float
    """Feed that the lags belong to [mm/min or deg/min]."""
    spindle_over_table_mm: float
    """Spindle nose over the work-holding surface with all axes at zero."""
    servo_period_s: float

    def as_contract(self) -> dict[str, object]:
        """The figures as ``twin machine show --format json`` prints them."""
        return dataclasses.asdict(self)


def describe(machine: MachineConfig, feed: float = 1000.0) -> MachineFacts:
    """Gather a machine's figures.

    Args:
        feed: What the expected lag is given for [mm/min; for rotary axes deg/min].

    Raises:
        ConfigError: The model is wrong.
    """
    loops = drives(machine, physics_model(machine, build_spec(machine)))
    facts = []
    for name, loop in zip(machine.axes.names, loops, strict=True):
        axis = machine.axis(name)
        trail = (1.0 - axis.velocity_feedforward) / kv_per_second(axis.kv) + axis.command_filter_s
        facts.append(
            AxisFacts(
                name=name,
                kind=axis.kind,
                travel=axis.travel,
                velocity=axis.velocity * SECONDS_PER_MINUTE,
                acceleration=axis.acceleration,
                jerk=axis.jerk,
                kv=axis.kv,
                moved=loop.moved,
                reflected=reflected_inertia(axis),
                natural_frequency_hz=loop.natural_frequency / (2.0 * math.pi),
                lag=feed / SECONDS_PER_MINUTE * trail,
            )
        )
    return MachineFacts(
        name=machine.file.name,
        axes=tuple(facts),
        feed=feed,
        spindle_over_table_mm=machine.at_zero.spindle_over_table,
        servo_period_s=machine.file.servo_period_s,
    )


def shipped_machines() -> tuple[MachineConfig, ...]:
    """The machines that come with the twin, by name, each with its variants after it."""
    names = sorted((*machine_names(), *variant_names()))
    return tuple(read_machine(machine_file(name)) for name in names)
