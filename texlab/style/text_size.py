"""How large text is: the user's zoom everywhere, and in Teach by the height of the window."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import QEvent, QObject, Qt
from PySide6.QtGui import QFont, QFontMetricsF

if TYPE_CHECKING:
    from collections.abc import Callable

    from PySide6.QtGui import QFontMetrics
    from PySide6.QtWidgets import QWidget

# Capitals are read from the back row when they are this part of the picture's height.
CAPITALS = 1 / 40
ZOOMS = (0.5, 0.6, 0.7, 0.8, 0.9, 1.0, 1.1, 1.25, 1.4, 1.6, 1.8, 2.0, 2.5, 3.0)
# How many times as large as other text the sentence of a lesson is: when teaching, else.
SENTENCE = (1.2, 1.6)
# The sign that something is left out.
MORE = "…"
# Sizes in pixels are made for lines of this height.
USUAL_LINE = 15.0
# Text that is smaller elsewhere is not smaller than this; it is that of Teach while one teaches.
_least = [0.0]


def teach_points(height: float, zoom: float, capitals: Callable[[float], float]) -> float:
    """Return the size of text, in points, with capitals of at least ``zoom`` / 40 of a height.

    Parameters
    ----------
    height
        Of the window, in pixels.
    zoom
        The user's own factor; 1 is the size that can be read from the back row.
    capitals
        Height of capitals in pixels for a size in points, rising with it (rounding to whole pixels is allowed).

    Raises
    ------
    ValueError
        When height or zoom are not positive.
    """
    if height <= 0 or zoom <= 0:
        raise ValueError(f"Height and zoom must be positive, got {height:g} and {zoom:g}.")
    wanted = height * CAPITALS * zoom
    # Half points: what is written into style sheets is what is measured.
    halves = max(1, int(2 * wanted / max(capitals(100.0) / 100, 1e-3)) - 2)
    while capitals(halves / 2) < wanted:
        halves += 1
    return halves / 2


def capitals_of(font: QFont) -> Callable[[float], float]:
    """Return the height of this font's capitals, in pixels, as a function of its size in points."""

    def measure(points: float) -> float:
        sized = QFont(font)
        sized.setPointSizeF(points)
        return float(QFontMetricsF(sized).capHeight())

    return measure


def next_zoom(zoom: float, step: int) -> float:
    """Return the next larger (1) or smaller (-1) zoom."""
    nearest = min(range(len(ZOOMS)), key=lambda place: abs(ZOOMS[place] - zoom))
    return ZOOMS[min(max(nearest + step, 0), len(ZOOMS) - 1)]


def set_least(points: float) -> None:
    """Let no text be smaller than this."""
    _least[0] = points


def is_teaching() -> bool:
    """Return whether text has the size that is read from the back row."""
    return _least[0] > 0


def sentence_points(points: float) -> float:
    """Return the size of a lesson's sentence beside text of this size: in Teach all text is large already."""
    return points * (SENTENCE[0] if is_teaching() else SENTENCE[1])


def smaller(points: float, factor: float, least: float = 6.5) -> float:
    """Return the size of a text that is ``factor`` times as large as usual, where it may be smaller than usual."""
    return max(points * factor, least, min(_least[0], points))


def whole_words(text: str, metrics: QFontMetrics, room: float) -> str:
    """Return the first words of a text that fit; where none does, a part of the first."""
    words = text.split(" ")
    while len(words) > 1 and metrics.horizontalAdvance(" ".join(words).rstrip(",")) > room:
        words.pop()
    return metrics.elidedText(" ".join(words).rstrip(","), Qt.TextElideMode.ElideRight, int(room))


def shortened(text: str, metrics: QFontMetrics, room: float) -> str:
    """Return a text that fits, with a sign where something is left out: whole words when it is read from afar."""
    if not is_teaching() or metrics.horizontalAdvance(text) <= room:
        return metrics.elidedText(text, Qt.TextElideMode.ElideRight, int(room))
    # Nobody in the back row can do anything with half a word.
    fit = whole_words(text, metrics, room - metrics.horizontalAdvance(f" {MORE}"))
    return fit if fit.endswith(MORE) else f"{fit} {MORE}"


def tight_line(metrics: QFontMetrics) -> int:
    """Return the least height of a line of numbers and plain words: no accents stand above its capitals."""
    box = metrics.tightBoundingRect("bdk0g")
    return box.height() + 1


def text_scale(widget: QWidget) -> float:
    """Return how many times as high as usual a widget's text is, at least 1: its sizes in pixels grow with it."""
    return max(1.0, float(QFontMetricsF(widget.font()).height()) / USUAL_LINE)


def line_scale(widget: QWidget) -> float:
    """Return how many times as thick as usual lines are drawn beside a widget's text, at least 1."""
    # At the smallest screen for teaching, usual lines can still be seen from afar.
    return max(1.0, text_scale(widget) / 2)


class _Follower(QObject):
    def __init__(self, widget: QWidget, changed: Callable[[], object]) -> None:
        super().__init__(widget)
        self._changed = changed
        widget.installEventFilter(self)
        changed()

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        if event.type() == QEvent.Type.FontChange:
            self._changed()
        return False


def follow_text(widget: QWidget, changed: Callable[[], object]) -> None:
    """Call ``changed`` now and whenever this widget's text has another size; its parent's may come before."""
    _Follower(widget, changed)


def grow_with_text(widget: QWidget, pixels: int, give: Callable[[int], object]) -> None:
    """Call ``give`` with a size that is ``pixels`` for usual text, now and whenever the widget's text changes."""
    follow_text(widget, lambda: give(round(pixels * text_scale(widget))))
