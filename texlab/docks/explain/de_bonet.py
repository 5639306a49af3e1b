"""De Bonet: the ancestors of a pixel, their candidates in the exemplar, and what they were compared by."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from PySide6.QtWidgets import QHBoxLayout, QVBoxLayout, QWidget

from texlab.docks.explain.base import Explainer, ExplanationView, never
from texlab.docks.explain.levels_view import LevelsView, Tile
from texlab.docks.explain.structure_view import Structure, StructureView
from texlab.docks.explain.words import Words
from texlab.docks.recent import Recent, Same
from texlab.docks.thresholds.table import KINDS, Axes, make_heads
from texlab.style.pictures import Mark, to_picture
from texlab_core.engine.inputs import exemplar_of
from texlab_core.methods.de_bonet.explain import explain
from texlab_core.methods.de_bonet.report import DeBonetDetails

if TYPE_CHECKING:
    from collections.abc import Callable

    from texlab.style.pictures import Picture
    from texlab.style.theme import Theme
    from texlab_core.engine.result import Result
    from texlab_core.methods.de_bonet.explain import ExplainedLevel, Explanation, Strictest
    from texlab_core.methods.de_bonet.features import Feature

# More marks than this tell no more, and would slow the painting down.
MOST_MARKS = 600

_pictures = Recent(4)


@dataclass(frozen=True, eq=False)
class ExplainedPixel:
    """An explanation with what its view needs.

    Parameters
    ----------
    explanation
        From the core.
    axes
        Levels and features.
    pictures
        Levels N .. 0 of the exemplar's Gaussian pyramid.
    marked
        For each of the levels N .. 0, which candidates are marked: all, or evenly spread ones and the chosen one.
    """

    explanation: Explanation
    axes: Axes
    pictures: tuple[Picture, ...]
    marked: tuple[tuple[int, ...], ...]


def explain_pixel(
    result: Result, row: int, column: int, should_stop: Callable[[], bool] = never
) -> ExplainedPixel:
    """Explain a pixel of a De Bonet result (in a background thread)."""
    explanation = explain(result.details.sampling, row, column)
    analysis = result.details.sampling.analysis
    pictures = _pictures.get(Same(analysis), lambda: level_pictures(result))
    marked = tuple(spread(len(each.candidates), each.chosen) for each in explanation.levels)
    return ExplainedPixel(explanation, Axes.of(analysis), pictures, marked)


def level_pictures(result: Result) -> tuple[Picture, ...]:
    """Return the levels N .. 0 of the exemplar that the result was sampled from, padded or cropped as it was."""
    from texlab_core.transforms.gaussian import build

    analysis = result.details.sampling.analysis
    pixels = exemplar_of(result.job.inputs).pixels[np.ix_(analysis.rows, analysis.columns)]
    levels = build(pixels, analysis.depth, analysis.border)
    return tuple(to_picture(level) for level in reversed(levels))


def spread(count: int, chosen: int) -> tuple[int, ...]:
    """Return at most ``MOST_MARKS`` of ``count`` indices, evenly spread, with the chosen one."""
    if count <= MOST_MARKS:
        return tuple(range(count))
    picked = np.linspace(0, count - 1, MOST_MARKS - 1).astype(int)
    return tuple(sorted({*picked.tolist(), chosen}))


# What is said.


def feature_words(feature: Feature) -> str:
    """Return a feature in words: ``red first derivative 45°``."""
    words = f"{feature.channel} {KINDS[feature.kind]}"
    return f"{words} {feature.angle:g}°" if feature.directed else words


def strictest_words(explanation: Explanation, strictest: Strictest) -> str:
    """Return which constraint excludes most, in words."""
    depth = len(explanation.levels) - 1
    level = depth + 1 - strictest.k
    tested = explanation.at(level).tested
    feature = feature_words(explanation.features[strictest.feature])
    return f"level {level} (k={strictest.k}), {feature} excludes {strictest.excluded} of {tested}"


def place_words(explanation: Explanation, level: int, row: int, column: int) -> str:
    """Return where in the exemplar a location of a level lies: its pixel, or the corner of its square."""
    top, left, side = explanation.exemplar_box(level, row, column)
    return f"{left}, {top}" + (f" ({side} x {side} px)" if side > 1 else "")


def summary(explanation: Explanation, level: int) -> str:
    """Return why the ancestor of a level is what it is, in words."""
    each = explanation.at(level)
    where = place_words(explanation, level, *each.source)
    count = len(each.candidates)
    if level == len(explanation.levels) - 1:
        return f"Level {level}, the coarsest, is laid out and not sampled: here stands {where}."
    taken = "the only candidate" if count == 1 else f"drawn from {count:,} candidates"
    words = f"Level {level}: {where}, {taken}."
    near, most = explanation.strictest(level + 1), explanation.strictest()
    if near is None or most is None:
        return f"{words} Level {level + 1} excludes nothing."
    said = strictest_words(explanation, near)
    words = f"{words} {said[0].upper()}{said[1:]}."
    return words if near == most else f"{words} Most of all, {strictest_words(explanation, most)}."


class DeBonetView(ExplanationView):
    """Levels with candidates on the left, parent structures on the right, words below."""

    def __init__(self) -> None:
        super().__init__()
        self.setObjectName("explain-de-bonet")
        self._explained: ExplainedPixel | None = None
        self._from_finest = 0
        self.levels = LevelsView("explain-levels")
        self.levels.selected.connect(self._select)
        self.levels.pointed.connect(self._point)
        self.structure = StructureView("explain-structure")
        self.caption = Words("explain-caption", "What is compared", 1)
        self.words = Words("explain-words", "Why the pixel is there", 2)
        right = QWidget()
        beside = QVBoxLayout(right)
        beside.setContentsMargins(0, 0, 0, 0)
        beside.setSpacing(1)
        beside.addWidget(self.caption)
        beside.addWidget(self.structure, 1)
        panes = QHBoxLayout()
        panes.addWidget(self.levels, 3)
        panes.addWidget(right, 2)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(6, 0, 6, 1)
        layout.setSpacing(2)
        layout.addLayout(panes, 1)
        layout.addWidget(self.words)
        self.setFocusProxy(self.levels)

    def set_theme(self, theme: Theme) -> None:
        """Repaint in another theme."""
        for part in (self.levels, self.structure, self.caption, self.words):
            part.set_theme(theme)

    def show_explanation(self, explained: ExplainedPixel) -> None:
        """Show the chain of ancestors; the level that was looked at stays."""
        self._explained = explained
        levels = explained.explanation.levels
        self._from_finest = min(self._from_finest, len(levels) - 1)
        tile = len(levels) - 1 - self._from_finest
        tiles = tuple(self._tile(place) for place in range(len(levels)))
        self.levels.show_tiles(tiles, tile, tiles[tile].chosen)
        self._show_level(tile, tiles[tile].chosen)
        self.marks_changed.emit(self._marks(tile))

    def empty_parts(self) -> None:
        """Empty levels, bars and words."""
        self.levels.show_tiles((), 0, 0)
        self.structure.show_structure(None)
        self.caption.show_parts()
        self.words.show_parts()

    def _tile(self, place: int) -> Tile:
        explained = self._explained
        assert explained is not None
        each, marked = explained.explanation.levels[place], explained.marked[place]
        count = len(each.candidates)
        note = "copied" if place == 0 else f"{count:,} candidate{'s' * (count != 1)}"
        title = f"level {each.level}" + (f", k {place + 1}" if each.level else "")
        places = each.candidates[list(marked)]
        return Tile(title, note, explained.pictures[place], places, marked.index(each.chosen))

    def _show_level(self, tile: int, place: int) -> None:
        explained = self._explained
        assert explained is not None
        explanation = explained.explanation
        each = explanation.levels[tile]
        index = explained.marked[tile][place]
        if tile == 0:
            self.structure.show_structure(None)
            self.caption.show_parts(("The coarsest level has no parents.", "muted"))
        else:
            self.structure.show_structure(structure_of(explained, each.level, index))
            self._show_legend(index, each)
        self.words.show_parts((summary(explanation, each.level), "text"))

    def _show_legend(self, index: int, each: ExplainedLevel) -> None:
        """Say what is compared, in the colours of the bars."""
        assert self._explained is not None
        row, column = each.candidates[index]
        where = place_words(self._explained.explanation, each.level, int(row), int(column))
        kind = "taken" if index == each.chosen else "not taken"
        self.caption.show_parts(
            ("the pixel", "exemplar"),
            (" and ", "muted"),
            (f"candidate {index + 1:,} of {len(each.candidates):,}", "result"),
            (f" ({kind}) at {where}", "muted"),
        )

    def _select(self, tile: int, place: int) -> None:
        assert self._explained is not None
        levels = len(self._explained.explanation.levels)
        moved = self._from_finest != levels - 1 - tile
        self._from_finest = levels - 1 - tile
        self._show_level(tile, place)
        if moved:
            self.marks_changed.emit(self._marks(tile))
            self.aspect_changed.emit(self._from_finest)

    def take_aspect(self, aspect: int) -> None:
        """Look at this level, counted from the finest."""
        explained = self._explained
        if explained is None or aspect == self._from_finest:
            return
        self._from_finest = min(aspect, len(explained.explanation.levels) - 1)
        self.show_explanation(explained)

    def _point(self, tile: int, place: int) -> None:
        """Show the candidate under the pointer, and the selected one again when it has gone."""
        if self._explained is not None:
            self._show_level(*((tile, place) if tile >= 0 else self.levels.current))

    def _marks(self, tile: int) -> tuple[Mark, ...]:
        """Return the candidates of a level as places of the exemplar; the one that was taken comes last."""
        explained = self._explained
        assert explained is not None
        each = explained.explanation.levels[tile]

        def mark(index: int) -> Mark:
            row, column = (int(part) for part in each.candidates[index])
            top, left, side = explained.explanation.exemplar_box(each.level, row, column)
            return Mark(top, left, side, side, "chosen" if index == each.chosen else "candidate")

        others = [mark(index) for index in explained.marked[tile] if index != each.chosen]
        return (*others, mark(each.chosen))


def structure_of(explained: ExplainedPixel, level: int, candidate: int) -> Structure:
    """Return the parent structures of the pixel's ancestor at a level and of a candidate."""
    explanation, axes = explained.explanation, explained.axes
    place = len(explanation.levels) - 1 - level
    every = explanation.candidate_structures(level, np.array(explained.marked[place]))
    names = [each.name for each in explanation.features]
    heads = make_heads(axes.features, "each")
    order = [names.index(head.first.name) for head in heads]
    rows = every.shape[1]
    return Structure(
        heads=heads,
        names=tuple(f"k {k}" for k in range(1, rows + 1)),
        pixel=explanation.parent_structure(level)[:, order],
        candidate=explanation.candidate_structure(level, candidate)[:, order],
        lowest=every.min(axis=0)[:, order],
        highest=every.max(axis=0)[:, order],
        thresholds=explanation.thresholds[:rows, order],
    )


EXPLAINER = Explainer(DeBonetDetails, explain_pixel, DeBonetView)
