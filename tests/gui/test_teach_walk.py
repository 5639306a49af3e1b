"""In Teach every step of the bundled lessons has its room, also with the largest words in the smallest window."""

from __future__ import annotations

import dataclasses
from typing import TYPE_CHECKING, Any

from painted_text import cut, painted, too_small
from PySide6.QtWidgets import QApplication

from tests.gui.conftest import wait_idle
from tests.gui.test_lessons import give, small_pictures, wait_ready
from tests.gui.test_teach import seen
from texlab.docks.lessons.words import StepWords
from texlab.state.intentions import GoToStep, LeaveLesson
from texlab.style.text_size import capitals_of, teach_points
from texlab.widgets.scroll_room import ScrollRoom
from texlab.window import teacher
from texlab_core.lessons.shelf import bundled

if TYPE_CHECKING:
    import pytest

    from texlab.app.explorer import Explorer
    from texlab_core.documents.lessons import Lesson

# Steps of the bundled lessons whose tabs need the most room beside the largest words, by number.
WORST = {
    "heeger-bergen": (3, 8),
    "de-bonet": (4, 5, 10, 11),
    "msg": (2,),
    "assignment-a": (4,),
    "assignment-b": (3,),
    "pyramids": (1, 8),
    "histograms": (2,),
    "shape": (1,),
}


def test_no_word_is_cut_and_no_tab_is_moved_away_where_words_are_largest(
    qtbot: Any, explorer: Explorer, monkeypatch: pytest.MonkeyPatch
) -> None:
    lessons = bundled()
    steps = [lessons[name].steps[place - 1] for name, places in WORST.items() for place in places]
    worst = small_pictures(dataclasses.replace(lessons["de-bonet"], steps=tuple(steps)))
    monkeypatch.setattr(teacher, "read", lambda *_: worst)
    window = explorer.window
    give(qtbot, explorer, "worst", own=False)
    wait_ready(qtbot, explorer)
    window.resize(1280, 720)
    window.actions_by_name["layout-teach"].trigger()
    for zoom in (1.6, 2.0):
        while window.layouts.zoom < zoom:
            window.actions_by_name["text-larger"].trigger()
        for place, step in enumerate(worst.steps):
            explorer.carrier.carry_out(GoToStep(place))
            wait_idle(qtbot, explorer)
            for _ in range(4):
                QApplication.processEvents()
            where = step.sentence, zoom
            found = painted(window)
            assert (window.width(), window.height()) == (1280, 720), where
            assert too_small(window, found) == [], where
            assert cut(window, found) == [], where
            # What is read may be longer than the room, and a code wider; all else is in sight.
            rooms = [*window.findChildren(ScrollRoom), explorer.workspace]
            moved = [room.objectName() for room in rooms if seen(room) and room.verticalScrollBar().maximum() > 0]
            assert moved == [], where
    check_a_late_answer_has_its_room_unless_the_user_has_chosen(qtbot, explorer, worst)
    check_the_window_keeps_the_size_that_it_is_given(qtbot, explorer)
    explorer.carrier.carry_out(LeaveLesson())
    wait_idle(qtbot, explorer)


def check_a_late_answer_has_its_room_unless_the_user_has_chosen(
    qtbot: Any, explorer: Explorer, lesson: Lesson
) -> None:
    window, workspace = explorer.window, explorer.workspace
    window.actions_by_name["text-usual"].trigger()
    tabs = [step.tab.name if step.tab is not None else "" for step in lesson.steps]
    explorer.carrier.carry_out(GoToStep(tabs.index("histograms")))
    wait_idle(qtbot, explorer)
    qtbot.waitUntil(workspace.isVisible)
    table = explorer.hosts["histograms"].dock.table
    # As many more lines as an answer may bring.
    table.setMinimumHeight(450)
    qtbot.waitUntil(lambda: not workspace.isVisible())
    assert window.height() == 720
    assert table.height() >= 450
    # Room does not go back and forth, and what the user asks for stays.
    table.setMinimumHeight(0)
    window.actions_by_name["tab-alone"].trigger()
    table.setMinimumHeight(450)
    for _ in range(4):
        QApplication.processEvents()
    assert workspace.isVisible()
    table.setMinimumHeight(0)


def check_the_window_keeps_the_size_that_it_is_given(qtbot: Any, explorer: Explorer) -> None:
    window = explorer.window
    # From a larger screen, too: parts that are large for a moment do not make it larger.
    for size in ((2560, 1440), (1280, 720)):
        window.resize(*size)
        points = teach_points(size[1], 1.0, capitals_of(window.font()))
        qtbot.waitUntil(lambda points=points: window.font().pointSizeF() == points)
        assert (window.width(), window.height()) == size
    window.actions_by_name["layout-explore"].trigger()
    # Elsewhere its parts say again how small it may be.
    QApplication.processEvents()
    assert window.minimumHeight() > 300


def test_an_answer_comes_into_sight_when_it_is_asked_for(qtbot: Any) -> None:
    words = StepWords()
    qtbot.addWidget(words)
    words.resize(300, 90)
    words.show()
    words.show_step(bundled()["assignment-b"].steps[2])
    qtbot.waitUntil(lambda: words.verticalScrollBar().maximum() > 0)
    words.reveal.click()
    room = words.viewport().height()
    qtbot.waitUntil(
        lambda: words.answer.visibleRegion().boundingRect().height() >= min(words.answer.height(), room)
    )
