"""The tabs below the images: a file or a folder each, found by :func:`dock_classes`."""

from __future__ import annotations

import functools
import importlib
import pkgutil
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from texlab.docks.base import Dock


def dock_classes() -> tuple[type[Dock], ...]:
    """Import every file of this package and return its docks by their order: named, and no part of another."""
    # Every window asks, and looking through the folders takes longer than making a tab.
    return _within(tuple(__path__))


@functools.lru_cache(maxsize=4)
def _within(folders: tuple[str, ...]) -> tuple[type[Dock], ...]:
    from texlab.docks.base import Dock

    found: list[type[Dock]] = []
    for each in pkgutil.walk_packages(folders, f"{__name__}."):
        module = importlib.import_module(each.name)
        found += [
            value
            for value in vars(module).values()
            if isinstance(value, type)
            and issubclass(value, Dock)
            and value.__module__ == module.__name__
            and "name" in vars(value)
            and not value.within
        ]
    return tuple(sorted(found, key=lambda dock: (dock.order, dock.name)))
