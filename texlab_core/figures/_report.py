"""The report that the help opens: ``python -m texlab_core.figures._report FILE [--batch FOLDER]``.

A sample of De Bonet's 800 textures as the page of its batch, with the small pictures inside: one file holds all.
"""

from __future__ import annotations

import argparse
import base64
import io
import sys
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING

from texlab_core.batch.page import page_of
from texlab_core.batch.plan import find_plan
from texlab_core.batch.running import run_batch
from texlab_core.errors import InputError
from texlab_core.files.regular import read_regular
from texlab_core.files.whole import write_whole

if TYPE_CHECKING:
    from collections.abc import Sequence

PLAN = "gallery:de-bonet-800"
SAMPLE = 40
QUALITY = 85
# Of a picture of the batch.
MAX_BYTES = 2**24
_BESIDE = (
    "They are spread evenly over the 800; click a heading to sort. Each texture is shown at its full size. "
    f"<code>texlab batch {PLAN} --sample {SAMPLE} --out FOLDER</code> makes them again, each with its recipe; "
    f"without <code>--sample {SAMPLE}</code> it makes all 800."
)


def report(folder: str | Path, sample: int = SAMPLE) -> bytes:
    """Run a sample of the plan, or find it in the batch's folder; return its page, which needs no other file."""
    plan = find_plan(PLAN)
    done = run_batch(plan, folder, sample=sample)

    def inside(path: str) -> str:
        return _data_uri(read_regular(Path(folder) / path, MAX_BYTES))

    pieces = page_of(
        f"{plan.name}: a sample of {sample}",
        plan.note,
        [each.name for each in plan.variants],
        done.rows,
        sample,
        address=inside,
        beside=_BESIDE,
        links=False,
    )
    return "".join(pieces).encode()


def _data_uri(png: bytes) -> str:
    """Return a picture as an address that holds it, as WebP: a fifth of the PNG."""
    from PIL import Image

    buffer = io.BytesIO()
    with Image.open(io.BytesIO(png)) as image:
        image.save(buffer, "WEBP", quality=QUALITY, method=6)
    return "data:image/webp;base64," + base64.b64encode(buffer.getvalue()).decode()


def main(arguments: Sequence[str] | None = None) -> int:
    """Write the report; return the exit code."""
    parser = argparse.ArgumentParser(prog="python -m texlab_core.figures._report", allow_abbrev=False)
    parser.add_argument("file", type=Path, metavar="FILE")
    parser.add_argument("--batch", type=Path, metavar="FOLDER", help="keep the batch there, or go on with it")
    args = parser.parse_args(arguments)
    try:
        with tempfile.TemporaryDirectory() as folder:
            content = report(args.batch or folder)
        write_whole(args.file, content)
    except (InputError, OSError) as error:
        print(f"{parser.prog}: {error}", file=sys.stderr)
        return 2
    print(f"{args.file}: {len(content) / 1000:.0f} kB")
    return 0


if __name__ == "__main__":
    sys.exit(main())
