"""Every command of the window, declared once: text, keys, explanation."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtGui import QAction, QKeySequence

from texlab.columns.commands import COLUMN_COMMANDS, Command
from texlab.widgets.plain import set_tip

if TYPE_CHECKING:
    from PySide6.QtWidgets import QWidget


_OF = COLUMN_COMMANDS
COMMANDS = (
    Command("&File", "open", "&Open image ...", "Ctrl+O", "Open an image, or a saved result with its recipe"),
    Command("&File", "paste", "&Paste image", "Ctrl+V", "Use the image on the clipboard as exemplar"),
    _OF["export"],
    Command("&File", "save-tab", "Save the &tab's picture ...", "Ctrl+Shift+S", "Save what the open tab shows"),
    Command("&File", "export-many", "&Export ...", "Ctrl+E", "Write results as files, a figure or an animation"),
    Command("&File", "save-project", "Save pro&ject ...", "Ctrl+Alt+S", "Keep everything in one file"),
    Command("&File", "student-copy", "Save a copy for a st&udent ...", "", "Without paths of this computer"),
    Command("&File", "batch", "Run for &many ...", "", "Run the columns' methods on many images, or a plan"),
    Command("&File", "forget-results", "&Forget kept results", "", "Remove finished results from the disk"),
    Command("&File", "another-window", "Another &window", "Ctrl+N", "Open a window with a session of its own"),
    Command("&File", "quit", "&Quit", "Ctrl+Q", "Close the window; the session comes back", separator=True),
    Command("&Edit", "undo", "&Undo", "Ctrl+Z", "Take the last change back"),
    Command("&Edit", "redo", "&Redo", "Ctrl+Shift+Z", "Do it again"),
    _OF["copy"],
    Command("&Edit", "copy-tab", "Copy the ta&b's picture", "Ctrl+Shift+C", "Copy what the open tab shows"),
    Command("&Edit", "dice", "&New seed", "D", "Another seed for all columns"),
    _OF["reset"],
    Command("&Edit", "palette", "Command &palette ...", "Ctrl+K", "Find any command by its name", separator=True),
    Command("&Column", "add", "&Add column", "Ctrl+T", "Add a column"),
    _OF["duplicate"],
    _OF["remove"],
    _OF["use"],
    _OF["enlarge"],
    _OF["apart"],
    _OF["rename"],
    _OF["history"],
    _OF["pin"],
    _OF["own-seed"],
    _OF["new-seed"],
    _OF["left"],
    _OF["right"],
    Command("&Column", "four", "The &four methods", "", "Heeger-Bergen, De Bonet, MSG, Efros-Leung side by side"),
    Command("&Column", "spectra", "Compare s&pectra", "", "Uncoded, MSG, CAR and AC-H with one phase (Fig. 8)"),
    Command("&Column", "previous", "Pre&vious column", "Ctrl+PgUp", "Choose the column to the left"),
    Command("&Column", "next", "&Next column", "Ctrl+PgDown", "Choose the column to the right"),
    _OF["run"],
    _OF["go-on"],
    _OF["stop"],
    Command("&Column", "run-all", "Run a&ll", "Shift+F5", "Run every column"),
    Command("&Column", "stop-all", "S&top all", "Shift+Esc", "Stop every column"),
    Command("&Lesson", "lessons", "&Lessons", "Ctrl+L", "Show the list of lessons"),
    Command("&Lesson", "lesson-next", "&Next step", "PgDown", "Go on with the lesson", separator=True),
    Command("&Lesson", "lesson-back", "&Previous step", "PgUp", "Go back in the lesson"),
    Command("&Lesson", "lesson-leave", "Lea&ve the lesson", "Ctrl+Shift+L", "Bring your own session back"),
    Command(
        "&Lesson",
        "popout",
        "Pop-&out test ...",
        "Ctrl+Shift+O",
        "Find the piece of the original in what the columns make",
        separator=True,
    ),
    Command("&View", "fit", "&Fit", "F", "Show the pictures whole"),
    Command("&View", "actual", "&Actual size", "1", "One image pixel per screen pixel"),
    Command("&View", "zoom-in", "Zoom &in", "+", "Enlarge"),
    Command("&View", "zoom-out", "Zoom &out", "-", "Reduce"),
    Command("&View", "link", "Link exemplar and results", "L", "Pan and zoom both together", True),
    Command("&View", "tile", "&Tile 2 x 2", "T", "Show every result four times, so that seams are seen", True),
    Command("&View", "crop", "&Crop box", "X", "Use a part of the exemplar", True),
    Command(
        "&View", "flicker", "A and B: flicker", "B", "B in the place of A; the same key shows A again", True, True
    ),
    Command("&View", "swipe", "A and B: swipe", "W", "A left of a line that is dragged, B right of it", True),
    Command("&View", "difference", "A and B: difference", "G", "What differs; black is equal", True),
    Command("&View", "magnifier", "Magnifier", "Z", "The place under the pointer, large in all pictures", True),
    Command(
        "&View",
        "rows-largest",
        "Rows: largest pictures",
        "",
        "As many rows as make the pictures largest",
        separator=True,
    ),
    Command("&View", "rows-one", "Rows: one", "", "All pictures in one row"),
    Command("&View", "rows-two", "Rows: two", "", "The pictures in two rows"),
    Command(
        "&View",
        "surround-grey",
        "Surround: grey",
        "",
        "A neutral middle grey around the pictures",
        separator=True,
    ),
    Command("&View", "surround-theme", "Surround: of the theme", "", "The theme's colour around the pictures"),
    Command("&View", "surround-black", "Surround: black", "", "Black around the pictures"),
    Command("&View", "surround-white", "Surround: white", "", "White around the pictures"),
    Command(
        "&View",
        "panels",
        "Panels below: open or close",
        "F4",
        "Show the panels, or only their names",
        separator=True,
    ),
    Command("&View", "big-panel", "Panel over the stage", "Shift+F4", "The open panel large, or back"),
    Command("&View", "theme-auto", "Theme of the &system", "", "Follow the system", separator=True),
    Command("&View", "theme-light", "&Light theme", "", "Light"),
    Command("&View", "theme-dark", "&Dark theme", "", "Dark"),
    Command("&View", "layout-explore", "Layout &Explore", "Ctrl+1", "Everything in sight", separator=True),
    Command("&View", "layout-teach", "Layout Teac&h", "Ctrl+2", "Large: the images and one dock, for a projector"),
    Command("&View", "layout-tune", "Layout T&une", "Ctrl+3", "Exemplar, A and B large, with their parameters"),
    Command("&View", "own-layouts", "O&wn layouts ...", "", "Keep how panels and tabs are, or go back to that"),
    Command("&Teach", "full-screen", "&Full screen", "F11", "The whole screen, without menus", True),
    Command("&Teach", "notes", "&Presenter's window", "F12", "Notes, next step, controls and clock", True),
    Command("&Teach", "text-larger", "&Larger text", "Ctrl++", "Larger text everywhere"),
    Command("&Teach", "text-smaller", "&Smaller text", "Ctrl+-", "Smaller text everywhere"),
    Command("&Teach", "text-usual", "&Usual text", "Ctrl+0", "Text of the usual size"),
    Command("&Teach", "next-tab", "&Next tab", "F8", "Go to the next tab", separator=True),
    Command("&Teach", "previous-tab", "Pre&vious tab", "Shift+F8", "Go to the tab before"),
    Command("&Teach", "tab-alone", "Tab &alone", "F3", "The open tab without the pictures, or with them", True),
    Command("&Teach", "tab-controls", "&Controls of the tab", "F7", "In Teach: with its controls, or without"),
    Command("&Teach", "overlay-gallery", "&Gallery", "F9", "The gallery; in Teach, over the pictures"),
    Command("&Teach", "overlay-parameters", "Pa&rameters", "F10", "The parameters; in Teach, over the pictures"),
    Command(
        "&Teach", "beside", "&Keep column in sight", "K", "In Teach: others come beside it", True, separator=True
    ),
    *(
        Command(
            "&Teach",
            f"sight-{place}",
            f"Column &{place}: show or hide" if place else "Exemplar: show or hide",
            f"Alt+{place}",
            f"In Teach: show or hide {f'column {place}' if place else 'the exemplar'}",
        )
        for place in range(10)
    ),
    Command("&Teach", "halo", "&Halo", "O", "A ring around the pointer", True, True),
    Command("&Teach", "spotlight", "Sp&otlight", "S", "Darken all but what is around the pointer", True),
    Command("&Teach", "ink", "&Draw", "I", "Draw on the window with the mouse", True),
    Command("&Teach", "ink-undo", "Take the last line &back", "Backspace", "Take the last drawn line back"),
    Command("&Teach", "ink-clear", "&Wipe", "Shift+Backspace", "Wipe all drawn lines away"),
    Command("&Help", "help", "&Help", "F1", "Explain the chosen method"),
    Command("&Help", "help-window", "The &window", "", "Explain the window"),
    Command("&Help", "shortcuts", "&Keyboard", "", "List the keys"),
    Command("&Help", "failures", "Failure &gallery ...", "", "Open an example of what the papers say fails"),
    Command("&Help", "about", "&About TexLab", "", "Version and licence"),
)


def make_actions(owner: QWidget) -> dict[str, QAction]:
    """Return an action for every command, by name."""
    made = {}
    for command in COMMANDS:
        action = QAction(command.text, owner)
        action.setObjectName(f"action-{command.name}")
        action.setCheckable(command.checkable)
        if command.keys:
            action.setShortcut(QKeySequence(command.keys))
        keys = f" ({action.shortcut().toString(QKeySequence.SequenceFormat.NativeText)})" if command.keys else ""
        set_tip(action, f"{command.help or plain(command.text)}{keys}")
        action.setStatusTip(command.help)
        made[command.name] = action
        owner.addAction(action)
    return made


def plain(text: str) -> str:
    """Return a menu text without its marks."""
    return text.replace("&", "").replace(" ...", "")
