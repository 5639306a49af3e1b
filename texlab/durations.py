"""Times as people read them."""

from __future__ import annotations


def duration(seconds: float) -> str:
    """Return how long something took: two digits that tell, in the largest unit that is not less than one."""
    if seconds < 0.0995:
        return f"{seconds * 1000:.0f} ms"
    if seconds < 9.995:
        return f"{seconds:.2f} s"
    return remaining(seconds)


def remaining(seconds: float) -> str:
    """Return how long something will take: nobody knows it better than to the second, or to half a minute."""
    if seconds < 99.5:
        return f"{seconds:.0f} s"
    return f"{seconds / 60:.1f} min" if seconds < 10 * 60 else f"{seconds / 60:.0f} min"
