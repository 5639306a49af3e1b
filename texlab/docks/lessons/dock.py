"""The list of lessons; while one is given, what belongs to its step: note, question, slider, drawing."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from PySide6.QtCore import QRect, QSize, Qt
from PySide6.QtWidgets import (
    QComboBox,
    QGridLayout,
    QPushButton,
    QSplitter,
    QTreeWidget,
    QTreeWidgetItem,
    QVBoxLayout,
    QWidget,
)

from texlab.docks.base import Question
from texlab.docks.frame import FramedDock
from texlab.docks.lessons.editor import LessonEditor
from texlab.docks.lessons.words import StepWords, words
from texlab.docks.recent import Same
from texlab.state.intentions import (
    ChangeLesson,
    CopyLesson,
    EditField,
    GoToStep,
    LeaveLesson,
    NewLesson,
    OpenLesson,
    SaveStep,
    UndoLesson,
)
from texlab.state.lesson_scene import NO_LESSON
from texlab.style.text_size import follow_text
from texlab.widgets.calm_wheel import ChoiceBox
from texlab.widgets.picture_pane import PicturePane
from texlab.widgets.plain import set_tip

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from PySide6.QtGui import QResizeEvent

    from texlab.state.lesson_scene import LessonScene
    from texlab.state.scene import Scene
    from texlab_core.documents.lessons import Lesson, LessonStep

SENTENCE = "A step of my own."
# Around the titles of the list, in pixels.
SLACK, ROW_MARGIN = 12, 4
FAR = 100_000
# A drawing is at least so high, as a part of the tab's width.
DRAWING = 0.2


class LessonsDock(FramedDock):
    """Lists the lessons by chapter and paper, and shows what is said about the step that is given."""

    name = "lessons"
    title = "Lessons"
    help = "Lessons, step by step: Page Down goes on, Page Up goes back; your own session comes back afterwards."
    order = 97
    rest_ms = 0
    empty = "The lessons are being read."
    # The step is the lesson's, and of one that is given a copy is edited.
    no_settings = frozenset({"jump", "edit"})

    def build(self) -> Iterator[None]:
        """Make the list and the words."""
        self._lesson = NO_LESSON
        self._is_folded = self._edits_copy = False
        self._shown: LessonStep | None = None
        self.jump = ChoiceBox()
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
        yield
        self.list = QTreeWidget()
        self.list.setObjectName("lessons-list")
        self.list.setAccessibleName("Lessons")
        self.list.setHeaderHidden(True)
        self.list.setRootIsDecorated(False)
        self.list.setWordWrap(True)
        self.list.setTextElideMode(Qt.TextElideMode.ElideNone)
        self.list.itemClicked.connect(self._clicked)
        self.list.itemActivated.connect(self._clicked)
        self.edit_button = QPushButton("Edit")
        self.edit_button.setCheckable(True)
        self.edit_button.toggled.connect(self._edit)
        tip = "Change words and order of a lesson of your own; of another one a copy becomes your own"
        self.add_control(self.edit_button, "edit", "Edit", tip)
        self.words = StepWords()
        self.words.slid.connect(self._slid)
        yield
        self.editor = LessonEditor()
        self.editor.changed.connect(lambda lesson, place: self.intention.emit(ChangeLesson(lesson, place)))
        self.editor.chosen.connect(lambda place: self.intention.emit(GoToStep(place, stay=True)))
        self.editor.undone.connect(lambda redo: self.intention.emit(UndoLesson(redo)))
        yield
        self._drawing = self._make_drawing()
        both = QWidget()
        self._grid = grid = QGridLayout(both)
        grid.setContentsMargins(0, 0, 0, 0)
        grid.addWidget(self.words, 0, 0)
        grid.addWidget(self.editor.words, 0, 0)
        grid.addWidget(self._drawing, 0, 1)
        grid.setColumnStretch(0, 2)
        grid.setColumnStretch(1, 3)
        splitter = QSplitter(Qt.Orientation.Horizontal)
        splitter.addWidget(self.list)
        splitter.addWidget(self.editor)
        splitter.addWidget(both)
        splitter.setStretchFactor(2, 1)
        splitter.setSizes([300, 300, 700])
        layout = QVBoxLayout(self.body)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.addWidget(splitter)
        # Who comes here by a key goes on with the arrow keys and Enter.
        self.setFocusProxy(self.list)
        self.words.show_step(None)
        self._drawing.setVisible(False)
        self._show_parts()
        follow_text(self.list, self._give_width)

    def _make_drawing(self) -> QWidget:
        self.pane = PicturePane("lessons-drawing", "Drawing of the step")
        self.lines = words("lessons-lines", muted=True)
        drawing = QWidget()
        beside = QVBoxLayout(drawing)
        beside.setContentsMargins(0, 0, 0, 0)
        beside.addWidget(self.pane, 1)
        beside.addWidget(self.lines)
        return drawing

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
        # The chapter first, in its order; one's own last.
        for name, own, lesson in sorted(lessons, key=lambda each: (each[1], not each[2].chapter)):
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
        super().show_scene(scene)
        lesson = scene.lesson
        given = lesson.lesson is not None
        self.leave_button.setEnabled(given)
        self.jump.setEnabled(given)
        self.edit_button.setEnabled(given)
        if lesson is self._lesson:
            return
        if lesson.lesson is not self._lesson.lesson:
            if (lesson.name, lesson.own) != (self._lesson.name, self._lesson.own):
                self._begin_editing(lesson)
            self.jump.clear()
            steps = lesson.lesson.steps if lesson.lesson is not None else ()
            for number, step in enumerate(steps, 1):
                self.jump.addItem(f"{number}. {step.sentence}")
        self._lesson = lesson
        self._show_parts()
        self.editor.show_lesson(lesson)
        if given:
            self.jump.setCurrentIndex(lesson.place)
        self._mark()
        if lesson.step is not self._shown:
            self._shown = lesson.step
            self.words.show_step(lesson.step)
        drawn = lesson.drawn
        has_drawing = lesson.step is not None and lesson.step.drawing is not None
        self._drawing.setVisible(has_drawing)
        # Nobody keeps room for what is hidden.
        self._grid.setColumnStretch(1, 3 * has_drawing)
        self._share_width()
        self.pane.set_picture(None if drawn is None else drawn.sheet)
        self.lines.setText("" if drawn is None else "\n".join(drawn.lines))

    def _begin_editing(self, lesson: LessonScene) -> None:
        """Go on with the copy that was made to be edited, and with no other lesson."""
        wanted = self._edits_copy and lesson.own
        blocked = self.edit_button.blockSignals(True)
        self.edit_button.setChecked(wanted)
        self.edit_button.blockSignals(blocked)
        self._edits_copy = False

    def least_height(self, width: int) -> int:
        """Return the height below which a question or a drawing has too little room."""
        has_drawing = not self._drawing.isHidden()
        share = 2 / 5 if has_drawing else 1.0
        words = self.words.least_height(round(share * width)) if self.words.isVisibleTo(self) else 0
        # All of the width for a drawing is worth the height of the pictures: it has the exemplar in it.
        drawing = self._drawing.minimumSizeHint().height() + round(DRAWING * width) if has_drawing else 0
        return max(super().least_height(width), words, drawing)

    def fold_controls(self, folded: bool) -> None:
        """Leave the room to the step that is given, or show the list again."""
        super().fold_controls(folded)
        self._is_folded = folded
        self._show_parts()

    def _give_width(self) -> None:
        """Let the list show its titles whole, when that leaves half of the room to the words."""
        bar = self.list.verticalScrollBar().sizeHint().width()
        wanted = self.list.sizeHintForColumn(0) + bar + 2 * self.list.frameWidth()
        self.list.setMinimumWidth(min(wanted, self.width() // 2))
        self._give_lines()

    def _give_lines(self) -> None:
        """Let titles take as many lines as they need in the width that there is."""
        metrics = self.list.fontMetrics()
        room = self.list.viewport().width() - self.list.indentation() - SLACK
        if not self.list.verticalScrollBar().isVisible():
            # It may come when titles take more lines.
            room -= self.list.verticalScrollBar().sizeHint().width()
        flags = int(Qt.TextFlag.TextWordWrap.value)
        items = self.list.findItems("", Qt.MatchFlag.MatchContains | Qt.MatchFlag.MatchRecursive)
        for item in items:
            needed = metrics.boundingRect(QRect(0, 0, max(room, 1), FAR), flags, item.text(0))
            natural = metrics.horizontalAdvance(item.text(0)) + SLACK
            item.setSizeHint(0, QSize(natural, needed.height() + ROW_MARGIN))

    def resizeEvent(self, event: QResizeEvent) -> None:
        """Give the list its share of the room."""
        super().resizeEvent(event)
        self._give_width()
        self._share_width()

    def _share_width(self) -> None:
        """Give words as much width as the drawing where they are too long for less."""
        long = self.words.least_height(round(2 / 5 * self.width())) > self.height()
        self._grid.setColumnStretch(0, 3 if long else 2)

    def _show_parts(self) -> None:
        given, editing = self._lesson.lesson is not None, self.edit_button.isChecked()
        self.list.setVisible(not editing and not (self._is_folded and given))
        self.words.setVisible(not editing)
        self.editor.setVisible(editing)
        self.editor.words.setVisible(editing)

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
        top = self.list.topLevelItem(0)
        first = None if top is None else top.child(0)
        if self.list.currentItem() is None and first is not None:
            self.list.setCurrentItem(first)

    # What the user does.

    def _clicked(self, item: QTreeWidgetItem, _: int = 0) -> None:
        data = item.data(0, Qt.ItemDataRole.UserRole)
        if data is not None:
            self.intention.emit(OpenLesson(*data))

    def _slid(self, parameter: str, value: Any) -> None:
        self.intention.emit(EditField(self._lesson.column_id, parameter, value))

    def _edit(self, wanted: bool) -> None:
        """Show the fields instead of the words; of a lesson that is not the user's own, of a copy."""
        if wanted and not self._lesson.own:
            self.edit_button.setChecked(False)
            self._edits_copy = True
            self.intention.emit(CopyLesson())
            return
        self._edits_copy = False
        self._show_parts()


def shelf(folder: Path | None) -> tuple[list[tuple[str, bool, Lesson]], tuple[str, ...]]:
    """Return name, whether it is the user's own, and the lesson, for each there is; and what cannot be used."""
    from texlab_core.lessons.shelf import bundled, own

    mine, problems = ({}, ()) if folder is None else own(folder)
    found = [(name, False, lesson) for name, lesson in bundled().items()]
    return [*found, *((name, True, lesson) for name, lesson in mine.items())], problems


def _about(lesson: Lesson) -> str:
    from texlab_core.documents.lessons import PAPERS

    return "\n".join([lesson.summary, ", ".join(PAPERS[each] for each in lesson.papers)]).strip()
