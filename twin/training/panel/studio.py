"""The room in MuJoCo Studio: one plugin lets time go on, the other shows the panel.

They run on two threads and share nothing but messages: the picture takes a snapshot whenever it is
ready for one, and the machine never waits for it.
"""

import dataclasses
import threading
import time
from collections.abc import Callable

import mujoco
import numpy as np
from mujoco.studio import (
    messages,
    plugin,
    ux,  # pyright: ignore[reportAttributeAccessIssue] (a compiled module, put there at run time)
)

from twin.render.scene.placement import ROTARY_TABLE
from twin.training.panel.display import STOCK_GROUP, Display
from twin.training.panel.panel import Panel
from twin.training.panel.request import Request
from twin.training.panel.trail import Trail
from twin.training.session.log import Replay
from twin.training.session.room import Room
from twin.training.session.session import Session
from twin.training.session.snapshot import Snapshot, take_snapshot

SHORTEST_REST_S = 0.001
"""What the machine always leaves to the picture between two looks at the clock [s]."""
MOST_BEHIND_S = 0.25
"""How far machine time may fall behind the wall's before it is given up [s]."""
_COSTLY = ("SHADOW", "REFLECTION", "HAZE")
"""Effects that a plain picture does without."""
REPLAY_SPEED = 4.0
"""Times faster than it was, a session is shown again."""


@dataclasses.dataclass(frozen=True)
class RoomSnapshot(messages.Snapshot):
    """The machine as the panel shows it."""

    now: Snapshot


@dataclasses.dataclass(frozen=True)
class RequestEvent(messages.Event):
    """Something that the panel asks for."""

    request: Request


class RoomPlugin(plugin.SimPlugin):
    """Lets the room's time go on with the wall's.

    Attributes:
        session: What is played.
        display: The drawn machine.
        heard: When the last request was heard, by ``time.perf_counter`` [s].
    """

    def __init__(
        self,
        session: Session,
        *,
        plain: bool,
        changed: Callable[[Session], None] = lambda _session: None,
    ) -> None:
        """Prepare a session for Studio.

        Args:
            session: What is played.
            plain: Draw plainly, for computers without a graphics card.
            changed: Told after every request.
        """
        self.session = session
        self.heard = 0.0
        self._plain = plain
        self._changed = changed
        self.display = Display(session.room, plain=plain)
        self._tool = session.room.tables.spindle
        self._replay: Replay | None = None
        self._speed = 1.0
        self._asked = threading.Event()
        self._restart_clock()

    def wake(self) -> None:
        """Hear what was asked for at once, and not when the next slice of time is due."""
        self._asked.set()

    def _restart_clock(self) -> None:
        self._wall = time.perf_counter()
        self._owed_s = 0.0

    @messages.handler
    def on_load_model(self, _event: messages.LoadModelEvent) -> bool:
        """Give Studio the drawn machine, whatever it asks for."""
        self.handle.set_model(self.display.model, data=self.display.data)
        return True

    @messages.handler
    def on_request(self, event: RequestEvent) -> None:
        """Do what the panel asks for."""
        request, session = event.request, self.session
        self.heard = time.perf_counter()
        if request.change == "freeze":
            session.frozen = True
        elif request.change == "go_on":
            session.frozen = False
        elif request.change == "rewind":
            session.rewind(request.seconds)
            session.frozen = True
        elif request.change == "replay":
            self._replay = session.replay()
        elif request.command is not None and self._replay is None:
            session.submit(request.command, request.who)
        self._changed(session)

    @messages.handler
    def on_step(self, event: messages.StepEvent) -> bool:
        """Let time go on as it has on the wall, and hand out what there is to see."""
        now = time.perf_counter()
        passed, self._wall = now - self._wall, now
        if self._replay is not None:
            self._replay.advance(REPLAY_SPEED * min(passed, MOST_BEHIND_S))
            room = self._replay.room
            if self._replay.over:
                self._replay, room = None, self.session.room
                self._restart_clock()
        else:
            self._go_on(passed)
            room = self.session.room
        if room.tables.spindle != self._tool:
            self._tool = room.tables.spindle
            self.display = Display(room, plain=self._plain)
            self.handle.set_model(self.display.model, data=self.display.data)
        self.display.update(room)
        if event.data is self.display.data:
            event.data.time = room.time_s
        self.handle.send_to_viewer(RoomSnapshot(self._look(room)))
        due = self.session.room.slice_s - self._owed_s - (time.perf_counter() - now)
        self._asked.wait(max(due, SHORTEST_REST_S))
        self._asked.clear()
        return True

    def _go_on(self, passed: float) -> None:
        session = self.session
        slice_s = session.room.slice_s
        if session.frozen:
            self._owed_s = 0.0
            return
        self._owed_s += passed
        kept = min(self._owed_s, MOST_BEHIND_S)
        share = kept / self._owed_s if self._owed_s > 0.0 else 1.0
        self._speed += 0.02 * (share - self._speed)
        slices = int(kept / slice_s)
        session.advance(slices)
        self._owed_s = kept - slices * slice_s

    def _look(self, room: Room) -> Snapshot:
        if room is self.session.room:
            return dataclasses.replace(self.session.snapshot(), speed=self._speed)
        return dataclasses.replace(take_snapshot(room), replaying=True, speed=REPLAY_SPEED)


class PanelPlugin(plugin.ViewerPlugin):
    """Shows the panel and the tool's way.

    Attributes:
        panel: The panel.
        now: The last snapshot.
    """

    def __init__(
        self,
        panel: Panel,
        display: Display,
        camera: str,
        *,
        plain: bool,
        trainer: Callable[[], bool],
        wake: Callable[[], None],
    ) -> None:
        """Prepare the panel for Studio.

        Args:
            panel: The panel.
            display: The drawn machine.
            camera: Named camera that the view begins with.
            plain: Draw plainly, for computers without a graphics card.
            trainer: Tells whether it is the trainer who has the panel.
            wake: Called after everything that is sent to the machine.
        """
        self.panel = panel
        self._trainer = trainer
        self._wake = wake
        self._plain = plain
        self.now: Snapshot | None = None
        self._frame = display.frame
        self._camera = camera
        self._trail = Trail(plain=plain)

    @messages.handler
    def on_model(self, _event: messages.PostModelEvent) -> None:
        """Look at the machine through the scene's camera, in dark colours."""
        ux.setup_theme(ux.GuiTheme.DARK)
        if self._plain:
            flags = self.viewer.render_flags
            costly = [int(getattr(mujoco.mjtRndFlag, f"mjRND_{name}")) for name in _COSTLY]
            flags.flags = [0 if flag in costly else on for flag, on in enumerate(flags.flags)]
        model, data, camera = self.viewer.model, self.viewer.data, self.viewer.camera
        number = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_CAMERA, self._camera)
        if number < 0:
            return
        # A free camera from where the named one stands, so that the mouse can turn it.
        away = data.cam_xmat[number].reshape(3, 3)[:, 2]
        eye = data.cam_xpos[number]
        target = data.xpos[model.body(ROTARY_TABLE).id]
        distance = float(np.linalg.norm(eye - target))
        camera.type = mujoco.mjtCamera.mjCAMERA_FREE
        camera.lookat[:] = target
        camera.distance = distance
        camera.azimuth = float(np.degrees(np.arctan2(-away[1], -away[0])))
        camera.elevation = float(np.degrees(np.arcsin(-away[2])))

    @messages.handler
    def on_room(self, snapshot: RoomSnapshot) -> None:
        """Take over what the machine shows."""
        now, before = snapshot.now, self.now
        if now.modal is None and before is not None:
            # A screen goes on showing what was in force when the last block ended.
            now = dataclasses.replace(now, modal=before.modal)
        self.now = now
        self._trail.add(snapshot.now.trail)

    @messages.handler
    def on_update(self, _event: messages.UpdateEvent) -> None:
        """Draw what the view's switches ask for."""
        side, viewer = self.panel.side, self.viewer
        viewer.vis_options.geomgroup[STOCK_GROUP] = side.show_stock
        viewer.vis_options.geomgroup[3] = side.show_collision
        viewer.extra_geoms.clear()
        if side.show_trail and viewer.model.nbody > 1:
            table = viewer.model.body(ROTARY_TABLE).id
            rotation = viewer.data.xmat[table].reshape(3, 3)
            viewer.extra_geoms.extend(
                self._trail.geoms(self._frame, viewer.data.xpos[table], rotation)
            )

    @messages.handler
    def on_build_gui(self, _event: messages.BuildGuiEvent) -> None:
        """Show the panel, and send what it asks for."""
        if self.now is None:
            return
        trainer = self._trainer()
        for request in self.panel.build(self.now, trainer=trainer):
            by = dataclasses.replace(request, who="trainer") if trainer else request
            self.viewer.send_to_sim(RequestEvent(by))
            self._wake()
