"""What rests is not traced any further, and nothing that is reported changes by that."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import pytest

from tests.coverage_floor import share

ROOT = Path(__file__).resolve().parents[2]
MODULE = '''"""A module."""
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from pathlib import Path

    import os


def half(number: int) -> int:
    if number % 2:
        number += (
            1
        )
    return number // 2
'''
SCRIPT = """
import json, sys
import coverage

sys.path[:0] = sys.argv[1:]
from tests.coverage_rest import Rest

def watch(rests):
    cov = coverage.Coverage(source=[sys.argv[1]], data_file=None)
    cov.start()
    sys.modules.pop("thing", None)
    import thing
    rest = Rest(cov, before) if rests else None
    told = []
    for number in (2, 4, 3, 2, 5):
        thing.half(number)
        if rest is not None:
            told.append(len(rest.look()))
    cov.stop()
    name = thing.__file__
    return sorted(cov.get_data().lines(name)), cov.analysis2(name)[3], told

before = {}
full, rested = watch(False), watch(True)
before = {sys.modules["thing"].__file__: set(full[0])}
print(json.dumps([full, rested, watch(True)]))
"""


def test_a_package_of_which_nothing_was_measured_is_below_its_floor() -> None:
    rows = [("texlab/a.py", 10, 1)]
    assert share(rows, "texlab") == 90.0
    with pytest.raises(pytest.UsageError, match="no file of texlab_core was measured"):
        share(rows, "texlab_core")


def test_a_file_rests_when_all_of_it_has_run(tmp_path: Path) -> None:
    (tmp_path / "thing.py").write_text(MODULE, "utf-8")
    done = subprocess.run(
        [sys.executable, "-c", SCRIPT, str(tmp_path), str(ROOT)], capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    full, rested, known = json.loads(done.stdout)
    assert rested[:2] == full[:2]
    assert (full[1], full[2]) == ([], [])
    # With the first odd number; and at once where an earlier run has seen the rest.
    assert rested[2] == [0, 0, 1, 0, 0]
    assert known[2] == [1, 0, 0, 0, 0]
    assert set(known[0]) < set(full[0])
