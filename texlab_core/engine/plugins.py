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
import threading
from contextvars import ContextVar
from dataclasses import dataclass
from types import MappingProxyType
from typing import TYPE_CHECKING, Generic, Protocol, TypeVar

from texlab_core.errors import ParamError
from texlab_core.files.wording import did_you_mean

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Mapping, MutableMapping

log = logging.getLogger(__name__)

OWN_PACKAGE = "texlab"
# Whose module is being imported; empty when none is.
_IMPORTED: ContextVar[str] = ContextVar("texlab_imported", default="")


class Entry(Protocol):
    """What can be registered."""

    @property
    def id(self) -> str:
        """Its name, used once."""

    @property
    def order(self) -> int:
        """Its place in lists."""


EntryT = TypeVar("EntryT", bound=Entry)


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
    token = _IMPORTED.set(source.package)
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
    finally:
        _IMPORTED.reset(token)
    return None


class Shelf(Generic[EntryT]):
    """Everything of one kind that modules register; they are imported when it is first asked for.

    Parameters
    ----------
    kind
        What users call an entry ("method"). Entry points of the group ``texlab_core.methods`` name the modules of
        other packages.
    own
        ``own()`` returns our own modules.
    accept
        As of :func:`load`.
    warn
        Whether what cannot be used is logged as a warning; not where everybody who lists the entries tells it.
    """

    def __init__(
        self,
        kind: str,
        own: Callable[[], Iterable[Source]],
        accept: Callable[[EntryT, str], EntryT] | None = None,
        *,
        warn: bool = True,
    ) -> None:
        self._kind = kind
        self._own = own
        self._accept = accept
        self._warn = warn
        self._entries: dict[str, EntryT] = {}
        self._owners: dict[str, str] = {}
        # None until the modules were imported.
        self._failures: tuple[Failure, ...] | None = None
        self._ordered: Mapping[str, EntryT] | None = None
        self._filling = False
        self._lock = threading.RLock()

    def add(self, entry: EntryT) -> EntryT:
        """Add an entry; a second one with the same id is a programming error, which names who has the first."""
        # Without the lock: whoever imports the module holds the lock of the import, for which the shelf may wait.
        package = _IMPORTED.get()
        if entry.id in self._entries:
            owner = self._owners.get(entry.id)
            whose = f", by {owner}" if owner else ""
            raise RuntimeError(f"A {self._kind} with the id {entry.id!r} is registered already{whose}.")
        if self._accept is not None and not self._filling and package not in {"", OWN_PACKAGE}:
            # What declares a method may declare its measures too.
            entry = self._accept(entry, package)
        self._entries[entry.id] = entry
        self._owners[entry.id] = package
        self._ordered = None
        return entry

    def all(self) -> Mapping[str, EntryT]:
        """Return every entry by id, in their order."""
        found = self._ordered
        if found is None:
            with self._lock:
                self._fill()
                ordered = sorted(self._entries.values(), key=lambda entry: (entry.order, entry.id))
                found = MappingProxyType({entry.id: entry for entry in ordered})
                # A module that asks while it is imported gets what there is until then.
                self._ordered = None if self._filling else found
        return found

    def failures(self) -> tuple[Failure, ...]:
        """Return what could not be used, of our own and of other packages."""
        with self._lock:
            self._fill()
            return self._failures or ()

    def find(self, name: str) -> EntryT:
        """Return the entry with this id; raises ``ParamError`` with the ids that there are."""
        known = self.all()
        if isinstance(name, str) and name in known:
            return known[name]
        close = did_you_mean(name, known)
        hint = f" ({close})" if close else ""
        if broken := sorted({failure.source.package for failure in self.failures()}):
            hint += f" (what {' and '.join(broken)} adds could not be loaded)"
        raise ParamError(self._kind, f"one of {', '.join(known)}{hint}", name)

    def _fill(self) -> None:
        if self._failures is not None or self._filling:
            return
        self._filling = True
        what = f"{self._kind}s"
        try:
            sources = (*self._own(), *entry_points(f"texlab_core.{what}"))
            tried = [load(source, self._entries, self._accept, what=what) for source in sources]
        finally:
            self._filling = False
        self._failures = tuple(each for each in tried if each is not None)
        for failure in self._failures if self._warn else ():
            log.warning("%s", failure.sentence)
