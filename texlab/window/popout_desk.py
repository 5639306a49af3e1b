"""Pop-out tests from the window: pictures are made in a thread, and every answer is kept as soon as it comes."""

from __future__ import annotations

import datetime
import secrets
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from PySide6.QtWidgets import QFileDialog

from texlab.runs.worker import Worker
from texlab.storage.paths import config_dir
from texlab.window.export_desk import column_titles
from texlab.window.popout_dialog import PopoutDialog
from texlab_core.errors import InputError
from texlab_core.popout.design import Design, Setting, figures, usual_size
from texlab_core.popout.store import FOLDER, PopoutStore

if TYPE_CHECKING:
    from texlab.runs.controller import Controller
    from texlab.runs.worker import Task
    from texlab.storage.settings import Settings
    from texlab.window.main_window import MainWindow
    from texlab.window.popout_setup import PopoutRequest
    from texlab_core.engine.inputs import ImageInput
    from texlab_core.popout.making import Made
    from texlab_core.popout.record import Record
    from texlab_core.popout.scoring import Answer

# A method ends at its next step.
PATIENCE_S = 30.0
MOST_SEED = 2**31 - 1


class PopoutDesk:
    """Opens the dialog (made when it is first wanted), makes the pictures, keeps the answers."""

    def __init__(self, window: MainWindow, settings: Settings, controller: Controller) -> None:
        self._window = window
        self._settings = settings
        self._controller = controller
        self.store = PopoutStore(config_dir() / FOLDER)
        self.dialog: PopoutDialog | None = None
        self.record: Record | None = None
        self._name = ""
        controller.exemplar_ready.connect(self._look_again)
        self._maker = Worker("popout", parent=window)
        self._maker.finished.connect(self._give)
        # One thread writes every answer in turn; a newer record holds all that an older one does.
        self._keeper = Worker("popout-answers", parent=window)
        self._keeper.failed.connect(self._not_kept)

    @property
    def busy(self) -> bool:
        """Whether pictures are made or answers are written."""
        return self._maker.busy or self._keeper.busy

    def open(self) -> None:
        """Show the dialog over the whole window, with the columns that there are now."""
        if self.dialog is None:
            dialog = self.dialog = PopoutDialog(self._window)
            dialog.edited.connect(self._foresee)
            dialog.asked.connect(self._make)
            dialog.stopped.connect(self._maker.cancel)
            self._maker.progressed.connect(dialog.show_progress)
            self._maker.failed.connect(lambda sentence: dialog.show_setup(sentence))
            self._maker.cancelled.connect(partial(dialog.show_setup, "Stopped."))
            dialog.answered.connect(self._keep)
            dialog.over.connect(self._end)
            dialog.table_wanted.connect(self._ask_table)
            dialog.set_theme(self._window.themes.theme)
            self._window.themes.changed.connect(dialog.set_theme)
        dialog = self.dialog
        if dialog.resting:
            named = enumerate(column_titles(self._controller).items(), 1)
            columns = [(column_id, f"{place}. {title}") for place, (column_id, title) in named]
            dialog.setup.set_columns(columns, secrets.randbelow(MOST_SEED + 1))
            dialog.show_setup()
        # Results and exemplar below it would help.
        dialog.setGeometry(self._window.geometry())
        dialog.show()
        dialog.raise_()

    def close(self) -> None:
        """Stop what is made, and wait until every answer is written."""
        if self.dialog is not None:
            self.dialog.close()
        self._maker.close(PATIENCE_S)
        # The last answer is worth waiting for.
        self._keeper.finish(PATIENCE_S)

    def design(self, asked: PopoutRequest) -> Design:
        """Return the test that a request stands for; raises ``InputError`` when it cannot be."""
        if asked.figures:
            return figures(asked.seed)
        exemplar: ImageInput | None = self._controller.exemplar
        if exemplar is None:
            raise InputError("The exemplar is still being read.")
        columns = [each for each in self._controller.session.state.columns if each.id in asked.columns]
        if not columns:
            raise InputError("Choose at least one method.")
        settings = [Setting(method=each.method, params=each.params, name=each.name) for each in columns]
        return Design(
            exemplar=exemplar,
            settings=tuple(settings),
            repeats=asked.repeats,
            size=usual_size(exemplar, asked.share),
            share=asked.share,
            feather=asked.feather,
            seed=asked.seed,
        )

    def _foresee(self, asked: PopoutRequest) -> None:
        assert self.dialog is not None
        try:
            design = self.design(asked)
        except InputError as error:
            self.dialog.setup.show_foreseen(str(error), sound=False)
            return
        (height, width), (rows, columns) = design.size, design.piece
        count = design.repeats * len(design.settings)
        self.dialog.setup.show_foreseen(
            f"{count} {'picture' if count == 1 else 'pictures'} of {width} x {height} pixels with a piece of"
            f" {columns} x {rows}, in an order that the seed draws. A click in the middle is right in"
            f" {design.chance:.0%}: that is guessing.",
            sound=True,
        )

    def _look_again(self, _: object) -> None:
        """Say what a test of the exemplar that has come would be, where its fields are shown."""
        if self.dialog is not None and self.dialog.isVisible() and self.dialog.resting:
            self.dialog.setup.edit()

    def _make(self, asked: PopoutRequest) -> None:
        dialog = self.dialog
        assert dialog is not None
        try:
            design = self.design(asked)
        except InputError as error:
            dialog.setup.show_foreseen(str(error), sound=False)
            return
        dialog.show_making()
        self._maker.submit(partial(make_pictures, design))

    def _give(self, made: Made) -> None:
        assert self.dialog is not None
        self.record = made.record
        self._name = self.store.new_name(datetime.datetime.now())
        self.dialog.show_test(made)

    def _keep(self, answer: Answer) -> None:
        assert self.record is not None
        assert self.dialog is not None
        self.record = record = self.record.answered(answer)
        name, store = self._name, self.store
        self._keeper.submit(lambda _: store.save(name, record), patient=True)

    def _not_kept(self, sentence: str) -> None:
        if self.dialog is not None:
            self.dialog.say(f"The answers could not be kept: {sentence} Export them as CSV before closing.")

    def _end(self) -> None:
        dialog, record = self.dialog, self.record
        assert dialog is not None
        if record is None or not record.answers:
            dialog.show_setup("Left before the first answer; nothing was kept.")
            return
        dialog.show_scores(record)

    def _ask_table(self, everything: bool) -> None:
        folder = self._settings.text("save-folder")
        start = str(Path(folder) / ("popout-tests.csv" if everything else f"popout-{self._name}.csv"))
        path, _ = QFileDialog.getSaveFileName(self.dialog, "Export CSV", start, "Tables (*.csv)")
        if path:
            self._settings.values["save-folder"] = str(Path(path).parent)
            self.write_table(path, everything=everything)

    def write_table(self, path: str, *, everything: bool) -> None:
        """Write the table of this test, or of all that were kept, in the background."""
        record, name, store = self.record, self._name, self.store

        def work(task: Task) -> str:
            from texlab_core.files.whole import check_target, write_whole
            from texlab_core.popout.record import table_of

            kept = store.all() if everything else None
            records = kept.records if kept is not None else ((name, record),) if record is not None else ()
            write_whole(check_target(path), table_of(records).encode())
            left = 0 if kept is None else len(kept.problems)
            rest = f"; {left} could not be read" if left else ""
            return f"Written: {path}, {len(records)} {'test' if len(records) == 1 else 'tests'}{rest}."

        self._controller.once("popout-table", work, self._told)

    def _told(self, sentence: str) -> None:
        dialog = self.dialog
        if dialog is None:
            return
        dialog.say(sentence)
        if dialog.pages.currentWidget() is dialog.fields:
            dialog.setup.foreseen.setText(sentence)


def make_pictures(design: Design, task: Task) -> Made:
    """Make the pictures of a test in a worker's thread."""
    from texlab_core.popout.making import make

    def tell(share: float) -> None:
        if task.due():
            task.progress(share)

    return make(design, on_progress=tell, should_stop=task.should_stop)
