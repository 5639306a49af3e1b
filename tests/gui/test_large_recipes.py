"""What asks for much says so and waits, from a file or as a solid; what the user asks for starts."""

from __future__ import annotations

import re
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
    from collections.abc import Callable
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
    assert re.fullmatch(r"F5 runs it: 70 x 60 needs about \d+ MB of memory( and \d+ s)?\.", scene.message)
    line = explorer.workspace.columns[chosen].line
    qtbot.waitUntil(lambda: scene.message in line.toolTip().replace("\n", " "))
    # Without figures the sentence has their line, too.
    assert line.text().startswith("F5 runs it: 70 x 60 needs about ")
    assert line.height() >= 2 * line.fontMetrics().lineSpacing()
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


def test_a_solid_that_takes_long_waits_until_it_is_asked_for(
    qtbot: Any, open_window: Callable[..., Explorer], texture: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    solid = methods()["solid"]
    inputs, params = {"exemplar": as_exemplar(str(texture))}, solid.params(iterations=1)
    small, large = (estimate.estimate_of(solid, inputs, params, (side, 8, 8)).seconds for side in (8, 12))
    assert small is not None
    assert large is not None
    monkeypatch.setattr(estimate, "LARGE_SECONDS", (small + large) / 2)
    explorer = open_window(str(texture), [("solid", params)], size=8)
    controller, session = explorer.controller, explorer.session
    column_id = session.selected_id

    def status() -> str:
        return controller.column_scene(column_id).status

    def seen() -> tuple[str, Any]:
        scene = controller.column_scene(column_id)
        return scene.status, scene.size

    assert seen() == ("finished", (8, 8, 8))
    # Larger by typing: it waits, and says what it takes.
    session.set_column_size(column_id, (12, 8, 8))
    qtbot.waitUntil(lambda: seen() == ("idle", (12, 8, 8)))
    scene = controller.column_scene(column_id)
    assert scene.result is None
    assert scene.message.startswith("F5 runs it: 8 x 8 x 12 needs about ")
    explorer.window.actions_by_name["run"].trigger()
    qtbot.waitUntil(lambda: seen() == ("finished", (12, 8, 8)))
    # As much was asked for: another seed starts, more rounds wait again.
    session.set_seed(5)
    qtbot.waitUntil(lambda: status() == "finished" and controller.column_scene(column_id).result.job.seed == 5)
    session.set_params(column_id, solid.params(iterations=2), "iterations")
    qtbot.waitUntil(lambda: status() == "idle")
    assert controller.column_scene(column_id).message.startswith("F5 runs it: ")
    # One step back there is a finished one, which takes nothing.
    session.undo()
    qtbot.waitUntil(lambda: status() == "finished")
    # What the machine cannot hold does not wait: it is refused.
    monkeypatch.setattr(estimate, "machine_bytes", lambda: 1000)
    session.set_column_size(column_id, (16, 8, 8))
    qtbot.waitUntil(lambda: status() == "failed")
    assert "of memory, and this machine has" in controller.column_scene(column_id).message
