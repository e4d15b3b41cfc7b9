"""The page of ``twin view`` from Python."""

import contextlib
import html
from pathlib import Path

from twin.errors import UsageError
from twin.extras import require_extra
from twin.run.replay import open_scene

HEIGHT = 640
"""Of the viewer in a cell [px]."""


class OpenViewer:
    """A viewer that is open until ``close``, or until it is left as a context.

    A cell of a notebook that is read at ``localhost`` shows the page itself; elsewhere there is its link.

    Attributes:
        address: Of the page, for a browser on this computer.
    """

    def __init__(self, recording: Path) -> None:
        """Serve a recording.

        Raises:
            UsageError: It has no samples, or a package of the extra ``train`` is missing.
        """
        require_extra("train", "the viewer")
        from twin.view.app import open_view
        from twin.view.recorded_run import RecordedRun

        with contextlib.ExitStack() as stack:
            scene, preparation = stack.enter_context(open_scene(recording))
            if not len(scene.recording):
                raise UsageError(f"{recording}: the recording has no samples")
            run = RecordedRun(scene, preparation.machine)
            self.address = stack.enter_context(open_view(run, framed=True))
            self._open = stack.pop_all()

    def close(self) -> None:
        """End the server."""
        self._open.close()

    def __enter__(self) -> "OpenViewer":
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def __repr__(self) -> str:
        return f"<OpenViewer {self.address}>"

    def _repr_html_(self) -> str:
        link = html.escape(self.address)
        # Browsers keep the page's cookie where both have the notebook's host.
        framed = link.replace("127.0.0.1", "localhost")
        return (
            f"<iframe src='{framed}' style='width: 100%; height: {HEIGHT}px; border: 0'></iframe>"
            f"<p><a href='{link}' target='_blank' rel='noopener'>open the viewer</a></p>"
        )
