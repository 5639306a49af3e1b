"""Where presets are kept: a user's own in a folder, one file each, and those that come with the program."""

from __future__ import annotations

import dataclasses
import os
import re
import threading
from pathlib import Path

from texlab_core.documents.presets import (
    Preset,
    PresetError,
    check_name,
    pick,
    preset_from_json,
    read_preset,
    write_preset,
)
from texlab_core.files.resources import resource
from texlab_core.files.strict_json import MAX_BYTES, loads

_MAX_STEM = 240


class PresetStore:
    """The presets in one folder.

    A file that cannot be used is left alone and reported by :meth:`problems`. Names are looked up in the files, so
    files may be called anything and copied by hand.

    Parameters
    ----------
    folder
        Made when the first preset is saved.
    """

    def __init__(self, folder: str | os.PathLike[str]) -> None:
        self.folder = Path(folder)
        self._lock = threading.RLock()

    def presets(self, method: str | None = None) -> tuple[Preset, ...]:
        """Return the usable presets (of one method), by method and name; of equal ones the first file counts."""
        found: dict[tuple[str, str], Preset] = {}
        for each in self._read()[0].values():
            if method is None or each.method == method:
                found.setdefault(each.key, each)
        return tuple(found[key] for key in sorted(found))

    def problems(self) -> tuple[str, ...]:
        """Return one sentence for each file that cannot be used."""
        return self._read()[1]

    def load(self, name: str, method: str | None = None) -> Preset:
        """Return a preset by name; raises ``PresetError`` if there is none, or several (``presets.pick``)."""
        return pick(self.presets(method), name, method)

    def save(self, preset: Preset, *, replace: bool = False) -> Path:
        """Keep a preset and return its file.

        Raises
        ------
        PresetError
            When there is one of this method and name already and ``replace`` is false, or it cannot be written.
        """
        with self._lock:
            path = self._file_of(preset.key)
            if path is not None and not replace:
                raise PresetError(f"There is a preset of {preset.method} called {preset.name} already.")
            path = self._free_path(preset) if path is None else path
            try:
                self.folder.mkdir(parents=True, exist_ok=True)
            except OSError as bad:
                raise PresetError(f"{self.folder}: cannot be made ({bad.strerror}).") from bad
            write_preset(preset, path)
            return path

    def rename(self, name: str, new_name: str, method: str | None = None) -> Preset:
        """Give a preset another name; raises ``PresetError`` when the new one is taken or no name."""
        with self._lock:
            old = self.load(name, method)
            new = dataclasses.replace(old, name=check_name(new_name))
            if new.key == old.key:
                self.save(new, replace=True)
            else:
                # Written first: a failure leaves the old one, never none.
                self.save(new)
                self._remove(old)
            return new

    def delete(self, name: str, method: str | None = None) -> Preset:
        """Delete a preset and return what it was, so that the deletion can be undone by saving it."""
        with self._lock:
            old = self.load(name, method)
            self._remove(old)
            return old

    def import_file(
        self, path: str | os.PathLike[str], *, name: str | None = None, replace: bool = False
    ) -> Preset:
        """Keep a copy of a preset file (under another name), after checking all of it."""
        if not os.fspath(path):
            raise PresetError("The name of the preset's file is empty.")
        preset = read_preset(Path(path))
        if name is not None:
            preset = dataclasses.replace(preset, name=check_name(name))
        self.save(preset, replace=replace)
        return preset

    def export(
        self, name: str, path: str | os.PathLike[str], method: str | None = None, *, replace: bool = False
    ) -> Path:
        """Write a preset to a file of the user's choice; into a folder, under the name it would have here."""
        preset = self.load(name, method)
        return export_preset(preset, path, replace=replace)

    def _read(self) -> tuple[dict[Path, Preset], tuple[str, ...]]:
        found: dict[Path, Preset] = {}
        problems = []
        with self._lock:
            for path in self._paths():
                try:
                    found[path] = read_preset(path)
                except PresetError as bad:
                    problems.append(str(bad))
        return found, tuple(problems)

    def _paths(self) -> list[Path]:
        try:
            return sorted(path for path in self.folder.iterdir() if path.suffix == ".json" and path.is_file())
        except OSError:
            return []

    def _file_of(self, key: tuple[str, str]) -> Path | None:
        return next((path for path, preset in self._read()[0].items() if preset.key == key), None)

    def _free_path(self, preset: Preset) -> Path:
        stem = file_name(preset).removesuffix(".json")
        # Compared without case: on Windows and macOS two such names are one file.
        taken = {path.name.casefold() for path in self.folder.iterdir()} if self.folder.is_dir() else set()
        number = 1
        while (name := f"{stem}.json" if number == 1 else f"{stem} {number}.json").casefold() in taken:
            number += 1
        return self.folder / name

    def _remove(self, preset: Preset) -> None:
        for path, each in self._read()[0].items():
            if each.key == preset.key:
                try:
                    path.unlink()
                except OSError as bad:
                    raise PresetError(f"The preset {preset.name} cannot be deleted ({bad.strerror}).") from bad


def file_name(preset: Preset) -> str:
    """Return a file name that every system accepts ("de-bonet-paper.json")."""
    # The method in front also keeps clear of the names that Windows gives to devices.
    name = re.sub(r'[<>:"|?*%]', lambda match: f"%{ord(match[0]):02x}", preset.name)
    # A name has at most 255 bytes on most systems; a few are left for a number.
    stem = f"{preset.method}-{name}".encode()[:_MAX_STEM].decode(errors="ignore").rstrip(" .")
    return f"{stem}.json"


def export_preset(preset: Preset, path: str | os.PathLike[str], *, replace: bool = False) -> Path:
    """Write a preset to a file, or into a folder under its own name; return the file."""
    target = Path(path)
    if target.is_dir():
        target = target / file_name(preset)
    write_preset(preset, target, replace=replace)
    return target


def bundled_presets(method: str | None = None) -> tuple[Preset, ...]:
    """Return the presets that come with the program (of one method), by method and name."""
    found = []
    for file in resource("presets").iterdir():
        if file.name.endswith(".json"):
            what = f"the bundled preset {file.name}"
            with file.open("rb") as opened:
                source = opened.read(MAX_BYTES + 1)
            found.append(preset_from_json(loads(source, what=what, error=PresetError), what=what))
    return tuple(sorted((each for each in found if method in (None, each.method)), key=lambda each: each.key))


def find_preset(source: str, store: PresetStore, method: str | None = None) -> Preset:
    """Return what ``FILE|NAME`` means: a file ending in ``.json``, else the user's own, else a bundled one.

    Raises
    ------
    PresetError
        When there is none, or it is for another method.
    """
    if source.lower().endswith(".json"):
        preset = read_preset(Path(source))
        if method is not None and preset.method != method:
            raise PresetError(f"The preset {preset.name} is for the method {preset.method}, not for {method}.")
        return preset
    return pick(store.presets(method) + bundled_presets(method), source, method)
