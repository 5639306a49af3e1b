"""The session: the state that the user has chosen, the history of its changes, and nothing computed."""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, Signal

from texlab.state.chosen import Column, State
from texlab.state.history import History
from texlab.state.sources import known_source
from texlab_core.engine.job import MAX_SEED
from texlab_core.engine.sizes import size_text

if TYPE_CHECKING:
    from texlab.state.chosen import Sample
    from texlab.state.scene import Past
    from texlab_core.engine.inputs import Input
    from texlab_core.engine.params import Params

MAX_HISTORY = 200
MAX_HISTORY_BYTES = 2**30
MAX_NAME = 80


@dataclass
class _Entry:
    state: State
    text: str
    merge: object | None = field(default=None)
    chosen: int = 0
    """The column that was chosen before the step."""


@dataclass(frozen=True, eq=False)
class Aside:
    """A state with its history and the chosen column."""

    entries: tuple[_Entry, ...]
    at: int
    selected_id: int

    @property
    def state(self) -> State:
        """The state."""
        return self.entries[self.at].state


class Session(QObject):
    """The observable session with undo and redo.

    A change with a ``merge`` key replaces the entry before it when that has the same key: a drag is one step.
    """

    changed = Signal(object, object)
    history_changed = Signal()
    selected = Signal(int)

    def __init__(self, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._entries = [_Entry(State(), "")]
        self._at = 0
        self._selected = 0
        self._history = History()
        self.history_changed.connect(self._note_history)

    @property
    def history(self) -> History:
        """The names of all steps; the same object until one of them is another."""
        return self._history

    def _note_history(self) -> None:
        texts = tuple(entry.text for entry in self._entries)
        if (texts, self._at) != (self._history.texts, self._history.at):
            self._history = History(texts, self._at)

    @property
    def state(self) -> State:
        """The present state."""
        return self._entries[self._at].state

    @property
    def selected_id(self) -> int:
        """Id of the chosen column; 0 when there is none."""
        return self._selected

    @property
    def selected_column(self) -> Column | None:
        """The chosen column."""
        return self.state.column(self._selected)

    def select(self, column_id: int) -> None:
        """Choose a column (not a step of the history)."""
        if column_id != self._selected:
            self._selected = column_id
            self.selected.emit(column_id)

    def apply(self, state: State, text: str, *, merge: object | None = None) -> None:
        """Change the state; ``text`` names the step for the undo menu."""
        before = self.state
        if state == before:
            return
        del self._entries[self._at + 1 :]
        if merge is not None and self._at > 0 and self._entries[self._at].merge == merge:
            self._entries[self._at] = _Entry(state, text, merge, self._entries[self._at].chosen)
        else:
            self._entries.append(_Entry(state, text, merge, self._selected))
            self._forget_oldest()
            self._at = len(self._entries) - 1
        self._announce(before)

    def _forget_oldest(self) -> None:
        """Keep the history short, and the pictures in it (held once each) within their limit."""
        first, held = len(self._entries), dict[int, int]()
        for entry in reversed(self._entries[-MAX_HISTORY:]):
            if entry.state.sample is not None:
                pixels = entry.state.sample.source.pixels
                held[id(pixels)] = pixels.nbytes
            if sum(held.values()) > MAX_HISTORY_BYTES and first < len(self._entries):
                break
            first -= 1
        del self._entries[:first]

    def finish_merge(self, merge: object | None = None) -> None:
        """End a drag (any, or the one with this key): the next change is a step of its own."""
        if merge is None or self._entries[self._at].merge == merge:
            self._entries[self._at].merge = None

    def set_aside(self) -> Aside:
        """Return the state with its history, to be brought back later; a lesson is given meanwhile."""
        return Aside(tuple(self._entries), self._at, self._selected)

    def bring_back(self, aside: Aside) -> None:
        """Go back to what was set aside: the state, everything that undo and redo know, and the chosen column."""
        before = self.state
        self._entries, self._at = list(aside.entries), aside.at
        if self._selected != aside.selected_id:
            self._selected = aside.selected_id
            self.selected.emit(self._selected)
        if self.state != before:
            self._announce(before)
        else:
            self.history_changed.emit()

    def replace_sample(self, one: Sample, other: Sample) -> bool:
        """Put a sample in the place of one with the same pixels, in the whole history; not a step of it.

        Return whether the present state has it now: what was cropped or scaled since is another sample.
        """
        before = self.state
        for entry in self._entries:
            if entry.state.sample is one:
                entry.state = dataclasses.replace(entry.state, sample=other)
        if self.state is not before:
            self._announce(before)
        return self.state.sample is other

    def reset_history(self) -> None:
        """Forget the history and keep the present state."""
        self._entries = [_Entry(self.state, "")]
        self._at = 0
        self.history_changed.emit()

    @property
    def undo_text(self) -> str | None:
        """What undo would take back, or None."""
        return self._entries[self._at].text if self._at > 0 else None

    @property
    def redo_text(self) -> str | None:
        """What redo would do again, or None."""
        return self._entries[self._at + 1].text if self._at + 1 < len(self._entries) else None

    def undo(self) -> None:
        """Take the last step back; a column that comes back is chosen."""
        self.go_to(self._at - 1)

    def redo(self) -> None:
        """Do the step again that was taken back last."""
        self.go_to(self._at + 1)

    def go_to(self, index: int) -> None:
        """Go to another state of the history; a column that comes back on the way back is chosen."""
        if not 0 <= index < len(self._entries) or index == self._at:
            return
        before, undone = self.state, self._entries[index + 1] if index < self._at else None
        self._at = index
        self.finish_merge()
        back = [column.id for column in self.state.columns if before.column(column.id) is None]
        if back and undone is not None:
            self._selected = undone.chosen if undone.chosen in back else back[0]
            self.selected.emit(self._selected)
        self._announce(before)

    def _announce(self, before: State) -> None:
        if self.state.column(self._selected) is None:
            gone = [column.id for column in before.columns]
            place = gone.index(self._selected) if self._selected in gone else 0
            left = self.state.columns
            self._selected = left[min(place, len(left) - 1)].id if left else 0
            self.selected.emit(self._selected)
        self.changed.emit(before, self.state)
        self.history_changed.emit()

    # Changes, one function each.

    def set_sample(self, sample: Sample, *, merge: object | None = None) -> None:
        """Choose another exemplar, or another crop or scale of it."""
        known = (each.state.sample for each in reversed(self._entries))
        source = known_source(sample.source, (each.source for each in known if each is not None))
        sample = dataclasses.replace(sample, source=source)
        same_source = self.state.sample is not None and self.state.sample.source is sample.source
        text = "crop or scale" if same_source else f"exemplar {sample.source.name}"
        before = self.state.sample
        if same_source and before is not None:
            changed = (before.levels, before.look_only) != (sample.levels, sample.look_only)
            text = "levels" if changed else text
        if self.state.sample is not None and sample.path is not None and sample.alpha != self.state.sample.alpha:
            text = "transparency"
        self.apply(dataclasses.replace(self.state, sample=sample), text, merge=merge)

    def set_seed(self, seed: int, *, merge: object | None = None) -> None:
        """Set the seed, 0 .. 2147483647."""
        self.apply(dataclasses.replace(self.state, seed=min(max(seed, 0), MAX_SEED)), f"seed {seed}", merge=merge)

    def set_size(self, size: tuple[int, int], *, merge: object | None = None) -> None:
        """Set the height and width of the results."""
        self.apply(dataclasses.replace(self.state, size=size), f"size {size[1]} x {size[0]}", merge=merge)

    def set_params(self, column_id: int, params: Params, text: str, *, merge: object | None = None) -> None:
        """Set a column's parameters; what belongs to another method is none of its business."""
        column = self.state.column(column_id)
        if column is not None and type(params) is type(column.params):
            changed = dataclasses.replace(column, params=params)
            self.apply(self.state.with_column(changed), text, merge=merge)

    def set_method(self, column_id: int, method: str, params: Params) -> None:
        """Give a column another method."""
        column = self.state.column(column_id)
        if column is not None and column.method != method:
            changed = dataclasses.replace(column, method=method, params=params, inputs=(), size=None, name="")
            self.apply(self.state.with_column(changed), f"method {method}")

    def set_column_size(self, column_id: int, size: tuple[int, ...], *, merge: object | None = None) -> None:
        """Give a column's result a size of its own."""
        column = self.state.column(column_id)
        if column is not None:
            changed = dataclasses.replace(column, size=size)
            self.apply(self.state.with_column(changed), f"size {size_text(size)}", merge=merge)

    def set_inputs(
        self, column_id: int, inputs: tuple[tuple[str, Input], ...], text: str, *, merge: object | None = None
    ) -> None:
        """Give a column other further inputs."""
        column = self.state.column(column_id)
        if column is not None:
            self.apply(self.state.with_column(dataclasses.replace(column, inputs=inputs)), text, merge=merge)

    def take_past(self, column_id: int, past: Past) -> None:
        """Give a column back what one of its finished results was made with."""
        column = self.state.column(column_id)
        if column is not None:
            self.apply(self.state.with_column(self._as_then(column, past)), "earlier result")

    def compare_past(self, column_id: int, past: Past) -> int:
        """Put an earlier result of a column into a new one behind it; returns its id, or 0."""
        copy = self.duplicate_column(column_id)
        column = self.state.column(copy)
        if column is not None:
            self.apply(self.state.with_column(self._as_then(column, past)), "earlier result")
        return copy

    def _as_then(self, column: Column, past: Past) -> Column:
        """Return a column as it was; what all columns share by now is not made its own."""
        then = dataclasses.replace(
            column, method=past.method, params=past.params, inputs=past.inputs, size=None, seed=None
        )
        size = None if self.state.size_of(then) == past.size else past.size
        seed = None if self.state.seed == past.seed else past.seed
        return dataclasses.replace(then, size=size, seed=seed)

    def add_column(self, method: str, params: Params, *, after: int | None = None) -> int:
        """Add a column behind the one with the id ``after`` (at the end without); returns its id."""
        state = self.state
        column = Column(state.next_id, method, params)
        columns = list(state.columns)
        places = [each.id for each in columns]
        columns.insert(places.index(after) + 1 if after in places else len(columns), column)
        self.apply(
            dataclasses.replace(state, columns=tuple(columns), next_id=state.next_id + 1), f"column {method}"
        )
        return column.id

    def fill(
        self, params: Params, inputs: tuple[tuple[str, Input], ...], size: tuple[int, ...] | None, method: str
    ) -> int:
        """Fill holes in the column that filled before, or in a new one at the end; returns its id."""
        state = self.state
        before = next(
            (each for each in state.columns if each.method == method and "mask" in dict(each.inputs)), None
        )
        if before is not None:
            column = dataclasses.replace(before, params=params, inputs=inputs, size=size)
            self.apply(state.with_column(column), "fill")
            return column.id
        column = Column(state.next_id, method, params, inputs, size)
        self.apply(dataclasses.replace(state, columns=(*state.columns, column), next_id=state.next_id + 1), "fill")
        return column.id

    def duplicate_column(self, column_id: int) -> int:
        """Add a copy of a column behind it; returns the copy's id, or 0."""
        column = self.state.column(column_id)
        if column is None:
            return 0
        state = self.state
        copy = dataclasses.replace(column, id=state.next_id, name="", pinned=False)
        place = state.columns.index(column) + 1
        # Behind all that are pinned.
        place = max(place, sum(each.pinned for each in state.columns))
        columns = (*state.columns[:place], copy, *state.columns[place:])
        self.apply(dataclasses.replace(state, columns=columns, next_id=state.next_id + 1), "duplicate column")
        return copy.id

    def remove_column(self, column_id: int) -> None:
        """Remove a column."""
        columns = tuple(column for column in self.state.columns if column.id != column_id)
        self.apply(dataclasses.replace(self.state, columns=columns), "remove column")

    def set_columns(self, columns: list[tuple[str, Params]], text: str) -> None:
        """Put other columns in the place of all."""
        state = self.state
        made = tuple(Column(state.next_id + place, name, params) for place, (name, params) in enumerate(columns))
        pinned = tuple(column for column in state.columns if column.pinned)
        self.apply(dataclasses.replace(state, columns=pinned + made, next_id=state.next_id + len(made)), text)

    def rename_column(self, column_id: int, name: str) -> None:
        """Call a column by a name of its own; an empty one leaves it to what differs from other columns."""
        column = self.state.column(column_id)
        if column is not None:
            name = " ".join(name.split())[:MAX_NAME]
            text = f"name {name}" if name else "name by what differs"
            self.apply(self.state.with_column(dataclasses.replace(column, name=name)), text)

    def pin_column(self, column_id: int, pinned: bool) -> None:
        """Keep a column in front and when others replace all columns, or no longer."""
        column = self.state.column(column_id)
        if column is not None and column.pinned != pinned:
            columns = self.state.with_column(dataclasses.replace(column, pinned=pinned)).columns
            ordered = tuple(sorted(columns, key=lambda each: not each.pinned))
            text = "pin column" if pinned else "unpin column"
            self.apply(dataclasses.replace(self.state, columns=ordered), text)

    def set_column_seed(self, column_id: int, seed: int | None, *, merge: object | None = None) -> None:
        """Give a column a seed of its own, 0 .. 2147483647; None shares the session's."""
        column = self.state.column(column_id)
        if column is not None:
            seed = None if seed is None else min(max(seed, 0), MAX_SEED)
            text = "shared seed" if seed is None else f"seed {seed} of one column"
            self.apply(self.state.with_column(dataclasses.replace(column, seed=seed)), text, merge=merge)

    def move_column(self, column_id: int, by: int) -> None:
        """Move a column by so many places to the right (left when negative)."""
        columns = list(self.state.columns)
        places = [each.id for each in columns]
        if column_id not in places:
            return
        old = places.index(column_id)
        new = min(max(old + by, 0), len(columns) - 1)
        columns.insert(new, columns.pop(old))
        # The pinned ones stay in front.
        ordered = tuple(sorted(columns, key=lambda each: not each.pinned))
        self.apply(dataclasses.replace(self.state, columns=ordered), "move column")
