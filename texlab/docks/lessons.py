"""The list of lessons; while one is given, what belongs to its step: note, question, slider, drawing."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from PySide6.QtCore import QEvent, Qt
from PySide6.QtWidgets import (
    QComboBox,
    QGridLayout,
    QHBoxLayout,
    QPushButton,
    QScrollArea,
    QSlider,
    QSplitter,
    QTreeWidget,
    QTreeWidgetItem,
    QVBoxLayout,
    QWidget,
)

from texlab.docks.base import Question
from texlab.docks.frame import FramedDock
from texlab.docks.recent import Same
from texlab.state.intentions import EditField, GoToStep, LeaveLesson, NewLesson, OpenLesson, SaveStep
from texlab.state.lesson_scene import NO_LESSON
from texlab.widgets.picture_pane import PicturePane
from texlab.widgets.plain import Label, set_tip

if TYPE_CHECKING:
    from pathlib import Path

    from PySide6.QtGui import QResizeEvent

    from texlab.state.scene import Scene
    from texlab_core.documents.lessons import Lesson, LessonStep

SENTENCE = "A step of my own."


class LessonsDock(FramedDock):
    """Lists the lessons by chapter and paper, and shows what is said about the step that is given."""

    name = "lessons"
    title = "Lessons"
    help = "Lessons, step by step: Page Down goes on, Page Up goes back; your own session comes back afterwards."
    order = 97
    rest_ms = 0
    empty = "The lessons are being read."

    def build(self) -> None:
        """Make the list and the words."""
        self._lesson = NO_LESSON
        self._is_folded = False
        self._shown: LessonStep | None = None
        self.jump = QComboBox()
        self.jump.setMinimumContentsLength(24)
        self.jump.setSizeAdjustPolicy(QComboBox.SizeAdjustPolicy.AdjustToMinimumContentsLengthWithIcon)
        self.jump.activated.connect(lambda place: self.intention.emit(GoToStep(place)))
        self.add_control(self.jump, "jump", "Step", "Go to a step of the lesson")
        self.leave_button = self.add_button(
            "leave", "Leave", "Bring your own session back", lambda: self.intention.emit(LeaveLesson())
        )
        self.save_button = self.add_button(
            "save",
            "Save this as a step",
            "Keep exemplar, columns, tab and its settings as a step of your own lesson",
            lambda: self.intention.emit(SaveStep(SENTENCE)),
        )
        self.new_button = self.add_button(
            "new",
            "New lesson",
            "Begin a lesson of your own with what the window shows",
            lambda: self.intention.emit(NewLesson("My lesson")),
        )
        self.list = QTreeWidget()
        self.list.setObjectName("lessons-list")
        self.list.setAccessibleName("Lessons")
        self.list.setHeaderHidden(True)
        self.list.setRootIsDecorated(False)
        self.list.itemClicked.connect(self._clicked)
        self.list.itemActivated.connect(self._clicked)
        splitter = QSplitter(Qt.Orientation.Horizontal)
        splitter.addWidget(self.list)
        splitter.addWidget(self._make_words())
        splitter.setStretchFactor(1, 1)
        splitter.setSizes([300, 700])
        layout = QVBoxLayout(self.body)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.addWidget(splitter)
        self._show_words(None)
        self._drawing.setVisible(False)

    def _make_words(self) -> QWidget:
        self.pane = PicturePane("lessons-drawing", "Drawing of the step")
        self.lines = _words("lessons-lines", muted=True)
        self.note = _words("lessons-note")
        self.question_label = _words("lessons-question")
        self.answer_label = _words("lessons-answer")
        self.try_label = _words("lessons-try")
        self.reveal = QPushButton("Show the answer")
        self.reveal.setObjectName("lessons-reveal")
        self.reveal.setCheckable(True)
        self.reveal.toggled.connect(self.answer_label.setVisible)
        set_tip(self.reveal, "The answer to the question, once everybody has had a try")
        self.slider = QSlider(Qt.Orientation.Horizontal)
        self.slider.setObjectName("lessons-series")
        self.slider.setAccessibleName("Values of the step")
        self.slider.valueChanged.connect(self._slid)
        self.slider_label = Label("")
        self.slider_label.setObjectName("lessons-series-value")
        self._slider_row = QWidget()
        row = QHBoxLayout(self._slider_row)
        row.setContentsMargins(0, 0, 0, 0)
        row.addWidget(self.slider, 1)
        row.addWidget(self.slider_label)
        inner = QWidget()
        column = QVBoxLayout(inner)
        for each in (
            self._slider_row,
            self.note,
            self.question_label,
            self.reveal,
            self.answer_label,
            self.try_label,
        ):
            column.addWidget(each)
        column.addStretch(1)
        scroll = QScrollArea()
        scroll.setObjectName("lessons-words")
        scroll.setAccessibleName("Words of the step")
        scroll.setWidgetResizable(True)
        scroll.setWidget(inner)
        self._drawing = QWidget()
        beside = QVBoxLayout(self._drawing)
        beside.setContentsMargins(0, 0, 0, 0)
        beside.addWidget(self.pane, 1)
        beside.addWidget(self.lines)
        both = QWidget()
        grid = QGridLayout(both)
        grid.setContentsMargins(0, 0, 0, 0)
        grid.addWidget(scroll, 0, 0)
        grid.addWidget(self._drawing, 0, 1)
        grid.setColumnStretch(0, 2)
        grid.setColumnStretch(1, 3)
        return both

    # What there is.

    def question(self, scene: Scene) -> Question | None:
        """Read the shelf, and make a picture of the drawing."""
        folder, drawn = scene.lesson.folder, scene.lesson.drawn

        def compute(should_stop: Any) -> tuple[list[tuple[str, bool, Lesson]], tuple[str, ...]]:
            return shelf(folder)

        return Question((self.name, folder, scene.lesson.shelf, Same(drawn)), compute)

    def show_answer(self, answer: tuple[list[tuple[str, bool, Lesson]], tuple[str, ...]]) -> None:
        """Fill the list."""
        lessons, problems = answer
        self.list.clear()
        headings: dict[str, QTreeWidgetItem] = {}
        for name, own, lesson in lessons:
            heading = (
                "Your own" if own else f"Chapter {lesson.chapter}" if lesson.chapter else "Beside the chapter"
            )
            if heading not in headings:
                headings[heading] = QTreeWidgetItem([heading])
                headings[heading].setFlags(Qt.ItemFlag.ItemIsEnabled)
                self.list.addTopLevelItem(headings[heading])
            item = QTreeWidgetItem([f"{lesson.title} ({len(lesson.steps)})"])
            item.setData(0, Qt.ItemDataRole.UserRole, (name, own))
            set_tip(item, _about(lesson))
            headings[heading].addChild(item)
        for problem in problems:
            item = QTreeWidgetItem([problem])
            item.setFlags(Qt.ItemFlag.ItemIsEnabled)
            set_tip(item, problem)
            self.list.addTopLevelItem(item)
        self.list.expandAll()
        self._give_width()
        self._mark()

    def show_scene(self, scene: Scene) -> None:
        """Show what belongs to the step that is given."""
        lesson = scene.lesson
        given = lesson.lesson is not None
        self.leave_button.setEnabled(given)
        self.jump.setEnabled(given)
        if lesson is self._lesson:
            return
        if lesson.lesson is not self._lesson.lesson:
            self.jump.clear()
            steps = lesson.lesson.steps if lesson.lesson is not None else ()
            for number, step in enumerate(steps, 1):
                self.jump.addItem(f"{number}. {step.sentence}")
        self._lesson = lesson
        self._show_list()
        if given:
            self.jump.setCurrentIndex(lesson.place)
        self._mark()
        if lesson.step is not self._shown:
            self._shown = lesson.step
            self._show_words(lesson.step)
        drawn = lesson.drawn
        self._drawing.setVisible(lesson.step is not None and lesson.step.drawing is not None)
        self.pane.set_picture(None if drawn is None else drawn.sheet)
        self.lines.setText("" if drawn is None else "\n".join(drawn.lines))

    def fold_controls(self, folded: bool) -> None:
        """Leave the room to the step that is given, or show the list again."""
        super().fold_controls(folded)
        self._is_folded = folded
        self._show_list()

    def changeEvent(self, event: QEvent) -> None:
        """Follow the size of the text."""
        super().changeEvent(event)
        if event.type() == QEvent.Type.FontChange:
            self._give_width()

    def _give_width(self) -> None:
        """Let the list show its titles whole, when that leaves half of the room to the words."""
        bar = self.list.verticalScrollBar().sizeHint().width()
        wanted = self.list.sizeHintForColumn(0) + bar + 2 * self.list.frameWidth()
        self.list.setMinimumWidth(min(wanted, self.width() // 2))

    def resizeEvent(self, event: QResizeEvent) -> None:
        """Give the list its share of the room."""
        super().resizeEvent(event)
        self._give_width()

    def _show_list(self) -> None:
        self.list.setVisible(not (self._is_folded and self._lesson.lesson is not None))

    def _show_words(self, step: LessonStep | None) -> None:
        texts = ("", "", "", "") if step is None else (step.note, step.question, step.answer, step.try_this)
        if step is None:
            texts = ("Click a lesson to give it.", *texts[1:])
        note, question, answer, try_this = texts
        for label, text in (
            (self.note, note),
            (self.question_label, question),
            (self.answer_label, answer),
            (self.try_label, f"Try: {try_this}" if try_this else ""),
        ):
            label.setText(text)
            label.setVisible(bool(text))
        self.reveal.setChecked(False)
        self.answer_label.setVisible(False)
        self.reveal.setVisible(bool(answer))
        series = None if step is None else step.series
        self._slider_row.setVisible(series is not None)
        if series is not None and step is not None:
            own = step.columns[series.column].params().to_json().get(series.parameter)
            blocked = self.slider.blockSignals(True)
            self.slider.setRange(0, len(series.values) - 1)
            self.slider.setPageStep(1)
            self.slider.setValue(series.values.index(own) if own in series.values else 0)
            self.slider.blockSignals(blocked)
            self._tell_value(own)

    def _tell_value(self, value: Any) -> None:
        step = self._lesson.step
        if step is not None and step.series is not None:
            self.slider_label.setText(f"{step.series.parameter.replace('_', ' ')} {value}")

    def _mark(self) -> None:
        """Choose the lesson that is given in the list."""
        self.list.clearSelection()
        for heading in self.list.findItems("", Qt.MatchFlag.MatchContains):
            for index in range(heading.childCount()):
                item = heading.child(index)
                if item is not None and item.data(0, Qt.ItemDataRole.UserRole) == (
                    self._lesson.name,
                    self._lesson.own,
                ):
                    self.list.setCurrentItem(item)

    # What the user does.

    def _clicked(self, item: QTreeWidgetItem, _: int = 0) -> None:
        data = item.data(0, Qt.ItemDataRole.UserRole)
        if data is not None:
            self.intention.emit(OpenLesson(*data))

    def _slid(self, place: int) -> None:
        step = self._lesson.step
        if step is not None and step.series is not None:
            value = step.series.values[place]
            self._tell_value(value)
            self.intention.emit(EditField(self._lesson.column_id, step.series.parameter, value))


def shelf(folder: Path | None) -> tuple[list[tuple[str, bool, Lesson]], tuple[str, ...]]:
    """Return name, whether it is the user's own, and the lesson, for each there is; and what cannot be used."""
    from texlab_core.lessons.shelf import bundled, own

    mine, problems = ({}, ()) if folder is None else own(folder)
    found = [(name, False, lesson) for name, lesson in bundled().items()]
    return [*found, *((name, True, lesson) for name, lesson in mine.items())], problems


def _about(lesson: Lesson) -> str:
    from texlab_core.documents.lessons import PAPERS

    return "\n".join([lesson.summary, ", ".join(PAPERS[each] for each in lesson.papers)]).strip()


def _words(name: str, *, muted: bool = False) -> Label:
    label = Label("")
    label.setObjectName(name)
    label.setWordWrap(True)
    label.setTextInteractionFlags(Qt.TextInteractionFlag.TextSelectableByMouse)
    if muted:
        label.setProperty("role", "muted")
    return label
