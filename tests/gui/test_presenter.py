"""What the presenter, the overlays and the status lines say, with stand-ins for the window."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from dock_scenes import column_of, image_input, noise, scene_of
from PySide6.QtCore import QObject, QRectF
from PySide6.QtGui import QAction

from texlab.columns.overlays import Overlays, available
from texlab.columns.status import details, status_parts
from texlab.runs.exemplar import Prepared
from texlab.state.chosen import Column, Sample, State
from texlab.state.session import Session
from texlab.style.pictures import Lit, Mark, to_picture
from texlab.widgets.image_pane import ImagePane
from texlab.widgets.view_link import ViewLink
from texlab.window.presenter import Presenter
from texlab_core.engine.inputs import Crop
from texlab_core.engine.late_maps import LateMaps, made_map
from texlab_core.engine.registry import methods
from texlab_core.engine.steps import Map

HB = methods()["heeger-bergen"]


class Said:
    """Keeps what it was given last, whatever it is called."""

    def __init__(self) -> None:
        self.calls: dict[str, Any] = {}

    def __getattr__(self, name: str) -> Any:
        def take(*args: Any) -> None:
            self.calls[name] = args

        return take


class Window(QObject):
    """What the presenter writes to."""

    def __init__(self) -> None:
        super().__init__()
        self.status = SimpleNamespace(pixel=Said(), jobs=Said())
        self.message_bar, self.gallery, self.parameters = Said(), Said(), Said()
        self.gallery.strip = Said()
        self.gallery.strip.sources = ()
        self.actions_by_name = {name: QAction(self) for name in ("export", "use", "crop")}
        self.title = ""
        self.sessions = 0

    def show_session(self, session: Session) -> None:
        self.sessions += 1

    def show_recent(self, paths: list[str], chosen: Any) -> None:
        self.recent = paths

    def setWindowTitle(self, title: str) -> None:
        self.title = title

    @property
    def pixel(self) -> str:
        return str(self.status.pixel.calls["setText"][0])


class Bench:
    def __init__(self, **column: Any) -> None:
        self.window: Any = Window()
        session = Session()
        self.source = image_input(noise(20, 30), "gallery:sand")
        sample = Sample(self.source, crop=Crop(4, 6, 12, 16))
        session.apply(State(sample, (Column(1, HB.id, HB.params()),), 5, (24, 32), 2), "start")
        session.select(1)
        exemplar = image_input(self.source.pixels[4:16, 6:22], "gallery:sand")
        self.prepared = Prepared(exemplar, to_picture(self.source.pixels), self.source)
        self.column = column_of(noise(24, 32), method=HB.id, params=HB.params(), **column)
        self.opened: list[tuple[str, ...]] = []
        controller: Any = SimpleNamespace(
            session=session,
            prepared=self.prepared,
            column_scene=self.column_scene,
            tell_opened=self.opened.append,
        )
        self.exemplar, self.link, self.overlays = Said(), Said(), Said()
        pane: Any = Said()
        self.pane = pane
        self.exemplar.pane = pane
        self.exemplar.panel = Said()
        workspace: Any = Said()
        self.workspace = workspace
        workspace.exemplar, workspace.link = self.exemplar, self.link
        settings: Any = SimpleNamespace(recent=["a.png"])
        presets, overlays = Said(), self.overlays
        self.host = Said()
        hosts: Any = [self.host]
        self.presenter = Presenter(self.window, workspace, controller, settings, presets, overlays, hosts)
        self.session = session

    def column_scene(self, column_id: int) -> Any:
        return self.column if column_id == 1 else None


def test_pixels_light_up_in_the_pictures_that_they_are_of(bench: Bench, qtbot: Any) -> None:
    panes = [ImagePane(ViewLink()) for _ in range(2)]
    for pane, picture in zip(panes, (bench.prepared.source_picture, to_picture(bench.column.image)), strict=True):
        qtbot.addWidget(pane)
        pane.set_picture(picture)
    bench.exemplar.pane = panes[0]
    bench.workspace.columns = {1: SimpleNamespace(pane=panes[1], scene=bench.column)}
    veils = [noise(*size, 4, seed=7).astype(np.uint8) for size in ((12, 16), (24, 32))]
    images = (bench.prepared.exemplar.pixels, bench.column.image)
    places = tuple(map(Lit, (0, 1), images, veils))
    bench.presenter.light_up(places)
    # The pane of the exemplar shows all of the source, and the box lies at (4, 6).
    shown = panes[0].light
    np.testing.assert_array_equal(shown[4:, 6:], veils[0])
    assert shown.shape == (16, 22, 4)
    assert not shown[:4].any()
    np.testing.assert_array_equal(panes[1].light, veils[1])
    # The same picture again keeps it, another one does not.
    panes[1].set_picture(panes[1].picture)
    assert panes[1].light is not None
    panes[1].set_picture(panes[1].picture.copy())
    assert panes[1].light is None
    # What is of another picture by now lights up nowhere.
    bench.presenter.light_up(tuple(Lit(each.column_id, each.image.copy(), each.veil) for each in places))
    assert [pane.light for pane in panes] == [None, None]
    bench.presenter.light_up(places)
    bench.presenter.light_up(())
    assert [pane.light for pane in panes] == [None, None]


@pytest.fixture
def bench(qapp: Any) -> Bench:
    source = np.zeros((24, 32, 2), np.int32)
    source[..., 0], source[..., 1] = 3, 11
    source[7, 9] = (5, 14)
    candidates = np.arange(24 * 32).reshape(24, 32)
    maps = {"source": Map(source, "source", "Source"), "candidates": Map(candidates, "count", "Candidates")}
    return Bench(maps=maps)


def test_the_pixel_of_a_result_with_where_it_is_from(bench: Bench) -> None:
    bench.presenter.say_column_pixel(1, 7, 9)
    red, green, blue = bench.column.image[7, 9]
    where = "from exemplar 14, 5   candidates 233"
    assert bench.window.pixel == f"9, 7   RGB {red:.3f} {green:.3f} {blue:.3f}   {where}"
    for outside in ((-1, -1), (24, 0), (0, 32)):
        bench.presenter.say_column_pixel(1, *outside)
        assert bench.window.pixel == ""
    bench.presenter.say_column_pixel(2, 7, 9)
    assert bench.window.pixel == ""


def test_what_is_under_the_pointer_follows_the_picture(bench: Bench) -> None:
    bench.presenter.say_column_pixel(1, 7, 9)
    before = bench.window.pixel
    bench.column = column_of(noise(24, 32, seed=5), method=HB.id, params=HB.params())
    bench.presenter.show_scene(scene_of(bench.column))
    red, green, blue = bench.column.image[7, 9]
    assert bench.window.pixel == f"9, 7   RGB {red:.3f} {green:.3f} {blue:.3f}" != before
    # A smaller picture has no such pixel; the exemplar is no other.
    bench.column = column_of(noise(6, 6), method=HB.id, params=HB.params())
    bench.presenter.show_scene(scene_of(bench.column))
    assert bench.window.pixel == ""
    bench.presenter.say_exemplar_pixel(19, 3)
    bench.presenter.show_scene(scene_of(bench.column))
    assert bench.window.pixel.endswith("picture 3, 19")


def test_a_pixel_without_a_value_has_none(bench: Bench) -> None:
    image = noise(24, 32)
    filled = np.zeros((24, 32), bool)
    filled[:8] = True
    done = bench.column
    bench.column = replace(done, status="running", image=image, filled=filled)
    bench.presenter.say_column_pixel(1, 9, 7)
    assert bench.window.pixel == "7, 9   not filled yet"
    bench.presenter.say_column_pixel(1, 7, 9)
    red, green, blue = image[7, 9]
    # The maps are those of the result before.
    assert bench.window.pixel == f"9, 7   RGB {red:.3f} {green:.3f} {blue:.3f}"
    bench.column = done
    bench.presenter.show_scene(scene_of(bench.column))
    assert "from exemplar 14, 5" in bench.window.pixel


def test_a_pixel_that_was_kept_comes_from_nowhere(bench: Bench) -> None:
    source = np.full((24, 32, 2), -1, np.int32)
    bench.column = column_of(
        noise(24, 32), method=HB.id, params=HB.params(), maps={"source": Map(source, "source", "Source")}
    )
    bench.presenter.say_column_pixel(1, 7, 9)
    assert "from" not in bench.window.pixel


def test_the_pixel_of_the_exemplar(bench: Bench) -> None:
    bench.presenter.say_exemplar_pixel(19, 3)
    red, green, blue = bench.source.pixels[19, 3]
    value = f"RGB {red:.3f} {green:.3f} {blue:.3f}"
    assert bench.window.pixel == f"outside the crop   {value}   picture 3, 19"
    # The crop begins at 6, 4: methods, maps and tabs count from there.
    bench.presenter.say_exemplar_pixel(9, 20)
    red, green, blue = bench.prepared.exemplar.pixels[5, 14]
    value = f"RGB {red:.3f} {green:.3f} {blue:.3f}"
    assert bench.window.pixel == f"exemplar 14, 5   {value}   picture 20, 9"
    bench.presenter._session = SimpleNamespace(state=SimpleNamespace(sample=Sample(bench.source)))
    bench.presenter.say_exemplar_pixel(9, 20)
    assert bench.window.pixel == f"exemplar 20, 9   {value}"
    bench.presenter.say_exemplar_pixel(20, 3)
    assert bench.window.pixel == ""


def test_marks_lie_in_the_crop_that_the_methods_see(bench: Bench) -> None:
    marks = (Mark(1, 2, 3, 4),)
    bench.presenter.show_marks(marks)
    assert bench.pane.calls["set_marks"] == (marks, (4, 6))


def test_a_scene_reaches_every_dock_and_the_numbers_of_jobs(bench: Bench) -> None:
    params = {"method": HB.id, "params": HB.params()}
    scene = scene_of(
        bench.column,
        column_of(None, column_id=2, status="running", **params),
        column_of(None, column_id=3, status="failed", **params),
    )
    bench.presenter.show_scene(scene)
    assert bench.host.calls["show_scene"] == (scene,)
    assert bench.overlays.calls["show_scene"] == (scene,)
    assert bench.window.status.jobs.calls["setText"] == ("1 running · 1 failed",)
    # The larger of the result's and the source's sides, and the thinnest of all.
    assert bench.workspace.calls["set_extents"] == ((24, 32), (20, 30))
    assert bench.window.actions_by_name["export"].isEnabled()
    bench.presenter.show_scene(scene_of(column_of(None, **params)))
    assert not bench.window.actions_by_name["use"].isEnabled()
    assert bench.window.status.jobs.calls["setText"] == ("ready",)


def test_the_session_and_the_exemplar_have_names(bench: Bench) -> None:
    bench.presenter.show_session()
    assert bench.window.sessions == 1
    assert bench.window.parameters.calls["show_column"] == (1, HB, HB.params())
    assert bench.window.title == "sand - TexLab"
    assert bench.window.actions_by_name["crop"].isChecked() is False
    assert bench.exemplar.calls["show_choice"][0] == "sand"
    assert bench.exemplar.calls["show_choice"][1] == ["16 x 12 colour at 6, 4 of 30 x 20"]
    assert "hide" not in bench.window.message_bar.calls
    other = Sample(image_input(noise(8, 8, 1, seed=4), "mine.png"))
    bench.session.set_sample(other)
    bench.presenter.show_session()
    # What was said was about the exemplar before.
    assert "hide" in bench.window.message_bar.calls
    assert bench.window.recent == ["a.png"]
    assert bench.opened[-1] == ("a.png",)


# Outlines.


def test_marks_are_painted_where_they_are(qtbot: Any) -> None:
    pane = ImagePane(ViewLink())
    qtbot.addWidget(pane)
    pane.set_marks((Mark(10, 3, 2, 5, "chosen"),), (100.0, 20.0))
    assert pane._marks is not None
    assert pane._marks._lines["chosen", False] == [QRectF(23, 110, 5, 2)]
    assert pane._marks.boundingRect() == QRectF(15, 102, 21, 18)


# Overlays.


class View:
    def __init__(self, scene: Any) -> None:
        self.scene, self.pane, self.maps = scene, Said(), ((), "")

    def show_maps(self, maps: Any, chosen: str) -> None:
        self.maps = (maps, chosen)


def overlaid(image: Any) -> Any:
    maps = {"count": Map(image[..., 0], "scalar", "Counts"), "more": Map(image[..., 1], "scalar", "More")}
    return column_of(image, maps=maps)


@pytest.fixture
def overlays(qapp: Any, monkeypatch: pytest.MonkeyPatch) -> Any:
    views: dict[int, Any] = {1: View(overlaid(noise(8, 8)))}
    made = Overlays(views)
    asked: list[Any] = []
    worker = SimpleNamespace(submit=asked.append, close=lambda: None)
    monkeypatch.setattr(made, "_worker", lambda column_id: worker)
    return SimpleNamespace(made=made, view=views[1], asked=asked)


def test_a_stale_overlay_is_never_shown(overlays: Any) -> None:
    made, view = overlays.made, overlays.view
    made.choose(1, "count")
    assert view.maps == ((("count", "Counts"), ("more", "More")), "count")
    picture = noise(8, 8)
    first = view.scene.result
    # Another result has come while the map of the one before was coloured.
    view.scene = overlaid(noise(8, 8, seed=2))
    made.show_scene(scene_of(view.scene))
    made._coloured((1, id(first), picture))
    assert view.pane.calls == {}
    made._coloured((1, id(view.scene.result), picture))
    assert view.pane.calls["set_overlay"] == (picture,)
    assert len(overlays.asked) == 2
    # While there is no result, there is nothing to lay over.
    view.scene = column_of(None, status="running")
    made.show_scene(scene_of(view.scene))
    assert view.pane.calls["set_overlay"] == (None,)
    made._coloured((1, id(first), picture))
    assert view.pane.calls["set_overlay"] == (None,)


def test_an_overlay_that_was_taken_away_does_not_come_back(overlays: Any) -> None:
    made, view = overlays.made, overlays.view
    made.choose(1, "more")
    made.choose(1, "")
    made._coloured((1, id(view.scene.result), noise(8, 8)))
    assert view.pane.calls["set_overlay"] == (None,)


# The line under a column.


def test_shares_are_told_in_per_cent() -> None:
    spectral = column_of(noise(8, 9), measures={"spectral-variation": 0.347, "spectral-distance": 2.04})
    assert {"power moved 35%", "spectrum 2.0 dB"} <= set(details(spectral))
    copied = column_of(noise(8, 9), measures={"copied-share": 0.126, "median-candidates": 7.0})
    assert {"copied 13%", "candidates 7"} <= set(details(copied))


def test_a_running_column_says_how_long_it_takes() -> None:
    parts = status_parts(column_of(None, status="running", message="level 2", fraction=0.25, elapsed_s=10.0))
    assert parts == ["level 2", "about 30 s left"]
    assert status_parts(column_of(None, status="failed", message="Too small.")) == ["Too small."]
    assert status_parts(column_of(None, status="cancelled", resumable=True)) == ["stopped", "F6 goes on"]


# Maps that are made late.


def made_by_nobody() -> Map:
    raise AssertionError("A map was made in the window's thread.")


def test_a_map_that_has_to_be_made_is_offered_but_not_made(overlays: Any) -> None:
    ready = Map(np.full((8, 8, 2), 3, np.int32), "source", "Source")
    maps = LateMaps({"source": ("Source", lambda: ready), "candidates": ("Candidates", made_by_nobody)})
    overlays.view.scene = column_of(noise(8, 8), maps=maps)
    overlays.made.show_scene(scene_of(overlays.view.scene))
    assert overlays.view.maps[0] == (("source", "Source"), ("candidates", "Candidates"))
    assert available(overlays.view.scene) == overlays.view.maps[0]
    assert made_map(maps, "source") is None
    assert maps["source"] is ready
    assert made_map(maps, "source") is ready
    assert made_map({"source": ready}, "source") is ready
    assert made_map({}, "source") is None


def test_the_value_under_the_pointer_tells_only_what_is_there(qapp: Any) -> None:
    ready = Map(np.full((24, 32, 2), 3, np.int32), "source", "Source")
    maps = LateMaps({"source": ("Source", lambda: ready), "candidates": ("Candidates", made_by_nobody)})
    bench = Bench(maps=maps)
    bench.presenter.say_column_pixel(1, 2, 5)
    assert "exemplar" not in bench.window.pixel
    assert maps["source"] is ready
    bench.presenter.say_column_pixel(1, 2, 5)
    assert bench.window.pixel.endswith("from exemplar 3, 3")
