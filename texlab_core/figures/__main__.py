"""Draw the figures of the help pages into a folder, or measure the numbers of the pages anew."""

from __future__ import annotations

import argparse
import sys
import time
from pathlib import Path

from texlab_core.errors import InputError
from texlab_core.figures import encode, figures
from texlab_core.figures._stated import renew
from texlab_core.files.whole import write_whole


def main() -> int:
    """Draw what was asked for; return the exit code."""
    parser = argparse.ArgumentParser(prog="python -m texlab_core.figures", description=__doc__, allow_abbrev=False)
    parser.add_argument("folder", type=Path, metavar="FOLDER")
    parser.add_argument("--numbers", action="store_true", help="FOLDER holds the pages: renew the numbers in them")
    parser.add_argument("names", nargs="*", metavar="NAME", help="default: all figures")
    args = parser.parse_args()
    try:
        if args.numbers:
            renew(args.folder)
            return 0
        args.folder.mkdir(parents=True, exist_ok=True)
        for figure in figures(args.names):
            start = time.perf_counter()
            content = encode(figure, figure.draw())
            write_whole(args.folder / figure.file, content)
            seconds = time.perf_counter() - start
            print(f"{figure.file}: {len(content) / 1000:.0f} kB, {seconds:.1f} s", flush=True)
    except (InputError, OSError) as error:
        print(f"{parser.prog}: {error}", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
