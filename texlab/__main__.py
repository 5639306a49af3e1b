"""``python -m texlab``."""

from __future__ import annotations

import sys

from texlab.cli.main import main

if __name__ == "__main__":
    sys.exit(main())
