"""What is kept between two starts: one session or the other after an end by force, and damaged files are none."""

from __future__ import annotations

import io
import json
import logging
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from tests.core.kills import deaths
from texlab.app.crash import CrashHandler
from texlab.state.chosen import Column, Sample, State
from texlab.state.session import Session
from texlab.storage.autosave import Autosave
from texlab.storage.kept_exemplar import Kept, keep, kept_exemplar, load
from texlab.storage.paths import config_dir, log_file
from texlab.storage.reading import last_exemplar
from texlab.storage.sessions import claim
from texlab.storage.settings import Settings, columns_from_json, session_to_json
from texlab_core.engine.registry import find_method
from texlab_core.errors import InputError
from texlab_core.images.exemplar import as_exemplar

if TYPE_CHECKING:
    from collections.abc import Iterator

CASES = sorted((Path(__file__).parent / "damaged").glob("*.npy"))
assert CASES


def state(seed: int) -> State:
    """Return a session whose exemplar and mask exist nowhere else."""
    draw = np.random.default_rng(seed)
    exemplar = as_exemplar(draw.random((6, 7, 3)).astype(np.float32), name=f"pasted {seed}")
    mask = as_exemplar((draw.random((6, 7)) > 0.5).astype(np.float32), name="mask")
    params = find_method("efros-leung").params()
    return State(Sample(exemplar), (Column(1, "efros-leung", params, (("mask", mask),)),), seed, (6, 7), 2)


@pytest.fixture
def autosave(qapp: Any, texlab_home: Path) -> Iterator[Autosave]:
    made = Autosave(Session(), Settings(), claim())
    yield made
    made.close()


def write(autosave: Autosave, kept: State) -> None:
    """Write a session as the autosave does in its thread."""
    assert kept.sample is not None
    autosave._write(dict(autosave._settings.values), session_to_json(kept, 1), kept.sample, kept)


def on_disk() -> Any:
    """Return the session that the next window would get."""
    return json.loads((config_dir() / "sessions" / "1.json").read_text())


def test_a_session_is_whole_whenever_the_program_ends(autosave: Autosave, monkeypatch: pytest.MonkeyPatch) -> None:
    old, new = state(1), state(2)
    seen = []

    def prepare() -> None:
        autosave._kept = None
        write(autosave, old)

    for _ in deaths(monkeypatch, prepare, lambda: write(autosave, new)):
        saved = on_disk()
        expected = {1: old, 2: new}[saved["seed"]]
        (choice,) = last_exemplar(saved)
        assert isinstance(choice.source, Kept)
        assert choice.source.name == f"pasted {saved['seed']}"
        assert expected.sample is not None
        assert np.array_equal(load(choice.source).pixels, expected.sample.source.pixels)
        inputs = columns_from_json(saved)[0][2]
        assert dict(inputs)["mask"].sha256 == dict(expected.columns[0].inputs)["mask"].sha256
        seen.append(saved["seed"])
    assert seen == sorted(seen)
    assert set(seen) == {1, 2}
    # Neither the other session nor anything half written is left.
    assert len(list(config_dir().glob("exemplar*"))) == 1
    assert len(list((config_dir() / "inputs").iterdir())) == 1
    assert list(config_dir().rglob(".texlab-*")) == []


def test_nothing_is_forgotten_when_the_session_cannot_be_written(
    autosave: Autosave, monkeypatch: pytest.MonkeyPatch
) -> None:
    write(autosave, state(1))
    before = on_disk()

    def refuse(*_: Any) -> None:
        raise InputError("Full.")

    monkeypatch.setattr("texlab.storage.sessions.write_whole", refuse)
    write(autosave, state(2))
    (choice,) = last_exemplar(before)
    assert isinstance(choice.source, Kept)
    assert load(choice.source).name == "pasted 1"
    assert len(columns_from_json(before)[0][2]) == 1


@pytest.mark.parametrize(
    "content",
    [
        b"",
        b"PK\x03\x04",
        b"PK\x05\x06" + bytes(18),
        b"\x93NUMPY",
        b"\x93NUMPY\x01\x00v\x00{'descr': '<f4', 'fortran_order': False, 'shape': (2, 2)}" + b" " * 60 + b"\n",
        b"\x93NUMPY\x01\x00v\x00{'descr': '|O', 'fortran_order': False, 'shape': (2,), }"
        + b" " * 60
        + b"\n"
        + b"x" * 9,
        b"\x93NUMPY\x02\x00\xff\xff\xff\x7f{",
        b"\x93NUMPY\x01\x00v\x00{'descr': '<f4', 'fortran_order': False, 'shape': (999999, 999999, 3)}",
        *(pytest.param(each.read_bytes(), id=each.stem) for each in CASES),
    ],
)
@pytest.mark.parametrize("name", ["exemplar.npy", f"exemplar-{'0' * 32}.npz"])
def test_a_damaged_exemplar_is_none(texlab_home: Path, content: bytes, name: str) -> None:
    config_dir().mkdir(parents=True)
    (config_dir() / name).write_bytes(content)
    kept = kept_exemplar({"name": "x", "path": None, "kept": name})
    assert kept is not None
    with pytest.raises(InputError, match=r"^The exemplar of the last session could not be read\.$"):
        load(kept)


def test_every_byte_of_a_kept_exemplar_counts(texlab_home: Path) -> None:
    pixels = np.random.default_rng(0).random((5, 4, 3)).astype(np.float32)
    path = keep(as_exemplar(pixels, name="x"), config_dir())
    whole = path.read_bytes()
    assert np.array_equal(load(Kept(path, "x")).pixels, pixels)
    for at in range(0, len(whole), 7):
        path.write_bytes(whole[:at] + bytes([whole[at] ^ 0x55]) + whole[at + 1 :])
        try:
            back = load(Kept(path, "x"))
        except InputError:
            continue
        # What a zip file says twice may differ in one of the places.
        assert np.array_equal(back.pixels, pixels)


def test_names_from_the_settings_lead_nowhere_else(texlab_home: Path) -> None:
    config_dir().mkdir(parents=True)
    (config_dir().parent / "exemplar-x.npz").write_bytes(b"")
    for name in ("../exemplar-x.npz", "settings.json", "/etc/passwd", 7, None, "exemplar-.npz"):
        assert kept_exemplar({"name": "x", "kept": name}) is None
    assert kept_exemplar(None) is None


def test_the_exemplar_of_the_first_version_is_brought_back(texlab_home: Path) -> None:
    config_dir().mkdir(parents=True)
    pixels = np.arange(60, dtype=np.uint8).reshape(6, 10)
    np.save(config_dir() / "exemplar.npy", pixels)
    (choice,) = last_exemplar({"sample": {"name": "old", "path": None, "scale": 1.0, "crop": None}})
    assert isinstance(choice.source, Kept)
    assert np.array_equal(load(choice.source).pixels, as_exemplar(pixels).pixels)


# The log.


def test_a_log_that_cannot_be_written_is_said_and_prints_nothing(
    qapp: Any, texlab_home: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    handler, told = CrashHandler(), []
    handler.crashed.connect(told.append)
    handler.install()
    try:
        assert handler._handler is not None

        class Full(io.StringIO):
            def write(self, _: str) -> int:
                raise OSError(28, "No space left on device")

        monkeypatch.setattr(handler._handler, "_open", Full)
        sys.excepthook(ZeroDivisionError, ZeroDivisionError("by zero"), None)
    finally:
        handler.remove()
    (sentence,) = told
    assert sentence.endswith(f"the log {log_file()} cannot be written (No space left on device).")
    assert capsys.readouterr().err == ""


def test_a_missing_log_folder_is_the_same(
    qapp: Any, texlab_home: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    log_file().parent.parent.mkdir(parents=True)
    log_file().parent.write_text("a file, not a folder")
    handler, told = CrashHandler(), []
    handler.crashed.connect(told.append)
    handler.install()
    try:
        logging.getLogger("texlab").warning("Something.")
        sys.excepthook(ZeroDivisionError, ZeroDivisionError("by zero"), None)
    finally:
        handler.remove()
    assert "cannot be written (Not a directory)" in told[0]
    assert capsys.readouterr().err == ""


def test_what_can_be_written_is(qapp: Any, texlab_home: Path) -> None:
    handler, told = CrashHandler(), []
    handler.crashed.connect(told.append)
    handler.install()
    try:
        sys.excepthook(ZeroDivisionError, ZeroDivisionError("by zero"), None)
    finally:
        handler.remove()
    assert f"the details are in {log_file()}." in told[0]
    assert "ZeroDivisionError: by zero" in log_file().read_text()


def test_settings_hold_what_they_held(texlab_home: Path) -> None:
    settings = Settings()
    settings.values["deep"] = [[[{"x": [1, 2.5, None, True]}]]]
    assert settings.write(settings.values)
    assert Settings().values == settings.values
