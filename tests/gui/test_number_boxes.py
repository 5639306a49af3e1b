"""Numbers are typed with either decimal sign, shown with one, and never become another number."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import pytest
from hypothesis import given
from hypothesis import strategies as st
from PySide6.QtCore import QLocale, Qt
from PySide6.QtTest import QTest

from tests.gui.conftest import make_everything
from texlab.style.numbers import parse_list, parse_number
from texlab.widgets.number_box import NumberBox, ShareBox, WholeBox

if TYPE_CHECKING:
    from collections.abc import Iterator

    from PySide6.QtWidgets import QWidget

LOCALES = ("en_US", "de_DE", "fr_FR", "ar_EG")


@pytest.fixture(params=LOCALES)
def locale(request: pytest.FixtureRequest) -> Iterator[str]:
    before = QLocale()
    QLocale.setDefault(QLocale(request.param))
    yield request.param
    QLocale.setDefault(before)


def type_into(box: QWidget, text: str) -> None:
    box.setFocus()
    box.selectAll()
    QTest.keyClick(box, Qt.Key.Key_Delete)
    QTest.keyClicks(box, text)
    QTest.keyClick(box, Qt.Key.Key_Return)


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("0.25", 0.25),
        ("0,25", 0.25),
        (",5", 0.5),
        ("-1,5e-3", -0.0015),
        ("\u22122", -2.0),
        (" 7 ", 7.0),
        ("٠٫٢٥", 0.25),
        ("1.234,5", None),
        ("1,234,5", None),
        ("1 000", None),
        ("", None),
        (".", None),
        ("nan", None),
        ("1e999", None),
        ("0x10", None),
        ("2 px", None),
    ],
)
def test_a_text_is_one_number_or_none(text: str, value: float | None) -> None:
    assert parse_number(text) == value


@given(st.floats(allow_nan=False, allow_infinity=False))
def test_what_python_writes_is_read_with_both_signs(value: float) -> None:
    assert parse_number(repr(value)) == value
    assert parse_number(repr(value).replace(".", ",")) == value


@pytest.mark.parametrize(
    ("text", "items"),
    [
        ("0.1, 0.2, 0.4", ["0.1", "0.2", "0.4"]),
        ("0,1; 0,2", ["0.1", "0.2"]),
        ("0,1 0,2", ["0.1", "0.2"]),
        ("1,2,3", ["1", "2", "3"]),
        ("0.1,0.2", ["0.1", "0.2"]),
        ("0,5", ["0.5"]),
        ("1, 2", ["1", "2"]),
        ("", []),
    ],
)
def test_lists_are_read_with_both_signs(text: str, items: list[str]) -> None:
    assert parse_list(text) == items


@pytest.mark.parametrize("typed", ["0.25", "0,25"])
def test_both_signs_are_typed_and_one_is_shown(qtbot: Any, locale: str, typed: str) -> None:
    box = NumberBox()
    qtbot.addWidget(box)
    box.setDecimals(3)
    box.setPrefix("T = ")
    box.setSuffix(" px")
    box.show()
    type_into(box, typed)
    assert box.value() == 0.25
    assert box.text() == "T = 0.250 px"


@pytest.mark.parametrize("typed", ["x", "1.2.3", "1,2,3", "9999", "-", "1e9", "2x", "1 2"])
@pytest.mark.parametrize("kind", [NumberBox, WholeBox])
def test_what_is_no_number_of_the_range_leaves_the_value(qtbot: Any, kind: type, typed: str) -> None:
    box = kind()
    qtbot.addWidget(box)
    box.setRange(0, 40)
    box.setValue(7)
    box.show()
    heard: list[float] = []
    box.valueChanged.connect(heard.append)
    type_into(box, typed)
    assert box.value() == 7
    assert heard == []
    assert box.text() in ("7", "7.00")


def test_a_whole_number_is_no_fraction(qtbot: Any, locale: str) -> None:
    box = WholeBox()
    qtbot.addWidget(box)
    box.setRange(0, 100_000)
    box.setValue(7)
    box.show()
    for typed in ("2.5", "2,5"):
        type_into(box, typed)
        assert box.value() == 7
    type_into(box, "12345")
    assert box.value() == 12345
    assert box.text() == "12345"


@pytest.mark.parametrize(
    ("typed", "value"),
    [
        ("50", 0.5),
        ("50 %", 0.5),
        ("0.5", 0.5),
        ("0,5", 0.5),
        ("×0.5", 0.5),
        ("x1", 1.0),
        ("12,5%", 0.125),
        ("1", 0.01),
    ],
)
def test_a_share_is_typed_in_percent_or_as_a_factor(qtbot: Any, locale: str, typed: str, value: float) -> None:
    box = ShareBox()
    qtbot.addWidget(box)
    box.setRange(0.01, 1.0)
    box.setValue(0.25)
    box.show()
    type_into(box, typed)
    assert box.value() == value
    assert box.text() == f"{100 * value:g} %"
    for wrong in ("0.5 %", "200", "x2", "half", ""):
        type_into(box, wrong)
        assert box.value() == value, wrong


def test_every_number_box_of_the_window_reads_both_signs(qtbot: Any, open_window: Any, texture: Any) -> None:
    explorer = open_window(str(texture), columns=None, wait=False)
    window = explorer.window
    qtbot.waitUntil(lambda: explorer.idle)
    make_everything(explorer)
    boxes = [box for box in window.findChildren(NumberBox) if box.objectName()]
    names = {box.objectName() for box in boxes}
    assert {"scale-box"} <= names
    assert len(names) >= 5
    for locale in LOCALES:
        QLocale.setDefault(QLocale(locale))
        for box in boxes:
            box.blockSignals(True)
            middle = round((box.minimum() + min(box.maximum(), box.minimum() + 2)) / 2 + 0.01, 2)
            # A share is written in percent.
            written = f"{100 * middle:.2f}" if isinstance(box, ShareBox) else f"{middle:.2f}"
            for typed in (written, written.replace(".", ",")):
                line = box.lineEdit()
                line.setText(f"{box.prefix()}{typed}{box.suffix()}")
                box.interpretText()
                assert box.value() == pytest.approx(middle, abs=10.0 ** -box.decimals()), (
                    locale,
                    box.objectName(),
                )
                assert "," not in line.text(), (locale, box.objectName())
            box.blockSignals(False)
    QLocale.setDefault(QLocale.c())


def test_whole_boxes_of_the_window_show_plain_digits(explorer: Any) -> None:
    make_everything(explorer)
    boxes = [box for box in explorer.window.findChildren(WholeBox) if box.objectName()]
    assert {"seed-box", "width-box", "height-box"} <= {box.objectName() for box in boxes}
    for box in boxes:
        assert box.locale().language() == QLocale.Language.C
        assert box.textFromValue(123456) == "123456"


@pytest.mark.parametrize(("kind", "value", "other"), [(NumberBox, 0.25, 0.5), (WholeBox, 7, 9)])
def test_a_value_that_is_shown_already_is_not_painted_again(qtbot: Any, kind: Any, value: Any, other: Any) -> None:
    painted: list[int] = []

    class Box(kind):  # type: ignore[misc]
        """Counts."""

        def paintEvent(self, event: Any) -> None:
            painted.append(1)
            super().paintEvent(event)

    box = Box()
    qtbot.addWidget(box)
    box.setSuffix(" px")
    box.setValue(value)
    box.show()
    qtbot.waitUntil(lambda: bool(painted), timeout=5000)
    QTest.qWait(0)
    painted.clear()
    for _ in range(3):
        box.setValue(value)
        QTest.qWait(0)
    assert painted == []
    box.setValue(other)
    qtbot.waitUntil(lambda: bool(painted), timeout=5000)
    assert box.value() == other
    # What was typed and not taken goes when the value is set again.
    shown = box.text()
    box.lineEdit().setText("3,,")
    box.setValue(other)
    assert box.text() == shown
