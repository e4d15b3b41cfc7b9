"""Plays every scene's solution and mistake with the keys of the real page; exit 1 where one ends otherwise.

``scripts/plays [SCENE...] [--firefox] [--jobs N]``. Rooms are played faster than real time, without
their view.
"""

import argparse
import multiprocessing
import sys
import time
import traceback
from concurrent.futures import ProcessPoolExecutor
from typing import get_args

from panel_player import What, browser, play

from twin.training.scene.scene_file import scene_names


def one_play(kind: str, scene: str, what: What) -> str:
    """Play; what was wrong, or nothing."""
    try:
        with browser(kind) as opened:
            played = play(opened, scene, what)
    except Exception:  # noqa: BLE001 (the other plays go on)
        return traceback.format_exc(limit=-3)
    return "" if played.intended else str(played)


def main() -> int:
    """Play what was asked for; the exit code."""
    parser = argparse.ArgumentParser(description=__doc__, add_help=True)
    parser.add_argument("scenes", nargs="*", help="shipped scenes; all by default")
    parser.add_argument("--firefox", action="store_true", help="in Firefox instead of Chromium")
    parser.add_argument("--jobs", type=int, default=2, help="plays at a time")
    given = parser.parse_args()
    if unknown := set(given.scenes) - set(scene_names()):
        parser.error(f"no scene {', '.join(sorted(unknown))}: there are {', '.join(scene_names())}")
    plays = [(scene, what) for scene in given.scenes or scene_names() for what in get_args(What)]
    kind = "firefox" if given.firefox else "chromium"
    begin, wrong = time.monotonic(), 0
    spawn = multiprocessing.get_context("spawn")
    with ProcessPoolExecutor(given.jobs, mp_context=spawn) as pool:
        results = [pool.submit(one_play, kind, *one) for one in plays]
        for (scene, what), result in zip(plays, results, strict=True):
            trouble = result.result()
            wrong += bool(trouble)
            print(f"{scene} {what}: {trouble or 'as intended'}", flush=True)
    print(f"{len(plays)} plays in {time.monotonic() - begin:.0f} s, {wrong} not as intended")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
