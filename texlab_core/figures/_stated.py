"""The numbers that stand in the words and tables of the help pages, measured anew and put in their places.

A place in a page is what lies between ``<!-- NAME -->`` and ``<!-- end of NAME -->``.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import TYPE_CHECKING

from texlab_core.errors import InputError
from texlab_core.files.regular import read_regular
from texlab_core.files.whole import write_whole

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence
    from pathlib import Path

    import numpy as np
    from numpy.typing import NDArray

MAX_PAGE_BYTES = 2**20
SAMPLED = (2, 4, 6, 8, 12)
MATCHED = (1, 2, 4, 6, 8, 12)
MATCHED_ON = {"zebra": "oriented-zebra", "gravel": "stochastic-gravel", "coral": "structured-coral"}
SEEDS = (0, 1, 2)
SLANTS = (10, 30, 50, 70)
VIEWS = 14
# Seeds of the pop-out tests that the machine observer takes.
WATCHED = tuple(range(24))
# From stochastic ones to those of which plain rounds move most bands away.
SOLIDS = (
    "stochastic-granite",
    "stochastic-bark",
    "stochastic-marble",
    "stochastic-cork",
    "structured-pebbles",
    "structured-scales",
    "quasiperiodic-knit",
    "quasiperiodic-brick",
    "manmade-ribs",
    "oriented-woodgrain",
    "inhomogeneous-litbrick",
    "letters-page",
)


def copied_neighbours(orientations: Sequence[int] = SAMPLED) -> list[float]:
    """Return which share of neighbours De Bonet's method copies with so many orientations.

    Over the steerable pyramid, from 128 x 128 pixels of pebbles, 256 x 256, alpha 0.4, seed 0.
    """
    from texlab_core.figures._tools import make, texture
    from texlab_core.measures.registry import measure_all
    from texlab_core.measures.subject import Subject

    pebbles = texture("structured-pebbles")
    shares = []
    for count in orientations:
        result = make("de-bonet", pebbles, 256, 0, pyramid="steerable", bands=count, alpha=0.4)
        shares.append(measure_all(Subject.of_result(result), ("copied-share",))["copied-share"])
    return shares


def spectral_distances(name: str, orientations: Sequence[int] = MATCHED) -> list[float]:
    """Return how far the spectra of Heeger-Bergen's results are from the exemplar's, in dB, mean of three seeds.

    From 128 x 128 pixels of a texture of the gallery, 256 x 256.
    """
    from texlab_core.figures._tools import make, texture
    from texlab_core.measures.registry import measure_all
    from texlab_core.measures.subject import Subject

    exemplar = texture(name)
    means = []
    for count in orientations:
        found = [
            measure_all(
                Subject.of_result(make("heeger-bergen", exemplar, 256, seed, orientations=count)),
                ("spectral-distance",),
            )["spectral-distance"]
            for seed in SEEDS
        ]
        means.append(sum(found) / len(found))
    return means


def searched() -> tuple[tuple[float, float], ...]:
    """Return keys looked at and structures compared per place of level 1, for the three ways of searching."""
    from texlab_core.figures._tools import make, texture
    from texlab_core.methods.de_bonet.search import survey

    sampling = make("de-bonet", texture("stochastic-lava"), 128, 0, alpha=0.15, beta=0.0).details.sampling
    counted = survey(sampling, 1, 4)
    ways = (counted.blank, counted.keys, counted.hierarchy)
    return tuple((way.keys / counted.locations, way.verified / counted.locations) for way in ways)


def shared_information() -> tuple[float, ...]:
    """Return bits of coral; bits and dependence of Heeger-Bergen's result, then of De Bonet's."""
    from texlab_core.figures._tools import make, texture
    from texlab_core.measures.dependence import PAIR
    from texlab_core.stats.dependence import difference, mutual_information, rank_histograms

    def information(ranks: NDArray[np.float64]) -> float:
        return sum(map(mutual_information, ranks)) / len(ranks)

    coral = texture("structured-coral", 256)
    own = rank_histograms(coral.pixels, PAIR)
    numbers = [information(own)]
    for method in ("heeger-bergen", "de-bonet"):
        other = rank_histograms(make(method, coral, 256, 0).image, PAIR)
        numbers += [information(other), difference(own, other)]
    return tuple(numbers)


def normal_errors(kind: str, slants: Sequence[int] = SLANTS) -> tuple[list[float], list[float]]:
    """Return mean errors of the normal in degrees, by search and by moments, on noise or discs."""
    import numpy as np

    from texlab_core.shape.isotropy import isotropy_spectrum
    from texlab_core.shape.orientation import Orientation
    from texlab_core.shape.rendering import slanted_plane
    from texlab_core.shape.textures import disc_texture, noise_texture

    rng = np.random.default_rng(20)
    textures = [noise_texture(800, rng) if kind == "noise" else disc_texture(800, rng) for _ in range(2)]
    by_search, by_moments = [], []
    for slant in slants:
        errors = []
        for view in range(VIEWS):
            truth = Orientation(slant, float(rng.uniform(0, 180)))
            seen = np.roll(textures[view % 2], tuple(rng.integers(0, 800, 2)), axis=(0, 1))
            spectrum = isotropy_spectrum(slanted_plane(seen, truth, (256, 256)))
            errors.append((spectrum.by_search().error(truth), spectrum.by_moments().error(truth)))
        search, moments = np.mean(errors, axis=0)
        by_search.append(float(search))
        by_moments.append(float(moments))
    return by_search, by_moments


def evidence_errors() -> tuple[list[float], list[float]]:
    """Return mean errors of the normal in degrees: by the shapes of 100 marks, by the density of 400 points.

    At slants of 30, 50 and 70, 90 tilts each; at slants of 0 and 40, 45 tilts each.
    """
    import numpy as np

    from texlab_core.shape import homogeneity
    from texlab_core.shape.orientation import Orientation

    rng = np.random.default_rng(3)
    by_marks = []
    for slant in (30, 50, 70):
        errors = []
        for tilt in range(0, 180, 2):
            truth = Orientation(slant, tilt)
            _, tensors = homogeneity.random_marks(100, truth, rng)
            errors.append(homogeneity.orientation_of_marks(tensors).error(truth))
        by_marks.append(float(np.mean(errors)))
    by_density = []
    for slant in (0, 40):
        errors = []
        for tilt in range(0, 360, 8):
            truth = Orientation(slant, tilt)
            points = homogeneity.perspective_points(400, truth, rng)
            found = homogeneity.orientation_of_density(points).orientation
            # Perspective tells a tilt from the turned one.
            errors.append(float(np.degrees(np.arccos(min(1.0, float(found.normal @ truth.normal))))))
        by_density.append(float(np.mean(errors)))
    return by_marks, by_density


def sphere_errors(seeds: Sequence[int] = (30, 31)) -> list[float]:
    """Return mean errors of the normals of a sphere of discs in degrees, by slant, windows of 24 pixels."""
    import numpy as np

    from texlab_core.shape.sphere import errors_by_slant, local_shape, render_sphere

    spheres = [render_sphere(512, np.random.default_rng(seed)) for seed in seeds]
    means = np.mean([errors_by_slant(each, local_shape(each.image, 24)) for each in spheres], axis=0)
    return [float(each) for each in means]


def solid_bands(name: str, kind: str, *, balance: bool = True) -> NDArray[np.float64]:
    """Return how far each band of a solid is from the exemplar's, (bands, rounds) in W1 / sd.

    The texture in gray at half size, 48 x 48 x 48, seed 0. Plain rounds do not measure slices at the end.
    """
    import numpy as np

    from texlab_core.figures._tools import make
    from texlab_core.images.exemplar import as_exemplar
    from texlab_core.transforms.luma import luma

    gray = as_exemplar(luma(as_exemplar(f"gallery:{name}", scale=0.5).pixels), name=name)
    curves = make("solid", gray, 48, 0, kind=kind, balance=balance).curves
    bands = [curve.y for band, curve in curves.items() if band.startswith("band-")]
    return np.array([each[: min(map(len, bands))] for each in bands])


def found_originals(seeds: Sequence[int] = WATCHED) -> tuple[list[int], float]:
    """Return in how many tests the machine finds the original, of Figs. 2 to 5, and what guessing finds."""
    from texlab_core.popout.design import figures
    from texlab_core.popout.making import make

    found = [0, 0, 0, 0]
    for seed in seeds:
        record = make(figures(seed)).record
        for answer in record.machine:
            found[record.trials[answer.trial - 1].setting] += record.hit(answer)
    return found, figures(0).chance


def _rows(head: Sequence[object], *rows: Sequence[object]) -> str:
    lines = [f"| {' | '.join(map(str, line))} |".replace("|  |", "| |") for line in (head, *rows)]
    return "\n".join([lines[0], "|---" * len(head) + "|", *lines[1:]])


def _copied() -> str:
    shares = [f"{share:.2f}".removeprefix("0") for share in copied_neighbours()]
    return _rows(["orientations", *SAMPLED], ["copied neighbours", *shares])


def _matched() -> str:
    rows = [[title, *(f"{each:.1f}" for each in spectral_distances(name))] for title, name in MATCHED_ON.items()]
    return _rows(["K", *MATCHED], *rows)


def _searched() -> str:
    names = ("blank search", "hash keys", "hierarchy")
    rows = [
        (name, f"{keys:.0f}", f"{compared:.0f}") for name, (keys, compared) in zip(names, searched(), strict=True)
    ]
    return _rows(["", "keys looked at", "structures compared"], *rows)


def _shared() -> str:
    own, *others = (f"{each:.3f}" for each in shared_information())
    return (
        f"For coral at 256 x 256 (seed 0): the exemplar's fine coefficients have {own} bits from their\n"
        f"parents, Heeger-Bergen leaves {others[0]} (dependence {others[1]}), De Bonet {others[2]} "
        f"(dependence {others[3]})."
    )


def _normals() -> str:
    rows = []
    for kind in ("noise", "discs"):
        for how, errors in zip(("search", "moments"), normal_errors(kind), strict=True):
            rows.append([f"{kind}, {how}", *(f"{each:.0f}" for each in errors)])
    return _rows(["true slant", *SLANTS], *rows)


def _evidence() -> str:
    marks, density = ([f"{each:.0f}" for each in errors] for errors in evidence_errors())
    return (
        f"From 100 ellipses in random directions the normal is {marks[0]}, {marks[1]} and {marks[2]} degrees off "
        "at slants of 30, 50\n"
        f"and 70, from the density of 400 points {density[0]} degrees at slant 0 and {density[1]} at 40."
    )


def _sphere() -> str:
    *errors, last = (f"{each:.0f}" for each in sphere_errors())
    return (
        f"With windows of 24 pixels on discs the normals are {', '.join(errors)} and {last} degrees off at "
        "slants of\n0 to 20, 20 to 40, 40 to 60 and 60 to 75 degrees."
    )


def _solids() -> str:
    import numpy as np

    rows = []
    for kind in ("laplacian", "mixed"):
        for balance in (False, True):
            found = [solid_bands(each, kind, balance=balance) for each in SOLIDS]
            nearer = sum(bool((bands[:, -1] < bands[:, 0]).all()) for bands in found)
            farther = max(float((bands[:, -1] - bands[:, 0]).max()) for bands in found)
            rise = max(float(np.diff(bands, axis=1).max()) for bands in found)
            left = np.mean([bands[:, -1].mean() for bands in found])
            numbers = (f"{nearer} of {len(found)}", f"{farther:.3f}", f"{rise:.3f}", f"{left:.2f}")
            rows.append((f"{kind}, {'balanced' if balance else 'plain'}", *numbers))
    head = (
        "",
        "all bands nearer",
        "most that a band ends farther",
        "most that one rises in a round",
        "mean distance",
    )
    return _rows(head, *rows)


def _observed() -> str:
    (repeated, pixels, bands, own), chance = found_originals()
    return (
        f"Of {len(WATCHED)} tests of Figs. 2 to 5 it finds the original of Fig. 2 in {repeated}, that of Fig. 3 in"
        f" {pixels}, that of Fig. 4 in {bands},\nand that of Fig. 5 in {own}, where guessing finds it in"
        f" {chance:.0%}."
    )


@dataclass(frozen=True)
class Stated:
    """Words with numbers in a page.

    Parameters
    ----------
    page
        The page's name.
    name
        That of the place in it.
    words
        Measures and writes them.
    """

    page: str
    name: str
    words: Callable[[], str]


STATED = (
    Stated("de-bonet", "orientations", _copied),
    Stated("laboratory", "search keys", _searched),
    Stated("laboratory", "orientations", _matched),
    Stated("laboratory", "dependence", _shared),
    Stated("shape-from-texture", "normals", _normals),
    Stated("shape-from-texture", "marks and points", _evidence),
    Stated("shape-from-texture", "sphere", _sphere),
    Stated("solid", "solids", _solids),
    Stated("popout", "observer", _observed),
)


def place(name: str) -> re.Pattern[str]:
    """Return what finds the words at a place of a page's text."""
    return re.compile(
        rf"(?<=<!-- {re.escape(name)} -->\n\n).*?(?=\n\n<!-- end of {re.escape(name)} -->)", re.DOTALL
    )


def renew(folder: Path) -> None:
    """Measure every number anew and put it into the pages of a folder; raises ``InputError`` and ``OSError``."""
    for each in STATED:
        path = folder / f"{each.page}.md"
        state(path, each.name, each.words)
        print(f"{path.name}, {each.name}", flush=True)


def state(path: Path, name: str, words: Callable[[], str]) -> None:
    """Put words at a place of a page, which is looked for first; raises ``InputError`` and ``OSError``."""
    text = read_regular(path, MAX_PAGE_BYTES).decode("utf-8")
    if place(name).search(text) is None:
        raise InputError(f"{path}: has no place called {name!r}.")
    said = words()
    write_whole(path, place(name).sub(lambda _: said, text).encode())
