"""Words in a plot: inside, near their points, and never over each other."""

from __future__ import annotations

from itertools import combinations
from typing import Any

from hypothesis import given
from hypothesis import strategies as st

from texlab.style.theme import LIGHT
from texlab.widgets.label_places import FARTHEST, Label, place_labels
from texlab.widgets.plots import Plot

ROOM = (400.0, 200.0)
labels = st.builds(
    Label,
    st.floats(-20, 420),
    st.floats(-20, 220),
    st.floats(5, 180),
    st.floats(8, 30),
    st.sampled_from([(0.0, 1.0), (1.0, 1.0), (0.5, 0.0)]),
)


def area_shared(one: tuple[float, float], two: tuple[float, float], first: Label, second: Label) -> float:
    across = min(one[0] + first.width, two[0] + second.width) - max(one[0], two[0])
    down = min(one[1] + first.height, two[1] + second.height) - max(one[1], two[1])
    return max(across, 0.0) * max(down, 0.0)


@given(st.lists(labels, max_size=12))
def test_no_label_covers_another_or_leaves_the_plot(given_labels: list[Label]) -> None:
    places = place_labels(given_labels, ROOM)
    shown = [(each, place) for each, place in zip(given_labels, places, strict=True) if place is not None]
    for each, (left, top) in shown:
        assert 0 <= left <= ROOM[0] - each.width + 1e-9
        assert 0 <= top <= ROOM[1] - each.height + 1e-9
    for (first, one), (second, two) in combinations(shown, 2):
        assert area_shared(one, two, first, second) == 0
    # The first has what it wants.
    assert not places or places[0] is not None


def test_a_label_with_room_stands_where_it_is_wanted() -> None:
    assert place_labels([Label(50, 100, 40, 10)], ROOM) == [(50, 90)]
    assert place_labels([Label(390, 100, 40, 10)], ROOM) == [(360, 90)]
    # What is larger than the plot would be cut.
    assert place_labels([Label(50, 100, 900, 10), Label(50, 100, 10, 300)], ROOM) == [None, None]


def test_labels_of_one_point_stand_around_it() -> None:
    crowd = [Label(200, 100, 60, 10)] * 6
    places = place_labels(crowd, ROOM)
    assert len(set(places)) == 6
    for place in places:
        assert place is not None
        assert abs(place[1] + 10 - 100) <= FARTHEST * 10


def test_what_has_no_place_is_left_out_and_comes_back_with_more_room(qtbot: Any) -> None:
    plot = Plot("plot", "Points")
    qtbot.addWidget(plot)
    plot.set_theme(LIGHT)
    plot.resize(260, 120)
    plot.show()
    plot.points([0.0, 1.0, 2.0], [0.0, 1.0, 2.0], "result")
    names = [f"a method with a long name {place}" for place in range(9)]
    for name in names:
        plot.text(1.0, 1.0, name, "text")
    plot.fit()

    def shown() -> int:
        return sum(item.isVisible() for item, *_ in plot._texts)

    few = shown()
    assert 0 < few < len(names)
    plot.resize(900, 600)
    qtbot.waitUntil(lambda: shown() == len(names))
