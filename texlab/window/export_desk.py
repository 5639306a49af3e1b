"""Exports from the window: one at a time, in a thread, over the same core as the command line."""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING

from PySide6.QtCore import QStandardPaths, QUrl
from PySide6.QtGui import QDesktopServices, QGuiApplication

from texlab.columns.status import known_numbers
from texlab.columns.titles import titles
from texlab.runs.column_run import job_of
from texlab.widgets.once import Once
from texlab.window.export_dialog import ExportDialog, ExportRequest
from texlab.window.run_dialog import RunDesk
from texlab_core.errors import InputError
from texlab_core.sheets.export_names import safe_part

if TYPE_CHECKING:
    from collections.abc import Sequence

    import numpy as np
    from numpy.typing import NDArray

    from texlab.runs.controller import Controller
    from texlab.runs.worker import Task
    from texlab.storage.settings import Settings
    from texlab.window.main_window import MainWindow
    from texlab_core.images.formats.writing import Bits
    from texlab_core.sheets.export import Export, Item
    from texlab_core.sheets.figure import Figure


@dataclass(frozen=True)
class Outcome:
    """What came of a request.

    Parameters
    ----------
    written
        The files.
    there
        All files that would be replaced, if the user was not told of every one of them: nothing was written then.
    note
        What there is to say about what was written, one sentence.
    """

    written: tuple[Path, ...] = ()
    there: tuple[Path, ...] = ()
    note: str = ""


# While a control is dragged, many changes become one.
FOLLOW_MS = 100
_BITS: dict[str, Bits | None] = {"": None, "8": 8, "16": 16, "float": "float"}


class ExportDesk(RunDesk):
    """Opens the dialog, and carries out what it asks for."""

    dialog: ExportDialog | None = None

    def __init__(self, window: MainWindow, settings: Settings, controller: Controller) -> None:
        super().__init__(window, "export", "Stopped; nothing was written.")
        self._settings = settings
        self._controller = controller
        self.written: tuple[Path, ...] = ()
        # What the dialog was told of last.
        self._told: tuple[object, ...] = ()
        self._late = Once(window, FOLLOW_MS, self._follow)
        controller.scene_changed.connect(lambda _: self._look())

    def open(self) -> None:
        """Show the dialog, which follows the columns from then on."""
        if self.dialog is None:
            self.dialog = ExportDialog(self._window)
            self.dialog.asked.connect(self._run)
            self.dialog.edited.connect(self._foresee)
            self._connect(self.dialog, self.dialog.show_share, self._done)
            self.dialog.folder_wanted.connect(self._show_folder)
            self.dialog.path_wanted.connect(self._copy_path)
        self._propose()
        self._tell((self._controller.session.selected_id,))
        self._show(self.dialog)

    def _now(self) -> tuple[object, ...]:
        session = self._controller.session
        return session.state, session.selected_id, self._controller.exemplar, column_titles(self._controller)

    def _look(self) -> None:
        """See whether anything that the dialog shows has changed."""
        if self.dialog is not None and self.dialog.isVisible() and self._now() != self._told:
            self._late.start()

    def _follow(self) -> None:
        if self.dialog is None or not self.dialog.isVisible():
            return
        if self._controller.exemplar is not self._told[2]:
            self._propose()
        self._tell(self.dialog.columns.ticked)

    def _propose(self) -> None:
        """Propose where to write to, and say how deep the exemplar is."""
        exemplar = self._controller.exemplar
        if exemplar is not None and self.dialog is not None:
            self.dialog.set_targets(self._folder(), safe_part(Path(exemplar.name.removeprefix("gallery:")).stem))
            self.dialog.set_depth(exemplar.depth)

    def _tell(self, ticked: Sequence[int]) -> None:
        """Let the dialog offer the columns that there are now."""
        assert self.dialog is not None
        self._told = self._now()
        self.dialog.set_columns(list(column_titles(self._controller).items()), ticked)

    def _folder(self) -> str:
        """Return where results went last, else where pictures are."""
        pictures = QStandardPaths.writableLocation(QStandardPaths.StandardLocation.PicturesLocation)
        return self._settings.text("save-folder") or pictures or str(Path.home())

    def _foresee(self, asked: ExportRequest) -> None:
        """Show the names that a request would give, or why it cannot be carried out."""
        assert self.dialog is not None
        try:
            names = foreseen(asked, self._items(asked))
            if asked.kind == "animation":
                title = column_titles(self._controller)[self._controller.session.selected_id]
                names = [f"{name}, of {title}" for name in names]
            self.dialog.show_names(names)
        except InputError as error:
            self.dialog.show_problem(str(error))

    def _items(self, asked: ExportRequest) -> list[Item]:
        wanted = (self._controller.session.selected_id,) if asked.kind == "animation" else asked.columns
        return column_items(self._controller, wanted, titled=asked.kind == "files")

    def _run(self, asked: ExportRequest) -> None:
        dialog = self.dialog
        assert dialog is not None
        try:
            items = self._items(asked)
        except InputError as error:
            dialog.show_problem(str(error))
            return
        folder = asked.out if asked.kind == "files" else str(Path(asked.out).parent)
        self._settings.values["save-folder"] = folder
        self._submit(dialog, lambda task: carry_out(asked, items, task))

    def _done(self, outcome: Outcome) -> None:
        assert self.dialog is not None
        if outcome.there:
            self.dialog.ask_to_replace(outcome.there)
            return
        written = self.written = outcome.written
        self.dialog.show_share(1.0)
        what = str(written[0]) if len(written) == 1 else f"{len(written)} files in {written[0].parent}"
        self.dialog.show_idle(f"Written: {what}. {outcome.note}".rstrip(), written=True)

    def _show_folder(self) -> None:
        if self.written:
            QDesktopServices.openUrl(QUrl.fromLocalFile(str(self.written[0].parent.absolute())))

    def _copy_path(self) -> None:
        QGuiApplication.clipboard().setText("\n".join(str(path.absolute()) for path in self.written))


def column_titles(controller: Controller) -> dict[int, str]:
    """Return what every column is called, by id."""
    columns = controller.scene().columns
    return dict(zip((each.id for each in columns), titles(columns), strict=True))


def column_items(controller: Controller, column_ids: Sequence[int], *, titled: bool = True) -> list[Item]:
    """Return columns as what can be exported, with the results that they have.

    ``titled`` ones are called as in the window; others by the name that they were given alone, for a figure writes
    beside it what they differ in.

    Raises
    ------
    InputError
        When none is chosen, the exemplar is still being read, or a column's job cannot work.
    """
    from texlab_core.sheets.export import Item

    state, exemplar = controller.session.state, controller.exemplar
    columns = [column for column in state.columns if column.id in column_ids]
    if not columns:
        raise InputError("Choose at least one column.")
    if exemplar is None:
        raise InputError("The exemplar is still being read.")
    items = []
    shown = column_titles(controller) if titled else {}
    for column in columns:
        title = shown.get(column.id, column.name)
        job = job_of(column, state, exemplar)
        scene = controller.column_scene(column.id)
        result = None if scene is None else scene.result
        # While a control is dragged, the result is of what was there before.
        if result is not None and result.job.key == job.key:
            # Depth and transparency are those of today's exemplar.
            known = known_numbers(scene)
            items.append(Item(job, title, dataclasses.replace(result, job=job), known))
        else:
            items.append(Item(job, title))
    return items


def _selected(asked: ExportRequest, items: Sequence[Item]) -> tuple[Item, ...]:
    from texlab_core.sheets.export import selection
    from texlab_core.sheets.export_names import parse_seeds, parse_sizes

    dimensions = {len(item.job.size) for item in items}
    if len(dimensions) > 1:
        raise InputError("Pictures and solids are exported one kind at a time.")
    sizes = parse_sizes(asked.sizes, dimensions.pop()) if asked.sizes else ()
    return selection(items, parse_seeds(asked.seeds) if asked.seeds else (), sizes)


def _export(asked: ExportRequest) -> Export:
    from texlab_core.sheets.export import Export

    quality = asked.quality or None
    recipe = asked.recipe
    return Export(Path(asked.out), asked.pattern, asked.suffix, _BITS[asked.bits], quality, recipe)  # type: ignore[arg-type]


def foreseen(asked: ExportRequest, items: Sequence[Item]) -> list[str]:
    """Return the names that a request would give; nothing is read or written.

    Raises
    ------
    InputError
        When it cannot be carried out.
    """
    from texlab_core.images.formats.movies import check_movie
    from texlab_core.sheets.export_animation import animation_of
    from texlab_core.sheets.export_names import file_stems
    from texlab_core.sheets.figure import is_figure

    if not asked.out:
        raise InputError("Say where to write to.")
    if asked.kind == "animation":
        animation_of(asked.motion, items[0].job, frames=asked.frames, rate=float(asked.rate))
        if Path(asked.out).suffix:
            check_movie(asked.out, float(asked.rate))
        return [Path(asked.out).name or asked.out]
    selected = _selected(asked, items)
    if asked.kind == "files":
        export = _export(asked)
        return [f"{stem}{export.suffix}" for stem in file_stems(asked.pattern, [each.named for each in selected])]
    _look(asked)
    if not is_figure(asked.out):
        raise InputError("The name of a figure ends in .pdf or .svg.")
    return [f"{Path(asked.out).name}, {len(selected)} panels"]


def _look(asked: ExportRequest) -> Figure:
    from texlab_core.errors import ParamError
    from texlab_core.sheets.figure import Figure

    try:
        width = float(asked.width.replace(",", "."))
    except ValueError:
        raise ParamError("width", "a number of cm from 2 to 100", asked.width) from None
    return Figure(width=width, dpi=float(asked.dpi), columns=asked.across or None)


def _there(asked: ExportRequest, items: Sequence[Item]) -> tuple[Path, ...]:
    """Return the files that a request would replace."""
    from texlab_core.sheets.export import planned
    from texlab_core.sheets.export_animation import is_sequence

    out = Path(asked.out)
    if asked.kind == "files":
        targets = planned(_export(asked), _selected(asked, items))
    elif asked.kind == "animation" and is_sequence(out):
        return tuple(sorted(out.glob("frame-*.png")))
    else:
        targets = (out,)
    return tuple(path for path in targets if path.exists())


def _stillness(frames: Sequence[NDArray[np.uint8]]) -> str:
    """Say how many pictures a growth really has, where that is fewer than its frames."""
    import numpy as np

    shown = 1 + sum(one is not other and not np.array_equal(one, other) for one, other in pairwise(frames))
    if shown == len(frames):
        return ""
    return f"Its {len(frames)} frames show {shown} different pictures: a run of this method shows no more."


def carry_out(asked: ExportRequest, items: Sequence[Item], task: Task) -> Outcome:
    """Carry a request out in a worker's thread; raises as the core does."""
    from texlab_core.files.whole import check_target, write_whole
    from texlab_core.sheets.export import export_tiles, run_export, run_items
    from texlab_core.sheets.export_animation import (
        animation_of,
        check_animation_target,
        draw_frames,
        write_animation,
    )
    from texlab_core.sheets.figure import encode_figure, figure_page

    def tell(share: float) -> None:
        if task.due():
            task.progress(share)

    stop = task.should_stop
    # What is there now counts: the columns may have changed since the user was told.
    there = _there(asked, items)
    if not asked.replace.issuperset(there):
        return Outcome(there=there)
    if asked.kind == "files":
        selected = _selected(asked, items)
        return Outcome(run_export(_export(asked), selected, on_progress=tell, should_stop=stop))
    if asked.kind == "figure":
        out = check_target(asked.out)
        selected = _selected(asked, items)
        results = run_items(selected, on_progress=tell, should_stop=stop)
        page = figure_page(export_tiles(zip(selected, results, strict=True)), _look(asked))
        write_whole(out, encode_figure(out, page))
        return Outcome((out,))
    animation = animation_of(asked.motion, items[0].job, frames=asked.frames, rate=float(asked.rate))
    check_animation_target(asked.out, animation)
    drawn, result = draw_frames(items[0].job, animation, on_progress=tell, should_stop=stop)
    written = write_animation(asked.out, drawn, result, rate=animation.rate, should_stop=stop)
    return Outcome(written, note=_stillness(drawn) if animation.of == "growth" else "")
