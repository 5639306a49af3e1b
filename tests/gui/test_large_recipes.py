"""A file from outside that asks for much says so and waits; what the user asks for starts."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from texlab_core.documents.record import save_result
from texlab_core.engine import estimate
from texlab_core.engine.job import Job
from texlab_core.engine.registry import methods
from texlab_core.engine.run import run
from texlab_core.images.exemplar import as_exemplar

if TYPE_CHECKING:
    from pathlib import Path

    from texlab.app.explorer import Explorer


@pytest.fixture
def recipe(tmp_path: Path) -> Path:
    exemplar = as_exemplar(np.random.default_rng(0).random((24, 24, 3), np.float32))
    params = methods()["heeger-bergen"].params.from_json({"scales": 2, "iterations": 1})
    path = tmp_path / "large.png"
    save_result(
        run(Job(method="heeger-bergen", inputs={"exemplar": exemplar}, params=params, size=(60, 70))), path
    )
    return path


def test_a_large_recipe_waits_for_the_user(
    qtbot: Any, explorer: Explorer, recipe: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(estimate, "LARGE_SAMPLES", 50 * 50)
    controller = explorer.controller
    explorer.opener.open(str(recipe))
    qtbot.waitUntil(lambda: explorer.session.state.size == (60, 70) and explorer.idle)
    chosen = explorer.session.selected_id
    qtbot.waitUntil(lambda: controller.column_scene(chosen).status == "idle")
    scene = controller.column_scene(chosen)
    assert scene.result is None
    assert scene.message.startswith("70 x 60 needs about ")
    assert scene.message.endswith("F5 runs it.")
    qtbot.waitUntil(lambda: "F5 runs it." in explorer.workspace.columns[chosen].line.toolTip().replace("\n", " "))
    explorer.window.actions_by_name["run"].trigger()
    qtbot.waitUntil(lambda: controller.column_scene(chosen).status == "finished")
    assert controller.column_scene(chosen).result.image.shape == (60, 70, 3)


def test_an_ordinary_recipe_starts_by_itself(qtbot: Any, explorer: Explorer, recipe: Path) -> None:
    explorer.opener.open(str(recipe))
    chosen = explorer.session.selected_id
    qtbot.waitUntil(
        lambda: (
            explorer.session.state.size == (60, 70)
            and explorer.idle
            and explorer.controller.column_scene(chosen).status == "finished"
        )
    )
