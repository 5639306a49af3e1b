"""What the preset bar asks for: files are read and written in the background."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from PySide6.QtCore import QObject
from PySide6.QtWidgets import QFileDialog, QInputDialog

from texlab.paths import config_dir
from texlab_core.preset_store import PresetStore, bundled_presets, export_preset, file_name
from texlab_core.presets import Preset, read_preset

if TYPE_CHECKING:
    from collections.abc import Callable

    from texlab.controller import Controller
    from texlab.jobs import Task
    from texlab.session import Session
    from texlab.views.preset_bar import PresetBar
    from texlab.window import MainWindow

Listed = tuple[str, list[Preset], set[tuple[str, str]], tuple[str, ...]]


class PresetManager(QObject):
    """Keeps the preset bar of the chosen column up to date and does what it asks."""

    def __init__(self, window: MainWindow, bar: PresetBar, session: Session, controller: Controller) -> None:
        super().__init__(window)
        self._window = window
        self._bar = bar
        self._session = session
        self._controller = controller
        self._store = PresetStore(config_dir() / "presets")
        self._method = ""
        self._current: tuple[str, str] | None = None
        bar.chosen.connect(self.take)
        bar.command.connect(self._command)

    def show_method(self, method: str) -> None:
        """List the presets of a method (again only when it is another one)."""
        if method != self._method:
            self._method = method
            self._current = None
            self.refresh()

    def refresh(self) -> None:
        """Read the presets again."""
        method, store = self._method, self._store
        if not method:
            self._bar.show_presets([], set())
            return

        def work(task: Task) -> Listed:
            own = store.presets(method)
            return method, [*bundled_presets(method), *own], {each.key for each in own}, store.problems()

        self._controller.once("presets", work, self._show)

    def _show(self, listed: Listed) -> None:
        method, presets, own, problems = listed
        if method == self._method:
            self._bar.show_presets(presets, own, self._current)
        if problems:
            self._controller.problem.emit(" ".join(problems))

    def take(self, preset: Preset) -> None:
        """Give the chosen column the values of a preset."""
        column = self._session.selected_column
        if column is None or column.method != preset.method:
            return
        try:
            params = preset.params(column.params)
        except ValueError as error:
            self._controller.problem.emit(str(error))
            return
        self._current = preset.key
        self._session.set_params(column.id, params, f"preset {preset.name}")

    def import_file(self, path: str) -> None:
        """Read a preset from a file, keep it, and give it to a column of its method."""

        def work(task: Task) -> Preset:
            from pathlib import Path

            preset = read_preset(Path(path))
            self._store.save(preset, replace=False)
            return preset

        self._controller.once("presets", work, self._imported)

    def _imported(self, preset: Preset) -> None:
        for column in self._session.state.columns:
            if column.method == preset.method:
                self._session.select(column.id)
                self.take(preset)
                break
        self._controller.said.emit(f"The preset {preset.name} was imported.")
        self.refresh()

    def _command(self, name: str, preset: Preset | None) -> None:
        {
            "save": self._save,
            "rename": lambda: self._rename(preset),
            "delete": lambda: self._delete(preset),
            "export": lambda: self._export(preset),
            "import": self._ask_import,
        }[name]()

    def _ask(self, title: str, label: str, text: str, done: Callable[[str], None]) -> None:
        dialog = QInputDialog(self._window)
        dialog.setObjectName("preset-name")
        dialog.setWindowTitle(title)
        dialog.setLabelText(label)
        dialog.setTextValue(text)
        dialog.textValueSelected.connect(done)
        dialog.finished.connect(dialog.deleteLater)
        dialog.open()

    def _save(self) -> None:
        column = self._session.selected_column
        if column is None:
            return

        def save(name: str) -> None:
            exemplar = self._controller.exemplar

            def work(task: Task) -> Preset:
                preset = Preset.of(name, column.method, column.params, exemplar=exemplar)
                self._store.save(preset)
                return preset

            self._do(work, f"Saved the preset {name}.")

        self._ask("Save preset", "Name of the preset", "", save)

    def _rename(self, preset: Preset | None) -> None:
        if preset is None:
            return

        def rename(name: str) -> None:
            self._do(lambda task: self._store.rename(preset.name, name, preset.method), f"Renamed to {name}.")

        self._ask("Rename preset", "New name", preset.name, rename)

    def _delete(self, preset: Preset | None) -> None:
        if preset is None:
            return

        def work(task: Task) -> None:
            self._store.delete(preset.name, preset.method)

        self._do(work, f"Deleted the preset {preset.name}.")

    def _export(self, preset: Preset | None) -> None:
        if preset is None:
            return
        path, _ = QFileDialog.getSaveFileName(self._window, "Export preset", file_name(preset), "Presets (*.json)")
        if path:
            self._do(lambda task: export_preset(preset, path, replace=True), f"Exported to {path}.")

    def _ask_import(self) -> None:
        path, _ = QFileDialog.getOpenFileName(self._window, "Import preset", "", "Presets (*.json)")
        if path:
            self.import_file(path)

    def _do(self, work: Callable[[Task], Any], said: str) -> None:
        def done(value: Any) -> None:
            self._current = value.key if isinstance(value, Preset) else None
            self._controller.said.emit(said)
            self.refresh()

        self._controller.once("presets", work, done)
