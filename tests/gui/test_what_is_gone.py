"""A tab holds nothing of a result that has gone, whether it is seen or lies behind another one."""

from __future__ import annotations

import dataclasses
import gc
import weakref
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from dock_scenes import image_input
from mouse import on_screen

from texlab.docks import dock_classes
from texlab.docks.explain.dock import ExplainDock
from texlab.docks.host import DockHost
from texlab.docks.lab.dock import LabDock
from texlab.runs.slots import Slots
from texlab.state.scene import ColumnScene, Frame, Probe, Scene
from texlab.style.pictures import to_picture
from texlab_core.engine.job import Job
from texlab_core.engine.registry import methods
from texlab_core.engine.run import run
from texlab_core.findings.finding import FINDING, Finding, Region, Remedy, Where

if TYPE_CHECKING:
    from texlab.docks.base import Dock
    from texlab.docks.explain.side import Side

# Sides that nothing else has, nor have their halves.
BIG = (41, 37)
SIGNS = (set(BIG), {-(-each // 2) for each in BIG})
SMALL = (20, 16)
BATCH = 256
METHODS = {
    "heeger-bergen": {"scales": 2, "iterations": 1},
    "de-bonet": {},
    "efros-leung": {"window": 5},
    "solid": {"scales": 2, "iterations": 1},
}
# What is kept for the scrubber and by iteration, and what is copied from places.
USUAL = ("heeger-bergen", "de-bonet")
OTHERS = {"explain": ("efros-leung",), "solids": ("solid",)}
CUTS = Finding(
    id="cuts", title="Cuts", what="It jumps by 9.", where=Where("result", "everywhere", (Region(1, 1, 3, 3),)),
    why="Pieces do not fit.", remedy=Remedy("Nothing.", {}), certainty=FINDING, measures=("cuts",),
)  # fmt: skip


@pytest.fixture(scope="module")
def exemplar() -> Any:
    return image_input(np.random.default_rng(2).random((24, 24, 3), np.float32), "noise")


def finished(exemplar: Any, method: str, size: tuple[int, int], column_id: int = 1) -> ColumnScene:
    """Return a column with everything that a run leaves."""
    kind = methods()[method]
    sides = (*(8,) * (kind.dimensions - 2), *size)
    params = kind.params.from_json(METHODS[method])
    frames: list[Frame] = []

    def watch(step: Any) -> None:
        if step.frame is not None and step.preview is not None:
            frames.append(Frame(step.frame, to_picture(step.preview())))

    result = run(Job(method=method, inputs={"exemplar": exemplar}, params=params, size=sides, seed=4), watch)
    return ColumnScene(
        column_id, method, kind.title, params, status="finished", picture=to_picture(result.image),
        image=result.image, result=result, frames=tuple(frames), measures=dict(result.measures),
        findings=(CUTS,), size=sides,
    )  # fmt: skip


def of_old() -> list[str]:
    """Return where arrays of the large result are held."""
    gc.collect()
    objects = gc.get_objects()
    found: dict[int, Any] = {}
    for first in range(0, len(objects), BATCH):
        batch = objects[first : first + BATCH]
        # Most hold no array: a whole batch is asked at once, and only one that does is taken apart.
        if not any(issubclass(kind, np.ndarray) for kind in set(map(type, gc.get_referents(*batch)))):
            continue
        for each in batch:
            for held in gc.get_referents(each):
                if isinstance(held, np.ndarray) and any(sign <= set(held.shape) for sign in SIGNS):
                    found[id(held)] = (held.shape, held.dtype, describe(each))
    return [str(each) for each in found.values()]


def describe(holder: Any) -> str:
    if isinstance(holder, dict):
        return ", ".join(str(key) for key in list(holder)[:12])
    return type(holder).__qualname__


class Watched:
    """A tab with its host."""

    def __init__(self, qtbot: Any, kind: type[Dock]) -> None:
        self._qtbot = qtbot
        self.dock = kind()
        qtbot.addWidget(self.dock)
        self.dock.resize(900, 300)
        self.host = DockHost(self.dock, Slots(1))

    def see(self, scene: Scene) -> None:
        self.dock.show()
        on_screen(self._qtbot, self.dock)
        self._show(scene)

    def pages(self, scene: Scene) -> None:
        """Look at a scene, at every page of it."""
        self.see(scene)
        if isinstance(self.dock, LabDock):
            for page in (*range(self.dock.bar.count()), 0):
                self.dock.bar.setCurrentIndex(page)
                self._show(scene)

    def hide(self) -> None:
        self.dock.hide()
        self._qtbot.waitUntil(lambda: not self.host._look.isActive())

    def tell(self, scene: Scene) -> None:
        self.host.show_scene(scene)

    def _show(self, scene: Scene) -> None:
        self.host.show_scene(scene)
        self._qtbot.waitUntil(lambda: not self.host.busy)
        # What was announced last may ask for more on the next turn.
        self._qtbot.wait(0)
        # The thread still holds an answer at the moment at which it tells it.
        self._qtbot.waitUntil(lambda: not self.host.busy and not self.host._worker.busy)


@pytest.mark.parametrize("kind", dock_classes(), ids=lambda kind: kind.name)
def test_what_has_gone_is_held_by_no_tab(qtbot: Any, exemplar: Any, kind: type[Dock]) -> None:
    watched = Watched(qtbot, kind)
    try:
        for method in (*USUAL, *OTHERS.get(kind.name, ())):
            small = finished(exemplar, method, SMALL)
            after = Scene(exemplar, (small,), 1, Probe(1, 3, 3, True))
            watched.pages(large_and(small, exemplar, method, 1))
            watched.pages(after)
            assert not of_old(), f"{method}, in sight"
            watched.pages(large_and(small, exemplar, method, 1))
            watched.hide()
            watched.tell(after)
            assert not of_old(), f"{method}, out of sight"
            watched.pages(large_and(small, exemplar, method, 2))
            watched.hide()
            watched.tell(after)
            assert not of_old(), f"{method}, beside the chosen column, out of sight"
    finally:
        watched.host.close()


def test_a_large_result_that_is_there_is_found(exemplar: Any) -> None:
    scene = large_and(finished(exemplar, USUAL[0], SMALL), exemplar, USUAL[0], 1)
    assert of_old()
    assert scene.columns


def held_by(side: Side, result: Any) -> list[weakref.ref[Any]]:
    """Return what tells whether a result, what it was made with and its explanation are still held."""
    assert side.view is not None
    found = [result]
    for whole in (result.details, side.view._explained):
        found += [whole, *(getattr(whole, field.name) for field in dataclasses.fields(whole))]
    # Not tuples and numbers.
    return [weakref.ref(each) for each in found if type(each).__weakrefoffset__]


def still(refs: list[weakref.ref[Any]]) -> list[str]:
    gc.collect()
    return [type(each).__qualname__ for ref in refs if (each := ref()) is not None]


@pytest.mark.parametrize("method", ["heeger-bergen", "de-bonet", "efros-leung"])
def test_an_explanation_goes_with_its_result(qtbot: Any, exemplar: Any, method: str) -> None:
    watched = Watched(qtbot, ExplainDock)
    dock: Any = watched.dock
    first, second = dock.sides
    small = finished(exemplar, method, SMALL)
    other = finished(exemplar, "efros-leung" if method != "efros-leung" else "de-bonet", SMALL)
    place = Probe(1, 3, 3, False)

    def explained(side: Side, column_id: int = 1) -> list[weakref.ref[Any]]:
        old = finished(exemplar, method, SMALL, column_id)
        columns = (old,) if column_id == 1 else (small, old)
        watched.see(Scene(exemplar, columns, 1, place, compared=tuple(each.id for each in columns)))
        found = held_by(side, old.result)
        assert len(found) > 3
        return found

    try:
        held = explained(first)
        watched.see(Scene(exemplar, (small,), 1))
        assert not still(held), "seen, and no pixel is asked about"
        held = explained(first)
        watched.see(Scene(exemplar, (other,), 1, place))
        assert not still(held), "seen, and explained in another view"
        held = explained(first)
        watched.hide()
        watched.tell(Scene(exemplar, (small,), 1))
        assert not still(held), "out of sight"
        held = explained(second, 2)
        watched.see(Scene(exemplar, (small,), 1, place))
        assert not still(held), "no longer compared"
        assert first.view is not None
    finally:
        watched.host.close()


def test_the_band_that_was_looked_at_is_looked_at_again(qtbot: Any, exemplar: Any) -> None:
    watched = Watched(qtbot, ExplainDock)
    dock: Any = watched.dock
    small = finished(exemplar, "heeger-bergen", SMALL)
    try:
        watched.see(Scene(exemplar, (small,), 1, Probe(1, 3, 3, False)))
        view: Any = dock.sides[0].view
        chosen = (view.bars.selected + 1) % len(view.bars.bars)
        view.bars._choose(chosen)
        for probe in (None, None, Probe(1, 4, 4, False)):
            watched.see(Scene(exemplar, (small,), 1, probe))
            assert bool(view.bars.bars) == (probe is not None)
        assert view.bars.selected == chosen
        assert view.title.text() == view.bars.bars[chosen].title.capitalize()
    finally:
        watched.host.close()


@pytest.mark.parametrize("seen", [True, False])
def test_an_experiment_holds_nothing_of_an_exemplar_that_has_gone(qtbot: Any, exemplar: Any, seen: bool) -> None:
    watched = Watched(qtbot, LabDock)
    try:
        watched.pages(Scene(image_input(np.random.default_rng(3).random((*BIG, 3), np.float32))))
        after = Scene(exemplar)
        if not seen:
            watched.hide()
            watched.tell(after)
        else:
            watched.see(after)
        assert not of_old()
    finally:
        watched.host.close()


def large_and(small: ColumnScene, exemplar: Any, method: str, place: int) -> Scene:
    """Return a scene with a large result as the chosen column, or beside it, that nobody else refers to."""
    large = finished(exemplar, method, BIG, place)
    return Scene(exemplar, (large,) if place == 1 else (small, large), 1, Probe(place, 3, 3, True))
