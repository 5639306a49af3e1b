"""What can be done to one column: declared once for its own menu, the window's menus, the palette and the keys."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Command:
    """A command of the window.

    Parameters
    ----------
    menu, name, text, keys, help
        Where it is found in the menus, its name, text, keys and explanation.
    checkable
        It is on or off.
    separator
        A line goes before it in the menu.
    own
        Its text in the column's own menu; "" keeps it out of there.
    apart
        A line goes before it in the column's own menu.
    """

    menu: str
    name: str
    text: str
    keys: str = ""
    help: str = ""
    checkable: bool = False
    separator: bool = False
    own: str = ""
    apart: bool = False


COLUMN_COMMANDS = {
    command.name: command
    for command in (
        Command(
            "&Column", "go-on", "&Go on", "F6", "Go on from where it stands, also at a larger size",
            own="Go on from here",
        ),
        Command(
            "&Column", "duplicate", "&Duplicate column", "Ctrl+D", "Copy the chosen column to compare settings",
            own="Duplicate column",
        ),
        Command(
            "&Column", "left", "Mov&e left", "Ctrl+Shift+Left", "Move the chosen column to the left",
            own="Move left",
        ),
        Command(
            "&Column", "right", "Move r&ight", "Ctrl+Shift+Right", "Move the chosen column to the right",
            own="Move right",
        ),
        Command(
            "&File", "export", "&Save result ...", "Ctrl+S", "Save the chosen column's result with its recipe",
            own="Save result ...", apart=True,
        ),
        Command(
            "&Edit", "copy", "&Copy picture", "Ctrl+C", "Copy the chosen column's picture", separator=True,
            own="Copy picture",
        ),
        Command(
            "&Column", "use", "Use result as e&xemplar", "", "Make the chosen column's result the exemplar",
            own="Use result as exemplar",
        ),
        Command(
            "&Column", "enlarge", "Enlarge column", "M", "Show the chosen column alone, or all of them again",
            own="Enlarge, or put back", apart=True,
        ),
        Command(
            "&Column", "apart", "Column in its o&wn window", "Shift+M",
            "Give the chosen column a window of its own, or put it back on the stage",
            own="In a window of its own, or back",
        ),
        Command(
            "&Column", "rename", "Rename column ...", "F2", "Call the chosen column by a name of its own",
            own="Rename ...",
        ),
        Command(
            "&Column", "history", "Earlier results ...", "H", "The finished results of the column, to go back to",
            own="Earlier results ...",
        ),
        Command(
            "&Column", "pin", "Pin column", "P", "Keep the chosen column in front, and when others replace all",
            own="Pin in front", checkable=True,
        ),
        Command(
            "&Column", "own-seed", "Seed of its own", "", "The dice for all columns leaves this column's seed",
            own="Lock the seed", checkable=True, apart=True,
        ),
        Command(
            "&Column", "new-seed", "New seed for this column", "Shift+D", "Another seed for this column alone",
            own="New seed for this column",
        ),
        Command(
            "&Column", "remove", "&Remove column", "Ctrl+W", "Remove the chosen column",
            own="Remove column", apart=True,
        ),
        Command("&Column", "run", "R&un column", "F5", "Run the chosen column again", separator=True),
        Command("&Column", "stop", "&Stop column", "Esc", "Stop the chosen column"),
        Command("&Edit", "reset", "R&eset parameters", "", "Defaults for the chosen column"),
    )
}  # fmt: skip
"""By name, those of the column's own menu in its order."""
