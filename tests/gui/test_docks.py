"""What holds for every dock: it follows from the scene alone, whatever happened while nobody looked at it."""

from __future__ import annotations

import threading
from dataclasses import replace
from typing import Any, ClassVar

import pytest
from dock_scenes import column_of, noise, scene_of
from mouse import on_screen
from PySide6.QtCore import Qt

from tests.gui.conftest import wait_idle
from texlab.docks import dock_classes
from texlab.docks.base import Dock, Question
from texlab.docks.frame import WORKING, FramedDock
from texlab.docks.host import DockHost
from texlab.docks.recent import Recent
from texlab.runs.slots import Slots
from texlab.state.intentions import Tell
from texlab.window.palette import CommandPalette
from texlab_core.engine.registry import methods
from texlab_core.engine.steps import Curve, Map


class Endless(Dock):
    """Computes until it is told to stop."""

    name: ClassVar[str] = "endless"
    title: ClassVar[str] = "Endless"
    help: ClassVar[str] = ""

    def __init__(self) -> None:
        super().__init__()
        self.begun, self.ended = threading.Event(), threading.Event()

    def question(self, scene: Any) -> Question:
        def compute(should_stop: Any) -> None:
            self.begun.set()
            while not should_stop():
                self.ended.wait(0.001)
            self.ended.set()

        return Question(("endless",), compute)


class Resting(Dock):
    """Tells the seeds of the scenes that it was asked about, and then rests."""

    name: ClassVar[str] = "resting"
    title: ClassVar[str] = "Resting"
    help: ClassVar[str] = ""
    rest_ms: ClassVar[int] = 600_000

    def __init__(self) -> None:
        super().__init__()
        self.answers: list[int] = []

    def question(self, scene: Any) -> Question:
        return Question((scene.seed,), lambda should_stop: scene.seed)

    def present(self, answer: int) -> None:
        self.answers.append(answer)


class Framed(FramedDock):
    """Shows nothing of what it is answered."""

    name: ClassVar[str] = "framed"
    title: ClassVar[str] = "Framed"
    help: ClassVar[str] = ""

    def build(self) -> None:
        self.recent = Recent(1)

    def show_answer(self, answer: Any) -> None:
        pass


@pytest.fixture
def watch(qtbot: Any) -> Any:
    """Return a function that puts a dock on its host, out of sight; all share one place."""
    hosts: list[DockHost] = []
    slots = Slots(1)

    def make(dock: Dock) -> DockHost:
        qtbot.addWidget(dock)
        dock.resize(700, 260)
        hosts.append(DockHost(dock, slots))
        return hosts[-1]

    make.slots = slots
    yield make
    for host in hosts:
        host.close()


def everything() -> Any:
    """A finished column that shows all there can be, on an exemplar."""
    image, method = noise(32, 32), methods()["heeger-bergen"]
    maps = {"count": Map(noise(32, 32, 1)[..., 0], "scalar", "Counts")}
    curves = {"distance": Curve.of((1.0, 0.5, 0.25), "distance")}
    return scene_of(
        column_of(image, method=method.id, params=method.params(), maps=maps, curves=curves),
        exemplar=noise(32, 32, seed=2),
    )


@pytest.mark.parametrize("kind", dock_classes(), ids=lambda kind: kind.name)
def test_a_dock_that_comes_into_sight_shows_what_there_is(qtbot: Any, watch: Any, kind: Any) -> None:
    dock = kind()
    host, scene = watch(dock), everything()
    assert watch.slots.acquire(lambda: False)
    # All of this happens while another dock is in front.
    waiting = scene_of(
        column_of(None, method="heeger-bergen", params=methods()["heeger-bergen"].params(), status="waiting"),
        exemplar=noise(32, 32, seed=2),
    )
    for each in (scene_of(exemplar=None), waiting, scene):
        host.show_scene(each)
    dock.show()
    on_screen(qtbot, dock)
    qtbot.waitUntil(lambda: host._was_seen is True)
    asks = dock.question(scene) is not None
    # Somebody else computes: nothing is not what is said of something that is on its way.
    assert (dock.message in (None, WORKING)) == asks
    assert not asks or host.busy
    watch.slots.release()
    qtbot.waitUntil(lambda: not host.busy)
    assert (dock.message is None) == asks


def test_a_dock_rests_between_two_answers(qtbot: Any, watch: Any) -> None:
    dock = Resting()
    host, scene = watch(dock), everything()
    dock.show()
    on_screen(qtbot, dock)
    host.show_scene(replace(scene, seed=1))
    qtbot.waitUntil(lambda: dock.answers == [1])
    # What comes while it rests waits for the end of the rest, and the newest alone is asked about.
    for seed in (2, 3):
        host.show_scene(replace(scene, seed=seed))
        assert host.busy
    assert (dock.answers, host._computing) == ([1], False)
    host._rested.setRemainingTime(0)
    host._rest.timeout.emit()
    qtbot.waitUntil(lambda: dock.answers == [1, 3])


@pytest.mark.parametrize("heavy", [False, True])
def test_only_heavy_answers_go_when_they_are_out_of_date(qtbot: Any, monkeypatch: Any, heavy: bool) -> None:
    monkeypatch.setattr(Framed, "heavy", heavy)
    dock = Framed()
    qtbot.addWidget(dock)
    dock.recent.get("a", lambda: 1)
    dock.present("an answer")
    dock.forget()
    kept = dock.recent.get("a", lambda: 2)
    assert (dock.answer, dock.message, kept) == ((None, WORKING, 2) if heavy else ("an answer", None, 1))


def test_nobody_waits_for_what_nobody_sees(qtbot: Any, watch: Any) -> None:
    endless, other = Endless(), dock_classes()[0]()
    first, second = watch(endless), watch(other)
    for host in (first, second):
        host.show_scene(everything())
    endless.show()
    on_screen(qtbot, endless)
    qtbot.waitUntil(endless.begun.is_set)
    other.show()
    on_screen(qtbot, other)
    qtbot.waitUntil(lambda: other.message == WORKING)
    endless.hide()
    qtbot.waitUntil(lambda: other.message is None)
    assert endless.ended.is_set()
    qtbot.waitUntil(lambda: not first.busy)
    # What was dropped is asked again.
    endless.begun.clear()
    endless.show()
    qtbot.waitUntil(endless.begun.is_set)


@pytest.mark.parametrize("kind", dock_classes(), ids=lambda kind: kind.name)
def test_every_dock_says_what_it_is(kind: Any) -> None:
    missing = [each for each in ("name", "title", "help") if not isinstance(getattr(kind, each, None), str)]
    assert not missing, f"{kind.__module__}.{kind.__name__} lacks {' and '.join(missing)}, as class attributes."
    assert kind.name.isidentifier(), f"The name of a dock is a Python name, got {kind.name!r}."
    assert kind.title, f"The dock {kind.name} has an empty title."
    assert kind.help.endswith("."), f"The help of the dock {kind.name} is a sentence, got {kind.help!r}."


def test_a_dock_is_made_when_it_is_first_seen(qtbot: Any, explorer: Any) -> None:
    window = explorer.window
    front = window.front_dock()
    made = [name for name, host in explorer.hosts.items() if host.is_made]
    assert made == [front]
    assert set(window.unmade) == {*explorer.hosts} - {front}
    window.themes.choose("dark")
    # By its name in the strip, by a command, by asking.
    name = "spectrum"
    host = explorer.hosts[name]
    told: list[Any] = []
    host.made.connect(told.append)
    window.docks[name].raise_()
    qtbot.waitUntil(lambda: host.is_made and host.seen)
    dock = host.dock
    assert told == [dock]
    assert dock.theme.name == "dark"
    wait_idle(qtbot, explorer)
    assert dock.message is None
    window.raise_dock("histograms")
    # It comes in pieces, and the keyboard goes on in what is made.
    qtbot.waitUntil(lambda: explorer.hosts["histograms"].is_made)
    assert explorer.hosts["histograms"].dock.isAncestorOf(window.focusWidget())
    assert window.docks["histograms"].isAncestorOf(window.focusWidget())
    window.themes.choose("light")
    assert {each.theme.name for each in (dock, explorer.hosts["histograms"].dock)} == {"light"}
    # What a tab that nobody has seen intends is carried out as well.
    explorer.hosts["steps"].dock.intention.emit(Tell("said", False))
    assert window.message_bar.label.text() == "said"


def test_settings_of_a_tab_that_was_never_seen_are_kept(qtbot: Any, explorer: Any) -> None:
    host, layouts = explorer.hosts["histograms"], explorer.own_layouts
    layouts.keep("unseen")
    assert layouts.layouts["unseen"].controls["histograms"] == {}
    host.take_settings({"log": True})
    layouts.keep("wanted")
    assert not host.is_made
    assert layouts.layouts["wanted"].controls["histograms"] == {"log": True}
    explorer.window.raise_dock("histograms")
    wait_idle(qtbot, explorer)
    assert host.settings()["log"] is True
    # Kept before anybody had seen it: as it is made.
    layouts.take("unseen")
    assert host.settings()["log"] is False
    layouts.take("wanted")
    assert host.settings()["log"] is True


def test_the_palette_offers_settings_of_tabs_that_nobody_has_seen(qtbot: Any, explorer: Any) -> None:
    window = explorer.window
    assert "spectrum" in window.unmade
    explorer.desk.show_palette()
    palette = window.findChild(CommandPalette, "command-palette")
    qtbot.keyClicks(palette.field, "fill radius")
    assert "spectrum" in window.unmade
    qtbot.waitUntil(lambda: palette.list.item(0).text().startswith("Fill: "))
    assert window.unmade == ()
    offered = [each.name for each in palette._entries if each.kind == "setting"]
    assert len(offered) == len(set(offered))
    assert {each.partition(":")[0] for each in offered} > {"Spectrum", "Fill", "Pyramid"}
    qtbot.keyClick(palette.field, Qt.Key.Key_Return)
    assert window.front_dock() == "fill"
    wait_idle(qtbot, explorer)
