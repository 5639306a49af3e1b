"""The script that measures De Bonet's defaults, and what it found."""

from __future__ import annotations

from typing import TYPE_CHECKING

from texlab_core.figures import defaults
from texlab_core.figures.defaults import COLUMNS, SETTINGS, Row, homogeneous, measured, shortfalls, table
from texlab_core.files.resources import resource
from texlab_core.images.gallery import gallery

if TYPE_CHECKING:
    from pathlib import Path

    import pytest

HELP = resource("help/de-bonet.md").read_text(encoding="utf-8")


def rows_of(text: str) -> list[Row]:
    """Read a table as it stands in the help page."""
    lines = [line.strip("| ").split(" | ") for line in text.strip().splitlines()]
    assert lines[0] == ["setting", *(head for _, head, _ in COLUMNS)]
    names = [name for name, _, _ in COLUMNS]
    return [Row(line[0], dict(zip(names, map(float, line[1:]), strict=True))) for line in lines[2:]]


def test_the_table_of_the_help_page_reaches_the_bar() -> None:
    written = defaults._TABLE.search(HELP)
    assert written is not None
    rows = rows_of(written[0])
    assert [row.setting for row in rows] == list(SETTINGS)
    assert table(rows) == written[0].strip()
    assert shortfalls(rows) == []


def test_what_falls_short_is_said() -> None:
    good = {"tile-share": 0.2, "cuts": 5.0, "own-cuts": 6.0, "discriminability": -4.2, "time": 1.2}
    former = Row("shifted, alpha 0.30", good | {"discriminability": -4.0})
    assert shortfalls([Row("defaults", good), former]) == []
    bad = {"tile-share": 0.35, "cuts": 6.1, "own-cuts": 6.0, "discriminability": -3.9, "time": 1.6}
    found = shortfalls([Row("defaults", bad), former])
    assert len(found) == 4
    assert found[0] == "The median tile share of the defaults is 0.35 and may be at most 0.35."
    assert found[2] == "The median D of the defaults is -3.90 and may be at most -4.00."


def test_the_script_writes_the_table_and_fails_below_the_bar(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    rows = rows_of(defaults._TABLE.search(HELP)[0])
    page, other = tmp_path / "page.md", tmp_path / "other.md"
    page.write_text(HELP.replace("| defaults |", "| outdated |"), encoding="utf-8")
    other.write_text("# Nothing", encoding="utf-8")
    monkeypatch.setattr(defaults, "measured", lambda names: rows)
    monkeypatch.setattr("sys.argv", ["defaults", "--write", str(page)])
    assert defaults.main() == 0
    assert defaults._TABLE.search(page.read_text(encoding="utf-8"))[0].strip() == table(rows)
    monkeypatch.setattr("sys.argv", ["defaults", "--write", str(other)])
    assert defaults.main() == 2
    assert "has no place for the table" in capsys.readouterr().err
    worse = [Row(row.setting, {**row.medians, "tile-share": 0.9}) for row in rows]
    monkeypatch.setattr(defaults, "measured", lambda names: worse)
    monkeypatch.setattr("sys.argv", ["defaults"])
    assert defaults.main() == 1
    assert "median tile share of the defaults is 0.90" in capsys.readouterr().err


def test_homogeneous_textures() -> None:
    names = homogeneous()
    assert len(names) == 39
    assert not any(name.startswith("inhomogeneous") for name in names)
    assert {each.name for each in gallery()} >= defaults._UNEVEN


def test_measured_as_the_table_says() -> None:
    """Two textures: the defaults tile less than half as much as random shifts, at a D that is good."""
    chosen = {setting: SETTINGS[setting] for setting in ("defaults", "preset shifted")}
    found = {
        row.setting: row.medians for row in measured(("stochastic-lava", "quasiperiodic-towel"), chosen, (1,))
    }
    assert found["preset shifted"]["time"] == 1
    assert found["defaults"]["tile-share"] < 0.35 < 0.7 < found["preset shifted"]["tile-share"]
    assert found["defaults"]["discriminability"] < -3.4
    assert found["defaults"]["visual-difference"] > 2 * found["preset shifted"]["visual-difference"]
