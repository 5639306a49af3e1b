"""Wires session, controller and window together."""

from __future__ import annotations

import logging
import secrets
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from PySide6.QtCore import QObject, QPoint, Qt, QTimer, Signal
from PySide6.QtGui import QGuiApplication, QImage
from PySide6.QtWidgets import QFileDialog, QMenu, QMessageBox

from texlab.controller import Controller
from texlab.crash import CrashHandler
from texlab.dock_host import DockHost
from texlab.docks import dock_classes
from texlab.editors import register_editors
from texlab.jobs import Slots, Task, Worker
from texlab.memory import memory_text
from texlab.opening import IMAGE_SUFFIXES, Choice, Opener, is_document, last_exemplar
from texlab.overlays import Overlays
from texlab.pictures import describe_pixel, to_picture
from texlab.preset_manager import PresetManager
from texlab.session import Column, Session, State
from texlab.storage.autosave import Autosave
from texlab.storage.settings import columns_from_json, seed_and_size
from texlab.views.help import HelpWindow
from texlab.views.palette import CommandPalette
from texlab.views.workspace import Workspace
from texlab.window import source_of
from texlab_core.gallery import gallery
from texlab_core.inputs import Crop
from texlab_core.multiresolution.thresholds import ThresholdTable
from texlab_core.params import describe
from texlab_core.registry import methods
from texlab_core.run import MAX_SEED, versions
from texlab_core.sheets.comparison import FIG_8, FIRST_SIGHT

if TYPE_CHECKING:
    from collections.abc import Sequence

    from texlab.docks.base import Dock
    from texlab.preparation import Prepared
    from texlab.scene import Mark, Picture, Scene
    from texlab.storage.settings import Settings
    from texlab.theme import ThemeSource
    from texlab.views.column import ColumnView
    from texlab.window import MainWindow

log = logging.getLogger(__name__)

FIRST_TEXTURE = "gallery:structured-pebbles"
FIRST_CROP = Crop(16, 16, 128, 128)
THUMBNAIL = 48
MEMORY_MS = 2000
TURN_MS = 600


class Explorer(QObject):
    """The running program behind the window."""

    painted = Signal()

    def __init__(self, window: MainWindow, settings: Settings, themes: ThemeSource) -> None:
        super().__init__(window)
        self.window = window
        self.settings = settings
        self.themes = themes
        self.session = Session(self)
        self.controller = Controller(self.session, themes, self)
        self.opener = Opener(self.session, self.controller, settings, lambda path: self.presets.import_file(path))
        self.presets = PresetManager(window, window.parameters.presets, self.session, self.controller)
        self.autosave = Autosave(self.session, settings, self)
        self.crash = CrashHandler(self)
        self.workspace = Workspace([(each.id, each.title) for each in methods().values()])
        self.workspace.set_theme(themes.theme)
        self.help: HelpWindow | None = None
        self.overlays = Overlays(self.workspace.columns, self)
        self._closed = False
        self._shown_exemplar = ""
        self._dock_slots = Slots(1)
        register_editors()
        self.docks: list[Dock] = [make() for make in dock_classes()]
        self.hosts = [DockHost(dock, self._dock_slots, self) for dock in self.docks]
        self._thumbnails = Worker("thumbnails", parent=self)
        self._turned = ""
        self._turning = QTimer(self)
        self._turning.setSingleShot(True)
        self._turning.setInterval(TURN_MS)
        self._turning.timeout.connect(lambda: self.session.finish_merge(self._turned))
        self._memory = QTimer(self)
        self._memory.setInterval(MEMORY_MS)
        self._memory.timeout.connect(lambda: window.memory_label.setText(memory_text()))
        window.set_workspace(self.workspace)
        window.add_docks(self.docks)
        self._connect()
        self._fill_gallery()
        self.crash.install()
        if settings.problem:
            log.warning(settings.problem)
            window.message_bar.tell(settings.problem, "problem")
        self._memory.start()

    # Start.

    def start(self, source: str | None, *, columns: Sequence[tuple[Any, ...]] | None = None) -> None:
        """Fill the window: the given image, or the last session, or the first texture."""
        saved = self.settings.values.get("session")
        chosen = columns or columns_from_json(saved) or first_columns()
        seed, size = seed_and_size(saved)
        made = tuple(Column(place + 1, *each) for place, each in enumerate(chosen))
        self.session.apply(State(None, made, seed, size, len(made) + 1), "start")
        place = saved.get("selected", 0) if isinstance(saved, dict) else 0
        place = place if isinstance(place, int) and 0 <= place < len(made) else 0
        self._select(made[place].id)
        self.session.reset_history()
        self._open_first(source, saved)

    def _open_first(self, source: str | None, saved: Any) -> None:
        choices = [*last_exemplar(saved), Choice(FIRST_TEXTURE, FIRST_CROP, 1.0)]
        if source is not None and is_document(source):
            # A code or a preset goes into a column; the exemplar is the last one.
            self.opener.open(source)
        elif source is not None and source.startswith("gallery:"):
            choices.insert(0, Choice(source, FIRST_CROP, 1.0))
        elif source is not None:
            choices.insert(0, Choice(source))
        self.opener.open_first_of(choices)

    def close(self) -> None:
        """Remember the session and stop every thread."""
        if self._closed:
            return
        self._closed = True
        self._memory.stop()
        self._turning.stop()
        self.window.remember_geometry()
        # Nobody has to watch the threads come to their end.
        self.window.hide()
        self.controller.leave()
        for host in self.hosts:
            host.leave()
        self.autosave.close()
        for host in self.hosts:
            host.close()
        self._thumbnails.close()
        self.overlays.close()
        self.controller.close()
        self.crash.remove()
        if self.help is not None:
            self.help.close()

    @property
    def idle(self) -> bool:
        """Whether nothing is computed and every visible dock has its answer."""
        waiting = self.controller.busy or any(host.busy for host in self.hosts)
        return not waiting and self.session.state.sample is not None

    # Wiring.

    def _connect(self) -> None:
        window, session, controller = self.window, self.session, self.controller
        window.dropped.connect(self.opener.open)
        window.closing.connect(self.close)
        window.gallery.chosen.connect(self.opener.open)
        window.seed_box.valueChanged.connect(lambda seed: self._turn("seed", partial(session.set_seed, seed)))
        for box in (window.width_box, window.height_box):
            box.valueChanged.connect(lambda _: self._turn("size", partial(session.set_size, window.size_shown)))
        parameters = window.parameters
        parameters.edited.connect(controller.edit_params)
        parameters.reset_wanted.connect(controller.reset_params)
        parameters.help_wanted.connect(self.show_help)
        parameters.dock_wanted.connect(window.raise_dock)
        session.changed.connect(lambda *_: self._show_session())
        session.history_changed.connect(self._show_session)
        session.selected.connect(lambda _: self._show_session())
        controller.scene_changed.connect(self._show_scene)
        controller.exemplar_ready.connect(self._show_exemplar)
        controller.marks_changed.connect(self._show_marks)
        controller.problem.connect(lambda text: window.message_bar.tell(text, "problem"))
        controller.open_wanted.connect(self.opener.open)
        controller.said.connect(lambda text: window.message_bar.tell(text, "news"))
        self.crash.crashed.connect(lambda text: window.message_bar.tell(text, "problem"))
        self.themes.changed.connect(self._show_theme)
        self.workspace.column_made.connect(self._connect_column)
        exemplar = self.workspace.exemplar
        exemplar.crop_changed.connect(controller.edit_crop)
        exemplar.scale_changed.connect(lambda scale: self._turn("scale", partial(controller.edit_scale, scale)))
        exemplar.hovered.connect(self._exemplar_hovered)
        for dock in self.docks:
            dock.set_theme(self.themes.theme)
            dock.intention.connect(lambda act: act(self.controller))
        for name, handler in self._handlers().items():
            window.actions_by_name[name].triggered.connect(handler)

    def _handlers(self) -> dict[str, Any]:
        session, controller, link = self.session, self.controller, self.workspace.link

        def chosen() -> int:
            return session.selected_id

        handlers: dict[str, Any] = {
            "open": self.ask_open,
            "paste": self.paste,
            "export": lambda: self.export(chosen()),
            "quit": self.window.close,
            "undo": session.undo,
            "redo": session.redo,
            "copy": lambda: self.copy(chosen()),
            "dice": lambda: session.set_seed(secrets.randbelow(MAX_SEED + 1)),
            "reset": lambda: controller.reset_params(chosen()),
            "palette": self.show_palette,
            "add": self.choose_new_column,
            "duplicate": lambda: self._select(session.duplicate_column(chosen())),
            "remove": lambda: session.remove_column(chosen()),
            "left": lambda: session.move_column(chosen(), -1),
            "right": lambda: session.move_column(chosen(), 1),
            "four": lambda: self.lay_out(FIRST_SIGHT, "the four methods"),
            "spectra": lambda: self.lay_out(FIG_8, "compare spectra"),
            "previous": lambda: self._step_column(-1),
            "next": lambda: self._step_column(1),
            "run": lambda: controller.run_column(chosen()),
            "stop": lambda: controller.stop_column(chosen()),
            "go-on": lambda: controller.go_on(chosen()),
            "run-all": controller.run_all,
            "stop-all": controller.stop_all,
            "fit": link.fit,
            "actual": link.actual_size,
            "zoom-in": lambda: link.zoom(1.5),
            "zoom-out": lambda: link.zoom(1 / 1.5),
            "tile": self.workspace.set_tiled,
            "crop": lambda: self.workspace.exemplar.crop_button.click(),
            "help": lambda: self.show_help(self._chosen_method()),
            "help-window": lambda: self.show_help("window"),
            "shortcuts": lambda: self.show_help("shortcuts"),
            "about": self.show_about,
        }
        for layout in ("explore", "teach", "tune"):
            handlers[f"layout-{layout}"] = partial(self._arrange, layout)
        return {name: _without_argument(call) if name != "tile" else call for name, call in handlers.items()}

    def _arrange(self, layout: str) -> None:
        column = self.session.selected_column
        fields = describe(type(column.params)) if column is not None else ()
        table = any(field.type is ThresholdTable for field in fields)
        self.window.arrange(layout, tuning="thresholds" if table else "histograms")
        self.workspace.link.fit()

    def _connect_column(self, view: ColumnView) -> None:
        controller = self.controller
        view.chosen.connect(self.session.select)
        view.method_chosen.connect(self._choose_method)
        view.run_wanted.connect(controller.run_column)
        view.stop_wanted.connect(controller.stop_column)
        view.command.connect(self._column_command)
        view.hovered.connect(self._column_hovered)
        view.hovered.connect(self.controller.point_at)
        view.pixel_clicked.connect(self.controller.pin)
        view.map_chosen.connect(self.overlays.choose)

    # What the user does.

    def _turn(self, what: str, change: Any) -> None:
        """Make ``change(merge=what)``: turns of a number box without a pause are one step of the history."""
        if what != self._turned:
            self.session.finish_merge(self._turned)
        self._turned = what
        change(merge=what)
        self._turning.start()

    def _choose_method(self, column_id: int, method: str) -> None:
        self.session.set_method(column_id, method, methods()[method].params())
        self.session.select(column_id)

    def _column_command(self, column_id: int, name: str) -> None:
        session = self.session
        if name == "duplicate":
            self._select(session.duplicate_column(column_id))
        elif name in ("left", "right"):
            session.move_column(column_id, -1 if name == "left" else 1)
        elif name == "remove":
            session.remove_column(column_id)
        elif name == "export":
            self.export(column_id)
        elif name == "copy":
            self.copy(column_id)
        elif name == "go-on":
            self.controller.go_on(column_id)
        elif name == "use":
            scene = self.controller.column_scene(column_id)
            if scene is not None and scene.result is not None:
                self.opener.use_as_exemplar(scene.result)

    def _select(self, column_id: int) -> None:
        if column_id:
            self.session.select(column_id)
            self.workspace.reveal(column_id)

    def _step_column(self, by: int) -> None:
        places = [column.id for column in self.session.state.columns]
        if places:
            here = places.index(self.session.selected_id)
            self._select(places[(here + by) % len(places)])

    def lay_out(self, wanted: tuple[str, ...], text: str) -> None:
        """Show these methods with their defaults, all with the session's seed: the spectral ones share a phase."""
        self.session.set_columns([(name, methods()[name].params()) for name in wanted], text)

    def choose_new_column(self) -> None:
        """Offer the methods, then add the chosen one."""
        menu = QMenu(self.window)
        menu.setObjectName("new-column-menu")
        for method in methods().values():
            action = menu.addAction(method.title)
            action.setToolTip(method.summary)
            action.triggered.connect(partial(self._add_column, method.id))
        button = self.window.toolbar.widgetForAction(self.window.actions_by_name["add"])
        menu.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        menu.popup(button.mapToGlobal(button.rect().bottomLeft()))

    def _add_column(self, method: str, _: bool = False) -> None:
        self._select(self.session.add_column(method, methods()[method].params()))

    def ask_open(self) -> None:
        """Ask for an image, a code or a preset."""
        pattern = " ".join(f"*{suffix}" for suffix in IMAGE_SUFFIXES)
        kinds = f"Images ({pattern});;MSG codes and presets (*.json);;All files (*)"
        folder = self.settings.text("open-folder")
        path, _ = QFileDialog.getOpenFileName(self.window, "Open image", folder, kinds)
        if path:
            self.settings.values["open-folder"] = str(Path(path).parent)
            self.opener.open(path)

    def paste(self) -> None:
        """Take the image on the clipboard."""
        source = source_of(QGuiApplication.clipboard().mimeData())
        if source is None:
            self.window.message_bar.tell("There is no image on the clipboard.", "problem")
        else:
            self.opener.open(source)

    def export(self, column_id: int) -> None:
        """Ask where to save a result."""
        scene = self.controller.column_scene(column_id)
        if scene is None or scene.result is None:
            self.window.message_bar.tell("The chosen column has no finished result to save.", "problem")
            return
        job = scene.result.job
        name = self._exemplar_name().replace("gallery:", "").replace("/", "-")
        suggested = f"{Path(name).stem}-{job.method}-{job.size[1]}x{job.size[0]}-seed{job.seed}.png"
        kinds = {"PNG (*.png)": ".png", "TIFF (*.tif)": ".tif", "JPEG (*.jpg)": ".jpg"}
        suggested = str(Path(self.settings.text("save-folder")) / suggested)
        path, kind = QFileDialog.getSaveFileName(self.window, "Save result", suggested, ";;".join(kinds))
        if path:
            self.settings.values["save-folder"] = str(Path(path).parent)
            target = path if Path(path).suffix else path + kinds.get(kind, ".png")
            if target != path and Path(target).exists():
                # The dialog has not asked about this one.
                self.window.message_bar.tell(f"{target} is already there: choose it to replace it.", "problem")
                return
            self.opener.save(scene.result, target)

    def copy(self, column_id: int) -> None:
        """Put a column's picture on the clipboard."""
        scene = self.controller.column_scene(column_id)
        if scene is not None and scene.picture is not None:
            height, width = scene.picture.shape[:2]
            data = scene.picture.tobytes()
            image = QImage(data, width, height, 3 * width, QImage.Format.Format_RGB888).copy()
            QGuiApplication.clipboard().setImage(image)

    def show_palette(self) -> None:
        """Open the command palette."""
        palette = CommandPalette(self.window.actions_by_name.values(), self.window)
        palette.move(self.window.mapToGlobal(QPoint((self.window.width() - palette.width()) // 2, 80)))
        palette.show()

    def show_help(self, page: str) -> None:
        """Open a help page."""
        if self.help is None:
            self.help = HelpWindow(self.window)
            self.help.knob_wanted.connect(self._show_knob)
        self.help.open_page(page)

    def show_about(self) -> None:
        """Say what this is."""
        box = QMessageBox(self.window)
        box.setObjectName("about")
        box.setWindowTitle("About TexLab")
        found = versions()
        listed = ", ".join(f"{name} {number}" for name, number in found.items() if name != "texlab")
        box.setText(
            f"<b>TexLab {found['texlab']}</b><br>Explorer of example-based texture synthesis.<br><br>"
            f"MIT licence; the textures of the gallery have their own.<br><br><small>{listed}</small>"
        )
        box.open()

    def _show_knob(self, method: str, knob: str) -> None:
        for column in self.session.state.columns:
            if column.method == method:
                self.session.select(column.id)
                form = self.window.parameters.form
                if form is not None and knob in form.knobs:
                    widget = form.knobs[knob]
                    self.window.parameters.scroll_area.ensureWidgetVisible(widget)
                    widget.setFocus()
                self.window.activateWindow()
                return

    def _chosen_method(self) -> str:
        column = self.session.selected_column
        return column.method if column is not None else "index"

    # Showing.

    def _show_session(self) -> None:
        column = self.session.selected_column
        self.window.show_session(self.session)
        method = methods()[column.method] if column is not None else None
        self.window.parameters.show_column(
            self.session.selected_id, method, column.params if column is not None else None
        )
        self.presets.show_method(column.method if column is not None else "")
        self._show_choice()

    def _show_choice(self) -> None:
        sample = self.session.state.sample
        if sample is None:
            return
        name = sample.source.name
        prepared = self.controller.prepared
        parts = []
        if prepared is not None:
            height, width = prepared.exemplar.size
            kind = "gray" if prepared.exemplar.channels == 1 else "colour"
            parts = [f"{width} x {height} {kind}", *sample.source.notes]
        self.workspace.exemplar.show_choice(name.removeprefix("gallery:"), parts, sample.scale, sample.crop)
        self.window.actions_by_name["crop"].setChecked(sample.crop is not None)
        if name != self._shown_exemplar:
            if self._shown_exemplar:
                # What was said was about the exemplar before.
                self.window.message_bar.hide()
            self._shown_exemplar = name
            self.window.gallery.mark(name)
            self.window.setWindowTitle(f"{name.removeprefix('gallery:')} - TexLab")
            self.window.show_recent(self.settings.recent, lambda path, _=False: self.opener.open(path))

    def _show_exemplar(self, prepared: Prepared) -> None:
        self.workspace.exemplar.show_source(prepared.source_picture)
        self._show_choice()

    def _show_scene(self, scene: Scene) -> None:
        state = self.session.state
        self.workspace.link.set_extent(
            *(max(sides) for sides in zip(state.size, self._source_size(), strict=True))
        )
        self.workspace.show_scene(scene)
        self.window.parameters.show_scene(scene.selected)
        self.overlays.show_scene(scene)
        for host in self.hosts:
            host.show_scene(scene)
        counts = [column.status for column in scene.columns]
        texts = [
            f"{counts.count(status)} {word}"
            for status, word in (("running", "running"), ("waiting", "waiting"), ("failed", "failed"))
            if status in counts
        ]
        self.window.jobs_label.setText(" · ".join(texts) or "ready")
        scene_chosen = scene.selected
        finished = scene_chosen is not None and scene_chosen.result is not None
        self.window.actions_by_name["export"].setEnabled(finished)
        self.painted.emit()

    def _show_marks(self, marks: tuple[Mark, ...]) -> None:
        sample = self.session.state.sample
        crop = sample.crop if sample is not None else None
        # Methods see the crop; the pane shows the whole source.
        self.workspace.exemplar.pane.set_marks(marks, (0.0, 0.0) if crop is None else (crop.top, crop.left))

    def _source_size(self) -> tuple[int, int]:
        prepared = self.controller.prepared
        return prepared.source_scaled.size if prepared is not None else (1, 1)

    def _show_theme(self) -> None:
        self.workspace.set_theme(self.themes.theme)
        for dock in self.docks:
            dock.set_theme(self.themes.theme)

    def _exemplar_name(self) -> str:
        sample = self.session.state.sample
        return sample.source.name if sample is not None else "texture"

    def _exemplar_hovered(self, row: int, column: int) -> None:
        prepared = self.controller.prepared
        text = ""
        if prepared is not None and row >= 0:
            pixels = prepared.source_scaled.pixels
            if row < pixels.shape[0] and column < pixels.shape[1]:
                text = "exemplar " + describe_pixel(pixels, row, column)
        self.window.pixel_label.setText(text)

    def _column_hovered(self, column_id: int, row: int, column: int) -> None:
        scene = self.controller.column_scene(column_id)
        text = ""
        if scene is not None and scene.image is not None and row >= 0:
            height, width = scene.image.shape[:2]
            if row < height and column < width:
                text = describe_pixel(scene.image, row, column)
                maps = scene.result.maps if scene.result is not None else {}
                if "source" in maps:
                    origin = maps["source"].data[row, column]
                    text += f"   from exemplar {origin[1]}, {origin[0]}"
                if "candidates" in maps:
                    text += f"   candidates {maps['candidates'].data[row, column]}"
        self.window.pixel_label.setText(text)

    # The gallery.

    def _fill_gallery(self) -> None:
        entries = gallery()
        self.window.gallery.show_entries(
            (entry.uri, entry.cls, entry.title, f"{entry.title}: {entry.author}, {entry.licence}")
            for entry in entries
        )
        self._thumbnails.progressed.connect(self._show_thumbnails)
        self._thumbnails.finished.connect(self._show_thumbnails)
        names = [entry.uri for entry in entries]
        self._thumbnails.submit(partial(make_thumbnails, names))

    def _show_thumbnails(self, made: tuple[tuple[str, Picture], ...]) -> None:
        for name, picture in made[self.window.gallery.thumbnails :]:
            self.window.gallery.set_thumbnail(name, picture)


def make_thumbnails(names: list[str], task: Task) -> tuple[tuple[str, Picture], ...]:
    """Return small pictures of textures, reporting those made so far on the way."""
    import cv2

    from texlab_core.images import as_exemplar

    made: list[tuple[str, Picture]] = []
    for name in names:
        if task.should_stop():
            break
        picture = to_picture(as_exemplar(name).pixels)
        side = min(picture.shape[:2])
        small = cv2.resize(picture[:side, :side], (THUMBNAIL, THUMBNAIL), interpolation=cv2.INTER_AREA)
        made.append((name, small.astype(np.uint8)))
        if task.due():
            task.progress(tuple(made))
    return tuple(made)


def first_columns() -> list[tuple[str, Any]]:
    """Return the columns of a first start."""
    known = methods()
    return [(name, known[name].params()) for name in FIRST_SIGHT]


def _without_argument(call: Any) -> Any:
    return lambda _=False: call()
