"""Export: which columns, seeds and sizes, as files, a figure or an animation, and how far it is."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Literal

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import QComboBox, QFileDialog, QLineEdit, QWidget

from texlab.widgets.calm_wheel import ChoiceBox
from texlab.widgets.number_box import WholeBox
from texlab.widgets.plain import Label
from texlab.widgets.tick_list import TickList
from texlab.window.run_dialog import RunDialog, with_text
from texlab_core.sheets.export_names import FIELDS, PATTERN

if TYPE_CHECKING:
    from collections.abc import Collection, Sequence

    from texlab_core.images.formats.writing import Bits

Kind = Literal["files", "figure", "animation"]
KINDS: tuple[tuple[Kind, str], ...] = (
    ("files", "files, one for each result"),
    ("figure", "a figure for print, PDF or SVG"),
    ("animation", "an animation of the chosen column"),
)
FORMATS = {
    "PNG": ".png",
    "TIFF": ".tif",
    "WebP": ".webp",
    "JPEG": ".jpg",
    "AVIF": ".avif",
    "JPEG XL": ".jxl",
    "EXR": ".exr",
}
BITS = {"as the exemplar": "", "8 bits": "8", "16 bits": "16", "floats": "float"}
RECIPES = {"inside, where the format holds it": "inside", "beside each file": "beside", "nowhere": "none"}
# Where a figure and an animation go until the user says otherwise.
_ENDINGS: dict[Kind, str] = {"figure": ".pdf", "animation": ".webp"}
_NAMED = 3
_SHOWN = 4


@dataclass(frozen=True)
class ExportRequest:
    """What the user wants to export.

    Parameters
    ----------
    kind
        Files, a figure or an animation.
    columns
        Ids of columns.
    seeds, sizes
        As on the command line; "" for each column's own.
    out
        A folder for files, a file for a figure, either for an animation.
    suffix, bits, quality, pattern, recipe
        Of files; the quality is 0 for none.
    width, dpi, across
        Of a figure: cm, pixels per inch, pictures in a row (0: its own).
    motion, frames, rate
        Of an animation.
    replace
        Files that may be replaced: those that the user was told are there.
    """

    kind: Kind
    columns: tuple[int, ...]
    seeds: str
    sizes: str
    out: str
    suffix: str = ".png"
    bits: str = ""
    quality: int = 0
    pattern: str = PATTERN
    recipe: str = "inside"
    width: str = "17"
    dpi: int = 300
    across: int = 0
    motion: str = "growth"
    frames: int = 60
    rate: int = 12
    replace: frozenset[Path] = frozenset()


class ExportDialog(RunDialog):
    """Asks what to export (``asked(ExportRequest)``), shows the names beforehand, then how far it is.

    ``edited(ExportRequest)`` when a field changes, ``folder_wanted()`` and ``path_wanted()`` for what was written.
    """

    edited = Signal(object)
    folder_wanted = Signal()
    path_wanted = Signal()

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__("export", "Export", "Making the results ...", 460, parent)
        self._written = False
        self._sound = False
        # What the user was told would be replaced; another press of the button means these alone.
        self._named: frozenset[Path] = frozenset()
        # A field or a column was edited while it ran.
        self._outdated = False
        # The file dialog has asked about this one.
        self._agreed = ""
        self._outs: dict[Kind, str] = {}
        self._proposed: dict[Kind, str] = {}
        self._shown_kind: Kind = "files"
        self.kind = _box([text for _, text in KINDS])
        self.columns = TickList(6)
        self.seeds, self.sizes, self.out = QLineEdit(), QLineEdit(), QLineEdit()
        self.seeds.setPlaceholderText("each column's own; or 1..4,9")
        self.sizes.setPlaceholderText("each column's own; or 512,1024x768")
        self.format, self.bits, self.recipe = _box(FORMATS), _box(BITS), _box(RECIPES)
        self.quality = _number(0, 100, 0, "without loss")
        self.pattern = QLineEdit(PATTERN)
        self.width_cm = QLineEdit("17")
        self.dpi = _number(36, 2400, 300)
        self.across = _number(0, 64, 0, "its own")
        self.motion = ChoiceBox()
        self.motion.setEditable(True)
        self.motion.addItems(["growth", "iterations", "seed=1:12:12"])
        self.frames, self.rate = _number(2, 720, 60), _number(1, 50, 12)
        self.names = Label(wraps=True)
        self.names.setMinimumHeight((_SHOWN + 1) * self.fontMetrics().lineSpacing())
        self.names.setAlignment(Qt.AlignmentFlag.AlignTop)
        self._lay_out()
        self._connect()
        self.show_idle("")

    def _rows(self) -> tuple[tuple[str, QWidget, str, str, tuple[Kind, ...]], ...]:
        fields = f"Text with {', '.join(f'{{{each}}}' for each in FIELDS)}"
        every: tuple[Kind, ...] = ("files", "figure", "animation")
        return (
            ("What", self.kind, "kind", "What is written", every),
            ("Columns", self.columns, "columns", "Whose results are written", ("files", "figure")),
            ("Seeds", self.seeds, "seeds", "Seeds as in 1..4,9", ("files", "figure")),
            (
                "Sizes",
                self.sizes,
                "sizes",
                "Sizes as in 512,1024x768",
                ("files", "figure"),
            ),
            ("Format", self.format, "format", "The format of the files", ("files",)),
            ("Depth", self.bits, "bits", "Bits for each sample", ("files",)),
            ("Quality", self.quality, "quality", "1 to 100 for smaller files that lose something", ("files",)),
            (
                "Names",
                self.pattern,
                "pattern",
                fields,
                ("files",),
            ),
            ("Recipes", self.recipe, "recipe", "Where it is kept how each file was made", ("files",)),
            ("Width in cm", self.width_cm, "width", "Of the page, that of its column in print", ("figure",)),
            ("Resolution", self.dpi, "dpi", "Finer pictures are reduced to so many pixels per inch", ("figure",)),
            ("In a row", self.across, "across", "Pictures side by side", ("figure",)),
            (
                "Shows",
                self.motion,
                "motion",
                "growth, iterations, or a knob: alpha=0.05:0.3:24",
                ("animation",),
            ),
            (
                "Frames",
                self.frames,
                "frames",
                "Of a growth, at most: a method that works level by level shows one picture a level, and keeps it",
                ("animation",),
            ),
            ("Frames a second", self.rate, "rate", "How fast it goes", ("animation",)),
        )

    def _lay_out(self) -> None:
        for label, widget, name, tip, _ in self._rows():
            self.add_row(label, widget, name, tip)
        tip = "A folder, or a name that ends in .pdf, .svg, .webp, .gif, .apng or .mp4"
        self.add_row("Write to", self.out, "out", tip, self._ask_out)
        self.names.setObjectName("export-names")
        self.form.addRow("Will be", self.names)
        self.folder_button, self.path_button = self.add_end(
            "Export",
            ("Show in folder", "folder", self.folder_wanted.emit),
            ("Copy path", "path", self.path_wanted.emit),
        )

    def _connect(self) -> None:
        self.kind.currentIndexChanged.connect(self._show_rows)
        for box in (self.kind, self.format, self.bits, self.recipe):
            box.currentIndexChanged.connect(self._edited)
        for line in (self.seeds, self.sizes, self.out, self.pattern, self.width_cm):
            line.textChanged.connect(self._edited)
        for number in (self.quality, self.dpi, self.across, self.frames, self.rate):
            number.valueChanged.connect(self._edited)
        self.motion.editTextChanged.connect(self._edited)
        self.columns.itemChanged.connect(self._edited)
        self._show_rows()

    def _show_rows(self) -> None:
        kind = self._kind()
        for _, widget, _, _, kinds in self._rows():
            self.form.setRowVisible(widget, kind in kinds)
        if kind != self._shown_kind:
            # Every kind keeps where it was to be written.
            self._outs[self._shown_kind] = self.out.text()
            self._shown_kind = kind
            self.out.setText(self._outs.get(kind, ""))
            if not self._running:
                self.bar.setValue(0)
                self.show_idle("")

    def _kind(self) -> Kind:
        return KINDS[self.kind.currentIndex()][0]

    def set_targets(self, folder: str, stem: str) -> None:
        """Propose where to write to, for every kind that has no place yet."""
        self._outs[self._shown_kind] = self.out.text()
        for kind, _ in KINDS:
            target = folder if kind == "files" else str(Path(folder) / f"{stem}{_ENDINGS[kind]}")
            # What was typed stays.
            if self._outs.get(kind, "") in ("", self._proposed.get(kind)):
                self._outs[kind] = target
            self._proposed[kind] = target
        self.out.setText(self._outs[self._shown_kind])

    def set_depth(self, depth: Bits) -> None:
        """Say how deep the exemplar is."""
        own = next(iter(BITS))
        words = "floats" if depth == "float" else f"{depth} bits"
        self.bits.setItemText(0, f"{own} ({words})")

    def set_columns(self, columns: Sequence[tuple[int, str]], ticked: Collection[int]) -> None:
        """Offer columns by id and title, some of them ticked, and foresee what would be written of them now."""
        if list(columns) != self.columns.things:
            self.columns.offer(columns, ticked)
        else:
            self.columns.tick(ticked)
        self._edited()

    def request(self) -> ExportRequest:
        """Return what the fields say."""
        return ExportRequest(
            kind=self._kind(),
            columns=self.columns.ticked,
            seeds=self.seeds.text().strip(),
            sizes=self.sizes.text().strip(),
            out=self.out.text().strip(),
            suffix=FORMATS[self.format.currentText()],
            bits=list(BITS.values())[self.bits.currentIndex()],
            quality=self.quality.value(),
            pattern=self.pattern.text(),
            recipe=RECIPES[self.recipe.currentText()],
            width=self.width_cm.text().strip(),
            dpi=self.dpi.value(),
            across=self.across.value(),
            motion=self.motion.currentText().strip(),
            frames=self.frames.value(),
            rate=self.rate.value(),
            replace=self._named | self._agreed_paths(),
        )

    def _agreed_paths(self) -> frozenset[Path]:
        agreed = bool(self._agreed) and self.out.text() == self._agreed
        return frozenset((Path(self._agreed.strip()),)) if agreed else frozenset()

    def ask_to_replace(self, paths: Sequence[Path]) -> None:
        """Say which files are there already; pressing the button once more replaces these, and no others."""
        self.bar.setValue(0)
        if self._outdated:
            # They belong to what the fields said before.
            self.show_idle("Nothing was written: what is asked for has changed meanwhile.")
            return
        self._named = frozenset(paths)
        names = [path.name for path in paths]
        self.run_button.setText("Replace")
        some = f"{len(names)} files are" if len(names) > 1 else "One file is"
        more = f" and {len(names) - _NAMED} more" if len(names) > _NAMED else ""
        self.show_idle(f"{some} there already: {', '.join(names[:_NAMED])}{more}. Replace, or write elsewhere.")

    def _ask_again(self) -> None:
        """Ask anew before anything is replaced."""
        self._named = frozenset()
        self.run_button.setText("Export")

    def _edited(self) -> None:
        self._outdated = True
        if self._named:
            self._ask_again()
            if not self._running:
                self.message.setText("")
        self.edited.emit(self.request())

    def show_names(self, names: Sequence[str]) -> None:
        """Show what the files will be called."""
        rest = f"\n... and {len(names) - _SHOWN} more" if len(names) > _SHOWN else ""
        self.names.setText("\n".join(names[:_SHOWN]) + rest)
        self._sound = True
        self._check()

    def show_problem(self, sentence: str) -> None:
        """Show why it cannot be exported like this."""
        self.names.setText(sentence)
        self._sound = False
        self._check()

    def show_idle(self, sentence: str, *, written: bool = False) -> None:
        """Show that nothing runs, and why not, or what came of it."""
        self._written = self._written or written
        if written:
            self._ask_again()
            self._agreed = ""
        super().show_idle(sentence)

    def show_running(self) -> None:
        """Show that it has begun."""
        self._written = self._outdated = False
        super().show_running()

    def _check(self) -> None:
        super()._check()
        self.run_button.setEnabled(self._sound and not self._running)
        self.folder_button.setEnabled(self._written)
        self.path_button.setEnabled(self._written)

    def _ask_out(self) -> None:
        kind = self._kind()
        if kind == "files":
            with_text(self.out, QFileDialog.getExistingDirectory(self, "Folder for the files", self.out.text()))
            return
        kinds = {
            "figure": "PDF (*.pdf);;SVG (*.svg)",
            "animation": "WebP (*.webp);;GIF (*.gif);;APNG (*.apng);;MP4 (*.mp4)",
        }[kind]
        self._agreed = QFileDialog.getSaveFileName(self, "Export", self.out.text(), kinds)[0]
        with_text(self.out, self._agreed)


def _box(texts: object) -> QComboBox:
    box = ChoiceBox()
    box.addItems([str(text) for text in texts])  # type: ignore[attr-defined]
    return box


def _number(low: int, high: int, value: int, none: str = "") -> WholeBox:
    box = WholeBox()
    box.setRange(low, high)
    box.setValue(value)
    box.setSpecialValueText(none)
    return box
