"""The command ``fretwear``, in this process."""

from __future__ import annotations

import signal
import sys

from . import _native


def main() -> int:
    # The command's own handlers stop it with a checkpoint.
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    return _native.command(["fretwear", *sys.argv[1:]])


if __name__ == "__main__":
    sys.exit(main())
