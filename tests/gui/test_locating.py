"""A saved result that lacks its exemplar asks where it is, and opens with it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from PySide6.QtWidgets import QFileDialog, QMessageBox

from tests.gui.conftest import wait_idle
from texlab_core.documents.record import save_result
from texlab_core.engine.job import Job
from texlab_core.engine.run import run
from texlab_core.images.exemplar import as_exemplar
from texlab_core.images.formats.writing import write_image

if TYPE_CHECKING:
    from pathlib import Path

    import pytest


def test_a_result_asks_where_its_exemplar_is(
    qtbot: Any, explorer: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("texlab_core.documents.recipe.MAX_USED", 100)
    monkeypatch.setattr("texlab_core.documents.embedding.MAX_EMBEDDED", 100)
    monkeypatch.setattr("texlab_core.documents.embedding.embed.__kwdefaults__", {"limit": 100, "used": 100})
    pixels = np.random.default_rng(5).integers(0, 256, (32, 32, 3), np.uint8).astype(np.float32) / np.float32(255)
    for name in ("right.png", "wrong.png"):
        write_image(tmp_path / name, pixels if name == "right.png" else 1 - pixels)
    exemplar = as_exemplar(tmp_path / "right.png")
    result = run(Job(method="heeger-bergen", inputs={"exemplar": exemplar}, size=(24, 24), seed=9))
    save_result(result, tmp_path / "result.png")

    def answer(name: str) -> None:
        path = str(tmp_path / name) if name else ""
        monkeypatch.setattr(QFileDialog, "getOpenFileName", lambda *_: (path, ""))
        explorer.opener.open(str(tmp_path / "result.png"))
        qtbot.waitUntil(lambda: explorer.window.findChild(QMessageBox, "locate-box") is not None)
        box = explorer.window.findChild(QMessageBox, "locate-box")
        assert "right.png (32 x 32 pixels" in box.text()
        box.buttons()[0].click()
        qtbot.waitUntil(lambda: explorer.window.findChild(QMessageBox, "locate-box") is None)

    before = explorer.session.state
    answer("")
    answer("wrong.png")
    bar = explorer.window.message_bar
    qtbot.waitUntil(lambda: "wrong.png is not the image of the recipe" in bar.label.text())
    assert explorer.session.state == before
    answer("right.png")
    qtbot.waitUntil(lambda: explorer.session.state.seed == 9)
    wait_idle(qtbot, explorer)
    assert explorer.session.state.sample.source.sha256 == exemplar.sha256
