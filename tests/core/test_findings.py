"""Findings: what is planted is seen where it is, what is right is left alone, and every remedy can be applied."""

from __future__ import annotations

import json
import pkgutil
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from texlab_core.engine.inputs import Crop
from texlab_core.engine.job import Job
from texlab_core.engine.registry import methods
from texlab_core.engine.run import run
from texlab_core.errors import Cancelled, ParamError
from texlab_core.figures.defaults import centre
from texlab_core.findings import detectors as package
from texlab_core.findings import registry
from texlab_core.findings.diagnosis import findings_of
from texlab_core.findings.finding import FINDING, LOOK_AT, Finding, Region, Remedy, Where, counted
from texlab_core.findings.limits import PRECISION, RECALL, RULES, Fit, Rule, Term, rule_for
from texlab_core.findings.registry import Case, Detector, Seen, detectors, failures, find_all, find_detector
from texlab_core.images.exemplar import as_exemplar
from texlab_core.measures.cuts import largest_cut_between
from texlab_core.measures.registry import Measure, find_measure
from texlab_core.measures.subject import PreparedCache, Subject

LABELS = Path(__file__).parents[1] / "data/labels/gallery"
CACHE = PreparedCache()


def labelled(texture: str, variant: str, method: str = "", **more: object) -> Subject:
    exemplar = as_exemplar(LABELS / f"{texture}.exemplar.webp")
    image = as_exemplar(LABELS / f"{texture}.{variant}.webp").pixels
    return Subject(image=image, exemplar=exemplar, method=method, cache=CACHE, **more)  # type: ignore[arg-type]


def seen(subject: Subject, params: object = None) -> dict[str, Finding]:
    return {each.id: each for each in find_all(subject, params)}  # type: ignore[arg-type]


def test_every_file_declares_detectors_and_all_can_be_used() -> None:
    for each in pkgutil.iter_modules(package.__path__):
        text = (Path(package.__path__[0]) / f"{each.name}.py").read_text(encoding="utf-8")
        assert re.search(r"^register\(", text, re.MULTILINE), each.name
    broken = [each.sentence for each in failures()]
    assert not broken, " ".join(broken)


@pytest.mark.parametrize("detector", detectors().values(), ids=lambda detector: detector.id)
def test_a_declaration_is_whole(detector: Detector) -> None:
    assert re.fullmatch(r"[a-z]+(-[a-z]+)*", detector.id)
    assert 0 < len(detector.title) <= 30
    for text in (detector.summary, *detector.why.values()):
        assert text.endswith("."), text
    assert set(detector.why) <= {"", *methods()}
    assert set(detector.remedies) <= {"", *methods()}
    assert set(detector.methods) <= set(methods())
    for each in detector.measures:
        find_measure(each)
    for rule in (rule for rule in RULES if rule.name.partition(".")[0] == detector.id):
        assert {term.measure for term in rule.terms} <= set(detector.measures)
        assert rule.evidence.endswith("."), rule.name
        assert len(rule.fit.weights) == len(rule.terms)
        assert np.isfinite(rule.fit.limit)


def test_every_rule_belongs_to_a_detector() -> None:
    assert {rule.name.partition(".")[0] for rule in RULES} <= set(detectors())
    assert len({rule.name for rule in RULES}) == len(RULES)


def test_certain_is_only_what_the_labels_allow() -> None:
    for rule in RULES:
        known = rule.fit.precision is not None and rule.fit.recall is not None
        good = known and rule.fit.precision >= PRECISION and rule.fit.recall >= RECALL  # type: ignore[operator]
        assert (rule.certainty == FINDING) == good
    sure = {rule.name for rule in RULES if rule.certainty == FINDING}
    # What the help says can be trusted.
    assert sure >= {"structure-lost.bands-alone", "cuts.de-bonet", "verbatim.de-bonet", "noise.de-bonet"}


@pytest.mark.parametrize("detector", detectors().values(), ids=lambda detector: detector.id)
def test_every_remedy_can_be_applied(detector: Detector) -> None:
    subject = labelled("stochastic-gravel", "efros-leung")
    given = 0
    for name, method in methods().items():
        advice = detector.remedies.get(name, detector.remedies.get("", ()))
        extreme = [method.params()]
        if name == "de-bonet":
            extreme += [method.params(alpha=0.02, patch=0.1), method.params(alpha=4.0, channels="luminance")]
            extreme += [method.params(coarsest="shift", places=1, coarsest_side=1, border="smooth")]
        if name == "efros-leung":
            extreme += [
                method.params(window=41, tau=60.0, eps=2.0),
                method.params(window=3, tau=0.0, shape="disc"),
            ]
        for params in extreme:
            for each in advice:
                found = each(Case(subject, name, params))
                if found is None:
                    continue
                given += 1
                assert found.words.endswith(".")
                assert "{" not in found.words
                if found.params:
                    assert params.replace(**found.params) != params
                if found.method:
                    assert found.method in methods()
                    assert found.method != name
    assert given or not detector.remedies


def test_what_an_observer_saw_is_seen() -> None:
    """Gravel as the labels have it: Efros-Leung is good, Heeger-Bergen is not, De Bonet at 0.30 is noisy."""
    efros = methods()["efros-leung"].params()
    assert "structure-lost" not in seen(labelled("stochastic-gravel", "efros-leung", "efros-leung"), efros)
    heeger = seen(labelled("stochastic-gravel", "heeger-bergen", "heeger-bergen"))
    assert heeger["structure-lost"].certainty == FINDING
    assert "Heeger and Bergen 1995" in heeger["structure-lost"].why
    assert heeger["structure-lost"].remedy.method == "efros-leung"
    assert "dependence-lost" in heeger
    # A picture of which no method is known has other words.
    unknown = seen(labelled("stochastic-gravel", "heeger-bergen"))["structure-lost"]
    assert "Heeger" not in unknown.why
    assert unknown.certainty == LOOK_AT
    shift = methods()["de-bonet"].params(coarsest="shift", alpha=0.3)
    bonet = seen(labelled("quasiperiodic-brick", "de-bonet-30", "de-bonet"), shift)
    assert bonet["cuts"].certainty == FINDING
    assert {"repetition", "verbatim"} & set(bonet)


def test_a_tiling_repeats_and_is_cut_where_it_is_laid_together() -> None:
    exemplar = as_exemplar("gallery:stochastic-gravel", crop=Crop(0, 0, 96, 96))
    image = np.tile(exemplar.pixels, (2, 2, 1))
    found = seen(Subject(image=image, exemplar=exemplar))
    assert "structure-lost" not in found
    assert {"repetition", "verbatim"} <= set(found)
    assert found["repetition"].where.regions == tuple(
        Region(top, left, 96, 96) for top in (0, 96) for left in (0, 96)
    )
    assert "100%" in found["repetition"].what
    assert found["verbatim"].where.regions[0].height > 80
    cut = found["cuts"]
    assert cut.where.regions[0] in (
        Region(95, 0, 2, 192),
        Region(0, 95, 192, 2),
        *(Region(95, left, 2, 96) for left in (0, 96)),
        *(Region(top, 95, 96, 2) for top in (0, 96)),
    )


def test_a_cut_is_certain_only_where_it_jumps_further_than_the_exemplars_own_lines() -> None:
    for texture, certainty in (("stochastic-gravel", FINDING), ("quasiperiodic-brick", LOOK_AT)):
        exemplar = as_exemplar(f"gallery:{texture}", crop=Crop(0, 0, 96, 96))
        subject = Subject(image=np.tile(exemplar.pixels, (2, 2, 1)), exemplar=exemplar)
        further = find_measure("cuts").of(subject) > find_measure("own-cuts").of(subject)
        assert further == (certainty == FINDING)
        assert seen(subject)["cuts"].certainty == certainty
    # What the limits for De Bonet's shifts are from has such exemplars, too.
    shift = methods()["de-bonet"].params(coarsest="shift", alpha=0.3)
    bricks = labelled("quasiperiodic-brick", "de-bonet-30", "de-bonet")
    assert find_measure("cuts").of(bricks) < find_measure("own-cuts").of(bricks)
    assert seen(bricks, shift)["cuts"].certainty == FINDING
    assert seen(labelled("quasiperiodic-brick", "de-bonet-30"))["cuts"].certainty == LOOK_AT


def test_a_cut_is_where_copies_meet_though_other_lines_jump_more() -> None:
    """Bricks have joints that jump more than any cut; the labelled cuts are in the middle."""
    shift = methods()["de-bonet"].params(coarsest="shift", alpha=0.3)
    found = seen(labelled("quasiperiodic-brick", "de-bonet-30", "de-bonet"), shift)["cuts"].where.regions[0]
    assert 127 in (found.top, found.left)
    rows = np.linspace(0.2, 0.4, 96, dtype=np.float32)
    exemplar = np.repeat(rows[:, None, None], 80, axis=1) + np.random.default_rng(1).random((96, 80, 1)) * 0.02
    subject = Subject.of_images(exemplar.astype(np.float32), np.tile(exemplar, (2, 1, 1)).astype(np.float32))
    cut = largest_cut_between(subject)
    assert cut is not None
    assert (cut.axis, cut.line) == ("row", 95)
    assert cut.value == pytest.approx(find_measure("cuts").of(subject))
    assert find_measure("cuts-at-sides").of(subject) == cut.value
    assert largest_cut_between(Subject.of_images(exemplar, exemplar)) is None
    assert find_measure("cuts-at-sides").of(Subject.of_images(exemplar, exemplar)) is None


def test_the_exemplar_itself_is_no_failure() -> None:
    exemplar = as_exemplar("gallery:stochastic-gravel", crop=Crop(0, 0, 128, 128))
    other = as_exemplar("gallery:stochastic-gravel", crop=Crop(0, 128, 128, 128))
    assert find_all(Subject(image=other.pixels, exemplar=exemplar)) == ()


def test_regions_lie_in_the_picture() -> None:
    for texture in ("oriented-zebra", "quasiperiodic-brick"):
        for variant in ("de-bonet-30", "efros-leung", "heeger-bergen"):
            method = variant.removesuffix("-30")
            subject = labelled(texture, variant, method)
            for found in find_all(subject, methods()[method].params()):
                height, width = (
                    subject.image.shape[:2] if found.where.place == "result" else subject.pixels.shape[:2]
                )
                for region in found.where.regions:
                    assert 0 <= region.top < region.top + region.height <= height
                    assert 0 <= region.left < region.left + region.width <= width
                assert json.loads(json.dumps(found.to_json(), allow_nan=False)) == found.to_json()
                assert set(found.to_json()) == {
                    "id", "title", "what", "why", "try", "where", "certainty", "measures",
                }  # fmt: skip
                assert found.what.endswith(".")
                assert re.search(r"\d", found.what)


def test_certain_things_come_first_and_are_counted_apart() -> None:
    found = find_all(
        labelled("quasiperiodic-brick", "de-bonet-30", "de-bonet"), methods()["de-bonet"].params(coarsest="shift")
    )
    order = [each.certainty for each in found]
    assert order == sorted(order, key=(FINDING, LOOK_AT).index)
    assert counted(found) == (order.count(FINDING), order.count(LOOK_AT))
    assert all(each.sentence.startswith("Look at") == (each.certainty == LOOK_AT) for each in found)


def test_thresholds_out_of_range_are_named_with_a_value_that_is_not() -> None:
    bonet, efros = methods()["de-bonet"].params, methods()["efros-leung"].params
    subject = labelled("stochastic-gravel", "efros-leung")
    for alpha, out in ((0.02, True), (0.15, False), (0.45, False), (1.0, True)):
        found = find_all(subject, bonet(alpha=alpha), "de-bonet")
        assert ("alpha-range" in {each.id for each in found}) == out
    low = Subject(image=subject.image, exemplar=as_exemplar(0.5 + 0.05 * (subject.pixels - 0.5)))
    for given, tau, scale, out in (
        (subject, 3.0, "relative", False),
        (subject, 0.0, "relative", True),
        (subject, 40.0, "relative", True),
        (low, 3.0, "absolute", True),
        (low, 3.0, "relative", False),
    ):
        params = efros(tau=tau, tau_scale=scale)
        found = [each for each in find_all(given, params, "efros-leung") if each.id == "tau-range"]
        assert bool(found) == out
        for each in found:
            again = find_all(given, params.replace(**each.remedy.params), "efros-leung")
            assert "tau-range" not in {other.id for other in again}


def test_a_result_that_was_to_tile_and_does_not() -> None:
    exemplar = as_exemplar("gallery:oriented-zebra", crop=Crop(0, 0, 64, 64))
    job = Job(method="tiling", inputs={"exemplar": exemplar}, size=(96, 80))
    assert "does-not-tile" in {each.id for each in findings_of(run(job))}
    job = Job(method="heeger-bergen", inputs={"exemplar": exemplar}, size=(96, 80))
    assert "does-not-tile" not in {each.id for each in findings_of(run(job))}
    bonet = methods()["de-bonet"].params()
    picture = Subject(image=run(job).image[:70, :70], exemplar=exemplar, method="de-bonet")
    assert "does-not-tile" not in seen(picture, bonet)
    assert "does-not-tile" in seen(picture, bonet.replace(tileable=True, uneven="crop"))


@pytest.mark.parametrize("size", [(2, 2), (3, 20), (9, 9), (16, 17), (20, 40), (33, 33), (40, 44), (64, 50)])
def test_pictures_of_any_size_can_be_examined_whatever_is_found(
    size: tuple[int, int], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Every detector speaks whenever its rule has a score at all."""
    monkeypatch.setattr(Rule, "fires", lambda rule, value: rule.score(value) is not None)
    random = np.random.default_rng(3)
    exemplar = as_exemplar(random.random((48, 40, 3), np.float32))
    for one, other in ((exemplar, size), (as_exemplar(exemplar.pixels[: size[0], : size[1], :1]), (48, 52))):
        subject = Subject(image=random.random((*other, 3), np.float32), exemplar=one, cache=CACHE)
        for name, method in methods().items():
            for found in find_all(subject, method.params(), name):
                assert found.what.endswith(".")


def test_finding_can_be_stopped() -> None:
    subject = labelled("stochastic-gravel", "efros-leung")

    def stop() -> None:
        raise Cancelled

    with pytest.raises(Cancelled):
        find_all(replace(subject, look=stop))


def test_without_an_exemplar_nothing_is_said() -> None:
    assert find_all(Subject(image=np.zeros((64, 64, 1), np.float32))) == ()


def test_a_volume_has_no_findings() -> None:
    exemplar = as_exemplar("gallery:stochastic-gravel", crop=Crop(0, 0, 32, 32))
    params = methods()["solid"].params(iterations=1)
    job = Job(method="solid", inputs={"exemplar": exemplar}, params=params, size=(16, 16, 16))
    assert findings_of(run(job)) == ()


def test_a_detector_has_words_for_all_and_rests_on_measures_that_exist() -> None:
    fields = {"id": "own", "title": "Own", "summary": "Only here.", "see": lambda case: None}
    with pytest.raises(ValueError, match="for other methods"):
        Detector(measures=(), why={}, **fields)  # type: ignore[arg-type]
    odd = Detector(measures=("nonsense",), why={"": "Because."}, **fields)  # type: ignore[arg-type]
    with pytest.raises(ParamError, match="measure: must be one of"):
        registry._accepted(odd, "other")
    good = Detector(measures=("cuts",), why={"": "Because."}, **fields)  # type: ignore[arg-type]
    assert registry._accepted(good, "other").package == "other"
    with pytest.raises(RuntimeError, match="registered already"):
        registry.register(find_detector("cuts"))
    with pytest.raises(ParamError, match="did you mean cuts"):
        find_detector("cut")


def test_a_detector_of_another_package_says_look_at_unless_it_knows_better() -> None:
    where = Where("result", "everywhere")
    own = Detector(
        id="own",
        title="Own",
        summary="Only here.",
        measures=("cuts",),
        see=lambda case: Seen("It is 1.", where),
        why={"": "Because."},
    )
    found = own.examine(Case(labelled("stochastic-gravel", "efros-leung")))
    assert found is not None
    assert found.certainty == LOOK_AT
    assert found.remedy == Remedy("No parameter of this method helps; try another one beside it.")
    assert replace(own, methods=("msg",)).examine(Case(labelled("stochastic-gravel", "efros-leung"))) is None
    sure = replace(own, certainty=FINDING).examine(Case(labelled("stochastic-gravel", "efros-leung")))
    assert sure is not None
    assert sure.certainty == FINDING


def test_rules() -> None:
    two = Rule(name="x", terms=(Term("a"), Term("b", -1, 1.0)), fit=Fit((2.0, -1.0), 3.0))
    values = {"a": 2.0, "b": np.e - 1}
    assert two.score(values.get) == pytest.approx(3.0)
    assert two.fires({"a": 2.1, "b": np.e - 1}.get)
    assert not two.fires({"a": 1.9, "b": np.e - 1}.get)
    assert not two.fires({"a": 9.0}.get)
    one = Rule(name="x", terms=(Term("b", -1, 0.01),), fit=Fit((-1.0,), -np.log(0.51)))
    assert one.border == pytest.approx(0.5)
    assert one.fires({"b": 0.49}.get)
    assert not one.fires({"b": 0.51}.get)
    bonet = methods()["de-bonet"].params
    for params, name in ((bonet(coarsest="shift"), "noise.de-bonet"), (bonet(), "noise"), (None, "noise")):
        # The labels know only one layout; what they say of it is not said of others.
        found = rule_for("noise", "de-bonet", params)
        assert found is not None
        assert found.name == name
    for finding, method, name in (
        ("noise", "", "noise"),
        ("structure-lost", "msg", "structure-lost.bands-alone"),
        ("structure-lost", "efros-leung", "structure-lost"),
    ):
        found = rule_for(finding, method)
        assert found is not None
        assert found.name == name
    assert rule_for("garbage", "msg") is None


def test_a_batch_says_what_it_finds_and_counts_hints_apart(monkeypatch: pytest.MonkeyPatch) -> None:
    from texlab_core.batch.page import _kinds
    from texlab_core.batch.pictures import finish

    exemplar = as_exemplar("gallery:stochastic-gravel", crop=Crop(0, 0, 64, 64))
    result = run(Job(method="tiling", inputs={"exemplar": exemplar}, size=(128, 128)))
    expected = tuple(each.sentence for each in findings_of(result))
    counted: list[str] = []
    real = Measure.of
    monkeypatch.setattr(Measure, "of", lambda self, subject: counted.append(self.id) or real(self, subject))
    picture = finish(result)
    assert picture.findings == expected
    # What is measured for the record is known to the findings.
    assert "discriminability" in counted
    assert len(counted) == len(set(counted))
    assert picture.findings
    assert _kinds(("It jumps.", "Look at this: it repeats.")) == ["found", "hinted"]
    assert _kinds(("Look at this: it repeats.",)) == ["hinted"]
    assert _kinds(("It jumps.",)) == ["found"]
    assert _kinds(()) == []


@pytest.mark.parametrize("texture", ["structured-scales", "structured-leaves"])
def test_a_cut_is_seen_in_the_default_layout_and_none_where_there_is_none(texture: str) -> None:
    exemplar = centre(texture)
    params = methods()["de-bonet"].params()
    job = Job(method="de-bonet", inputs={"exemplar": exemplar}, params=params, size=(256, 256), seed=5)
    whole = run(job).image
    cut = whole.copy()
    cut[:, 100:] = np.roll(whole[:, 100:], 67, axis=0)
    found = [
        seen(Subject(image=each, exemplar=exemplar, method="de-bonet", cache=CACHE), params)
        for each in (whole, cut)
    ]
    assert "cuts" not in found[0]
    assert found[1]["cuts"].certainty == "look at"
    # Either of the two lines that were made.
    (place,) = found[1]["cuts"].where.regions[:1]
    assert abs(place.left - 100) <= 2 or abs(place.top - 67) <= 2
