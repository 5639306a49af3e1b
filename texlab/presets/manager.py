"""What the preset bar asks for: files are read and written in the background."""

from __future__ import annotations

import dataclasses
from pathlib import Path
from typing import TYPE_CHECKING, Any

from PySide6.QtCore import QObject, Signal
from PySide6.QtWidgets import QFileDialog

from texlab.presets.dialog import PresetDialog
from texlab.state.chosen import State
from texlab.state.intentions import AskOnce, ChooseColumn, EditParams, Tell
from texlab.storage.paths import config_dir
from texlab_core.documents.preset_store import PresetStore, bundled_presets, export_preset, file_name
from texlab_core.documents.presets import Preset, PresetError, read_preset

if TYPE_CHECKING:
    from collections.abc import Callable

    from PySide6.QtWidgets import QWidget

    from texlab.presets.bar import PresetBar
    from texlab.state.chosen import Column
    from texlab_core.engine.inputs import ImageInput

Listed = tuple[str, list[Preset], set[tuple[str, str]], tuple[str, ...]]


class PresetManager(QObject):
    """Keeps the preset bar of the chosen column up to date and does what it asks.

    What is to happen to columns, in the background or in the window leaves as ``intention(Intention)``.
    """

    intention = Signal(object)

    def __init__(self, window: QWidget, bar: PresetBar) -> None:
        super().__init__(window)
        self._window = window
        self._bar = bar
        self._state = State()
        self._selected_id = 0
        self._exemplar: ImageInput | None = None
        self._store = PresetStore(config_dir() / "presets")
        self._method = ""
        self._current: tuple[str, str] | None = None
        self._own: list[str] = []
        self._deleted: Preset | None = None
        self._problems: tuple[str, ...] = ()
        bar.chosen.connect(self.take)
        bar.command.connect(self._command)

    def show_session(self, state: State, selected_id: int) -> None:
        """List the presets of the chosen column's method (again only when it is another one)."""
        self._state, self._selected_id = state, selected_id
        column = self._column
        method = "" if column is None else column.method
        if method != self._method:
            self._method = method
            self._current = None
            self._bar.show_presets([], set())
            self.refresh()
        else:
            self._forget_changed()

    def show_exemplar(self, exemplar: ImageInput | None) -> None:
        """Take note of the exemplar that presets are made with."""
        self._exemplar = exemplar

    @property
    def _column(self) -> Column | None:
        return self._state.column(self._selected_id)

    def _once(self, work: Callable[[], Any], done: Callable[[Any], None]) -> None:
        self.intention.emit(AskOnce("presets", lambda should_stop: work(), done))

    def _forget_changed(self) -> None:
        """Show no preset as chosen once the column's parameters are no longer those of the preset."""
        column, preset = self._column, self._bar.current
        if preset is None or column is None or preset.key != self._current:
            return
        try:
            is_same = preset.params(column.params) == column.params
        except ValueError:
            is_same = False
        if not is_same:
            self._current = None
            self._bar.forget_current()

    def refresh(self) -> None:
        """Read the presets again."""
        method, store = self._method, self._store
        if not method:
            self._bar.show_presets([], set())
            return

        def work() -> Listed:
            own = store.presets(method)
            keys = {each.key for each in own}
            # One of the user's stands for a bundled one of the same name.
            bundled = [each for each in bundled_presets(method) if each.key not in keys]
            return method, [*bundled, *own], keys, store.problems()

        self._once(work, self._show)

    def _show(self, listed: Listed) -> None:
        method, presets, own, problems = listed
        if method == self._method:
            self._own = [each.name for each in presets if each.key in own]
            self._bar.show_presets(presets, own, self._current)
        if problems and problems != self._problems:
            self.intention.emit(Tell(" ".join(problems), problem=True))
        self._problems = problems

    def take(self, preset: Preset) -> None:
        """Give the chosen column the values of a preset."""
        column = self._column
        if column is not None and column.method == preset.method:
            self._give(column, preset)

    def _give(self, column: Column, preset: Preset) -> None:
        try:
            params = preset.params(column.params)
        except ValueError as error:
            self.intention.emit(Tell(str(error), problem=True))
            self._bar.forget_current()
            return
        self._current = preset.key
        self.intention.emit(EditParams(column.id, params, f"preset {preset.name}"))

    def import_file(self, path: str) -> None:
        """Read a preset from a file, keep it, and give it to a column of its method."""
        self._import(lambda: read_preset(Path(path)))

    def import_preset(self, preset: Preset) -> None:
        """Keep a preset that was read, and give it to a column of its method."""
        self._import(lambda: preset)

    def _import(self, read: Callable[[], Preset]) -> None:
        def work() -> Preset:
            preset = read()
            self._store.save(preset, replace=False)
            return preset

        self._once(work, self._imported)

    def _imported(self, preset: Preset) -> None:
        columns = sorted(self._state.columns, key=lambda column: column.id != self._selected_id)
        column = next((each for each in columns if each.method == preset.method), None)
        if column is not None:
            self.intention.emit(ChooseColumn(column.id))
            self._give(column, preset)
        self.intention.emit(Tell(f"The preset {preset.name} was imported."))
        self.refresh()

    def _command(self, name: str, preset: Preset | None) -> None:
        {
            "save": self._save,
            "rename": lambda: self._rename(preset),
            "delete": lambda: self._delete(preset),
            "restore": self._restore,
            "export": lambda: self._export(preset),
            "import": self._ask_import,
        }[name]()

    def _ask(self, dialog: PresetDialog, done: Callable[[str, str, bool], None]) -> None:
        dialog.chosen.connect(done)
        dialog.open()

    def _save(self) -> None:
        column = self._column
        if column is None:
            return
        exemplar = self._exemplar
        current, known = self._bar.current, {each.casefold() for each in self._own}

        def save(name: str, note: str, is_partial: bool) -> None:
            def work() -> Preset:
                preset = Preset.of(name, column.method, column.params, note=note, exemplar=exemplar)
                if is_partial:
                    defaults = type(column.params)().to_json()
                    changed = {key: value for key, value in preset.parameters.items() if value != defaults[key]}
                    preset = dataclasses.replace(preset, parameters=changed)
                # The dialog has said that one is replaced, but of those only that another window has made since.
                self._store.save(preset, replace=name.casefold() in known)
                return preset

            self._do(work, f"Saved the preset {name}.")

        own = current if current is not None and current.name in self._own else None
        name, note = ("", "") if own is None else (own.name, own.note)
        self._ask(PresetDialog("Save preset", name, self._own, note=note, is_new=True, parent=self._window), save)

    def _rename(self, preset: Preset | None) -> None:
        if preset is None:
            return

        def rename(name: str, note: str, is_partial: bool) -> None:
            self._do(lambda: self._store.rename(preset.name, name, preset.method), f"Renamed to {name}.")

        dialog = PresetDialog("Rename preset", preset.name, self._own, is_new=False, parent=self._window)
        self._ask(dialog, rename)

    def _delete(self, preset: Preset | None) -> None:
        if preset is None:
            return

        def done(deleted: Preset) -> None:
            self._deleted, self._current = deleted, None
            self._bar.offer_restore(deleted.name)
            told = f"Deleted the preset {deleted.name}; the menu of presets can bring it back."
            self.intention.emit(Tell(told))
            self.refresh()

        self._once(lambda: self._store.delete(preset.name, preset.method), done)

    def _restore(self) -> None:
        preset = self._deleted
        if preset is None:
            return

        def work() -> Preset:
            self._store.save(preset)
            return preset

        def done(restored: Preset) -> None:
            self._deleted = None
            self._bar.offer_restore(None)
            self._done(restored, f"The preset {restored.name} is back.")

        self._once(work, done)

    def _export(self, preset: Preset | None) -> None:
        if preset is None:
            return

        def export(path: str) -> None:
            self._do(lambda: export_preset(preset, path, replace=True), f"Exported to {path}.")

        dialog = self._file_dialog("Export preset", export)
        dialog.setAcceptMode(QFileDialog.AcceptMode.AcceptSave)
        dialog.setDefaultSuffix("json")
        dialog.selectFile(file_name(preset))
        dialog.open()

    def _ask_import(self) -> None:
        dialog = self._file_dialog("Import preset", self.import_file)
        dialog.setFileMode(QFileDialog.FileMode.ExistingFile)
        dialog.open()

    def _file_dialog(self, title: str, done: Callable[[str], None]) -> QFileDialog:
        dialog = QFileDialog(self._window, title)
        dialog.setObjectName("preset-file-dialog")
        dialog.setNameFilter("Presets (*.json)")
        dialog.fileSelected.connect(done)
        dialog.finished.connect(dialog.deleteLater)
        return dialog

    def _do(self, work: Callable[[], Any], said: str) -> None:
        def attempt() -> Any:
            try:
                return work()
            except PresetError as error:
                return error

        def done(value: Any) -> None:
            if isinstance(value, PresetError):
                # Another window may have changed the presets: that is seen then.
                self.intention.emit(Tell(str(value), problem=True))
                self.refresh()
            else:
                self._done(value, said)

        self._once(attempt, done)

    def _done(self, value: Any, said: str) -> None:
        if isinstance(value, Preset):
            self._current = value.key
        self.intention.emit(Tell(said))
        self.refresh()
