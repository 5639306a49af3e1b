"""What is remembered between two starts: window, theme, recent files and the session."""

from __future__ import annotations

import json
import logging
from typing import TYPE_CHECKING, Any

from texlab.state.session import MAX_NAME
from texlab.storage.kept_exemplar import file_name, has_no_home
from texlab.storage.kept_inputs import input_to_json, kept_folder, load_input
from texlab.storage.paths import config_dir
from texlab.storage.sessions import writing
from texlab_core.engine.job import DEFAULT_SIZE, check_seed, check_size
from texlab_core.engine.registry import EXEMPLAR, methods
from texlab_core.errors import InputError
from texlab_core.files import strict_json
from texlab_core.files.regular import read_regular, reason
from texlab_core.files.whole import write_whole

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from texlab.state.chosen import Column, State
    from texlab_core.engine.inputs import Input
    from texlab_core.engine.params import Params
    from texlab_core.engine.registry import Method

    # Method, parameters, further inputs and the column's own size; name, pin and its own seed.
    SavedColumn = tuple[str, Params, tuple[tuple[str, Input], ...], tuple[int, ...] | None, str, bool, int | None]

log = logging.getLogger(__name__)

RECENT = "recent"
# Where versions with one session for all windows kept it.
OLD_SESSION = "session"
MAX_RECENT = 10
MAX_BYTES = 2**25
MAX_DEPTH = 64
# More than anybody lays side by side; a damaged file must not start thousands.
MAX_COLUMNS = 100


class Settings:
    """A small JSON file that may be missing, old or broken: then the defaults hold.

    All windows share it: only the values that this window has changed replace those in the file.

    Parameters
    ----------
    kept
        False for a window that neither reads nor writes it.
    """

    def __init__(self, *, kept: bool = True) -> None:
        self._path = config_dir() / "settings.json"
        self.kept = kept
        self.values: dict[str, Any] = {}
        self.problem = ""
        try:
            self.values = self._read() if kept else {}
        except OSError as error:
            self.problem = f"The settings could not be read ({reason(error)}); the defaults hold."
        except InputError:
            self._put_aside()
        # What the file held when this window last read or wrote it.
        self._known = dict(self.values)

    def _read(self) -> dict[str, Any]:
        try:
            text = read_regular(self._path, MAX_BYTES)
        except FileNotFoundError:
            return {}
        loaded = strict_json.loads(text, max_bytes=MAX_BYTES, max_depth=MAX_DEPTH)
        if not isinstance(loaded, dict):
            raise InputError("It is no object.")
        return loaded

    def _put_aside(self) -> None:
        broken = self._path.with_suffix(".broken.json")
        self.problem = f"The settings are damaged; the defaults hold. The file was kept as {broken}."
        try:
            self._path.replace(broken)
        except OSError:
            self.problem = f"The settings in {self._path} are damaged; the defaults hold."

    def text(self, name: str, default: str = "") -> str:
        """Return a text, or the default."""
        value = self.values.get(name)
        return value if isinstance(value, str) else default

    @property
    def recent(self) -> list[str]:
        """Paths opened lately, the latest first."""
        return _recent(self.values)

    def add_recent(self, path: str) -> None:
        """Put a path first among the recent ones."""
        self.values[RECENT] = [path, *(other for other in self.recent if other != path)][:MAX_RECENT]

    def save(self) -> None:
        """Write the file; a failure is logged, never shown: nothing the user made is lost by it."""
        self.write(dict(self.values))

    def write(self, values: Mapping[str, Any]) -> bool:
        """Write what has changed of these values, in one thread at a time, and return whether it was written."""
        if not self.kept:
            return True
        try:
            self._path.parent.mkdir(parents=True, exist_ok=True)
            # Without the lock the file is whole all the same, and at worst lacks what another window just changed.
            with writing("settings"):
                merged = self._merged(values)
                write_whole(self._path, json.dumps(merged, indent=1).encode())
        except (OSError, InputError) as error:
            log.warning("The settings could not be saved: %s", error)
            return False
        self._known = dict(values)
        return True

    def _merged(self, values: Mapping[str, Any]) -> dict[str, Any]:
        try:
            merged = self._read()
        except InputError:
            merged = {}
        for name in self._known.keys() - values.keys():
            merged.pop(name, None)
        theirs = _recent(merged)
        merged |= {name: value for name, value in values.items() if self._known.get(name, self) != value}
        if RECENT in merged:
            merged[RECENT] = list(dict.fromkeys([*_recent(merged), *theirs]))[:MAX_RECENT]
        return merged


def _recent(values: Mapping[str, Any]) -> list[str]:
    value = values.get(RECENT)
    listed = value if isinstance(value, list) else []
    return [path for path in listed if isinstance(path, str)][:MAX_RECENT]


def session_to_json(state: State, selected: int) -> dict[str, Any]:
    """Return the session as JSON: names, numbers and hashes, not pixels."""
    sample: dict[str, Any] | None = None
    if state.sample is not None:
        crop = state.sample.crop
        sample = {
            "name": state.sample.source.name,
            "path": state.sample.path,
            "scale": state.sample.scale,
            "alpha": state.sample.alpha,
            "crop": None if crop is None else [crop.top, crop.left, crop.height, crop.width],
        }
        if state.sample.levels is not None:
            sample["levels"] = state.sample.levels.to_json()
            sample["look_only"] = state.sample.look_only
        if has_no_home(state.sample):
            sample["kept"] = file_name(state.sample.source)
    places = [column.id for column in state.columns]
    return {
        "sample": sample,
        "columns": [column_to_json(column) for column in state.columns],
        "seed": state.seed,
        "size": list(state.size),
        "selected": places.index(selected) if selected in places else 0,
        "notes": state.notes,
    }


def column_to_json(column: Column) -> dict[str, Any]:
    """Return a column as JSON; of its further inputs, documents whole and of arrays what leads to their files."""
    saved: dict[str, Any] = {"method": column.method, "params": column.params.to_json()}
    if column.inputs:
        saved["inputs"] = {name: input_to_json(each) for name, each in column.inputs}
    if column.size is not None:
        saved["size"] = list(column.size)
    if column.name:
        saved["name"] = column.name
    if column.pinned:
        saved["pinned"] = True
    if column.seed is not None:
        saved["seed"] = column.seed
    return saved


def columns_from_json(data: Any, tell: Callable[[str], None] = log.warning) -> list[SavedColumn]:
    """Return the columns of a saved session; what does not fit any more is left out.

    A column whose further input is damaged or gone comes without it, and ``tell(sentence)`` says so.
    """
    found: list[SavedColumn] = []
    listed = data.get("columns") if isinstance(data, dict) else None
    for each in (listed if isinstance(listed, list) else [])[:MAX_COLUMNS]:
        try:
            method = methods()[each["method"]]
            params = method.params.from_json(each["params"])
            size = None if each.get("size") is None else check_size(tuple(each["size"]), method.dimensions)
            inputs = _inputs_from_json(each.get("inputs", {}), method, tell)
            found.append((method.id, params, inputs, size, *_labels_from_json(each)))
        except (InputError, AttributeError, KeyError, TypeError, ValueError) as error:
            log.warning("A column of the last session was left out: %s", error)
    return found


def has_kept_inputs(data: Any) -> bool:
    """Return whether a saved session names further inputs, which have to be read from files."""
    listed = data.get("columns") if isinstance(data, dict) else None
    return isinstance(listed, list) and any(isinstance(each, dict) and each.get("inputs") for each in listed)


def _labels_from_json(each: Any) -> tuple[str, bool, int | None]:
    name, seed = each.get("name", ""), each.get("seed")
    if not isinstance(name, str) or len(name) > MAX_NAME:
        raise ValueError(f"a name must be a text of at most {MAX_NAME} characters")
    return name, each.get("pinned") is True, None if seed is None else check_seed(seed)


def _inputs_from_json(saved: Any, method: Method, tell: Callable[[str], None]) -> tuple[tuple[str, Input], ...]:
    inputs: list[tuple[str, Input]] = []
    for spec in method.inputs:
        if spec.name not in saved or spec.name == EXEMPLAR.name:
            continue
        try:
            inputs.append((spec.name, load_input(saved[spec.name], spec.kind, kept_folder())))
        except InputError as error:
            log.warning("The input %s of the last session was left out: %s", spec.name, error)
            tell(f"The {spec.name} of {method.title} could not be brought back; the column starts without it.")
    return tuple(inputs)


def notes_of(data: Any) -> str:
    """Return the notes of a saved session, or none."""
    from texlab_core.documents.project import MAX_NOTE

    notes = data.get("notes", "") if isinstance(data, dict) else ""
    return notes if isinstance(notes, str) and len(notes) <= MAX_NOTE else ""


def seed_and_size(data: Any) -> tuple[int, tuple[int, int]]:
    """Return seed and size of a saved session, or the defaults."""
    try:
        return check_seed(data["seed"]), check_size(tuple(data["size"]))
    except (InputError, KeyError, TypeError):
        return 1, DEFAULT_SIZE
