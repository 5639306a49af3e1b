"""What the opener makes of what it reads, with a stand-in for the controller."""

from __future__ import annotations

import json
from types import SimpleNamespace
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from PIL import Image

from texlab.state.chosen import Column, State
from texlab.state.session import Session
from texlab.storage.reading import Choice
from texlab.window.exchange import Exchange
from texlab.window.opener import Opener
from texlab_core.documents.presets import Preset, write_preset
from texlab_core.documents.reading import read_recipe
from texlab_core.engine.inputs import Crop
from texlab_core.engine.job import Job
from texlab_core.engine.registry import methods
from texlab_core.engine.run import run
from texlab_core.errors import InputError
from texlab_core.files import strict_json
from texlab_core.images.exemplar import as_exemplar

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

HB = methods()["heeger-bergen"]


class Background:
    """A controller whose background work waits until it is told to go on."""

    def __init__(self) -> None:
        self.news: list[str] = []
        self.exemplar = None
        self.problems: list[str] = []
        self.said = SimpleNamespace(emit=self.news.append)
        self.waiting: list[Callable[[], None]] = []
        self.asking = 0

    def ask_first(self) -> None:
        self.asking += 1

    def once(self, name: str, request: Any, done: Any = None, failed: Any = None) -> None:
        def work() -> None:
            try:
                value = request(SimpleNamespace(should_stop=lambda: False))
            except (InputError, OSError) as error:
                self.problems.append(str(error))
                if failed is not None:
                    failed()
            else:
                done(value)

        self.waiting.append(work)

    def go_on(self) -> None:
        while self.waiting:
            self.waiting.pop(0)()


class Bench:
    def __init__(self) -> None:
        self.session = Session()
        columns = (Column(1, HB.id, HB.params()), Column(2, "msg", methods()["msg"].params()))
        self.session.apply(State(None, columns, 5, (24, 32), 3), "start")
        self.session.select(1)
        self.session.reset_history()
        self.background: Any = Background()
        self.recent: list[str] = []
        self.presets: list[Any] = []
        self.several: list[Any] = []
        settings: Any = SimpleNamespace(add_recent=self.recent.append)
        self.opener = Opener(self.session, self.background, settings, self.presets.append, self.several.append)

    def open(self, source: Any) -> None:
        self.opener.open(source)
        self.background.go_on()

    @property
    def sample(self) -> Any:
        return self.session.state.sample


@pytest.fixture
def bench(qapp: Any) -> Bench:
    return Bench()


def picture(path: Path, height: int, width: int) -> Path:
    pixels = np.random.default_rng(1).integers(0, 256, (height, width, 3), np.uint8)
    Image.fromarray(pixels).save(path)
    return path


def test_a_photograph_is_reduced_and_remembered(bench: Bench, tmp_path: Path) -> None:
    path = picture(tmp_path / "photo.png", 320, 512)
    bench.open(str(path))
    assert (bench.sample.source.size, bench.sample.scale, bench.sample.path) == ((320, 512), 0.5, str(path))
    assert bench.recent == [str(path)]
    # Nobody wants to undo to an empty window; afterwards every image is a step.
    assert bench.session.undo_text is None
    bench.open(str(picture(tmp_path / "small.png", 40, 50)))
    assert bench.sample.scale == 1.0
    assert bench.session.undo_text == f"exemplar {bench.sample.source.name}"


def test_the_crop_is_kept_between_textures_of_the_gallery(bench: Bench, tmp_path: Path) -> None:
    crop = Crop(16, 16, 128, 128)
    bench.opener.open_first_of([Choice("gallery:structured-pebbles", crop, 1.0)])
    bench.background.go_on()
    assert bench.sample.crop == crop
    bench.open("gallery:oriented-zebra")
    assert (bench.sample.source.name, bench.sample.crop) == ("gallery:oriented-zebra", crop)
    bench.open(str(picture(tmp_path / "mine.png", 200, 200)))
    assert bench.sample.crop is None
    assert len(bench.recent) == 1


def test_the_newest_of_several_wins(bench: Bench, tmp_path: Path) -> None:
    first, second = picture(tmp_path / "first.png", 20, 20), picture(tmp_path / "second.png", 30, 30)
    bench.opener.open(str(first))
    bench.opener.open(str(second))
    # The slower one comes last.
    bench.background.waiting.reverse()
    bench.background.go_on()
    assert bench.sample.source.size == (30, 30)


def test_a_failure_of_the_gallery_brings_its_job(bench: Bench) -> None:
    bench.opener.open_failure("small-thresholds")
    bench.background.go_on()
    column = bench.session.selected_column
    assert (column.method, column.params.alpha) == ("de-bonet", 0.02)
    assert bench.sample.source.name == "gallery:stochastic-gravel"
    assert bench.session.state.size == (256, 256)
    assert bench.background.news[-1].startswith("Thresholds too small: Whole stones")
    # Another method beside it is added once.
    methods = [each.method for each in bench.session.state.columns]
    for beside in ("de-bonet", "tiling", "tiling"):
        bench.opener.open_failure("coral", beside)
        bench.background.go_on()
    assert "de-bonet" in methods
    assert [each.method for each in bench.session.state.columns] == [*methods, "tiling"]
    assert bench.session.selected_column.method == "heeger-bergen"
    # The newest wins, also over an image.
    bench.opener.open_failure("rotational-symmetry")
    bench.opener.open("gallery:oriented-zebra")
    bench.background.go_on()
    assert bench.sample.source.name == "gallery:oriented-zebra"
    bench.opener.open_failure("rotational-symmetry")
    bench.background.go_on()
    assert bench.sample.crop == Crop(64, 64, 128, 128)
    assert bench.session.undo_text == "failure rotational-symmetry"


def test_the_first_that_can_be_read_is_opened(bench: Bench, tmp_path: Path) -> None:
    there = picture(tmp_path / "there.png", 20, 24)
    bench.opener.open_first_of([Choice(str(tmp_path / "gone.png")), Choice(str(there), Crop(1, 1, 8, 8), 1.0)])
    bench.background.go_on()
    assert (bench.sample.source.size, bench.sample.crop) == ((20, 24), Crop(1, 1, 8, 8))
    assert len(bench.background.problems) == 1
    assert "gone.png" in bench.background.problems[0]


def test_a_saved_result_brings_its_job_back(bench: Bench, tmp_path: Path) -> None:
    exemplar = as_exemplar(str(picture(tmp_path / "exemplar.png", 32, 32)))
    params = HB.params(scales=1, iterations=1)
    result = run(Job(method=HB.id, inputs={"exemplar": exemplar}, params=params, size=(16, 20), seed=77))
    path = tmp_path / "made.png"
    bench.opener.save(result, str(path), measures={"discriminability": -3.126, "copied-share": 0.4})
    bench.background.go_on()
    assert bench.background.news == [f"Saved {path} with its recipe."]
    assert read_recipe(str(path)).job().seed == 77
    bench.session.select(2)
    bench.open(str(path))
    state = bench.session.state
    assert (state.seed, state.size, state.column(1).params) == (77, (16, 20), params)
    assert bench.session.selected_id == 1
    assert bench.recent == []
    assert bench.background.news[1].endswith(" were restored. It was saved with D -3.13, copied 40%.")
    # What a file asks for may be too much; an example of our own is not.
    assert bench.background.asking == 1
    bench.opener.open_failure("tiling")
    bench.background.go_on()
    assert bench.background.asking == 1


def test_the_newest_copy_stays_on_the_clipboard(bench: Bench, monkeypatch: pytest.MonkeyPatch) -> None:
    copied: list[Any] = []
    monkeypatch.setattr("texlab.window.exchange.put_on_clipboard", lambda png, picture: copied.append(picture))
    pictures = {column: np.full((4, 5, 3), column, np.uint8) for column in (1, 2)}
    bench.background.column_scene = lambda column: SimpleNamespace(picture=pictures[column], result=None)
    window: Any = None
    exchange = Exchange(window, window, bench.background, bench.opener)
    exchange.copy(1)
    exchange.copy(2)
    # The later one is encoded first.
    bench.background.waiting.reverse()
    bench.background.go_on()
    assert [picture is pictures[2] for picture in copied] == [True]
    assert bench.background.news == ["Copied 5 x 4 pixels."]


def test_a_preset_is_read_once(bench: Bench, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    preset = Preset.of("mine", HB.id, HB.params(iterations=3), note="")
    path = tmp_path / "mine.json"
    write_preset(preset, path)
    read: list[Any] = []
    load = strict_json.load
    monkeypatch.setattr(strict_json, "load", lambda *args, **more: read.append(args) or load(*args, **more))
    bench.open(str(path))
    assert [each.parameters["iterations"] for each in bench.presets] == [3]
    assert len(read) == 1
    assert bench.session.undo_text is None


def test_what_is_no_document_gets_one_sentence(bench: Bench, tmp_path: Path) -> None:
    path = tmp_path / "else.json"
    path.write_text(json.dumps({"format": "something"}), encoding="utf-8")
    bench.open(str(path))
    assert bench.background.problems == ["else.json is neither a code of MSG nor a preset."]
    assert bench.presets == []


def test_a_result_becomes_the_exemplar(bench: Bench) -> None:
    pixels = np.random.default_rng(0).random((16, 20, 3), np.float32)
    result: Any = SimpleNamespace(image=pixels, job=SimpleNamespace(method="msg", inputs={}))
    bench.opener.use_as_exemplar(result)
    bench.background.go_on()
    assert bench.sample.source.name == "msg result"
    assert np.array_equal(bench.sample.source.pixels, pixels)


def test_of_several_pictures_the_first_readable_is_taken_and_all_can_be_chosen(
    bench: Bench, tmp_path: Path
) -> None:
    bad, good = tmp_path / "bad.png", tmp_path / "good.png"
    bad.write_text("no picture")
    Image.fromarray(np.arange(64, dtype=np.uint8).reshape(8, 8)).save(good)
    preset = tmp_path / "five.json"
    write_preset(Preset.of("five", HB.id, HB.params()), preset)
    bench.opener.open_all([str(bad), str(preset), str(good)])
    bench.background.go_on()
    assert bench.sample.path == str(good)
    assert [each.name for each in bench.presets] == ["five"]
    assert bench.several == [[str(bad), str(good)]]
    assert any("bad.png" in sentence for sentence in bench.background.problems)
    assert "2 pictures were opened" in bench.background.news[0]
