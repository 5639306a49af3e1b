"""Run for many: what to work on, with what, where to, and how far it is."""

from __future__ import annotations

import os
from dataclasses import dataclass
from typing import TYPE_CHECKING

from PySide6.QtCore import Signal
from PySide6.QtWidgets import QFileDialog, QLineEdit, QPlainTextEdit

from texlab.style.numbers import duration
from texlab.widgets.calm_wheel import ChoiceBox
from texlab.widgets.number_box import WholeBox
from texlab.window.run_dialog import RunDialog, with_text

if TYPE_CHECKING:
    from PySide6.QtWidgets import QWidget

    from texlab_core.batch.running import BatchResult, Progress

MOST_SEEDS = 1000


@dataclass(frozen=True)
class BatchRequest:
    """What the user wants to run.

    Parameters
    ----------
    plan
        A plan's file or ``gallery:NAME``; with it, the next four count for nothing.
    inputs
        Files, folders, globs and textures of the gallery.
    all_columns
        Every column's method and parameters, or those of the chosen one only.
    seeds
        How many, counted from the session's.
    sizes
        As a plan has them.
    out
        Folder for the results.
    processes
        How many.
    """

    plan: str
    inputs: tuple[str, ...]
    all_columns: bool
    seeds: int
    sizes: tuple[str, ...]
    out: str
    processes: int


class BatchDialog(RunDialog):
    """Asks what to run (``asked(BatchRequest)``), and shows how far it is.

    ``page_wanted(path)`` to look at the report.
    """

    page_wanted = Signal(str)

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__("batch", "Run for many", "Reading the inputs ...", 420, parent)
        self.plan = QLineEdit()
        self.plan.setPlaceholderText("none: what is said below")
        self.inputs = QPlainTextEdit()
        self.inputs.setPlaceholderText("one on each line: a file, a folder, in/*.png, gallery:structured")
        self.inputs.setTabChangesFocus(True)
        self.inputs.setFixedHeight(5 * self.fontMetrics().lineSpacing())
        self.methods = ChoiceBox()
        self.methods.addItems(["the chosen column's method and parameters", "those of every column"])
        self.seeds = WholeBox()
        self.seeds.setRange(1, MOST_SEEDS)
        self.sizes = QLineEdit("1x")
        self.out = QLineEdit()
        self.processes = WholeBox()
        self.processes.setRange(1, 256)
        # One core is left for the window.
        self.processes.setValue(max(1, (os.cpu_count() or 2) - 1))
        self._page = ""
        self._lay_out()
        for edited in (
            self.plan.textChanged,
            self.inputs.textChanged,
            self.sizes.textChanged,
            self.out.textChanged,
        ):
            edited.connect(self._check)
        self.show_idle("")

    def _lay_out(self) -> None:
        rows = (
            ("Plan", self.plan, "plan", "A plan's file, or gallery:de-bonet-800", self._ask_plan),
            ("Inputs", self.inputs, "inputs", "Every image is an exemplar", self._ask_folder),
            ("Methods", self.methods, "methods", "What is run on each of them", None),
            ("Seeds", self.seeds, "seeds", "How many results of each, counted from the seed of the window", None),
            (
                "Sizes",
                self.sizes,
                "sizes",
                "WxH, one number for a square, or a factor of the exemplar's sides as in 2x; several with commas",
                None,
            ),
            (
                "Results",
                self.out,
                "out",
                "Folder for pictures and report; what is there already is kept",
                self._ask_out,
            ),
            ("Processes", self.processes, "processes", "How many work side by side", None),
        )
        for row in rows:
            self.add_row(*row)
        (self.page_button,) = self.add_end("Run", ("Open the report", "page", self._want_page))

    def request(self) -> BatchRequest:
        """Return what the fields say."""
        return BatchRequest(
            plan=self.plan.text().strip(),
            inputs=tuple(line.strip() for line in self.inputs.toPlainText().splitlines() if line.strip()),
            all_columns=self.methods.currentIndex() == 1,
            seeds=self.seeds.value(),
            sizes=tuple(part.strip() for part in self.sizes.text().split(",") if part.strip()),
            out=self.out.text().strip(),
            processes=self.processes.value(),
        )

    def show_progress(self, progress: Progress) -> None:
        """Show how far it is, and how long it will take."""
        self.show_share(progress.fraction)
        failed = f", {progress.failed} failed" if progress.failed else ""
        left = "" if progress.remaining_s is None else f", {duration(progress.remaining_s)} left"
        last = f"\n{progress.error}" if progress.error else ""
        self.message.setText(f"{progress.done + progress.failed} of {progress.total}{failed}{left}{last}")

    def show_result(self, result: BatchResult) -> None:
        """Show what came of it."""
        self.show_share(1.0)
        self._page = str(result.page)
        found = f", {result.found} were done already" if result.found else ""
        failed = f", {result.failed} failed (the report says why)" if result.failed else ""
        self.show_idle(f"{result.made} textures in {duration(result.elapsed_s)}{found}{failed}.")

    def _check(self) -> None:
        super()._check()
        self.page_button.setEnabled(bool(self._page))
        asked = self.request()
        complete = bool(asked.out and (asked.plan or (asked.inputs and asked.sizes)))
        self.run_button.setEnabled(complete and not self._running)
        for widget in (self.inputs, self.methods, self.seeds, self.sizes):
            widget.setEnabled(not asked.plan and not self._running)
        for widget in (self.plan, self.out, self.processes):
            widget.setEnabled(not self._running)

    def _want_page(self) -> None:
        self.page_wanted.emit(self._page)

    def _ask_plan(self) -> None:
        with_text(
            self.plan, QFileDialog.getOpenFileName(self, "Plan", "", "Plans (*.json *.toml);;All files (*)")[0]
        )

    def _ask_folder(self) -> None:
        if path := QFileDialog.getExistingDirectory(self, "Folder of images"):
            self.inputs.appendPlainText(path)

    def _ask_out(self) -> None:
        with_text(self.out, QFileDialog.getExistingDirectory(self, "Folder for the results"))
