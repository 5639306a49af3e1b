"""What a dock, a lesson or a script can ask for: frozen values, carried out in one place.

An intention says what is wanted and holds all that is needed for it; who carries it out is not its business.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal

if TYPE_CHECKING:
    from collections.abc import Callable

    from texlab.state.filling import FillPlan
    from texlab.state.scene import Frame
    from texlab.state.sweeps import SweepPlan
    from texlab.state.tuning import TuningPlan
    from texlab.style.pictures import Lit, Mark
    from texlab_core.documents.lessons import Lesson
    from texlab_core.engine.inputs import ImageInput, Input
    from texlab_core.engine.params import Params
    from texlab_core.sheets.sweep import Cell


@dataclass(frozen=True)
class EditParams:
    """Give a column other parameters.

    Parameters
    ----------
    column_id
        The column.
    params
        All its parameters; those of another method than the column's are not taken.
    name
        What was changed, for the undo menu.
    final
        False while a control is dragged: the column draws drafts, and the whole drag is one step of the history.
    """

    column_id: int
    params: Params
    name: str
    final: bool = True


@dataclass(frozen=True)
class EditField:
    """Give one parameter of a column another value; the others stay as they are by then."""

    column_id: int
    field: str
    value: Any
    final: bool = True


@dataclass(frozen=True)
class ChangeMethod:
    """Run another method in a column, with its defaults, and choose that column."""

    column_id: int
    method: str


@dataclass(frozen=True)
class EditInputs:
    """Give a column other further inputs (a code, a mask); ``final`` as in :class:`EditParams`."""

    column_id: int
    inputs: tuple[tuple[str, Input], ...]
    text: str
    final: bool = True


@dataclass(frozen=True)
class EditSize:
    """Give a column's result a size of its own: height and width, or depth, height and width."""

    column_id: int
    size: tuple[int, ...]


@dataclass(frozen=True)
class FillHoles:
    """Fill holes with a method, in the column that filled before or in a new one, and choose that column.

    Parameters
    ----------
    method
        Id of the method.
    inputs
        Its mask, and what else it works on.
    size
        Height and width of the result; None takes those of the tool bar.
    """

    method: str
    inputs: tuple[tuple[str, Input], ...]
    size: tuple[int, int] | None = None


@dataclass(frozen=True)
class RunFill:
    """Fill a whole picture at its own resolution; what came out is told by the scene."""

    plan: FillPlan


@dataclass(frozen=True)
class StopFill:
    """Stop the fill of a whole picture."""


@dataclass(frozen=True)
class TakeExemplar:
    """Make an image the exemplar."""

    image: ImageInput


@dataclass(frozen=True)
class TakeStage:
    """Let the panel of this name take the whole stage, or give it back."""

    dock: str


@dataclass(frozen=True)
class ChooseColumn:
    """Choose a column and bring it into view."""

    column_id: int


@dataclass(frozen=True)
class Point:
    """Ask about the pixel of a result that is under the pointer; a negative row asks about none."""

    column_id: int
    row: int
    column: int


@dataclass(frozen=True, eq=False)
class LightUp:
    """Let these pixels of the pictures light up, and no others."""

    places: tuple[Lit, ...] = ()


@dataclass(frozen=True)
class Pin:
    """Keep asking about a pixel of a result; the same pixel again lets go of it."""

    column_id: int
    row: int
    column: int


@dataclass(frozen=True)
class ShowStage:
    """Let every tab look at a stage of a column's run; None goes back to the result."""

    column_id: int
    stage: Frame | None


@dataclass(frozen=True)
class TakePicture:
    """Take what a dock shows away as a picture: put it on the clipboard, save it, or drag it elsewhere."""

    dock: str
    how: Literal["copy", "save", "drag"]


@dataclass(frozen=True)
class ShowMarks:
    """Outline these places in the exemplar, and no others."""

    marks: tuple[Mark, ...]


@dataclass(frozen=True)
class Open:
    """Open a file or a texture of the gallery (``gallery:NAME``)."""

    source: str


@dataclass(frozen=True)
class OpenFailure:
    """Open an example of the failure gallery.

    Parameters
    ----------
    name
        Of the example.
    beside
        A method whose result is wanted beside it; a column of it is added when there is none.
    """

    name: str
    beside: str = ""


@dataclass(frozen=True)
class GoToState:
    """Go back, or forward again, to a state of the session's history by its index; an index beyond it is none."""

    index: int


@dataclass(frozen=True)
class EditNotes:
    """Change the project's notes; what follows before ``final`` is the same step of the history."""

    text: str
    final: bool = True


@dataclass(frozen=True)
class OpenTab:
    """Bring a tab to the front, with its controls set by name as a user would."""

    tab: str
    settings: tuple[tuple[str, bool | int | float | str], ...] = ()


@dataclass(frozen=True)
class Tell:
    """Show one sentence in the window: good news, or a problem."""

    sentence: str
    problem: bool = False


@dataclass(frozen=True, eq=False)
class AskOnce:
    """Do something once in the background: read a file, write one, make something large.

    Parameters
    ----------
    name
        Of the thread.
    compute
        Called in a background thread with a ``should_stop`` function; it must not touch any widget. What it raises
        is shown as one sentence.
    done
        Called with what ``compute`` returned, in the thread of the window.
    """

    name: str
    compute: Callable[[Callable[[], bool]], Any]
    done: Callable[[Any], None]


@dataclass(frozen=True)
class RunSweep:
    """Run a sweep of a column's method instead of one that runs."""

    column_id: int
    plan: SweepPlan


@dataclass(frozen=True)
class StopSweep:
    """Stop the sweep; the finished cells stay."""


@dataclass(frozen=True)
class RunTuning:
    """Search for parameters of a column's method instead of a search that runs."""

    column_id: int
    plan: TuningPlan


@dataclass(frozen=True)
class StopTuning:
    """Stop the search for parameters; its points stay."""


@dataclass(frozen=True, eq=False)
class TakeCell:
    """Give a column the parameters of a cell of a sweep (and its seed, when that was varied), and choose it.

    Parameters
    ----------
    cell
        The cell.
    wanted
        Ids of columns by preference; the first with the cell's method takes them, then any other.
    """

    cell: Cell
    wanted: tuple[int, ...]


@dataclass(frozen=True)
class CellAsColumn:
    """Open a cell of a sweep as a column of its own, with its seed, behind the column ``after``, and choose it."""

    cell: Cell
    after: int = 0


@dataclass(frozen=True)
class CellInWindow:
    """Open a cell of another texture in a window of its own: all columns of this one share their exemplar."""

    cell: Cell


@dataclass(frozen=True)
class OpenLesson:
    """Give a lesson: one that comes with the program, or the name of one of the user's own."""

    name: str
    own: bool = False


@dataclass(frozen=True)
class GoToStep:
    """Show another step of the lesson, by its index; ``stay`` in the tab that is in front."""

    place: int
    stay: bool = False


@dataclass(frozen=True)
class LeaveLesson:
    """Bring the user's own session back."""


@dataclass(frozen=True)
class SaveStep:
    """Keep what the window shows as a step of the user's own lesson, behind the one that is shown."""

    sentence: str


@dataclass(frozen=True)
class NewLesson:
    """Begin a lesson of the user's own with what the window shows as its first step."""

    title: str


@dataclass(frozen=True)
class ChangeLesson:
    """Let the user's own lesson that is given be this one, and show one of its steps."""

    lesson: Lesson
    place: int


@dataclass(frozen=True)
class UndoLesson:
    """Take the last change of the user's own lesson back, or make it again."""

    redo: bool = False


@dataclass(frozen=True)
class CopyLesson:
    """Make a copy of the lesson that is given, which is the user's own."""


Intention = (
    EditParams
    | EditField
    | ChangeMethod
    | EditInputs
    | EditSize
    | FillHoles
    | RunFill
    | StopFill
    | TakeExemplar
    | TakeStage
    | ChooseColumn
    | Point
    | LightUp
    | Pin
    | ShowStage
    | TakePicture
    | ShowMarks
    | Open
    | OpenFailure
    | OpenTab
    | GoToState
    | EditNotes
    | Tell
    | AskOnce
    | RunSweep
    | StopSweep
    | RunTuning
    | StopTuning
    | TakeCell
    | CellAsColumn
    | CellInWindow
    | OpenLesson
    | GoToStep
    | LeaveLesson
    | SaveStep
    | NewLesson
    | ChangeLesson
    | UndoLesson
    | CopyLesson
)
