"""G codes as the tables of dialects declare them, a line each: by the manual of their control."""

from collections.abc import Mapping
from typing import Unpack

from twin.nc.control.codes import Action, Basis, GCode, Interpolation, MCode
from twin.nc.control.control import Control
from twin.nc.control.modal import ModalChanges
from twin.nc.geometry.planes import Plane


def modal(
    meaning: str,
    group: str = "",
    action: Action | None = None,
    *,
    non_modal: bool = False,
    basis: Basis = "manual",
    **sets: Unpack[ModalChanges],
) -> GCode:
    """A code that puts something into force, or does something before the block moves."""
    return GCode(
        meaning=meaning,
        group=group,
        sets=sets,
        action=action,
        non_modal=non_modal,
        basis=basis,
    )


def replacement(
    meaning: str, perform: Action, group: str = "", *, consumes: str = "", basis: Basis = "manual"
) -> GCode:
    """A code that replaces a move."""
    return GCode(meaning=meaning, group=group, perform=perform, consumes=consumes, basis=basis)


def motion_code(meaning: str, interpolation: Interpolation, basis: Basis = "manual") -> GCode:
    """A code by which axis words become a move; it ends a cycle."""
    return modal(meaning, "motion", basis=basis, interpolation=interpolation, cycle=None)


def plane_code(
    meaning: str, plane: Plane, action: Action | None = None, basis: Basis = "manual"
) -> GCode:
    """A code of a working plane; ``action``: done instead of refusing it while compensation is in force."""
    return modal(meaning, "plane", action or keep_compensated_plane, basis=basis, plane=plane)


def keep_compensated_plane(control: Control) -> None:
    """The plane has changed."""
    if not control.path.compensation.acts_in(
        control.motion.part_plane
    ):  # else it is in force already
        refuse_compensated_plane(control)


def refuse_compensated_plane(control: Control) -> None:
    """The plane is about to change."""
    if control.path.compensation.in_force:
        message = "the plane cannot change while compensation is in force"
        control.fail("compensation-plane", message, hint="end it by G40 first")


def refused(
    meaning: str, reason: str, *numbers: float, group: str = "", advice: str = ""
) -> Mapping[float, GCode]:
    """Codes that the control knows and the twin does not follow."""
    code = GCode(meaning=meaning, group=group, refused=reason, advice=advice, basis="manual")
    return dict.fromkeys(numbers, code)


def flow_function(meaning: str, action: Action, group: str = "") -> MCode:
    """An M code of the program's flow: it acts when the block has moved, and is not reported to the machine."""
    return MCode(
        meaning=meaning, group=group, after_motion=True, action=action, silent=True, basis="manual"
    )
