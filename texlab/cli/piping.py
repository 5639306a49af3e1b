"""``-`` in the place of an image: standard input and standard output."""

from __future__ import annotations

import contextlib
import os
import sys
from typing import TYPE_CHECKING

from texlab_core.errors import InputError

if TYPE_CHECKING:
    import argparse
    from collections.abc import Iterator
    from pathlib import Path

STREAM = "-"
MAX_BYTES = 2**30
_IN, _OUT = "standard input", "standard output"


@contextlib.contextmanager
def standard_streams(args: argparse.Namespace, command: object) -> Iterator[None]:
    """Within the block, ``-`` stands for files that hold what came in, and what shall go out.

    Parameters
    ----------
    args
        The arguments; those that are ``-`` become paths.
    command
        Its ``READS`` are the names of arguments that may be ``-``, its ``WRITES`` the ending of ``--out -``; where
        it takes ``--input NAME=FILE``, one of these files may be ``-`` too.

    Raises
    ------
    InputError
        When two arguments are ``-``, nothing comes in, a stream is closed, or a picture would go to a terminal or
        among other output.
    """
    reading = [name for name in getattr(command, "READS", ()) if getattr(args, name, None) == STREAM]
    named = getattr(args, "input", None)
    inputs = named if isinstance(named, list) else []
    roles = [text.partition("=")[0] for text in inputs if text.partition("=")[2] == STREAM]
    ending = getattr(command, "WRITES", "") if getattr(args, "out", None) == STREAM else ""
    if not reading and not roles and not ending:
        yield
        return
    if len([*reading, *roles]) > 1:
        raise InputError(f"Standard input can be only one of {' and '.join([*reading, *roles])}.")
    if ending and getattr(args, "json", False):
        raise InputError("--out - and --json both want standard output; choose one of them.")
    if ending and sys.stdout is None:
        raise InputError("Standard output is closed, and --out - writes to it.")
    if ending and sys.stdout.isatty():
        raise InputError(
            "Standard output is a terminal, which cannot show a file; name one, or send it on with |."
        )
    import tempfile
    from pathlib import Path

    with tempfile.TemporaryDirectory(prefix="texlab-") as made:
        # As sentences call it: a folder for temporary files may be reached by a link.
        folder = os.path.realpath(made)
        if reading:
            setattr(args, reading[0], str(_take_in(Path(folder))))
        if roles:
            piped = f"{roles[0]}={_take_in(Path(folder))}"
            args.input = [piped if text == f"{roles[0]}={STREAM}" else text for text in inputs]
        out = Path(folder) / f"{_OUT}{ending}"
        with contextlib.ExitStack() as stack:
            if ending:
                args.out = str(out)
                stack.enter_context(contextlib.redirect_stdout(stack.enter_context(open(os.devnull, "w"))))
            try:
                yield
            except InputError as error:
                # The temporary folder says nothing to anybody.
                raise InputError(str(error).replace(f"{folder}{os.sep}", "")) from error
        if ending and out.exists():
            sys.stdout.buffer.write(out.read_bytes())
            sys.stdout.buffer.flush()


def _take_in(folder: Path) -> Path:
    if sys.stdin is None:
        raise InputError("Standard input is closed, and an image is wanted from it.")
    data = sys.stdin.buffer.read(MAX_BYTES + 1)
    if not data:
        raise InputError("Nothing came from standard input, and an image is wanted.")
    if len(data) > MAX_BYTES:
        raise InputError(f"More than {MAX_BYTES // 2**30} GB came from standard input, the most that is read.")
    path = folder / _IN
    path.write_bytes(data)
    return path
