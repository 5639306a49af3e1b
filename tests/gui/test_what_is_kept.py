"""What is kept for the next time is bounded in bytes, also for the largest picture."""

from __future__ import annotations

import dataclasses
import functools
import importlib
import inspect
import pkgutil
import sys
from typing import Any

import numpy as np
import pytest
from PySide6.QtGui import QImage

import texlab
import texlab_core
from texlab import docks
from texlab.docks.lab import filters
from texlab.docks.thresholds import painting, table
from texlab.style import icons
from texlab.widgets import plain
from texlab.window import gallery_thumbnails
from texlab_core.files.resources import resource
from texlab_core.images.gallery import gallery
from texlab_core.methods.de_bonet import layout, quadtree
from texlab_core.sheets import typeface
from texlab_core.transforms import spread

SIDE = 4096
MOST_BYTES = 16 * 2**20
OPEN_ICON = resource("icons/tools/open.svg").read_text("utf-8")
# The largest of what each cache that counts its values may hold; how many there can be where it does not count.
LARGEST: dict[Any, tuple[Any, ...]] = {
    filters.filter_pictures: (7, 16.0),
    layout._every_place: (16, layout._MOST_PLACES // 16),
    quadtree._parts: (quadtree.Grid.covering(SIDE, SIDE, 7), 0),
    spread._reducing: (SIDE,),
    spread._expanding: (SIDE, "interpolate"),
    plain._wrapped: ("word " * 400,),
    painting.cell_colour: (1, 2, 3),
    table.make_heads: ((), "each"),
    gallery_thumbnails._thumbnail: (f"gallery:{gallery()[0].name}",),
    typeface.typeface: ("bold",),
    icons._painted: (OPEN_ICON, "#202020", icons.MOST_KEPT, max(icons.RATIOS), 1.0),
    docks._within: (tuple(docks.__path__),),
}
COUNTS = {gallery_thumbnails._thumbnail: len(gallery()), typeface.typeface: len(typeface._FILES)}


def counting_caches() -> dict[Any, str]:
    """Return the functions of the program, with parameters, whose values are kept by number."""
    found = {}
    for package in (texlab, texlab_core):
        for each in pkgutil.walk_packages(package.__path__, f"{package.__name__}."):
            if each.name.startswith(("texlab.__main__", "texlab._pyinstaller", "texlab_core.figures")):
                continue
            module = importlib.import_module(each.name)
            kinds = [value for value in vars(module).values() if isinstance(value, type)]
            for holder in (module, *kinds):
                for name, value in vars(holder).items():
                    if isinstance(value, functools._lru_cache_wrapper) and inspect.signature(value).parameters:
                        found[value] = f"{value.__module__}.{name}"
    return found


def weight(value: Any) -> int:
    """Return what a value takes, its arrays included."""
    if isinstance(value, np.ndarray):
        return value.nbytes
    if isinstance(value, QImage):
        return value.sizeInBytes()
    if isinstance(value, tuple | list):
        return sum(map(weight, value))
    if isinstance(value, dict):
        return sum(map(weight, value.values()))
    if dataclasses.is_dataclass(value):
        return sum(weight(getattr(value, field.name)) for field in dataclasses.fields(value))
    if hasattr(value, "indptr"):
        return weight((value.data, value.indices, value.indptr))
    if isinstance(value, typeface.Typeface):
        return weight(vars(value))
    return sys.getsizeof(value)


def test_every_cache_that_counts_is_known() -> None:
    found = counting_caches()
    assert {found[each] for each in found.keys() - LARGEST.keys()} == set(), (
        "kept by number: how large can it get?"
    )
    assert found.keys() >= LARGEST.keys()


@pytest.mark.parametrize("cache", list(LARGEST), ids=lambda cache: cache.__qualname__)
def test_what_is_kept_by_number_stays_small(cache: Any, qapp: Any) -> None:
    one = weight(cache(*LARGEST[cache]))
    most = cache.cache_parameters()["maxsize"] or COUNTS[cache]
    assert one * most <= MOST_BYTES
