"""The program ``jurist``."""

from __future__ import annotations

import signal
import sys

from . import _jurist


def main() -> None:
    """Runs the program on the process's arguments, and ends the process with its status."""
    # Ctrl-C ends the program at once, as it does without Python around it.
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    sys.exit(_jurist.program(["jurist", *sys.argv[1:]]))


if __name__ == "__main__":
    main()
