"""A pointer that moves costs the window next to nothing: what it does not change is not made again."""

from __future__ import annotations

from collections import Counter
from typing import TYPE_CHECKING, Any

import pytest
from PySide6.QtCore import QPoint
from PySide6.QtTest import QTest

from tests.gui.conftest import ids, wait_idle
from texlab.columns import foot, workspace
from texlab.columns.column import ColumnView
from texlab.docks.bands.pyramid import PyramidDock
from texlab.form.form import ParameterForm
from texlab.state.scene import ColumnScene, Probe, Scene, same_but_probe
from texlab_core.engine.registry import methods

if TYPE_CHECKING:
    from collections.abc import Callable

    from texlab.app.explorer import Explorer


@pytest.fixture
def calls(monkeypatch: pytest.MonkeyPatch) -> Counter[str]:
    """How often the parts of the window make what they show."""
    counted: Counter[str] = Counter()

    def count(owner: Any, name: str) -> None:
        real: Callable[..., Any] = getattr(owner, name)

        def counting(*args: Any, **options: Any) -> Any:
            counted[name] += 1
            return real(*args, **options)

        monkeypatch.setattr(owner, name, counting)

    for owner, name in (
        (foot, "details"),
        (foot, "figures"),
        (workspace, "titles"),
        (PyramidDock, "question"),
        (ParameterForm, "set_context"),
        (ColumnView, "show_title"),
    ):
        count(owner, name)
    return counted


def test_the_pointer_makes_nothing_but_what_it_changes(
    qtbot: Any, explorer: Explorer, calls: Counter[str]
) -> None:
    explorer.window.show_dock("pyramid")
    wait_idle(qtbot, explorer)
    calls.clear()
    pane = explorer.workspace.columns[ids(explorer)[0]].pane
    middle = QPoint(pane.width() // 2, pane.height() // 2)
    for step in range(5):
        with qtbot.waitSignal(explorer.presenter.painted):
            QTest.mouseMove(pane.viewport(), middle + QPoint(9 * step, 0))
    assert explorer.controller.pointing.probe is not None
    assert not calls
    # Another column is told to everybody.
    explorer.session.select(ids(explorer)[1])
    wait_idle(qtbot, explorer)
    assert calls["question"] > 0
    assert calls["set_context"] > 0


def test_scenes_that_differ_in_more_than_the_pixel_are_told_apart() -> None:
    method = methods()["msg"]
    column = ColumnScene(1, method.id, method.title, method.params())
    other = ColumnScene(1, method.id, method.title, method.params())
    one = Scene(columns=(column,), selected_id=1)
    assert same_but_probe(one, Scene(columns=(column,), selected_id=1, probe=Probe(1, 2, 3)))
    for different in (
        Scene(columns=(other,), selected_id=1),
        Scene(columns=(), selected_id=1),
        Scene(columns=(column,), selected_id=0),
        Scene(columns=(column,), selected_id=1, seed=2),
        Scene(columns=(column,), selected_id=1, points=(object(),)),  # type: ignore[arg-type]
    ):
        assert not same_but_probe(one, different)
