"""Maps laid over the columns' pictures: which one is chosen, coloured in the background."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import QObject

from texlab.runs.worker import Worker
from texlab.style.colouring import colour_map
from texlab_core.engine.late_maps import map_titles

if TYPE_CHECKING:
    from texlab.columns.column import ColumnView
    from texlab.runs.worker import Task
    from texlab.state.scene import ColumnScene, Scene
    from texlab.style.pictures import Picture
    from texlab_core.engine.result import Result

Coloured = tuple[int, int, "Picture"]


class Overlays(QObject):
    """Keeps every column's overlay up to date with its result."""

    def __init__(self, views: dict[int, ColumnView], parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._views = views
        self._chosen: dict[int, str] = {}
        self._shown: dict[int, tuple[int, str]] = {}
        self._workers: dict[int, Worker] = {}

    def choose(self, column_id: int, name: str) -> None:
        """Lay a map over a column's picture; an empty name takes it away."""
        self._chosen[column_id] = name
        self._update(column_id)

    def show_scene(self, scene: Scene) -> None:
        """Follow the newest results."""
        present = {column.id for column in scene.columns}
        for gone in [column_id for column_id in self._workers if column_id not in present]:
            # Its answer is dropped, and nobody waits for its end.
            worker = self._workers.pop(gone)
            worker.leave()
            worker.deleteLater()
            self._chosen.pop(gone, None)
        for column in scene.columns:
            self._update(column.id)

    def close(self) -> None:
        """Stop and join the threads."""
        for worker in self._workers.values():
            worker.close()

    def _update(self, column_id: int) -> None:
        view = self._views.get(column_id)
        if view is None or view.scene is None:
            return
        name = self._chosen.get(column_id, "")
        view.show_maps(available(view.scene), name)
        result = view.scene.result
        if not name or result is None or name not in result.maps:
            if self._shown.pop(column_id, None) is not None:
                view.pane.set_overlay(None)
            return
        wanted = (id(result), name)
        if self._shown.get(column_id) != wanted:
            self._shown[column_id] = wanted
            self._worker(column_id).submit(lambda task: _colour(task, column_id, result, name))

    def _worker(self, column_id: int) -> Worker:
        if column_id not in self._workers:
            worker = self._workers[column_id] = Worker(f"overlay-{column_id}", parent=self)
            worker.finished.connect(self._coloured)
        return self._workers[column_id]

    def _coloured(self, value: Coloured) -> None:
        column_id, result_id, picture = value
        view = self._views.get(column_id)
        if view is not None and self._shown.get(column_id, (0, ""))[0] == result_id:
            view.pane.set_overlay(picture)


def available(scene: ColumnScene) -> tuple[tuple[str, str], ...]:
    """Return (name, title) of the maps that a column has."""
    maps = scene.result.maps if scene.result is not None else {}
    return map_titles(maps)


def _colour(task: Task, column_id: int, result: Result, name: str) -> Coloured:
    exemplar = result.job.inputs.get("exemplar")
    extent = getattr(exemplar, "size", None)
    return column_id, id(result), colour_map(result.maps[name].plane, extent)
