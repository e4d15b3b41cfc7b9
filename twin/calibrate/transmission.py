"""Backlash and stiffness from logs of a second encoder or of ball-bars."""

import dataclasses
from collections.abc import Sequence

from twin.calibrate.fit.ball_bar import STIFFNESS, BallBarFit
from twin.calibrate.fit.give import NO_SECOND_ENCODER, fit_give, rigid_errors
from twin.calibrate.fit.parameters import coordinates
from twin.calibrate.fit.solve import Interval
from twin.calibrate.fit.stages import AxisFit
from twin.calibrate.prepared import PreparedLog
from twin.machine.description.config import MachineConfig
from twin.machine.description.machine_file import AxisTable
from twin.machine.model.drives import reflected_inertia
from twin.units import AxisKind

BEFORE_THE_GAP = ("motor_inertia", "screw_inertia")
"""What of the mass lies before the gap: no log determines it, it is the base's. A stiffness depends on it."""


def units_of(kind: AxisKind) -> dict[str, str]:
    """Units of all that may be fitted of an axis, by name."""
    give = {"backlash": "mm", "stiffness": "N/mm"}
    if kind == "rotary":
        give = {"backlash": "deg", "stiffness": "N m/deg"}
    return {name: coordinate.unit for name, coordinate in coordinates(kind, 1.0).items()} | give


def with_give(
    machine: MachineConfig, name: str, fit: AxisFit, logs: Sequence[PreparedLog], moved: float
) -> AxisFit:
    """A fit with backlash and stiffness, where a second encoder tells them.

    Args:
        fit: What else its logs came to.
        moved: What the motor of the base feels [kg or kg m²].
    """
    pieces = [
        piece
        for item in logs
        if not item.is_slow and "load" in item.log.axes[name].more
        for piece in item.stretches(name)
    ]
    if not pieces:
        absent = dict.fromkeys(("backlash", "stiffness"), NO_SECOND_ENCODER)
        return dataclasses.replace(fit, undetermined=fit.undetermined | absent)
    axis = machine.axis(name)
    mass = fit.parameters.mass if "mass" in fit.fitted else moved
    fitted, conditional = dict(fit.fitted), dict(fit.conditional)
    friction = fitted.get("dry_friction") or conditional.get("dry_friction", (None,))[0]
    give = fit_give(axis.kind, pieces, fit.parameters, mass - reflected_inertia(axis), friction)
    undetermined = dict(fit.undetermined)
    if give.backlash is not None and give.backlash.low > 0.0:
        errors = rigid_errors(pieces)
        errors |= {"damping_ratio": errors["mass"]} if errors else {}
        fitted = {key: _off_by(one, errors.get(key, 0.0)) for key, one in fitted.items()}
        conditional = {
            key: (_off_by(one, errors.get(key, 0.0)), given)
            for key, (one, given) in conditional.items()
        }
    if give.backlash is None:
        undetermined["backlash"] = give.why
    elif give.backlash.low <= 0.0:
        undetermined["backlash"] = _up_to(give.backlash.high, axis)
    else:
        fitted["backlash"] = give.backlash
    if give.stiffness is None:
        undetermined["stiffness"] = give.why
    else:
        stiffness, given = give.stiffness, [*BEFORE_THE_GAP]
        if "mass" in fit.fitted:
            known = fit.fitted["mass"]
            off = max(known.high - known.value, known.value - known.low) / known.value
            stiffness = stiffness.widened(off * stiffness.value)
        else:
            given.insert(0, "mass")
        conditional["stiffness"] = (stiffness, tuple(given))
        undetermined["stiffness"] = (
            "only its ratio to the mass behind the gap is determined; "
            f"{stiffness.value:.4g} holds for {mass - reflected_inertia(axis):.5g} "
            f"of {mass:.5g} behind it, as the base's motor and screw have it, and for friction there"
        )
    return dataclasses.replace(
        fit, fitted=fitted, conditional=conditional, undetermined=undetermined
    )


def _off_by(interval: Interval, share: float) -> Interval:
    """An interval of what may be off by a share of its value besides."""
    return interval.widened(share * abs(interval.value))


def with_ball_bars(
    axis: AxisTable, name: str, fit: AxisFit, circles: Sequence[BallBarFit]
) -> AxisFit:
    """A fit with the backlash that ball-bars tell, where no second encoder does.

    Args:
        fit: What else its logs came to.
    """
    lost = [circle.lost[name] for circle in circles if name in circle.lost]
    if not lost or "backlash" in fit.fitted:
        return fit
    strained = 2.0 * fit.parameters.dry_friction / axis.stiffness if axis.stiffness else 0.0
    middle = lost[0].spanning(*lost[1:])
    low, value, high = (end - strained for end in (middle.low, middle.value, middle.high))
    undetermined, fitted = dict(fit.undetermined), dict(fit.fitted)
    undetermined["stiffness"] = STIFFNESS
    if low > 0.0:
        fitted["backlash"] = Interval(value, low, high)
        undetermined.pop("backlash", None)
    else:
        undetermined["backlash"] = _up_to(high, axis)
    return dataclasses.replace(fit, fitted=fitted, undetermined=undetermined)


def _up_to(high: float, axis: AxisTable) -> str:
    """Why a backlash that may be none is not taken."""
    return (
        f"anything up to {max(high, 0.0):.3g} {units_of(axis.kind)['backlash']} would fit as well"
    )


def as_built(axis: AxisTable, fit: AxisFit) -> AxisFit:
    """A fit without what an axis cannot have that has no screw; it is named."""
    if axis.lead:
        return fit
    known = {name: interval for name, (interval, _) in fit.conditional.items()} | fit.fitted
    undetermined = dict(fit.undetermined)
    for name in {"backlash", "stiffness"} & set(known):
        undetermined[name] = (
            f"the log has {known[name].value:.4g} {units_of(axis.kind)[name]}, but the base's axis has no "
            "'lead', and nothing gives in an axis without a screw"
        )
    gone = ("backlash", "stiffness")
    return dataclasses.replace(
        fit,
        fitted={name: interval for name, interval in fit.fitted.items() if name not in gone},
        conditional={name: pair for name, pair in fit.conditional.items() if name not in gone},
        undetermined=undetermined,
    )
