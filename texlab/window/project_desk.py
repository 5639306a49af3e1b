"""Project files from the window: saving everything, and a copy for a student."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from PySide6.QtWidgets import QFileDialog

from texlab.columns.status import known_numbers
from texlab.storage.projects import SUFFIX, project_of

if TYPE_CHECKING:
    from texlab.runs.controller import Controller
    from texlab.runs.worker import Task
    from texlab.storage.settings import Settings
    from texlab.window.main_window import MainWindow


class ProjectDesk:
    """Asks where to save, and saves in the background."""

    def __init__(self, window: MainWindow, settings: Settings, controller: Controller) -> None:
        self._window = window
        self._settings = settings
        self._controller = controller

    def save(self, *, for_student: bool = False) -> None:
        """Ask for a name and save the session there."""
        title = "Save a copy for a student" if for_student else "Save project"
        folder = self._settings.text("save-folder")
        path, _ = QFileDialog.getSaveFileName(
            self._window, title, str(Path(folder) / f"project{SUFFIX}"), f"TexLab projects (*{SUFFIX})"
        )
        if not path:
            return
        target = path if path.lower().endswith(SUFFIX) else path + SUFFIX
        if target != path and Path(target).exists():
            # The dialog has not asked about this one.
            self._window.message_bar.tell(f"{target} is already there: choose it to replace it.", "problem")
            return
        self._settings.values["save-folder"] = str(Path(target).parent)
        self.save_to(target, for_student=for_student)

    def save_to(self, path: str, *, for_student: bool = False) -> None:
        """Save the session in a file."""
        session = self._controller.session
        state, selected = session.state, session.selected_id
        images, measures, histories = {}, {}, {}
        # While another exemplar is on its way, the one in use is not the one that is saved.
        exemplar = None if self._controller.preparing else self._controller.exemplar
        for column in state.columns:
            scene = self._controller.column_scene(column.id)
            if scene is not None and exemplar is not None:
                # Those of another exemplar could not be made again.
                histories[column.id] = [each for each in scene.history if each.exemplar == exemplar.sha256]
            if scene is not None and scene.result is not None and not scene.draft:
                images[column.id] = scene.result.image
                measures[column.id] = known_numbers(scene) or {}
        layout = self._settings.text("layout")

        def work(task: Task) -> str:
            from texlab_core.documents.project import save_project

            made = project_of(
                state, selected, images, layout, measures=measures, histories=histories, for_student=for_student
            )
            save_project(path, made)
            return path

        def done(saved: str) -> None:
            self._controller.said.emit(f"Saved {saved}: it needs nothing beside it.")

        self._controller.once("save-project", work, done)
