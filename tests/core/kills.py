"""Ends by force at every change to the disk, without a process: from one call on nothing changes any more."""

from __future__ import annotations

import contextlib
import os
from typing import TYPE_CHECKING, Any

from texlab_core.files import leftovers

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    import pytest

CHANGES = ("write", "fsync", "replace", "rename", "unlink", "remove", "link", "symlink", "mkdir", "rmdir", "chmod")


class Killed(BaseException):
    """The end; nothing catches it."""


def deaths(
    monkeypatch: pytest.MonkeyPatch, prepare: Callable[[], None], work: Callable[[], None]
) -> Iterator[int]:
    """Do some work again and again, killed one change later each time, until it comes to its end.

    Yields
    ------
    int
        How many changes were made before the end; what is on the disk then can be looked at.
    """
    for survived in range(1000):
        prepare()
        with monkeypatch.context() as patch, contextlib.suppress(Killed):
            counter = _kill_after(patch, survived)
            work()
            if counter[0] <= survived:
                return
        # Another process has other names in use.
        leftovers._live.clear()
        yield survived
    raise AssertionError("The work never came to its end.")


def _kill_after(patch: pytest.MonkeyPatch, survived: int) -> list[int]:
    made = [0]

    def watched(change: Callable[..., Any], cut: bool) -> Callable[..., Any]:
        def call(*given: Any, **options: Any) -> Any:
            made[0] += 1
            if made[0] > survived:
                if cut and made[0] == survived + 1:
                    change(given[0], given[1][: len(given[1]) // 2])
                raise Killed
            return change(*given, **options)

        return call

    for name in CHANGES:
        patch.setattr(os, name, watched(getattr(os, name), name == "write"))
    opened = os.open

    def open_file(path: Any, flags: int, *rest: Any, **options: Any) -> int:
        if flags & (os.O_CREAT | os.O_TRUNC):
            made[0] += 1
            if made[0] > survived:
                raise Killed
        return opened(path, flags, *rest, **options)

    patch.setattr(os, "open", open_file)
    return made
