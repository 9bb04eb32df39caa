"""An end that is asked for from outside."""

from __future__ import annotations

import signal


def stop_when_told() -> None:
    """Make SIGTERM clean up as an interruption does."""

    def stop(number: int, frame: object) -> None:
        raise KeyboardInterrupt

    signal.signal(signal.SIGTERM, stop)
