"""Full-text search of the help pages: pure functions over their Markdown."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Mapping

EXCERPT = 72
# What an occurrence is worth, by where it stands.
IN_TITLE, IN_HEADING, IN_TEXT, MOST_OF_TEXT = 100, 20, 1, 10
_HEADING = re.compile(r"#+\s+(.*)")
_PICTURE = re.compile(r"!\[([^\]]*)\]\([^)]*\)")
_LINK = re.compile(r"\[([^\]]*)\]\([^)]*\)")
_COMMENT = re.compile(r"<!--.*?-->")
_RULE = re.compile(r"[|\s:-]*")
_SIGNS = re.compile(r"\\([\\`*_{}\[\]<>#+\-!|&])|(?<!\w)[*_]{1,3}(?=\S)|(?<=\S)[*_]{1,3}(?!\w)|`")


@dataclass(frozen=True, slots=True)
class Section:
    """A heading of a page and the words below it, without markup."""

    heading: str
    text: str


@dataclass(frozen=True, slots=True)
class Hit:
    """A page on which every word was found.

    Attributes
    ----------
    page, title
        Name of the page, and its first heading.
    heading
        Of the section that fits best.
    excerpt
        Words of that section around the first of those that were typed; the heading's own words are left out.
    score
        Greater is better.
    """

    page: str
    title: str
    heading: str
    excerpt: str
    score: int


def sections_of(markdown: str) -> tuple[Section, ...]:
    """Return the sections of a page in order; the first one is headed by the page's title."""
    found: list[Section] = []
    heading = ""
    lines: list[str] = []
    fenced = False
    for line in markdown.splitlines():
        if line.lstrip().startswith("```"):
            fenced = not fenced
            continue
        match = None if fenced else _HEADING.match(line)
        if match:
            if heading or lines:
                found.append(Section(heading, " ".join(lines)))
            heading, lines = _plain(match[1]), []
        elif words := " ".join((line if fenced else _plain(line)).split()):
            lines.append(words)
    found.append(Section(heading, " ".join(lines)))
    return tuple(found)


def _plain(line: str) -> str:
    """Return a line without markup; of pictures and links the words stay, of tables the cells."""
    line = _LINK.sub(r"\1", _PICTURE.sub(r"\1", _COMMENT.sub("", line)))
    if "|" in line:
        line = "" if _RULE.fullmatch(line) else line.strip().strip("|").replace("|", " ")
    return _SIGNS.sub(lambda match: match[1] or "", line)


def search(pages: Mapping[str, tuple[Section, ...]], typed: str) -> list[Hit]:
    """Return the pages that hold every word that was typed, best first.

    A word is found at the start of a word of the page, whatever the case: "hist" finds "histograms". A page whose
    title or heading has it comes before one that only mentions it.

    Parameters
    ----------
    pages
        Sections by name of the page, in the order of the list of pages, which decides between equals.
    typed
        Words in any order; without any, nothing is found.
    """
    words = [_at_start(word) for word in typed.split()]
    found = [hit for name, sections in pages.items() if words and (hit := _hit(name, sections, words))]
    return sorted(found, key=lambda hit: -hit.score)


def _at_start(word: str) -> re.Pattern[str]:
    # A sign has no start of a word before it.
    start = r"(?<!\w)" if word[0].isalnum() else ""
    return re.compile(start + re.escape(word), re.IGNORECASE)


def _hit(name: str, sections: tuple[Section, ...], words: list[re.Pattern[str]]) -> Hit | None:
    title = sections[0].heading
    total, best, most = 0, sections[0], -1
    for word in words:
        in_text = sum(len(word.findall(each.text)) for each in sections)
        in_headings = sum(bool(word.search(each.heading)) for each in sections[1:])
        in_title = bool(word.search(title))
        if not (in_text or in_headings or in_title):
            return None
        total += IN_TITLE * in_title + IN_HEADING * in_headings + IN_TEXT * min(in_text, MOST_OF_TEXT)
    for each in sections:
        fit = sum(_fit(word, each) for word in words)
        if fit > most:
            best, most = each, fit
    return Hit(name, title, best.heading, _excerpt(best.text, words), total)


def _fit(word: re.Pattern[str], section: Section) -> int:
    """Return how well a section fits a word: all words somewhere in it come before one of them often."""
    count = len(word.findall(section.text))
    return IN_TITLE * bool(count) + IN_HEADING * bool(word.search(section.heading)) + min(count, MOST_OF_TEXT)


def _excerpt(text: str, words: list[re.Pattern[str]]) -> str:
    places = [match.start() for word in words if (match := word.search(text))]
    at = min(places, default=0)
    start = 0 if at < EXCERPT // 2 else text.rfind(" ", 0, at - EXCERPT // 3) + 1
    end = len(text) if start + EXCERPT >= len(text) else max(text.rfind(" ", start, start + EXCERPT), at)
    return ("… " if start else "") + text[start:end] + (" …" if end < len(text) else "")
