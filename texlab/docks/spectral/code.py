"""Code: the 69 numbers of MSG as a table that can be edited while the texture follows."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from PySide6.QtCore import QSignalBlocker, Qt
from PySide6.QtWidgets import (
    QFileDialog,
    QFrame,
    QHBoxLayout,
    QScrollArea,
    QVBoxLayout,
    QWidget,
)

from texlab.docks.base import Question
from texlab.docks.frame import FramedDock
from texlab.docks.recent import Recent, Same
from texlab.docks.spectral.code_answer import CodeAnswer, edit_code, encoded, given_code
from texlab.docks.spectral.code_numbers import (
    COLUMNS,
    SIZES,
    Group,
    Number,
    differs,
    dragged,
    limits,
    title,
    unit,
    value,
    values,
    with_value,
)
from texlab.docks.spectral.code_views import CodeGrid, HistogramBars
from texlab.docks.spectral.code_words import (
    ANGLE_NAMES,
    HEADINGS,
    HINT,
    OCTAVE_NAMES,
    RADIAL,
    RESIDUAL_NAMES,
    TIPS,
    short,
)
from texlab.state.intentions import AskOnce, EditInputs, Open, Tell
from texlab.style.colouring import SEQUENTIAL_TABLE
from texlab.style.numbers import number as digits
from texlab.widgets.number_box import NumberBox
from texlab.widgets.plain import Label, set_tip
from texlab_core.transforms.gabor_bank import WIDTHS

if TYPE_CHECKING:
    from collections.abc import Callable

    from texlab.state.scene import Scene
    from texlab_core.engine.inputs import DataInput
    from texlab_core.methods.spectral.choices import BandwidthAxes, BandwidthMeasure
    from texlab_core.methods.spectral.code import MsgCode

EDITED = "edited code"
FILES = "MSG codes (*.msg.json);;JSON (*.json);;All files (*)"


class CodeDock(FramedDock):
    """Shows and edits the code of an MSG column."""

    name = "code"
    title = "Code"
    help = "The numbers of MSG, 69 for gray: drag or type them and the texture follows; save and open them."
    order = 34
    # A number of the code is the column's.
    no_settings = frozenset({"value"})
    empty = "The code appears as soon as there is an exemplar."

    def build(self) -> None:
        """Make the controls and the groups of numbers."""
        self._recent = Recent(4)
        self._looks: dict[Group, tuple[bytes, bytes, Number]] = {}
        self._column_id = 0
        self._code: MsgCode | None = None
        self._measured: MsgCode | None = None
        self._key = ""
        self._name = ""
        self._exemplar_name = ""
        # The code at the beginning of a drag; what is dragged is counted from there.
        self._pressed: MsgCode | None = None
        self._sent: DataInput | None = None
        self._chosen = Number("energy", 0)
        self.box = NumberBox()
        self.box.setDecimals(3)
        self.box.setStepType(NumberBox.StepType.AdaptiveDecimalStepType)
        self.box.valueChanged.connect(self._box_changed)
        self.add_control(self.box, "value", "The chosen number", "The number chosen below: type it")
        tip = "Synthesize from the numbers measured on the exemplar again"
        self.back = self.add_button("back", "Back to the exemplar", tip, self._back)
        self.open_button = self.add_button("open", "Open ...", "Open a code (*.msg.json)", self._ask_open)
        tip = "Save these numbers as a file from which any amount of the texture can be made"
        self.save_button = self.add_button("save", "Save ...", tip, self._ask_save)
        self.state = Label("")
        self.add_control(self.state, "state", "What the column is made from", "What the column is made from")
        self.readout = self.add_readout()
        self._headings: dict[Group, Label] = {}
        self.grids: dict[Group, CodeGrid] = {}
        inside = QWidget()
        row = QHBoxLayout(inside)
        row.setContentsMargins(0, 0, 0, 0)
        row.setSpacing(8)
        shares: dict[Group, int] = {"energy": 5, "u": 4, "v": 3, "residual": 3}
        for group, stretch in shares.items():
            self.grids[group] = grid = CodeGrid(f"code-{group}", HEADINGS[group])
            self._connect(group, grid)
            row.addWidget(self._headed(group, grid), stretch)
        self.bars = HistogramBars("code-histogram", HEADINGS["histogram"])
        self._connect("histogram", self.bars)
        row.addWidget(self._headed("histogram", self.bars), 5)
        area = QScrollArea()
        area.setObjectName("code-area")
        area.setAccessibleName("Tables of the code")
        area.setWidgetResizable(True)
        area.setFrameShape(QFrame.Shape.NoFrame)
        area.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        area.setWidget(inside)
        layout = QVBoxLayout(self.body)
        layout.setContentsMargins(6, 0, 6, 4)
        layout.addWidget(area)
        self._area = area

    def least_height(self, width: int) -> int:
        """Return the height below which tables are scrolled down."""
        inner = self._area.widget()
        more = 0 if inner is None else inner.minimumSizeHint().height() - self._area.minimumSizeHint().height()
        return super().least_height(width) + max(0, more)

    def _headed(self, group: Group, view: QWidget) -> QWidget:
        set_tip(view, f"{TIPS[group]}\n{HINT}")
        part = QWidget()
        column = QVBoxLayout(part)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(1)
        self._headings[group] = heading = Label(HEADINGS[group])
        set_tip(heading, TIPS[group])
        column.addWidget(heading)
        column.addWidget(view, 1)
        return part

    def _connect(self, group: Group, view: CodeGrid | HistogramBars) -> None:
        if isinstance(view, CodeGrid):
            columns = COLUMNS[group]
            view.chosen.connect(lambda row, column: self._choose(Number(group, row * columns + column)))
            view.hovered.connect(
                lambda row, column: self._hover(Number(group, row * columns + column) if row >= 0 else None)
            )
            view.dragged.connect(lambda place, steps: self._drag(Number(group, place), steps))
        else:
            view.chosen.connect(lambda place: self._choose(Number(group, place)))
            view.hovered.connect(lambda place: self._hover(Number(group, place) if place >= 0 else None))
            view.dragged.connect(self._draw)
        view.dropped.connect(self._drop)
        view.nudged.connect(lambda place, steps: self._nudge(Number(group, place), steps))
        view.emptied.connect(lambda place: self._set(Number(group, place), 0.0))
        view.typed.connect(lambda place, text: self._begin(Number(group, place), text))

    # Asking.

    def question(self, scene: Scene) -> Question | None:
        """Ask for the code of the chosen column, and for what its result reaches."""
        self.why = ""
        column = scene.selected
        usable = scene.exemplar is not None and column is not None and column.method == "msg"
        for control in (self.box, self.save_button):
            control.setEnabled(usable)
        self.back.setEnabled(usable and column is not None and given_code(column) is not None)
        if scene.exemplar is None or column is None or not usable:
            self.state.setText("")
            if scene.exemplar is not None:
                self.why = "Only MSG works from a code: choose a column of MSG, or open a code."
            return None
        given = given_code(column)
        self._key = "" if given is None else given.sha256
        self._exemplar_name = scene.exemplar.name
        exemplar, image = scene.exemplar.pixels, self.looked_at(scene)
        gray = getattr(column.params, "colours", "keep") == "gray"
        measure: BandwidthMeasure = getattr(column.params, "bandwidths", "participation")
        axes: BandwidthAxes = getattr(column.params, "bandwidth_axes", "uv")
        column_id, recent = column.id, self._recent

        def compute(should_stop: Callable[[], bool]) -> CodeAnswer:
            from texlab_core.methods.spectral.codefile import code_from_json
            from texlab_core.methods.spectral.encoding import gray_of

            seen = gray_of(exemplar) if gray else exemplar
            key = (Same(exemplar), measure, axes, gray)
            measured = recent.get(key, lambda: encoded(seen, measure, axes))
            code = measured if given is None else code_from_json(given.data).code
            pixels = image.values()
            reached = None if pixels is None else values(encoded(pixels, measure), "energy")
            name = "" if given is None else given.name
            return CodeAnswer(column_id, code, measured, "" if given is None else given.sha256, name, reached)

        return Question((self.name, Same(exemplar), measure, axes, column_id, self._key, image.key), compute)

    # Showing.

    def show_answer(self, answer: CodeAnswer) -> None:
        """Show the numbers, unless they were edited since."""
        other = answer.column_id != self._column_id
        if other:
            self._pressed = None
        self._column_id = answer.column_id
        self._measured = answer.measured
        if other or (self._pressed is None and answer.key == self._key):
            self._code, self._name = answer.code, answer.name
            self._key = answer.key
        self._show_code()

    def _show_code(self) -> None:
        code = self._code
        if code is None:
            return
        for group, grid in self.grids.items():
            self._show_group(grid, group, code)
        for group, words in (RADIAL if code.axes == "radial" else HEADINGS).items():
            self._headings[group].setText(words)
        same_kind = self._measured is not None and self._measured.tone.histogram.kind == code.tone.histogram.kind
        measured = values(self._measured, "histogram") if self._measured is not None and same_kind else None
        self.bars.show_bars(values(code, "histogram"), measured)
        self._show_number()
        self._show_state(code)

    def _show_group(self, grid: CodeGrid, group: Group, code: MsgCode) -> None:
        found = values(code, group)
        changed = differs(code, self._measured, group)
        looks = (found.tobytes(), changed.tobytes(), self._chosen)
        # While one group is dragged, the others need not be painted again.
        if self._looks.get(group) == looks:
            return
        self._looks[group] = looks
        columns = COLUMNS[group]
        shape = (SIZES[group] // columns, columns)
        top = 75.0 if group in ("u", "v") else float(found.max()) or 1.0
        places = np.clip(found / top, 0, 1)
        if group == "residual":
            # Gray levels and moduli have no common scale.
            places = np.concatenate([[found[0] / 255], 0.9 * found[1:] / max(float(found[1:].max()), 1e-9)])
        texts = [[short(each, group) for each in row] for row in found.reshape(shape).tolist()]
        # The rows of v are those of u, beside it.
        rows = {"residual": RESIDUAL_NAMES, "v": [""] * len(OCTAVE_NAMES)}.get(group, OCTAVE_NAMES)
        names = [""] if group == "residual" else ANGLE_NAMES
        if group in ("u", "v"):
            names = [name.rstrip("°") for name in names]
        grid.show_cells(places.reshape(shape), texts, rows, names, SEQUENTIAL_TABLE)
        grid.mark_changed(changed.reshape(shape))
        if self._chosen.group == group:
            grid.select(divmod(self._chosen.place, columns))

    def _show_state(self, code: MsgCode) -> None:
        count = code.parameters
        edited = bool(self._key)
        if not edited:
            text = f"{count} numbers of the exemplar"
        elif self._name == EDITED:
            text = f"{count} edited numbers, not the exemplar's"
        else:
            text = f"{count} numbers of {self._name}, not the exemplar's"
        self.state.setText(text)
        role = "warning" if edited else "muted"
        if self.state.property("role") != role:
            self.state.setProperty("role", role)
            self.state.style().unpolish(self.state)
            self.state.style().polish(self.state)

    def _show_number(self) -> None:
        code, number = self._code, self._chosen
        if code is None:
            return
        low, high = limits(code, number)
        with QSignalBlocker(self.box):
            # Each of these has the line of controls arranged anew.
            if (self.box.minimum(), self.box.maximum()) != (round(low, 3), round(high, 3)):
                self.box.setRange(low, high)
            if (prefix := f"{title(number)}: ") != self.box.prefix():
                self.box.setPrefix(prefix)
                self.box.setSuffix(f" {unit(number)}".rstrip())
            self.box.setValue(value(code, number))

    def _choose(self, number: Number) -> None:
        self._chosen = number
        for group, grid in self.grids.items():
            if group != number.group:
                grid.select(None)
        if number.group != "histogram":
            self.bars.select(-1)
        self._show_number()

    def _hover(self, number: Number | None) -> None:
        self.readout.tell(partial(self._number_words, number))

    def _number_words(self, number: Number | None) -> str:
        code, answer = self._code, self.answer
        if code is None or answer is None or number is None:
            return ""
        words = [f"{title(number)}: {digits(value(code, number))} {unit(number)}".rstrip()]
        if number.group == "energy":
            levels = float(np.sqrt(code.energies[number.place]))
            words[0] += f" (rms {digits(levels)} gray levels)"
        elif number.group in ("u", "v"):
            words[0] += f" ({digits(value(code, number) / 100 * float(WIDTHS[number.place]))} c/px)"
        if self._measured is not None and self._key:
            words.append(f"exemplar {digits(value(self._measured, number))}")
        if number.group == "energy" and answer.reached is not None:
            words.append(f"result {digits(float(answer.reached[number.place]))}")
        return ", ".join(words)

    # What the user does.

    def _drag(self, number: Number, steps: float) -> None:
        self._begin_drag()
        if self._pressed is not None:
            self._send(with_value(self._pressed, number, dragged(self._pressed, number, steps)), final=False)

    def _draw(self, drawn: dict[int, float]) -> None:
        code = self._code
        if code is None:
            return
        self._begin_drag()
        for place, wanted in drawn.items():
            code = with_value(code, Number("histogram", place), wanted)
        self._send(code, final=False)

    def _begin_drag(self) -> None:
        if self._pressed is None:
            self._pressed, self._sent = self._code, None

    def _drop(self) -> None:
        if self._pressed is None:
            return
        self._pressed = None
        sent, column_id = self._sent, self._column_id
        if sent is not None:
            self.intention.emit(edit_code(column_id, sent, final=True))

    def _nudge(self, number: Number, steps: int) -> None:
        if self._code is not None:
            self._set(number, dragged(self._code, number, steps))

    def _set(self, number: Number, wanted: float) -> None:
        if self._code is not None:
            self._send(with_value(self._code, number, wanted), final=True)

    def _begin(self, number: Number, text: str) -> None:
        """Go on typing in the box."""
        self._choose(number)
        self.box.setFocus()
        self.box.selectAll()
        if text:
            self.box.lineEdit().insert(text)

    def _box_changed(self, wanted: float) -> None:
        self._set(self._chosen, wanted)

    def _send(self, code: MsgCode, *, final: bool) -> None:
        from texlab_core.methods.spectral.codefile import code_input

        if code == self._code:
            return
        given = code_input(code, EDITED)
        self._code, self._key, self._name, self._sent = code, given.sha256, EDITED, given
        self.back.setEnabled(True)
        self._show_code()
        self.intention.emit(edit_code(self._column_id, given, final=final))

    def _back(self) -> None:
        self.intention.emit(EditInputs(self._column_id, (), "back to the exemplar"))

    def _ask_open(self) -> None:
        path, _ = QFileDialog.getOpenFileName(self, "Open code", "", FILES)
        if path:
            self.intention.emit(Open(path))

    def _ask_save(self) -> None:
        code, exemplar = self._code, self._exemplar_name
        if code is None:
            return
        stem = Path(exemplar.replace("gallery:", "").replace("/", "-")).stem
        path, _ = QFileDialog.getSaveFileName(self, "Save code", f"{stem}.msg.json", FILES)
        if path:
            self.save(code, path)

    def save(self, code: MsgCode, path: str) -> None:
        """Save a code as a file in the background."""
        exemplar = self._exemplar_name

        def write(should_stop: Callable[[], bool]) -> None:
            from texlab_core.methods.spectral.codefile import write_code

            write_code(code, path, exemplar)

        self.intention.emit(AskOnce("save-code", write, lambda _: self.intention.emit(Tell(f"Saved {path}."))))
