"""The folder where tests are kept: one document for each, written whole after every answer."""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from texlab_core.errors import InputError
from texlab_core.files import strict_json
from texlab_core.files.whole import write_whole
from texlab_core.popout.record import Record, read_record

if TYPE_CHECKING:
    import datetime
    from pathlib import Path

# Below the folder of settings.
FOLDER = "popout"
# More are never read at once; a test is a few kilobytes.
MOST = 5000
_NAME = re.compile(r"[0-9A-Za-z-]{1,80}")


@dataclass(frozen=True)
class Kept:
    """Tests that could be read, by name in the order of time, and one sentence for each that could not."""

    records: tuple[tuple[str, Record], ...] = ()
    problems: tuple[str, ...] = field(default=())


class PopoutStore:
    """Keeps tests in a folder (made when the first one comes).

    Parameters
    ----------
    folder
        Where.
    """

    def __init__(self, folder: Path) -> None:
        self.folder = folder

    def new_name(self, now: datetime.datetime) -> str:
        """Return the name of a test that begins: date and time, and a number where that is taken."""
        first = now.strftime("%Y-%m-%d-%H%M%S")
        name, number = first, 1
        while (self.folder / f"{name}.json").exists():
            number += 1
            name = f"{first}-{number}"
        return name

    def save(self, name: str, record: Record) -> Path:
        """Write a test under its name, instead of what was there; raises ``InputError`` when it cannot be."""
        if not _NAME.fullmatch(name):
            raise InputError(
                f"The name of a test has letters, digits and hyphens, got {strict_json.shorten(name)}."
            )
        path = self.folder / f"{name}.json"
        try:
            self.folder.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise InputError(f"{self.folder}: cannot be made ({error.strerror}).") from error
        write_whole(path, strict_json.dumps(record.to_json()).encode())
        return path

    def all(self) -> Kept:
        """Read every test; what is damaged or gone is said and left out."""
        try:
            paths = sorted(self.folder.glob("*.json"), key=lambda path: path.stem)[:MOST]
        except OSError:
            paths = []
        records, problems = [], []
        for path in paths:
            try:
                records.append((path.stem, read_record(path)))
            except InputError as error:
                problems.append(str(error))
        return Kept(tuple(records), tuple(problems))
