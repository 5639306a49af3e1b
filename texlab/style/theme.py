"""Palette, fonts, colour maps and the configuration of pyqtgraph: the one place for looks."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal

from PySide6.QtCore import QObject, Qt, Signal
from PySide6.QtGui import QColor, QGuiApplication, QPalette, QPixmapCache

from texlab.style.text_size import sentence_points

if TYPE_CHECKING:
    from PySide6.QtWidgets import QApplication

ThemeName = Literal["auto", "light", "dark"]


@dataclass(frozen=True)
class Theme:
    """Colours by role, as ``#rrggbb``; the plot colours can be told apart by the colour-blind."""

    name: Literal["light", "dark"]
    window: str
    base: str
    raised: str
    text: str
    muted: str
    border: str
    accent: str
    accent_text: str
    exemplar: str
    result: str
    third: str
    good: str
    warning: str
    error: str
    canvas: str
    grid: str


# Fusion keeps a picture of every button and box that it drew, by size and palette, also of those that have gone.
DRAWN_KB = 2048
# Text from this size on, in points, has marks, arrows, handles and bars of its own size.
LARGE = 13.0

LIGHT = Theme(
    name="light",
    window="#f3f3f1",
    base="#ffffff",
    raised="#e9e9e6",
    text="#1c1c1a",
    muted="#63635e",
    border="#d0d0cb",
    accent="#0b62b0",
    accent_text="#ffffff",
    exemplar="#0072b2",
    result="#c85200",
    third="#007a5a",
    good="#1d7a3e",
    warning="#8a5a00",
    error="#b3261e",
    canvas="#dededa",
    grid="#b8b8b2",
)
DARK = Theme(
    name="dark",
    window="#1f2022",
    base="#17181a",
    raised="#2a2c2f",
    text="#e8e8e4",
    muted="#a3a39c",
    border="#3a3c40",
    accent="#5aa9f0",
    accent_text="#0c0d0e",
    exemplar="#56b4e9",
    result="#f0a035",
    third="#35c79a",
    good="#6ccf8e",
    warning="#f0b95a",
    error="#ff8a80",
    canvas="#121314",
    grid="#55585e",
)


class ThemeSource(QObject):
    """Holds the theme in force and tells when it changes; ``auto`` follows the system."""

    changed = Signal(object)

    def __init__(self, choice: ThemeName = "auto", parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._choice = choice
        self._theme = self._resolve()
        hints = QGuiApplication.styleHints()
        hints.colorSchemeChanged.connect(self._system_changed)

    @property
    def theme(self) -> Theme:
        """The theme in force."""
        return self._theme

    @property
    def choice(self) -> ThemeName:
        """What the user chose."""
        return self._choice

    def choose(self, choice: ThemeName) -> None:
        """Take another theme."""
        self._choice = choice
        self._update()

    def _system_changed(self) -> None:
        self._update()

    def _update(self) -> None:
        theme = self._resolve()
        if theme is not self._theme:
            self._theme = theme
            self.changed.emit(theme)

    def _resolve(self) -> Theme:
        if self._choice == "auto":
            dark = QGuiApplication.styleHints().colorScheme() == Qt.ColorScheme.Dark
            return DARK if dark else LIGHT
        return DARK if self._choice == "dark" else LIGHT


def palette(theme: Theme) -> QPalette:
    """Return the theme as a Qt palette."""
    made = QPalette()
    roles = QPalette.ColorRole
    for role, colour in (
        (roles.Window, theme.window),
        (roles.WindowText, theme.text),
        (roles.Base, theme.base),
        (roles.AlternateBase, theme.raised),
        (roles.ToolTipBase, theme.raised),
        (roles.ToolTipText, theme.text),
        (roles.Text, theme.text),
        (roles.PlaceholderText, theme.muted),
        (roles.Button, theme.raised),
        (roles.ButtonText, theme.text),
        (roles.BrightText, theme.error),
        (roles.Link, theme.accent),
        (roles.Highlight, theme.accent),
        (roles.HighlightedText, theme.accent_text),
        (roles.Accent, theme.accent),
        (roles.Light, theme.base),
        (roles.Midlight, theme.raised),
        (roles.Mid, theme.border),
        (roles.Dark, theme.border),
        (roles.Shadow, theme.canvas),
    ):
        made.setColor(role, QColor(colour))
    for role in (roles.WindowText, roles.Text, roles.ButtonText):
        made.setColor(QPalette.ColorGroup.Disabled, role, QColor(theme.grid))
    return made


def stylesheet(theme: Theme, points: float) -> str:
    """Return the few rules that a palette cannot say; titles of docks do not follow the font of the program."""
    # Qt paints the titles of docks small when their font is that of the application.
    return f"""
    QToolTip {{ color: {theme.text}; background: {theme.raised}; border: 1px solid {theme.border}; padding: 4px; }}
    QToolBar {{ border: none; border-bottom: 1px solid {theme.border}; spacing: 3px; padding: 4px 6px; }}
    QMenuBar {{ spacing: {0.5 * points:.0f}px; }}
    QStatusBar {{ border-top: 1px solid {theme.border}; }}
    QStatusBar::item {{ border: none; }}
    QMainWindow > QTabBar::tab {{ padding: 4px 8px; border: none; border-top: 2px solid transparent; }}
    QTabBar#lab-experiments::tab {{ border: none; border-top: 2px solid transparent; }}
    QTabBar#lab-experiments::tab {{ padding: 2px {max(3.0, 0.35 * points):.0f}px; }}
    QTabBar::tab:!selected {{ color: {theme.muted}; }}
    QTabBar::tab:selected {{ background: {theme.base}; border-top-color: {theme.accent}; }}
    QTabBar::tab:hover {{ color: {theme.text}; }}
    QDockWidget {{ font-size: {points + 0.5:.1f}pt; }}
    QDockWidget::title {{ padding: 4px 8px; background: {theme.window}; }}
    QFrame#column {{ border: 2px solid {theme.border}; border-radius: 5px; background: {theme.base}; }}
    QFrame#column[failed="true"] {{ border-color: {theme.error}; }}
    QFrame#column[chosen="true"] {{ border-color: {theme.accent}; }}
    QLabel[role="muted"] {{ color: {theme.muted}; }}
    QLabel[role="error"] {{ color: {theme.error}; }}
    QLabel[role="warning"] {{ color: {theme.warning}; }}
    QLabel[role="heading"] {{ font-weight: 600; }}
    QLabel[role="sentence"] {{ font-size: {sentence_points(points):.1f}pt; }}
    QLabel[role="figure"] {{ font-weight: 600; font-size: {points * 1.15:.1f}pt; }}
    QDialog#command-palette {{ border: 1px solid {theme.accent}; background: {theme.window}; }}
    QListWidget, QTreeWidget, QScrollArea {{ border: none; }}
    QProgressBar {{ border: none; background: {theme.raised}; border-radius: 2px; }}
    QProgressBar {{ max-height: 4px; min-height: 4px; color: transparent; }}
    QProgressBar::chunk {{ background: {theme.accent}; border-radius: 2px; }}
    QSplitter::handle {{ background: {theme.window}; }}
    QSplitter::handle:hover {{ background: {theme.accent}; }}
    {_large(theme, points)}
    """


def _large(theme: Theme, points: float) -> str:
    """Return the rules for what is to be hit and read beside large text: the style's own has one size."""
    if points < LARGE:
        return ""
    side, thin, bar = round(1.3 * points), max(3, round(0.25 * points)), round(1.1 * points)
    handle = f"width: {side}px; margin: -{(side - thin) // 2}px 0; border-radius: {thin // 2}px"
    return f"""
    QCheckBox::indicator, QRadioButton::indicator, QGroupBox::indicator {{ width: {side}px; height: {side}px; }}
    QAbstractItemView::indicator {{ width: {side}px; height: {side}px; }}
    QAbstractSpinBox::up-button, QAbstractSpinBox::down-button {{ width: {side}px; }}
    QScrollBar:vertical {{ width: {bar}px; }}
    QScrollBar:horizontal {{ height: {bar}px; }}
    QSlider:horizontal {{ min-height: {side + 2}px; }}
    QSlider::groove:horizontal {{ height: {thin}px; border-radius: {thin // 2}px; background: {theme.border}; }}
    QSlider::sub-page:horizontal {{ border-radius: {thin // 2}px; background: {theme.accent}; }}
    QSlider::handle:horizontal {{ {handle}; border: 1px solid {theme.muted}; background: {theme.raised}; }}
    QTabBar::scroller {{ width: {2 * side}px; }}
    """


def apply_theme(application: QApplication, theme: Theme) -> None:
    """Give the whole application the theme (pyqtgraph's items take theirs from ``Theme`` themselves)."""
    sheet = stylesheet(theme, application.font().pointSizeF())
    # Each call polishes every widget anew: a theme that is there already would cost half a second.
    if application.styleSheet() == sheet:
        return
    if application.property("texlab-style") is None:
        # Once: every further style would stay in memory.
        application.setStyle("Fusion")
        QPixmapCache.setCacheLimit(DRAWN_KB)
        application.setProperty("texlab-style", True)
    application.setPalette(palette(theme))
    # Fusion outlines check boxes with the darkened window colour, which a dark theme swallows.
    boxes = palette(theme)
    boxes.setColor(QPalette.ColorRole.Base, QColor(theme.border if theme.name == "dark" else theme.base))
    application.setPalette(boxes, "QCheckBox")  # type: ignore[arg-type]  # Qt wants text
    # The same outline is all that tells a field to type in from what is around it.
    fields = palette(theme)
    fields.setColor(QPalette.ColorRole.Base, QColor(theme.raised if theme.name == "dark" else theme.base))
    for kind in ("QLineEdit", "QAbstractSpinBox"):
        application.setPalette(fields, kind)  # type: ignore[arg-type]
    application.setStyleSheet(sheet)


def set_text_size(application: QApplication, points: float, theme: Theme) -> None:
    """Make all texts larger or smaller."""
    font = application.font()
    font.setPointSizeF(points)
    application.setFont(font)
    # Widgets that a style sheet has touched keep their font until it is set again.
    application.setStyleSheet(stylesheet(theme, points))


def configure_pyqtgraph() -> Any:
    """Import and configure pyqtgraph; returns the module."""
    import pyqtgraph as pg

    # Without a limit to the rate of moves, a drag ends exactly where the button goes up.
    pg.setConfigOptions(imageAxisOrder="row-major", antialias=False, useOpenGL=False, mouseRateLimit=-1)
    return pg
