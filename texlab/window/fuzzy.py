"""How well what was typed fits a name: a pure function for the palette."""

from __future__ import annotations

# Of a word that was typed, by where it is found.
START, WITHIN, SCATTERED, EXPLAINED = 100.0, 60.0, 25.0, 10.0


def fit(typed: str, name: str, explanation: str = "") -> float | None:
    """Return how well a name fits, or None when it does not.

    Every word that was typed must be found: at the start of a word of the name, inside the name, scattered in it
    in the order of its letters, or in the explanation; the first of these that holds counts. Whole words, words
    near the front and short names fit better.

    Parameters
    ----------
    typed
        Words in any order and case; none at all fit everything equally.
    name, explanation
        What is searched.
    """
    total = 0.0
    low, more = name.casefold(), explanation.casefold()
    for word in typed.casefold().split():
        found = _of_word(word, low)
        if found is None and word in more:
            found = EXPLAINED
        if found is None:
            return None
        total += found
    # A tie goes to the name of which more was typed.
    return total - len(name) / 100 if typed.strip() else 0.0


def _of_word(word: str, name: str) -> float | None:
    parts = name.split()
    for place, part in enumerate(parts):
        if part.startswith(word):
            return START + (20 if part == word else 0) - min(place, 9)
    at = name.find(word)
    if at >= 0:
        return WITHIN - min(at, 30) / 3
    return _scattered(word, name)


def _scattered(word: str, name: str) -> float | None:
    """Return the fit of letters that stand in order with others between them; single letters do not count."""
    if len(word) < 3:
        return None
    at, first = -1, 0
    for place, letter in enumerate(word):
        at = name.find(letter, at + 1)
        if at < 0:
            return None
        first = at if place == 0 else first
    gaps = at - first + 1 - len(word)
    # Letters that are strewn over a whole sentence mean nothing.
    return SCATTERED - gaps if gaps <= 2 * len(word) else None
