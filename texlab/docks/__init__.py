"""The tabs below the images: one file each, found by :func:`dock_classes`."""

from __future__ import annotations

import importlib
import pkgutil
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from texlab.docks.base import Dock


def dock_classes() -> tuple[type[Dock], ...]:
    """Import every file of this package and return its dock classes by their order."""
    from texlab.docks.base import Dock

    found: list[type[Dock]] = []
    for each in pkgutil.iter_modules(__path__):
        module = importlib.import_module(f"{__name__}.{each.name}")
        found += [
            value
            for value in vars(module).values()
            if isinstance(value, type)
            and issubclass(value, Dock)
            and value is not Dock
            and value.__module__ == module.__name__
        ]
    return tuple(sorted(found, key=lambda dock: (dock.order, dock.name)))
