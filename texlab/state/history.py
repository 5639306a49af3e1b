"""The steps of the session as docks see them."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, eq=False)
class History:
    """Names of the states that undo and redo can reach.

    Parameters
    ----------
    texts
        What led to each state, the oldest first; that of the first one is "": nothing is known of before.
    at
        Index of the present state.
    """

    texts: tuple[str, ...] = ("",)
    at: int = 0


NO_HISTORY = History()
