"""Modules that register something when imported, ours and those of other packages; a broken one is left out.

Another package adds methods, measures or findings by an entry point that names a module of its own::

    [project.entry-points."texlab_core.methods"]
    stripes = "texlab_stripes.method"

The module is imported once, and what it registers is known from then on, under the name of its package. Whatever
goes wrong meanwhile costs what the module would have added, and is kept as one sentence.
"""

from __future__ import annotations

import importlib
import importlib.metadata
import logging
import pkgutil
from dataclasses import dataclass
from typing import TYPE_CHECKING, TypeVar

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, MutableMapping

log = logging.getLogger(__name__)

OWN_PACKAGE = "texlab"
EntryT = TypeVar("EntryT")


@dataclass(frozen=True, slots=True)
class Source:
    """Where something is registered.

    Parameters
    ----------
    package
        The installed package, as pip knows it.
    module
        What is imported.
    """

    package: str
    module: str


@dataclass(frozen=True, slots=True)
class Failure:
    """A module that could not be used.

    Parameters
    ----------
    source
        Which one.
    what
        What it would have added ("methods").
    reason
        The error, on one line.
    """

    source: Source
    what: str
    reason: str

    @property
    def sentence(self) -> str:
        """What is missing, whose it is, and why."""
        where = f"{self.source.package} in {self.source.module}"
        return f"The {self.what} of {where} are left out, since it cannot be loaded ({self.reason.rstrip('.')})."


def own_modules(package: str) -> Iterator[Source]:
    """Return the modules of one of our packages; a name that starts with an underscore is none."""
    for each in pkgutil.iter_modules(importlib.import_module(package).__path__):
        if not each.name.startswith("_"):
            yield Source(OWN_PACKAGE, f"{package}.{each.name}")


def entry_points(group: str) -> tuple[Source, ...]:
    """Return the modules that installed packages offer, by package and module."""
    found = set()
    for point in importlib.metadata.entry_points(group=group):
        package = point.dist.name if point.dist is not None else point.module.partition(".")[0]
        found.add(Source(package, point.module))
    return tuple(sorted(found, key=lambda source: (source.package, source.module)))


def load(
    source: Source,
    shelf: MutableMapping[str, EntryT],
    accept: Callable[[EntryT, str], EntryT] | None = None,
    *,
    what: str,
) -> Failure | None:
    """Import a module that registers entries on a shelf; on any failure the shelf is as it was before.

    Parameters
    ----------
    source
        What to import.
    shelf
        Where it registers.
    accept
        ``accept(entry, package)`` checks an entry that is new, and returns what is kept in its place.
    what
        What the entries are ("methods").

    Returns
    -------
    Failure or None
        None when all went well.
    """
    before = dict(shelf)
    try:
        importlib.import_module(source.module)
        for name in [name for name in shelf if name not in before]:
            if accept is not None:
                shelf[name] = accept(shelf[name], source.package)
    except (Exception, SystemExit) as error:
        shelf.clear()
        shelf.update(before)
        reason = f"{type(error).__name__}: {' '.join(str(error).split())}".rstrip(": ")
        failure = Failure(source, what, reason)
        log.info("%s", failure.sentence, exc_info=error)
        return failure
    return None
