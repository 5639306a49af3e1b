"""What a pop-out test is about: its fields, and what they come to."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from PySide6.QtCore import Signal
from PySide6.QtWidgets import QDialogButtonBox, QFormLayout, QWidget

from texlab.widgets.calm_wheel import ChoiceBox
from texlab.widgets.number_box import WholeBox
from texlab.widgets.plain import Label, set_tip
from texlab.widgets.tick_list import TickList
from texlab_core.engine.job import MAX_SEED
from texlab_core.popout.design import DEFAULT_REPEATS, MAX_REPEATS

if TYPE_CHECKING:
    from collections.abc import Sequence

    from PySide6.QtWidgets import QPushButton

SHARES = {
    "a half of the exemplar": 0.5,
    "a third of the exemplar": 1 / 3,
    "the whole exemplar, as in the paper": 1.0,
}
MAX_FEATHER = 64
# Of fields and sentences: the dialog is as large as the window.
WIDEST = 720


@dataclass(frozen=True)
class PopoutRequest:
    """What the user wants to test.

    Parameters
    ----------
    columns
        Ids of columns; none for the figures of the paper.
    repeats
        Pictures of each.
    share
        Sides of the piece over those of the exemplar.
    feather
        Width of the soft edge in pixels; 0 is hard.
    seed
        Decides seeds, places and order.
    figures
        Figs. 2 to 5 of De Bonet instead of columns.
    """

    columns: tuple[int, ...]
    repeats: int
    share: float
    feather: int
    seed: int
    figures: bool = False


class PopoutSetup(QWidget):
    """The fields of a test.

    ``asked(PopoutRequest)`` to begin, ``edited(PopoutRequest)`` when a field changes, ``table_wanted(True)`` for
    the table of all tests, ``closed()`` when nothing is wanted.
    """

    asked = Signal(object)
    edited = Signal(object)
    table_wanted = Signal(bool)
    closed = Signal()

    def __init__(self) -> None:
        super().__init__()
        self.setAccessibleName("What is tested")
        self.setMaximumWidth(WIDEST)
        form = QFormLayout(self)
        self.columns = TickList(7)
        self.columns.itemChanged.connect(self.edit)
        self.share = ChoiceBox()
        for text, value in SHARES.items():
            self.share.addItem(text, value)
        self.repeats, self.feather, self.seed = WholeBox(), WholeBox(), WholeBox()
        self.repeats.setRange(1, MAX_REPEATS)
        self.repeats.setValue(DEFAULT_REPEATS)
        self.feather.setRange(0, MAX_FEATHER)
        self.feather.setSpecialValueText("hard, as in the paper")
        self.feather.setSuffix(" px")
        self.seed.setRange(0, min(MAX_SEED, 2**31 - 1))
        rows = (
            ("Methods", self.columns, "columns", "Whose results are tested, with the columns' parameters"),
            ("Piece", self.share, "share", "How much of the original is put into each picture"),
            (
                "Edge",
                self.feather,
                "feather",
                "Over how many pixels the piece is blended in; a hard edge may show",
            ),
            ("Pictures of each", self.repeats, "repeats", "More pictures make the interval narrower"),
            ("Seed", self.seed, "seed", "Decides results, places and order; the same seed gives the same test"),
        )
        for label, widget, name, tip in rows:
            widget.setObjectName(f"popout-{name}")
            widget.setAccessibleName(label)
            set_tip(widget, tip)
            form.addRow(label, widget)
        for box in (self.repeats, self.feather, self.seed):
            box.valueChanged.connect(self.edit)
        self.share.currentIndexChanged.connect(self.edit)
        self.foreseen = Label(name="popout-foreseen", wraps=True)
        self.foreseen.setMinimumHeight(3 * self.fontMetrics().lineSpacing())
        form.addRow(self.foreseen)
        buttons = QDialogButtonBox()
        self.start_button = action_button(buttons, "Make the pictures", "popout-start")
        self.start_button.clicked.connect(lambda _=False: self.asked.emit(self.request()))
        self.figures_button = action_button(buttons, "Figures 2 to 5 of De Bonet", "popout-figures")
        set_tip(self.figures_button, "Four ready-made pictures: repetition, pixels, bands, and De Bonet's own")
        self.figures_button.clicked.connect(lambda _=False: self.asked.emit(self.request(figures=True)))
        self.all_button = action_button(buttons, "Export all tests ...", "popout-export-all")
        set_tip(self.all_button, "Write every test that was kept as one table, CSV")
        self.all_button.clicked.connect(lambda _=False: self.table_wanted.emit(True))
        close = action_button(buttons, "Close", "popout-close")
        close.clicked.connect(lambda _=False: self.closed.emit())
        form.addRow(buttons)

    def set_columns(self, columns: Sequence[tuple[int, str]], seed: int) -> None:
        """Offer columns by id and title, all ticked, and a seed."""
        self.columns.offer(columns, [column_id for column_id, _ in columns])
        self.seed.setValue(seed)
        self.edit()

    def request(self, *, figures: bool = False) -> PopoutRequest:
        """Return what the fields say."""
        return PopoutRequest(
            columns=self.columns.ticked,
            repeats=self.repeats.value(),
            share=float(self.share.currentData()),
            feather=self.feather.value(),
            seed=self.seed.value(),
            figures=figures,
        )

    def edit(self) -> None:
        """Tell what the fields say."""
        self.edited.emit(self.request())

    def show_foreseen(self, sentence: str, *, sound: bool) -> None:
        """Say what the test will be, or why it cannot be."""
        self.foreseen.setText(sentence)
        self.start_button.setEnabled(sound)


def action_button(box: QDialogButtonBox, text: str, name: str) -> QPushButton:
    """Add a button that the Enter key does not press."""
    button = box.addButton(text, QDialogButtonBox.ButtonRole.ActionRole)
    button.setObjectName(name)
    button.setAutoDefault(False)
    return button
