"""What the session and the running columns look like in the window."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, Signal

from texlab.state.changes import levels_words, part_words, reduced_words
from texlab.storage.projects import is_project
from texlab.style.pictures import describe_value
from texlab_core.engine.late_maps import made_map
from texlab_core.engine.registry import methods

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from texlab.columns.overlays import Overlays
    from texlab.columns.workspace import Workspace
    from texlab.docks.host import DockHost
    from texlab.presets.manager import PresetManager
    from texlab.runs.controller import Controller
    from texlab.runs.exemplar import Prepared
    from texlab.state.scene import Scene
    from texlab.storage.settings import Settings
    from texlab.style.pictures import Lit, Mark
    from texlab.style.theme import Theme
    from texlab.window.main_window import MainWindow


class Presenter(QObject):
    """Hands the session, the exemplar and the newest scene to the views.

    ``painted()`` after every scene; ``recent_chosen(path)`` when a recent file is wanted.
    """

    painted = Signal()
    recent_chosen = Signal(object)

    def __init__(
        self,
        window: MainWindow,
        workspace: Workspace,
        controller: Controller,
        settings: Settings,
        presets: PresetManager,
        overlays: Overlays,
        hosts: Sequence[DockHost],
    ) -> None:
        super().__init__(window)
        self._window = window
        self._workspace = workspace
        self._controller = controller
        self._session = controller.session
        self._settings = settings
        self._presets = presets
        self._overlays = overlays
        self._hosts = hosts
        self._shown_exemplar = ""
        # Says again what is under the pointer, which stays while pictures come and go.
        self._say_pixel: Callable[[], None] = lambda: None

    def show_session(self) -> None:
        """Follow the session: values, form, presets, what is chosen."""
        column = self._session.selected_column
        self._window.show_session(self._session)
        method = methods()[column.method] if column is not None else None
        self._window.parameters.show_column(
            self._session.selected_id, method, column.params if column is not None else None
        )
        self._presets.show_session(self._session.state, self._session.selected_id)
        self._show_choice()

    def show_exemplar(self, prepared: Prepared) -> None:
        """Show another exemplar."""
        self._workspace.exemplar.show_source(prepared.source_picture)
        self._presets.show_exemplar(prepared.exemplar)
        self._show_choice()
        self._say_pixel()

    def show_scene(self, scene: Scene) -> None:
        """Show the columns and everything about them."""
        if (prepared := self._controller.prepared) is not None:
            self._workspace.set_extents(self._session.state.size, prepared.source_scaled.size)
        self._workspace.show_scene(scene)
        self._window.parameters.show_scene(scene.selected)
        self._overlays.show_scene(scene)
        for host in self._hosts:
            host.show_scene(scene)
        counts = [column.status for column in scene.columns]
        texts = [
            f"{counts.count(status)} {word}"
            for status, word in (("running", "running"), ("waiting", "waiting"), ("failed", "failed"))
            if status in counts
        ]
        self._window.status.jobs.setText(" · ".join(texts) or "ready")
        scene_chosen = scene.selected
        finished = scene_chosen is not None and scene_chosen.result is not None
        for name in ("export", "use"):
            self._window.actions_by_name[name].setEnabled(finished)
        self._say_pixel()
        self.painted.emit()

    def show_marks(self, marks: tuple[Mark, ...]) -> None:
        """Outline places in the exemplar."""
        sample = self._session.state.sample
        crop = sample.crop if sample is not None else None
        # Methods see the crop; the pane shows the whole source.
        self._workspace.exemplar.pane.set_marks(marks, (0.0, 0.0) if crop is None else (crop.top, crop.left))

    def light_up(self, places: tuple[Lit, ...]) -> None:
        """Let pixels light up in the pictures that they are of, for as long as these are shown."""
        sample, prepared = self._session.state.sample, self._controller.prepared
        crop = sample.crop if sample is not None else None
        by_column = {each.column_id: each for each in places}
        found = by_column.get(0)
        own = found is not None and prepared is not None and prepared.exemplar.pixels is found.image
        offset = (0, 0) if crop is None else (crop.top, crop.left)
        self._workspace.exemplar.pane.set_light(found.veil if own and found is not None else None, offset)
        for column_id, view in self._workspace.columns.items():
            found = by_column.get(column_id)
            own = found is not None and view.scene is not None and view.scene.image is found.image
            view.pane.set_light(found.veil if own and found is not None else None)

    def show_theme(self, theme: Theme) -> None:
        """Repaint in another theme."""
        self._workspace.set_theme(theme)
        for host in self._hosts:
            host.set_theme(theme)

    def say_exemplar_pixel(self, row: int, column: int) -> None:
        """Say what is under the pointer in the exemplar."""
        self._say_pixel = partial(self.say_exemplar_pixel, row, column)
        prepared = self._controller.prepared
        text = ""
        if prepared is not None and row >= 0:
            pixels = prepared.source_scaled.pixels
            if row < pixels.shape[0] and column < pixels.shape[1]:
                text = self._exemplar_words(describe_value(pixels, row, column), row, column)
        self._window.status.pixel.setText(text)

    def _exemplar_words(self, value: str, row: int, column: int) -> str:
        """Count from the crop's corner, as maps, tabs and files do."""
        sample = self._session.state.sample
        crop = sample.crop if sample is not None else None
        if crop is None:
            return f"exemplar {column}, {row}   {value}"
        x, y = column - crop.left, row - crop.top
        inside = 0 <= x < crop.width and 0 <= y < crop.height
        return f"{f'exemplar {x}, {y}' if inside else 'outside the crop'}   {value}   picture {column}, {row}"

    def say_column_pixel(self, column_id: int, row: int, column: int) -> None:
        """Say what is under the pointer in a column."""
        self._say_pixel = partial(self.say_column_pixel, column_id, row, column)
        scene = self._controller.column_scene(column_id)
        text = ""
        if scene is not None and scene.image is not None and row >= 0:
            height, width = scene.image.shape[:2]
            if row < height and column < width:
                filled = scene.filled is None or bool(scene.filled[row, column])
                value = describe_value(scene.image, row, column) if filled else "not filled yet"
                text = f"{column}, {row}   {value}"
                # A preview is not what the maps of an earlier result are about.
                shown = scene.result if scene.result is not None and scene.result.image is scene.image else None
                maps = shown.maps if shown is not None else {}
                # Only what is there already: making a map takes long.
                source, counts = made_map(maps, "source"), made_map(maps, "candidates")
                if source is not None:
                    origin = source.plane.data[row, column]
                    # What is beside a hole that was filled has no source.
                    text += f"   from exemplar {origin[1]}, {origin[0]}" if origin[0] >= 0 else ""
                if counts is not None:
                    text += f"   candidates {counts.plane.data[row, column]}"
        self._window.status.pixel.setText(text)

    def _show_choice(self) -> None:
        from texlab_core.images.exemplar import scaled_size

        sample = self._session.state.sample
        if sample is None:
            return
        name = sample.source.name
        prepared = self._controller.prepared
        parts = []
        if prepared is not None:
            height, width = prepared.exemplar.size
            kind = "gray" if prepared.exemplar.channels == 1 else "colour"
            said = reduced_words(sample)
            part = part_words(sample, prepared.source_scaled.size)
            size = f"{width} x {height} {kind}"
            said_first = [each for each in (said, levels_words(sample)) if each]
            between = " " if part.startswith("at ") else ", "
            parts = [*said_first, f"{size}{between}{part}" if part else size, *sample.source.notes]
        self._workspace.exemplar.show_choice(name.removeprefix("gallery:"), parts, sample.scale, sample.crop)
        self._workspace.exemplar.offer(sample)
        if prepared is not None:
            panel = self._workspace.exemplar.panel
            size_now = scaled_size(*sample.source.size, sample.scale)
            panel.show_choice(size_now, sample.scale, sample.crop, sample.source.size)
            panel.show_levels(prepared.histogram, sample.levels, sample.look_only, prepared.auto)
        self._workspace.set_look(sample.levels if sample.look_only else None)
        self._window.actions_by_name["crop"].setChecked(sample.crop is not None)
        if name != self._shown_exemplar:
            if self._shown_exemplar:
                # What was said was about the exemplar before.
                self._window.message_bar.hide()
            self._shown_exemplar = name
            self._window.gallery.mark(name)
            self._window.gallery.strip.mark(sample.path)
            self._window.setWindowTitle(f"{name.removeprefix('gallery:')} - TexLab")
            self._window.show_recent(self._settings.recent, lambda path, _=False: self.recent_chosen.emit(path))
            together = [each for each in self._window.gallery.strip.sources if isinstance(each, str)]
            open_files = [each for each in together or self._settings.recent if not is_project(each)]
            self._controller.tell_opened(tuple(open_files))
