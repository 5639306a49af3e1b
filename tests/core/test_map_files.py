"""Maps and curves as files: exact data, pictures with known colours, tables that read back."""

import csv
import json
from dataclasses import replace

import numpy as np
import pytest

from tests.core.toy_recipe import levels, method, result_of  # noqa: F401
from texlab_core.documents.record import save_maps
from texlab_core.engine.steps import Curve, Map
from texlab_core.errors import InputError
from texlab_core.images.exemplar import as_exemplar
from texlab_core.images.formats.maps import picture

SOURCE = np.dstack(np.meshgrid(np.arange(9), np.arange(13), indexing="ij")).astype(np.int32)
MAPS = {
    "source": Map(SOURCE, "source", "Where pixels come from"),
    "candidates": Map(np.arange(117).reshape(9, 13), "count", "Candidates"),
    "pieces": Map((np.arange(117) % 5).reshape(9, 13).astype(np.int32), "label", "Copied pieces"),
    "local error": Map(np.linspace(0, 1, 117, dtype=np.float32).reshape(9, 13), "scalar", "Error", "levels"),
}


def test_everything_is_written_and_reads_back(tmp_path):
    curve = Curve.of([0.1, 1 / 3, np.nan], "Distance", y_label="W1")
    result = replace(result_of(as_exemplar(levels())), maps=MAPS, curves={"distance": curve})
    written = save_maps(result, tmp_path / "deep" / "maps")
    assert {each.name for each in written} == {each.name for each in (tmp_path / "deep" / "maps").iterdir()}
    names = {each.name for each in written}
    assert {"source.npy", "source.png", "local-error.npy", "distance.csv", "index.json"} <= names
    by_name = {each.name: each for each in written}
    for name, each in MAPS.items():
        found = np.load(by_name[name.replace(" ", "-") + ".npy"], allow_pickle=False)
        assert found.dtype == each.data.dtype
        assert np.array_equal(found, each.data)
        shown = as_exemplar(by_name[name.replace(" ", "-") + ".png"])
        assert shown.size == (9, 13)
    with by_name["distance.csv"].open(newline="") as table:
        rows = list(csv.reader(table))
    assert rows[0] == ["iteration", "W1"]
    assert [float(row[1]) for row in rows[1:3]] == [0.1, 1 / 3]
    index = json.loads(by_name["index.json"].read_text())
    assert index["maps"]["local error"]["unit"] == "levels"
    assert (index["maps"]["candidates"]["least"], index["maps"]["candidates"]["greatest"]) == (0, 116)
    assert index["curves"]["distance"]["file"] == "distance.csv"


def test_source_maps_show_the_place_in_the_exemplar():
    data = SOURCE.copy()
    data[4, 4] = -1
    shown = picture(Map(data, "source", ""), extent=(17, 25))
    assert shown[0, 0].tolist() == [0, 0, 96]
    assert shown[8, 12].tolist() == [128, 128, 96]
    assert shown[4, 4].tolist() == [0, 0, 0]
    assert picture(Map(SOURCE, "source", ""))[8, 12].tolist() == [255, 255, 96]


def test_scalars_go_along_viridis_and_nothing_is_black():
    data = np.array([[0.0, 5.0], [10.0, np.nan]], np.float32)
    shown = picture(Map(data, "scalar", ""))
    # The ends of viridis: dark violet and yellow.
    assert np.abs(shown[0, 0].astype(int) - [68, 1, 84]).max() <= 1
    assert np.abs(shown[1, 0].astype(int) - [253, 231, 37]).max() <= 2
    assert shown[1, 1].tolist() == [0, 0, 0]
    constant = picture(Map(np.full((2, 2), 3), "count", ""))
    assert (constant == constant[0, 0]).all()
    empty = picture(Map(np.full((2, 2), np.nan), "scalar", ""))
    assert not empty.any()


def test_labels_are_told_apart_and_zero_is_black():
    shown = picture(Map(np.arange(40, dtype=np.int32).reshape(5, 8), "label", "")).reshape(-1, 3).astype(int)
    assert not shown[0].any()
    distances = np.abs(shown[1:, None] - shown[None, 1:]).sum(axis=2) + 1000 * np.eye(39, dtype=int)
    assert distances.min() > 5
    assert np.diagonal(distances, 1).min() > 100


def test_a_folder_that_cannot_be_made(tmp_path):
    (tmp_path / "file").write_text("")
    with pytest.raises(InputError, match=r"file: cannot be made \(File exists\)\.$"):
        save_maps(result_of(as_exemplar(levels())), tmp_path / "file")
