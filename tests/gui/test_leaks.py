"""What comes and goes leaves nothing behind: objects of Qt are counted, caches held to their limits."""

from __future__ import annotations

import dataclasses
import gc
import importlib
import pkgutil
from collections import Counter
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
import shiboken6
from PySide6.QtCore import QCoreApplication, QEvent, QObject, QPoint
from PySide6.QtGui import QContextMenuEvent, QPixmapCache
from PySide6.QtWidgets import QApplication, QComboBox, QMainWindow, QMenu, QWidget

import texlab
from tests.gui.conftest import ids, make_everything, wait_idle
from tests.soak.census import malloc_in_use
from texlab.docks.recent import Recent, Same
from texlab.runs import kept_points
from texlab.runs.kept_points import KeptPoints
from texlab.state.chosen import Sample
from texlab.state.scene import ColumnScene
from texlab.state.session import Session
from texlab.style.pictures import to_picture
from texlab.style.theme import LIGHT, apply_theme
from texlab_core.engine.job import Job
from texlab_core.engine.registry import methods
from texlab_core.engine.run import run
from texlab_core.images.exemplar import as_exemplar

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable
    from pathlib import Path

    from texlab.app.explorer import Explorer


def settle() -> None:
    for _ in range(3):
        QCoreApplication.processEvents()
        QCoreApplication.sendPostedEvents(None, QEvent.Type.DeferredDelete)


def close_all() -> None:
    """Close what lies over the window."""
    settle()
    for each in QApplication.topLevelWidgets():
        if each.isVisible() and not isinstance(each, QMainWindow):
            each.close()
    settle()


def objects() -> Counter[str]:
    """Count the objects of Qt by their class."""
    gc.collect()
    roots: list[Any] = [QCoreApplication.instance(), *QApplication.topLevelWidgets()]
    found = {
        shiboken6.getCppPointer(each)[0]: each for root in roots for each in (root, *root.findChildren(QObject))
    }
    return Counter(each.metaObject().className() for each in found.values())


def command(name: str) -> Callable[[Explorer], None]:
    return lambda explorer: explorer.window.actions_by_name[name].trigger()


def twice(name: str) -> Callable[[Explorer], None]:
    def act(explorer: Explorer) -> None:
        for _ in range(2):
            explorer.window.actions_by_name[name].trigger()
            settle()

    return act


def themes(explorer: Explorer) -> None:
    for name in ("theme-dark", "theme-light"):
        explorer.window.actions_by_name[name].trigger()


def numbers(explorer: Explorer) -> None:
    explorer.workspace.columns[ids(explorer)[0]].show_numbers()


def column_menu(explorer: Explorer) -> None:
    view, at = explorer.workspace.columns[ids(explorer)[0]], QPoint(4, 4)
    QApplication.sendEvent(view, QContextMenuEvent(QContextMenuEvent.Reason.Mouse, at, view.mapToGlobal(at)))


def search_menu(explorer: Explorer) -> None:
    field, at = explorer.window.gallery.search, QPoint(4, 4)
    QApplication.sendEvent(field, QContextMenuEvent(QContextMenuEvent.Reason.Mouse, at, field.mapToGlobal(at)))


COMING_AND_GOING = {
    **{name: command(name) for name in ("about", "palette", "add", "failures", "batch", "history", "export-many")},
    **{f"{name} twice": twice(name) for name in ("crop", "tile", "magnifier", "panels", "link")},
    "themes": themes,
    "numbers": numbers,
    "menu of a column": column_menu,
    "menu of a field": search_menu,
}


def column_of_its_own(explorer: Explorer) -> None:
    explorer.handlers._add_column("msg")
    settle()
    explorer.window.actions_by_name["remove"].trigger()


COMING_AND_GOING["a column"] = column_of_its_own


def growth(qtbot: Any, explorer: Explorer, names: Iterable[str]) -> Counter[str]:
    """Return which objects are more after these came and went once more."""
    counts = []
    for _ in range(2):
        for name in names:
            COMING_AND_GOING[name](explorer)
            close_all()
        wait_idle(qtbot, explorer)
        settle()
        counts.append(objects())
    return counts[1] - counts[0]


@pytest.fixture
def imported() -> None:
    """What modules hold is there before anything is counted."""
    for each in pkgutil.walk_packages(texlab.__path__, "texlab."):
        if not each.name.startswith(("texlab.__main__", "texlab._pyinstaller")):
            importlib.import_module(each.name)


def ours() -> dict[int, Any]:
    """Return every object of a class of the window's program by its id."""
    return {id(each): each for each in gc.get_objects() if str(type(each).__module__).startswith("texlab.")}


@pytest.mark.slow
@pytest.mark.usefixtures("imported")
def test_what_comes_and_goes_leaves_no_object_and_a_closed_window_none(
    qtbot: Any, open_window: Callable[..., Explorer], texture: Path
) -> None:
    before = ours()
    explorer = open_window(str(texture), [("pixels", methods()["pixels"].params())])
    # Tabs are made once and stay.
    make_everything(explorer)
    box = explorer.workspace.exemplar._box
    if growth(qtbot, explorer, COMING_AND_GOING):
        # The first times may make what is kept for good.
        left = {name: grown for name in COMING_AND_GOING if (grown := growth(qtbot, explorer, [name]))}
        assert not left
    assert not [each for each in QApplication.allWidgets() if isinstance(each, QMenu) and each.title() == "Handle"]
    assert explorer.workspace.exemplar._box is box
    assert len(box.getHandles()) == 8

    window = explorer.window
    del explorer, box
    window.close()
    window.deleteLater()
    del window
    settle()
    gc.collect()
    assert Counter(type(each).__qualname__ for key, each in ours().items() if key not in before) == Counter()


# What is kept is bounded.


def test_pictures_of_boxes_that_have_gone_are_few(qapp: Any) -> None:
    if not malloc_in_use():
        pytest.skip("another C library")
    apply_theme(qapp, LIGHT)

    def draw(kind: type[QWidget], count: int) -> None:
        """Draw so many that differ, and let them go."""
        for place in range(count):
            box = kind()
            box.resize(200 + place % 97, 60 + place // 97)
            box.grab()
            box.deleteLater()
        settle()
        gc.collect()

    draw(QComboBox, 1)
    QPixmapCache.clear()
    before = malloc_in_use()
    draw(QComboBox, 400)
    # By itself Qt keeps 10 MB of them.
    assert malloc_in_use() - before < 5 * 2**20


def test_recent_values_are_bounded_in_number_as_well_as_in_weight() -> None:
    recent = Recent(1000, lambda value: 1.0, most=3)
    kept = [np.zeros(1) for _ in range(5)]
    for each in kept:
        recent.get(Same(each), lambda: "made")
    assert len(recent) == 3
    assert recent.get(Same(kept[4]), lambda: "again") == "made"
    assert recent.get(Same(kept[0]), lambda: "again") == "again"
    recent.clear()
    assert len(recent) == 0


def test_a_picture_that_is_opened_again_is_held_once() -> None:
    pixels = np.random.default_rng(0).random((8, 8, 3), np.float32)
    first, again, named = (as_exemplar(pixels.copy(), name=name) for name in ("one", "one", "other"))
    session = Session()
    for image in (first, named, again):
        session.set_sample(Sample(image))
    assert session.state.sample is not None
    assert session.state.sample.source is first
    session.undo()
    assert session.state.sample is not None
    assert session.state.sample.source is named


def finished_column(seed: int, number: int) -> ColumnScene:
    exemplar = as_exemplar(np.random.default_rng(seed).random((8, 8, 3), np.float32))
    result = run(Job(method="pixels", inputs={"exemplar": exemplar}, size=(8, 8)))
    scene = ColumnScene(number, "pixels", "Pixels", result.job.params, status="finished", result=result)
    return dataclasses.replace(scene, measures={"mean": 0.5}, picture=to_picture(result.image))


def test_points_hold_few_exemplars_that_are_out_of_use(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(kept_points, "MAX_BYTES", 2 * 8 * 8 * 3 * 4)
    points = KeptPoints()
    columns = [finished_column(seed, 1) for seed in range(5)]
    for column in columns:
        points.note(column)
    # The one in use, and two from before.
    assert [point.cell.job for point in points.points] == [each.result.job for each in columns[2:]]
    # Any number of points of the exemplar in use.
    job = columns[4].result.job
    for seed in range(1, 6):
        result = run(dataclasses.replace(job, seed=seed))
        points.note(dataclasses.replace(columns[4], result=result, measures={"mean": 0.1 * seed}))
    assert sum(point.cell.job.inputs["exemplar"] is job.inputs["exemplar"] for point in points.points) == 6
