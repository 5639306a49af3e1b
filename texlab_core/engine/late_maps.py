"""Maps that are made when somebody looks, and questions that make none."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from texlab_core.engine.steps import Map


class LateMaps(Mapping[str, "Map"]):
    """Maps by name, each made when it is first looked at; that may take as long as a part of the run.

    Parameters
    ----------
    makers
        Title and maker of every map, by name.
    """

    def __init__(self, makers: Mapping[str, tuple[str, Callable[[], Map]]]) -> None:
        self._makers = dict(makers)
        self._made: dict[str, Map] = {}

    def __getitem__(self, name: str) -> Map:
        if name not in self._made:
            self._made.setdefault(name, self._makers[name][1]())
        return self._made[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._makers)

    def __len__(self) -> int:
        return len(self._makers)

    def __reduce__(self) -> tuple[type[dict[str, Map]], tuple[dict[str, Map]]]:
        # Another process gets the maps themselves.
        return dict, (dict(self),)

    def titles(self) -> tuple[tuple[str, str], ...]:
        """Return (name, title) of every map, made or not."""
        return tuple((name, title) for name, (title, _) in self._makers.items())

    def made(self, name: str) -> Map | None:
        """Return a map that somebody has looked at, else None."""
        return self._made.get(name)


def map_titles(maps: Mapping[str, Map]) -> tuple[tuple[str, str], ...]:
    """Return (name, title) of every map; none is made for that."""
    if isinstance(maps, LateMaps):
        return maps.titles()
    return tuple((name, each.title) for name, each in maps.items())


def made_map(maps: Mapping[str, Map], name: str) -> Map | None:
    """Return a map that is there already; None for one that would have to be made, or that there is not."""
    return maps.made(name) if isinstance(maps, LateMaps) else maps.get(name)
