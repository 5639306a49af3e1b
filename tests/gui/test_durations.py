"""Times as people read them."""

from __future__ import annotations

import pytest

from texlab.style.numbers import duration, remaining


@pytest.mark.parametrize(
    ("seconds", "taken", "left"),
    [
        (0.0004, "0 ms", "0 s"),
        (0.0994, "99 ms", "0 s"),
        (0.0996, "0.10 s", "0 s"),
        (1.234, "1.23 s", "1 s"),
        (9.994, "9.99 s", "10 s"),
        (9.996, "10 s", "10 s"),
        (99.4, "99 s", "99 s"),
        (116.0, "1.9 min", "1.9 min"),
        (3600.0, "60 min", "60 min"),
    ],
)
def test_digits_and_units_change_where_they_should(seconds: float, taken: str, left: str) -> None:
    assert (duration(seconds), remaining(seconds)) == (taken, left)
