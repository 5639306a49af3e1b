"""The textures that come with the program, by class and by name."""

from __future__ import annotations

import csv
import difflib
import functools
from dataclasses import dataclass
from types import MappingProxyType
from typing import TYPE_CHECKING

from texlab_core.errors import ImageError
from texlab_core.files.resources import resource

if TYPE_CHECKING:
    from collections.abc import Mapping

PREFIX = "gallery:"
CLASSES: Mapping[str, str] = MappingProxyType(
    {
        "stochastic": "Stochastic",
        "quasiperiodic": "Nearly periodic",
        "oriented": "Oriented",
        "structured": "Structured",
        "manmade": "Man-made",
        "letters": "Letters",
        "inhomogeneous": "Inhomogeneous",
        "failure": "Failures by design",
    }
)
"""Titles of the classes, from what every method can do to what none can."""

_COMPOUNDS = {
    "canefence": "cane fence",
    "coffeebeans": "coffee beans",
    "colourgradient": "colour gradient",
    "crazypaving": "crazy paving",
    "dotlines": "dot lines",
    "drystone": "dry stone",
    "litbrick": "lit brick",
    "oldbrick": "old brick",
    "oldwood": "old wood",
    "rubblewall": "rubble wall",
    "sandripples": "sand ripples",
    "seedgradient": "seed gradient",
    "sizegradient": "size gradient",
    "woodgrain": "wood grain",
}


@dataclass(frozen=True, slots=True)
class GalleryEntry:
    """One texture.

    Parameters
    ----------
    name
        Class and texture with a hyphen ("structured-pebbles"); ``gallery:`` before it makes it a source.
    cls
        Its class, a key of ``CLASSES``.
    title
        For people ("Pebbles").
    author, licence, source
        As ``SOURCES.tsv`` has them.
    done
        What was done to the source to make this texture.
    keywords
        Further words by which it is found.
    """

    name: str
    cls: str
    title: str
    author: str
    licence: str
    source: str
    done: str
    file: str
    keywords: tuple[str, ...] = ()

    @property
    def uri(self) -> str:
        """The name that ``as_exemplar`` and the command line take."""
        return PREFIX + self.name

    def read(self) -> bytes:
        """Return the bytes of its PNG file."""
        try:
            return resource(f"gallery/{self.file}").read_bytes()
        except OSError as error:
            raise ImageError(f"{self.uri}: the file {self.file} is missing from the program's gallery.") from error


@functools.cache
def gallery() -> tuple[GalleryEntry, ...]:
    """Return every texture, grouped by class; reads the table only, no image."""
    table = resource("gallery/SOURCES.tsv").read_text(encoding="utf-8").splitlines()
    entries = [_entry(row) for row in csv.DictReader(table, delimiter="\t")]
    order = {cls: place for place, cls in enumerate(CLASSES)}
    return tuple(sorted(entries, key=lambda entry: (order.get(entry.cls, len(order)), entry.cls, entry.name)))


def _entry(row: Mapping[str, str]) -> GalleryEntry:
    name = row["file"].removesuffix(".png")
    word = name.removeprefix(row["class"] + "-")
    return GalleryEntry(
        name=name,
        cls=row["class"],
        title=_COMPOUNDS.get(word, word).capitalize(),
        author=row["author"],
        licence=row["licence"],
        source=row["source"],
        done=row["what_was_done"],
        file=row["file"],
        keywords=tuple((row["keywords"] or "").split()),
    )


def find_entry(name: str) -> GalleryEntry:
    """Return the texture with this name, with or without ``gallery:`` before it.

    Raises
    ------
    ImageError
        When there is none; the message suggests the closest names.
    """
    wanted = name.removeprefix(PREFIX)
    known = {entry.name: entry for entry in gallery()}
    if wanted in known:
        return known[wanted]
    close = [each for each in known if wanted and wanted.lower() in each][:3]
    close = close or difflib.get_close_matches(wanted.lower(), known, n=3)
    hint = (
        f"did you mean {' or '.join(close)}?"
        if close
        else f"it has {len(known)}, for example {next(iter(known))}."
    )
    raise ImageError(f"The gallery has no texture called {wanted!r}; {hint}")
