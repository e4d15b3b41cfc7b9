"""``twin`` and ``python -m twin``: the command line, and what an early end of it says.

A signal may come while the libraries are still being loaded: even then a sentence is said.
"""

import signal
import sys


def main() -> None:
    """Run the command line and exit with the code that the contract promises."""
    stopped: list[int] = []

    def stop(number: int, _: object) -> None:
        stopped.append(number)
        raise KeyboardInterrupt

    # Asked to end, by a batch system say, is the same as Ctrl-C: files are left whole or absent.
    signal.signal(signal.SIGTERM, stop)
    signal.signal(signal.SIGINT, stop)
    try:
        from twin.cli import main as run

        run()
    except (KeyboardInterrupt, ImportError):
        # A library that is interrupted while it is being loaded says that it cannot be.
        if not stopped:
            raise
        print("interrupted before anything was begun", file=sys.stderr)
        raise SystemExit(130) from None
    except MemoryError:
        print("there is not enough memory to begin", file=sys.stderr)
        raise SystemExit(2) from None


if __name__ == "__main__":
    main()
