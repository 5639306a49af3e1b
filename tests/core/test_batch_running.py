"""A batch makes every file once, whole; finds what is done; lists what fails; reports all of it."""

from __future__ import annotations

import csv
import errno
import io
import json
import os
import re
from html.parser import HTMLParser
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from tests.core.batch_tools import files_of, shape_of, small_plan
from texlab_core.api import synthesize
from texlab_core.batch import parcels
from texlab_core.batch.folder import BatchFolder, Record, file_stem
from texlab_core.batch.orders import make_order
from texlab_core.batch.parcels import Packer, Unpacked
from texlab_core.batch.pictures import thumbnail
from texlab_core.batch.places import InProcess
from texlab_core.batch.processes import Processes
from texlab_core.batch.rows import Row, Rows
from texlab_core.batch.running import Progress, run_batch, run_jobs
from texlab_core.documents.record import read_recipe
from texlab_core.engine.inputs import ArraysInput, Crop, DataInput
from texlab_core.engine.job import Job
from texlab_core.errors import Cancelled, InputError
from texlab_core.findings.revision import judged_by
from texlab_core.images.exemplar import as_exemplar
from texlab_core.images.formats.reading import read_image
from texlab_core.images.formats.volumes import read_volume
from texlab_core.images.formats.writing import quantize
from texlab_core.measures.registry import find_measure, measure_all, measure_quick
from texlab_core.measures.subject import Subject


def test_every_combination_is_what_one_call_makes(tmp_path: Path) -> None:
    result = run_batch(small_plan(tmp_path), tmp_path / "out")
    assert (result.made, result.found, result.failed) == (12, 0, 0)
    for row in result.rows:
        alone = synthesize(
            tmp_path / str(row.about["input"]), row.about["method"], size=(12, 20), seed=row.about["seed"]
        )
        kept = read_image(tmp_path / "out" / row.picture, "picture").values
        assert np.array_equal(kept, quantize(alone.image, 255).reshape(kept.shape))
        assert row.measures == measure_quick(Subject.of_result(alone))
    order = [(row.about["input"], row.about["variant"], row.about["seed"]) for row in result.rows]
    assert order == [
        (f"in/photo-{number}.png", method, seed)
        for number in range(3)
        for method in ("tiling", "heeger-bergen")
        for seed in (1, 2)
    ]


def test_a_picture_carries_its_recipe(tmp_path: Path) -> None:
    plan = small_plan(
        tmp_path, inputs=[{"from": "in/photo-1.png", "crops": ["16x10+2+3"]}], methods=["heeger-bergen"], seeds=[7]
    )
    (row,) = run_batch(plan, tmp_path / "out").rows
    recipe = read_recipe(tmp_path / "out" / row.picture)
    assert (recipe.method, recipe.seed, recipe.size) == ("heeger-bergen", 7, (12, 20))
    assert recipe.job().inputs["exemplar"].sha256 == plan.exemplars[0].load().sha256


def test_further_inputs_of_a_method(tmp_path: Path) -> None:
    small_plan(tmp_path)
    (tmp_path / "broken.png").write_bytes(b"no image")
    methods = [
        {"method": "mixture", "set": {"weight": 0.4}, "inputs": {"second": "in/photo-1.png"}, "name": "mixed"},
        {"method": "mixture", "inputs": {"second": "broken.png"}, "name": "broken"},
    ]
    plan = small_plan_of(tmp_path, inputs=["in/photo-0.png", "in/photo-2.png"], methods=methods, sizes=["20x12"])
    result = run_batch(plan, tmp_path / "out")
    assert (result.made, result.failed) == (2, 2)
    (error,) = {row.error for row in result.rows if row.error}
    assert error.startswith("broken.png: is not an image")
    second = as_exemplar(tmp_path / "in" / "photo-1.png")
    for row in result.rows[::2]:
        exemplar = tmp_path / str(row.about["input"])
        alone = synthesize(exemplar, "mixture", size=(12, 20), inputs={"second": second}, weight=0.4)
        kept = read_image(tmp_path / "out" / row.picture, "picture").values
        assert np.array_equal(kept, quantize(alone.image, 255).reshape(kept.shape))
        assert row.about["inputs"] == {"second": {"name": second.name, "sha256": second.sha256}}
        assert read_recipe(tmp_path / "out" / row.picture).job().inputs["second"].sha256 == second.sha256


def test_solids_are_kept_as_stacks(tmp_path: Path) -> None:
    plan = small_plan(
        tmp_path, inputs=["in/photo-0.png"], methods=["solid", "tiling"], seeds=[3], sizes=["7x6x5"], bits=16
    )
    row, refused = run_batch(plan, tmp_path / "out").rows
    assert (row.size, row.picture[-4:]) == ("7x6x5", ".tif")
    assert "size: must be height and width" in refused.error
    alone = synthesize(tmp_path / "in/photo-0.png", "solid", size=(5, 6, 7), seed=3)
    kept = read_volume(tmp_path / "out" / row.picture).values
    assert np.array_equal(kept, quantize(alone.volume, 65535))
    assert read_recipe(tmp_path / "out" / row.picture).size == (5, 6, 7)
    first, _ = csv.DictReader(io.StringIO((tmp_path / "out" / "report.csv").read_text("utf-8")))
    assert first["depth"] == "5"


def test_sixteen_bits(tmp_path: Path) -> None:
    plan = small_plan(tmp_path, methods=["tiling"], seeds=[1], bits=16)
    row = run_batch(plan, tmp_path / "out").rows[0]
    assert read_image(tmp_path / "out" / row.picture, "picture").peak == 65535


def test_what_is_done_is_found_and_what_is_half_is_made_again(tmp_path: Path) -> None:
    plan, out = small_plan(tmp_path), tmp_path / "out"
    first = run_batch(plan, out)
    before = files_of(out)
    again = run_batch(plan, out)
    assert (again.made, again.found) == (0, 12)
    assert files_of(out) == before
    # Shortened, removed, spoiled and renamed files, and what a killed process leaves.
    rows = first.rows
    (out / rows[0].picture).write_bytes(before[rows[0].picture][:-1])
    (out / rows[1].thumbnail).unlink()
    (out / "records" / f"{rows[2].job}.json").write_text("{", "utf-8")
    (out / "records" / f"{rows[3].job}.json").write_text("[]", "utf-8")
    (out / "records" / f"{rows[4].job}.json").write_bytes(before[f"records/{rows[5].job}.json"])
    # Numbers of another program, and of one that did not say which it was: they are not mixed with those of now.
    for row, judged in ((rows[6], {"judged_by": "0-0123456789ab"}), (rows[7], {})):
        path = out / "records" / f"{row.job}.json"
        old = json.loads(path.read_bytes())
        assert old.pop("judged_by") == judged_by()
        old["measures"]["discriminability"] = -9.0
        path.write_text(json.dumps(old | judged), "utf-8")
    (out / "pictures" / ".texlab-0123456789abcdef.tmp").write_bytes(b"half")
    (out / ".texlab-parcels").mkdir()
    (out / ".texlab-parcels" / "some.npz").write_bytes(b"half")
    mended = run_batch(plan, out)
    assert (mended.made, mended.found) == (7, 5)
    assert files_of(out) == before


def test_a_larger_plan_takes_what_is_there(tmp_path: Path) -> None:
    out = tmp_path / "out"
    run_batch(small_plan(tmp_path, seeds=[1]), out)
    more = run_batch(small_plan(tmp_path), out)
    assert (more.made, more.found) == (6, 6)
    assert files_of(out) == files_of(_fresh(small_plan(tmp_path), tmp_path / "other"))


def _fresh(plan: Any, out: Path) -> Path:
    run_batch(plan, out)
    return out


def test_what_fails_is_listed_and_the_rest_goes_on(tmp_path: Path) -> None:
    small_plan(tmp_path)
    (tmp_path / "in" / "photo-1.png").write_bytes(b"no image")
    entry = [{"from": "in/*.png", "crops": {"size": "28x24"}}, "in/photo-0.png"]
    plan = small_plan_of(tmp_path, inputs=entry, methods=["tiling"], seeds=[1], sizes=["20x12", "900x"])
    told: list[Progress] = []
    result = run_batch(plan, tmp_path / "out", on_progress=told.append)
    assert (result.made, result.failed) == (3, 5)
    errors = {row.title: row.error for row in result.rows if row.error}
    assert errors["in/photo-1.png (crop 1 of 1), tiling, 20x12, seed 1"].startswith(
        "in/photo-1.png: is not an image"
    )
    assert all("64 megapixels" in error for title, error in errors.items() if "photo-1" not in title)
    said = [each.error for each in told if each.error]
    assert len(said) == 4, "an image that cannot be read is told once"
    assert said[1].endswith("2 jobs need it.")
    assert told[-1] == Progress(3, 5, 8, told[-1].remaining_s, told[-1].error)
    assert told[-1].fraction == 1
    # Mended, it goes on.
    small_plan(tmp_path)
    again = run_batch(plan, tmp_path / "out")
    assert (again.made, again.found, again.failed) == (1, 3, 4)


def small_plan_of(folder: Path, **changes: Any) -> Any:
    from texlab_core.batch.plan import plan_from_json

    return plan_from_json(changes, folder=folder)


def test_what_is_said_of_an_exemplar_names_it_once(tmp_path: Path) -> None:
    small_plan(tmp_path)
    entry = [{"from": "in/photo-0.png", "crops": ["99x99+0+0"]}]
    plan = small_plan_of(tmp_path, inputs=entry, methods=["tiling"], seeds=[1], sizes=["20x12"])
    told: list[Progress] = []
    run_batch(plan, tmp_path / "out", on_progress=told.append)
    (said,) = [each.error for each in told if each.error]
    assert said.startswith("in/photo-0.png (crop 99x99+0+0): the crop must lie inside")


def test_the_same_job_twice_is_made_once(tmp_path: Path) -> None:
    plan = small_plan(
        tmp_path,
        methods=[{"method": "tiling", "name": "a"}, {"method": "tiling", "name": "b"}],
        seeds=[1],
        sizes=["20x12", "20x12", "1x"],
    )
    result = run_batch(plan, tmp_path / "out")
    assert (plan.count, result.made, result.repeated, len(result.rows)) == (12, 6, 6, 6)


def test_a_plan_can_choose_what_is_measured(tmp_path: Path) -> None:
    plan = small_plan(tmp_path, methods=["tiling"], seeds=[1], measures=["w1-pixels", "tile-share"])
    result = run_batch(plan, tmp_path / "out")
    assert {tuple(row.measures or {}) for row in result.rows} == {("tile-share", "w1-pixels")}
    page = (tmp_path / "out" / "index.html").read_text("utf-8")
    measure = find_measure("w1-pixels")
    assert f"<button>{measure.title}</button>" in page
    value = (result.rows[0].measures or {})["w1-pixels"]
    assert value is not None
    assert f">{measure.text(value)}</td>" in page
    whole = run_batch(small_plan(tmp_path, methods=["tiling"], seeds=[1], measures="all"), tmp_path / "out")
    alone = synthesize(tmp_path / "in" / "photo-0.png", "tiling", size=(12, 20), seed=1)
    assert whole.rows[0].measures == measure_all(Subject.of_result(alone))
    # Measured otherwise, it is another record.
    again = run_batch(small_plan(tmp_path, methods=["tiling"], seeds=[1]), tmp_path / "out")
    assert (again.made, again.found) == (3, 0)


def test_a_sample_runs_only_its_jobs(tmp_path: Path) -> None:
    told: list[Progress] = []
    plan = small_plan(tmp_path)
    result = run_batch(plan, tmp_path / "out", sample=3, on_progress=told.append)
    assert result.made == 3
    assert [row.about["input"] for row in result.rows] == [f"in/photo-{number}.png" for number in range(3)]
    assert told[-1].total == 3
    assert told[-1].remaining_s == 0
    rest = run_batch(plan, tmp_path / "out")
    assert (rest.made, rest.found) == (9, 3)


def test_stopping_keeps_what_is_done_and_reports_it(tmp_path: Path) -> None:
    plan, out = small_plan(tmp_path), tmp_path / "out"
    told: list[Progress] = []
    with pytest.raises(Cancelled):
        run_batch(plan, out, on_progress=told.append, should_stop=lambda: len(told) == 5)
    assert len(list((out / "records").iterdir())) == 5
    assert "5 of 12 textures" in (out / "index.html").read_text("utf-8")
    run_batch(plan, out)
    assert files_of(out) == files_of(_fresh(plan, tmp_path / "other"))


def test_no_folder_is_looked_through_once_for_each_job(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    looked, scan = [], os.scandir

    def watched(path: Any) -> Any:
        looked.append(Path(path).relative_to(tmp_path / "out"))
        return scan(path)

    plan = small_plan(tmp_path, methods=["tiling"])
    monkeypatch.setattr(os, "scandir", watched)
    assert run_batch(plan, tmp_path / "out").made == 6
    assert not [path for path in looked if looked.count(path) > 1 and path.parts]


def test_two_batches_never_share_a_folder(tmp_path: Path) -> None:
    plan, out = small_plan(tmp_path), tmp_path / "out"
    with BatchFolder(out), pytest.raises(InputError, match=r"^Another batch is at work in .*out; wait"):
        run_batch(plan, out)
    (tmp_path / "file").write_text("", "utf-8")
    with pytest.raises(InputError, match="is a file, and a folder is wanted"):
        run_batch(plan, tmp_path / "file")
    with pytest.raises(InputError, match="cannot be made or written to"):
        run_batch(plan, tmp_path / "no" / "out")


class FullDisk:
    """A file on a disk that has no room any more."""

    def tell(self) -> int:
        return 1

    def write(self, text: str) -> int:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    def close(self) -> None:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))


def test_a_full_disk_is_one_sentence_and_the_folder_is_let_go_of(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    plan, out = small_plan(tmp_path, methods=["tiling"]), tmp_path / "out"
    with monkeypatch.context() as patch:
        patch.setattr("texlab_core.batch.folder.open_appending", lambda path: FullDisk())
        with pytest.raises(InputError, match=r"times\.csv: cannot be written \(No space left on device\)\.$"):
            run_batch(plan, out)
    with monkeypatch.context() as patch:
        patch.setattr("numpy.savez", lambda file, **arrays: FullDisk().write(""))
        with pytest.raises(InputError, match=r"cannot be laid down there \(No space left on device\)\.$"):
            run_batch(plan, out, place=Processes(1))
    (out / "times.csv").unlink()
    (out / "times.csv").mkdir()
    with pytest.raises(InputError, match=r"times\.csv: cannot be written \("):
        run_batch(plan, out)
    (out / "times.csv").rmdir()
    assert (out / "times.csv").parent.is_dir()
    again = run_batch(plan, out)
    assert (again.made, again.found) == (5, 1)


def test_the_table_holds_every_number(tmp_path: Path) -> None:
    plan = small_plan(tmp_path, inputs=["in/photo-0.png", "in/photo-1.png"])
    (tmp_path / "in" / "photo-1.png").rename(tmp_path / "=1+1.png")
    plan = small_plan_of(tmp_path, inputs=["=1+1.png", "in/photo-0.png"], methods=["heeger-bergen"])
    result = run_batch(plan, tmp_path / "out")
    rows = list(csv.DictReader(io.StringIO((tmp_path / "out" / "report.csv").read_text("utf-8"))))
    assert [row["input"] for row in rows] == ["'=1+1.png", "in/photo-0.png"], "no formula for a spreadsheet"
    for row, made in zip(rows, result.rows, strict=True):
        assert (row["width"], row["height"], row["seed"]) == ("30", "26", "0")
        assert json.loads(row["parameters"]) == made.about["parameters"]
        assert (tmp_path / "out" / row["picture"]).is_file()
        for name, value in (made.measures or {}).items():
            assert float(row[name]) == value


class Page(HTMLParser):
    """Collects the rows, the links and the pictures of a page, and checks that tags are closed."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.open: list[str] = []
        self.rows: list[dict[str, str | None]] = []
        self.paths: list[str] = []
        self.feed(text)
        assert self.open == []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        given = dict(attrs)
        if tag == "tr" and "data-state" in given:
            self.rows.append(given)
        self.paths += [path for key in ("src", "href") if (path := given.get(key)) is not None]
        if tag not in ("meta", "img", "input"):
            self.open.append(tag)

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag


def test_the_page_needs_nothing_but_its_folder(tmp_path: Path) -> None:
    small_plan(tmp_path)
    hostile = 'x"><script>alert(1)<'
    (tmp_path / "in" / "photo-2.png").rename(tmp_path / "in" / f"{hostile}.png".replace("/", ""))
    (tmp_path / "in" / "photo-1.png").write_bytes(b"no image")
    data = {"inputs": ["in"], "methods": ["tiling"], "name": "<b>", "note": "</p>", "sizes": ["20x12"]}
    run_batch(small_plan_of(tmp_path, **data), tmp_path / "out")
    text = (tmp_path / "out" / "index.html").read_text("utf-8")
    page = Page(text)
    assert text.count("<script>") == 1
    assert "http:" not in text
    assert "https:" not in text
    assert [row["data-state"] for row in page.rows] == ["made", "failed", "made"]
    assert len(page.paths) == 1 + 2 * 3
    from urllib.parse import unquote

    assert all((tmp_path / "out" / unquote(path)).is_file() for path in page.paths)
    used = set(re.findall(r"form\.(\w+)\.value", text))
    assert used == {"words", "variant", "state"}
    assert all(f'name="{name}"' in text for name in used)


def test_file_names_that_every_system_accepts() -> None:
    assert file_stem("in/ä b\\c:*?.png") == "in-b-c-.png"
    assert file_stem("../..") == "texture"
    assert len(file_stem("a" * 300)) == 80


def test_small_pictures_keep_their_proportions() -> None:
    image = np.random.Generator(np.random.PCG64(1)).random((40, 300, 3), np.float32)
    assert read_image(thumbnail(image), "a").values.shape == (17, 128, 3)
    assert read_image(thumbnail(image[:, :50]), "a").values.shape == (40, 50, 3)
    mean = read_image(thumbnail(image), "a").values.mean() / 255
    assert abs(mean - image.mean()) < 0.01


def test_a_hash_depends_on_everything_that_the_result_does(monkeypatch: pytest.MonkeyPatch) -> None:
    pixels = np.random.Generator(np.random.PCG64(1)).random((16, 18, 3), np.float32)

    def key(
        method: str = "heeger-bergen", image: Any = pixels, seed: int = 0, size: Any = None, **params: Any
    ) -> str:
        from texlab_core.engine.registry import find_method

        kind = find_method(method).params
        exemplar = as_exemplar(image) if isinstance(image, np.ndarray) else image
        job = Job(method=method, inputs={"exemplar": exemplar}, params=kind(**params), size=size, seed=seed)
        return make_order(job, shape_of, bits=8)[0].key

    whole = as_exemplar(pixels)
    different = [
        key(),
        key("tiling"),
        key(image=pixels[:, ::-1]),
        key(image=as_exemplar(whole, crop=Crop(0, 0, 16, 17))),
        key(image=as_exemplar(whole, name="other")),
        key(seed=1),
        key(size=(8, 8)),
        key(iterations=2),
    ]
    assert len(set(different)) == len(different)
    assert key() == different[0]
    monkeypatch.setattr("texlab_core.batch.orders.versions", lambda: {"numpy": "0"})
    assert key() != different[0]


def test_the_hash_of_a_source_is_made_once_while_it_is_there(monkeypatch: pytest.MonkeyPatch) -> None:
    hashed: list[Any] = []
    whole = parcels.hash_arrays
    monkeypatch.setattr(parcels, "hash_arrays", lambda arrays: hashed.append(1) or whole(arrays))
    packer = Packer()
    first, second = (as_exemplar(np.full((6, 6), value, np.float32)) for value in (0.1, 0.2))
    packed = [packer.pack({"exemplar": first, "second": second})[1] for _ in range(5)]
    assert len(hashed) == 2
    assert len({name for each in packed for name in each}) == 2
    for number in range(30):
        # Arrays that are gone leave their places in memory to others.
        (digest,) = packer.pack({"exemplar": as_exemplar(np.full((6, 6), number / 30, np.float32))})[1]
        assert digest == whole({"pixels": np.full((6, 6, 1), np.float32(number / 30))})


def test_every_kind_of_input_travels() -> None:
    pixels = np.random.Generator(np.random.PCG64(1)).random((16, 18, 3), np.float32)
    image = as_exemplar(pixels, scale=0.5, crop=Crop(1, 1, 4, 5), name="image")
    arrays = ArraysInput({"a": np.arange(4), "b": np.ones((2, 2))}, "state")
    data = DataInput({"x": [1, 2]}, "code")
    slips, sent = Packer().pack({"exemplar": image, "state": arrays, "code": data, "again": as_exemplar(image)})
    assert len(sent) == 2, "what two inputs share is sent once"
    for role, given in {"exemplar": image, "state": arrays, "code": data}.items():
        found = slips[role].unpack(sent)
        assert (found.sha256, found.name, type(found)) == (given.sha256, given.name, type(given))
    spoiled = {name: {key: value + 0.25 for key, value in each.items()} for name, each in sent.items()}
    with pytest.raises(InputError, match="has other values where it arrived"):
        slips["state"].unpack(spoiled)


def test_of_large_scans_only_the_newest_stays_unpacked() -> None:
    whole = [as_exemplar(np.full((64, 64, 1), value, np.float32)) for value in (0.1, 0.2, 0.3)]
    unpacked, packer = Unpacked(max_bytes=40_000), Packer()
    for scan in whole:
        for place in range(3):
            given = as_exemplar(scan, crop=Crop(place, 0, 8, 8))
            slips, sent = packer.pack({"exemplar": given})
            found = unpacked.get(slips["exemplar"], sent)
            assert found is unpacked.get(slips["exemplar"], sent)
            assert found.sha256 == given.sha256
    # Crops of one scan count it once; two scans of 16 kB fit beside their crops.
    assert len(unpacked) == 6
    small = Unpacked(max_bytes=1)
    small.get(slips["exemplar"], sent)
    assert len(small) == 1


def test_rows_are_read_when_they_are_wanted() -> None:
    read: list[str] = []

    def record(key: str) -> Record:
        read.append(key)
        data = dict.fromkeys(("picture", "thumbnail"), f"{key}.png") | {"findings": [], "notes": []}
        return Record(key, data | {"measures": {"w1-pixels": 0.5}})

    rows = Rows(record)
    for place in (4, 0, 2):
        rows.add(place, Row.of(record(f"{place:064x}")))
    rows.add(3, Row.failed({}, "No."))
    read.clear()
    assert (len(rows), rows.failed, rows.measures, read) == (4, 1, ("w1-pixels",), [])
    assert rows[1].job == f"{2:064x}"
    assert len(read) == 1
    assert [each.error or int(each.job, 16) for each in rows] == [0, 2, "No.", 4]
    assert [each.error for each in rows.failures] == ["No."]
    assert [each.job for each in rows[::3]] == [f"{0:064x}", f"{4:064x}"]


def test_another_version_there_is_refused() -> None:
    job = Job(method="tiling", inputs={"exemplar": as_exemplar(np.eye(8, dtype=np.float32))})
    order, sent = make_order(job, shape_of)
    import dataclasses

    other = dataclasses.replace(order, versions={**order.versions, "numpy": "0.1"})
    outcomes = list(InProcess().run(iter([(other, sent), (order, sent)])))
    assert "numpy" in outcomes[0].error
    assert "started with 0.1" in outcomes[0].error
    assert outcomes[1].value[0] == (8, 8, 1)


def test_jobs_without_a_plan() -> None:
    exemplar = as_exemplar(np.eye(8, dtype=np.float32))
    jobs = [Job(method="tiling", inputs={"exemplar": exemplar}, size=(size, 9)) for size in (3, 4, 5)]
    found = list(run_jobs(iter(jobs)))
    assert [number for number, _ in found] == [0, 1, 2]
    for job, (_, outcome) in zip(jobs, found, strict=True):
        assert outcome.error == ""
        assert outcome.value.image.shape == (*job.size, 1)
        assert outcome.value.maps == {}
    broken = list(run_jobs(iter(jobs[:1]), finish=_spoil))
    assert broken[0][1].error == "Something unexpected happened (ZeroDivisionError: float division by zero)."


def _spoil(result: Any) -> float:
    return result.elapsed_s / 0


def test_an_endless_supply_takes_no_memory() -> None:
    exemplar = as_exemplar(np.eye(8, dtype=np.float32))
    taken = []

    def supply() -> Any:
        for seed in range(10**6):
            taken.append(seed)
            yield Job(method="tiling", inputs={"exemplar": exemplar}, size=(4, 4), seed=seed)

    outcomes = run_jobs(supply(), finish=shape_of)
    for _ in range(3):
        next(outcomes)
    outcomes.close()  # type: ignore[attr-defined]
    assert len(taken) == 3
