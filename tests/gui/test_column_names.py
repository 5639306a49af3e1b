"""What columns are called, and what stays with them: names, pins, seeds, titles of what differs."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import pytest
from PySide6.QtCore import Qt

from tests.gui.conftest import ids, wait_idle
from texlab.columns.titles import titles
from texlab.state.difference import difference
from texlab.state.scene import ColumnScene
from texlab.state.session import Session
from texlab_core.engine.params import describe
from texlab_core.engine.registry import methods
from texlab_core.errors import InputError
from texlab_core.methods.de_bonet.thresholds import ThresholdTable

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from texlab.app.explorer import Explorer

LEFT = Qt.MouseButton.LeftButton


def test_a_name_is_typed_over_the_title(qtbot: Any, explorer: Explorer) -> None:
    first, second = ids(explorer)
    views = explorer.workspace.columns
    assert views[first].method_box.label == "Heeger-Bergen, iterations 2"
    assert views[second].method_box.label == "Heeger-Bergen, iterations 1"
    state = explorer.session.state
    qtbot.mouseDClick(views[first].grip, LEFT)
    field = views[first].findChild(object, "name-field")
    qtbot.keyClicks(field, "the coarse one")
    qtbot.keyClick(field, Qt.Key.Key_Return)
    qtbot.waitUntil(lambda: views[first].method_box.label == "the coarse one")
    # Alone with its method among those without a name.
    assert views[second].method_box.label == "Heeger-Bergen"
    assert difference(state, explorer.session.state).run == ()
    explorer.session.undo()
    qtbot.waitUntil(lambda: views[first].method_box.label == "Heeger-Bergen, iterations 2")
    explorer.session.select(first)
    qtbot.keyClick(explorer.window, Qt.Key.Key_F2)
    field = views[first].findChild(object, "name-field")
    qtbot.keyClicks(field, "x")
    qtbot.keyClick(field, Qt.Key.Key_Escape)
    assert explorer.session.state.column(first).name == ""


def test_a_locked_seed_is_left_alone_by_the_dice(qtbot: Any, explorer: Explorer) -> None:
    first, second = ids(explorer)
    explorer.session.select(first)
    explorer.window.actions_by_name["own-seed"].trigger()
    before = explorer.session.state
    explorer.session.set_seed(77)
    assert difference(before, explorer.session.state).run == (second,)
    wait_idle(qtbot, explorer)
    assert explorer.controller.column_scene(first).result.job.seed == 5
    assert explorer.controller.column_scene(second).result.job.seed == 77
    assert "seed 5" in explorer.workspace.columns[first].method_box.label
    qtbot.keyClick(explorer.window, Qt.Key.Key_D, Qt.KeyboardModifier.ShiftModifier)
    wait_idle(qtbot, explorer)
    own = explorer.session.state.column(first).seed
    assert explorer.controller.column_scene(first).result.job.seed == own != 5
    explorer.window.actions_by_name["own-seed"].trigger()
    assert explorer.session.state.column(first).seed is None
    wait_idle(qtbot, explorer)
    assert explorer.controller.column_scene(first).result.job.seed == 77


def test_names_pins_and_seeds_come_back(
    qtbot: Any, open_window: Callable[..., Explorer], texture: Path, explorer: Explorer
) -> None:
    first, second = ids(explorer)
    explorer.session.rename_column(first, "  one   name ")
    explorer.session.pin_column(second, True)
    explorer.session.set_column_seed(second, 9)
    wait_idle(qtbot, explorer)
    explorer.window.close()
    again = open_window(str(texture))
    two, one = again.session.state.columns
    assert (one.name, one.pinned, one.seed) == ("one name", False, None)
    assert (two.name, two.pinned, two.seed) == ("", True, 9)


def test_pinned_columns_stay_when_others_take_the_place_of_all() -> None:
    session = Session()
    params = methods()["msg"].params()
    first, second = (session.add_column("msg", params) for _ in range(2))
    session.pin_column(second, True)
    assert [each.id for each in session.state.columns] == [second, first]
    session.set_columns([("msg", params), ("msg", params)], "two")
    assert [each.pinned for each in session.state.columns] == [True, False, False]
    assert session.state.columns[0].id == second
    copy = session.duplicate_column(second)
    assert [each.id for each in session.state.columns].index(copy) == 1
    session.move_column(copy, -1)
    assert session.state.columns[0].id == second
    session.pin_column(second, False)
    session.move_column(copy, -1)
    assert session.state.columns[0].id == copy


def column(params: Any, number: int, **more: Any) -> Any:
    return ColumnScene(number, "de-bonet", "De Bonet", params, **more)


def test_titles_say_what_differs() -> None:
    make = methods()["de-bonet"].params
    table = ThresholdTable((((1, "luminance/laplacian"), 0.28),))
    one, other = make(alpha=0.2), make(alpha=0.15, thresholds=table)
    assert titles([column(one, 1)]) == ["De Bonet"]
    found = titles([column(one, 1), column(other, 2)])
    assert found == ["De Bonet, alpha .2 / k1 by law", "De Bonet, alpha .15 / k1 .28"]
    # A name goes first, and takes the column out of the family.
    assert titles([column(one, 1, name="mine"), column(other, 2)]) == ["mine", "De Bonet"]
    assert titles([column(one, 1), column(one, 2)]) == ["De Bonet (1)", "De Bonet (2)"]
    seeds = titles([column(one, 1), column(one, 2, seed=7)])
    assert seeds == ["De Bonet, shared seed", "De Bonet, seed 7"]
    spread = table.changed({(1, "red/first-0"): 0.5})
    assert titles([column(make(alpha=0.2, thresholds=spread), 1), column(one, 2)])[0] == "De Bonet, k1 .28\u2013.5"


@pytest.mark.parametrize("method", sorted(methods()))
def test_every_parameter_that_differs_is_in_the_title(method: str) -> None:
    known = methods()[method]
    plain = known.params()
    for field in describe(known.params):
        other = other_value(field, getattr(plain, field.name))
        try:
            changed = known.params.from_json({**plain.to_json(), field.name: other})
        except InputError:
            continue
        if changed == plain:
            continue
        scenes = [ColumnScene(k, method, known.title, params) for k, params in enumerate((plain, changed))]
        first, second = titles(scenes)
        assert first != second
        assert first.startswith(known.title)
        assert field.name.replace("_", " ") in second or "k1" in second


def other_value(field: Any, value: Any) -> Any:
    if isinstance(value, bool):
        return not value
    if isinstance(value, ThresholdTable):
        return [[1, "luminance/laplacian", 0.5]]
    if isinstance(value, int | float):
        return field.knob.low if value != field.knob.low else field.knob.high
    return next((choice for choice in field.choices or () if choice != value), value)
