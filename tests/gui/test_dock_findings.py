"""The findings dock: what it decides, what it shows and sends, and findings that come after the picture."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from dock_scenes import check_controls, column_of, feed, noise, scene_of, shown
from PySide6.QtCore import Qt

from texlab.columns.status import details, signs, status_parts
from texlab.docks.findings.dock import FindingsDock
from texlab.docks.findings.words import (
    attempt,
    before_and_after,
    explanation,
    heading,
    marks,
    try_it,
)
from texlab.runs.controller import Controller
from texlab.state.chosen import Column, Sample, State
from texlab.state.intentions import ChangeMethod, EditParams
from texlab.state.session import Session
from texlab.style.pictures import Mark, to_picture
from texlab_core.engine.inputs import Crop
from texlab_core.engine.registry import methods
from texlab_core.findings.finding import FINDING, LOOK_AT, Finding, Region, Remedy, Where
from texlab_core.images.exemplar import as_exemplar

BONET = methods()["de-bonet"].params
PATIENCE_MS = 30_000
CUT = (Region(31, 0, 2, 64),)


def found(
    name: str = "cuts",
    *,
    place: Any = "result",
    regions: Any = CUT,
    remedy: Remedy | None = None,
    certainty: Any = FINDING,
) -> Finding:
    return Finding(
        id=name,
        title=name.capitalize(),
        what="It jumps by 9.",
        where=Where(place, "between rows 31 and 32", regions),
        why="Pieces do not fit (De Bonet 1997, section 4.3).",
        remedy=remedy or Remedy("Halve α to 0.075.", {"alpha": 0.075}),
        certainty=certainty,
        measures=("cuts",),
    )


def column(*findings: Finding, **more: Any) -> Any:
    return replace(
        column_of(noise(48, 64), method="de-bonet", params=BONET(), title="De Bonet"),
        findings=findings,
        measures={"discriminability": -2.5, "cuts": 9.0},
        **more,
    )


# Decisions, without a widget.


def test_certain_things_and_hints_have_their_own_signs_and_counts() -> None:
    hint = found(certainty=LOOK_AT)
    assert (heading(found()), heading(hint)) == ("! Cuts", "? Cuts")
    assert explanation(found()).startswith("It jumps by 9.")
    assert "not certain" in explanation(hint)
    for word in ("Where: ", "Why: ", "What to do: "):
        assert word in explanation(found())
    assert signs((found(), hint, hint)) == ["! 1", "? 2"]
    assert signs((hint,)) == ["? 1"]
    assert signs(()) == []
    one = column(found(), hint)
    assert "! 1" in status_parts(one)
    assert status_parts(one).index("? 1") == status_parts(one).index("! 1") + 1
    assert details(one)[:2] == ["It jumps by 9.", "Look at this: It jumps by 9."]
    # While the column runs its old findings are nobody's.
    assert "! 1" not in status_parts(replace(one, status="running"))


def test_the_worst_place_is_outlined_apart() -> None:
    two = found(regions=(Region(1, 2, 3, 4), Region(5, 6, 7, 8)))
    assert marks(two) == (Mark(1, 2, 3, 4, "chosen"), Mark(5, 6, 7, 8, "candidate"))


def test_what_is_tried_is_sent_as_an_intention() -> None:
    one = column(found())
    assert attempt(one, found()) == EditParams(1, BONET(alpha=0.075), "try: cuts")
    other = found(remedy=Remedy("Try Efros-Leung.", method="efros-leung"))
    assert attempt(one, other) == ChangeMethod(1, "efros-leung")
    assert attempt(one, found(remedy=Remedy("Crop it."))) is None
    # The column has got another method meanwhile.
    assert attempt(replace(one, params=methods()["msg"].params()), found()) is None


def test_numbers_before_and_after() -> None:
    before = column(found())
    tried = try_it(before, found())
    assert tried.measures == ("discriminability", "visual-difference", "cuts")
    assert before_and_after(None, (before,)) == ""
    assert before_and_after(tried, ()) == ""
    running = replace(before, status="running", measures={})
    assert before_and_after(tried, (running,)).endswith("The numbers come when it has finished.")
    after = replace(before, measures={"discriminability": -3.5, "cuts": 4.0}, findings=(found("noise"),))
    text = before_and_after(tried, (after,))
    assert "D -2.50 → -3.50, cuts 9.0 → 4.0." in text
    assert "The finding is gone." in text
    assert "gone" not in before_and_after(tried, (replace(after, findings=(found(),)),))
    failed = replace(before, status="failed", message="It is too large.")
    assert before_and_after(tried, (failed,)).endswith("It is too large.")


# The dock, fed with plain data.


@pytest.fixture
def dock(qtbot: Any) -> Any:
    return shown(qtbot, FindingsDock())


def test_controls(dock: Any) -> None:
    check_controls(dock)


def test_clicks_choose_show_and_try(dock: Any, qtbot: Any) -> None:
    small = found("small", place="exemplar", regions=(), certainty=LOOK_AT)
    scene = scene_of(column(found(), small), exemplar=noise(32, 32, seed=4))
    feed(dock, scene)
    assert [dock.list.item(row).text() for row in range(2)] == ["! Cuts", "? Small"]
    assert np.array_equal(dock.pane.picture, to_picture(scene.columns[0].image))
    assert "It jumps by 9." in dock.text.text()
    item = dock.list.visualItemRect(dock.list.item(1)).center()
    qtbot.mouseClick(dock.list.viewport(), Qt.MouseButton.LeftButton, pos=item)
    assert dock.chosen is small
    assert np.array_equal(dock.pane.picture, to_picture(scene.exemplar.pixels))
    qtbot.keyClick(dock.list, Qt.Key.Key_Up)
    assert dock.chosen.id == "cuts"
    with qtbot.waitSignal(dock.intention) as sent:
        qtbot.mouseClick(dock.apply, Qt.MouseButton.LeftButton)
    assert sent.args == [EditParams(1, BONET(alpha=0.075), "try: cuts")]
    changed = replace(scene.columns[0], measures={"discriminability": -3.5}, findings=(small,))
    feed(dock, replace(scene, columns=(changed,)))
    assert "D -2.50 → -3.50" in dock.outcome.text()
    assert dock.outcome.isVisible()
    assert [dock.list.item(row).text() for row in range(dock.list.count())] == ["? Small"]


def test_what_was_tried_is_told_where_nothing_is_left_to_list(dock: Any, qtbot: Any) -> None:
    scene = scene_of(column(found()), exemplar=noise(32, 32, seed=4))
    feed(dock, scene)
    qtbot.mouseClick(dock.apply, Qt.MouseButton.LeftButton)
    feed(dock, replace(scene, columns=(replace(scene.columns[0], status="running", measures={}),)))
    assert dock.message.endswith("The numbers come when it has finished.")
    assert not dock.apply.isEnabled()
    better = replace(scene.columns[0], measures={"discriminability": -3.5, "cuts": 4.0}, findings=())
    feed(dock, replace(scene, columns=(better,)))
    assert "D -2.50 → -3.50, cuts 9.0 → 4.0. The finding is gone. Nothing was found" in dock.message
    assert not dock.apply.isEnabled()
    feed(dock, scene)
    assert dock.apply.isEnabled()


def test_where_nothing_can_be_set_nothing_is_offered(dock: Any) -> None:
    feed(dock, scene_of(column(found(remedy=Remedy("Crop it."))), exemplar=noise()))
    assert not dock.apply.isEnabled()


def test_what_is_chosen_stays_chosen(dock: Any) -> None:
    one, two = found("one"), found("two")
    feed(dock, scene_of(column(one, two), exemplar=noise()))
    dock.list.setCurrentRow(1)
    feed(dock, scene_of(column(found("new"), one, two), exemplar=noise()))
    assert dock.chosen.id == "two"


def test_without_findings_the_dock_says_why(dock: Any) -> None:
    assert feed(dock, scene_of(column(), exemplar=noise())) is None
    assert dock.message == "Nothing was found in the result of De Bonet."
    assert feed(dock, scene_of(replace(column(), measures={}), exemplar=noise())) is None
    assert "Nothing was found" not in dock.message
    assert dock.message == "The result of De Bonet is not examined yet."
    for unseen in ({"findings": None}, {"draft": True}):
        assert feed(dock, scene_of(replace(column(), **unseen), exemplar=noise())) is None
        assert dock.message == "The result of De Bonet is not examined yet."
    never = replace(column(), findings=None, unexamined="A solid is not examined.")
    assert feed(dock, scene_of(never, exemplar=noise())) is None
    assert dock.message == "A solid is not examined."
    assert feed(dock, scene_of(column_of(), exemplar=noise())) is None
    assert "Nothing was found" not in dock.message


# In the running program.


def test_findings_come_after_the_numbers_and_go_with_the_picture(qtbot: Any) -> None:
    session = Session()
    controller = Controller(session)
    params = methods()["tiling"].params()
    session.apply(State(None, (Column(1, "tiling", params),), 5, (128, 128), 2), "start")
    scenes: list[Any] = []
    controller.scene_changed.connect(lambda scene: scenes.append(scene.columns[0]))
    try:
        session.set_sample(Sample(as_exemplar("gallery:stochastic-gravel", crop=Crop(0, 0, 64, 64))))
        qtbot.waitUntil(lambda: bool(controller.column_scene(1).findings), timeout=PATIENCE_MS)
        names = {each.id for each in controller.column_scene(1).findings}
        assert "repetition" in names
        first = next(place for place, each in enumerate(scenes) if each.findings)
        assert scenes[first].measures
        assert any(each.measures and not each.findings for each in scenes[:first])
        session.set_size((96, 96))
        qtbot.waitUntil(lambda: not controller.column_scene(1).findings, timeout=PATIENCE_MS)
    finally:
        controller.close()
        controller.deleteLater()
