"""Figure sheets: text is text in an embedded typeface, pictures are exact, everything lies on the page."""

from __future__ import annotations

import base64
import io
import itertools
import re
import xml.etree.ElementTree as ElementTree

import numpy as np
import pypdf
import pytest
from PIL import Image, ImageDraw, ImageFont

from texlab_core.errors import ImageError, InputError, ParamError, RecipeError
from texlab_core.files.resources import resource
from texlab_core.sheets.contact_sheet import Tile
from texlab_core.sheets.figure import Figure, encode_figure, figure_page, letter, nice_length
from texlab_core.sheets.figure_items import Box, Picture, Words
from texlab_core.sheets.figure_pdf import attached_text
from texlab_core.sheets.figure_svg import carried_text
from texlab_core.sheets.sweep_sources import find_sweep
from texlab_core.sheets.typeface import typeface

SVG = "{http://www.w3.org/2000/svg}"
HREF = "{http://www.w3.org/1999/xlink}href"
GREEK = "α 0.15, β ≤ 1 — naïve “Łódź” <&>"


def tiles(count=5, side=24, channels=3):
    random = np.random.default_rng(1)
    shapes = [(side, side + 4 * (index % 2), channels) for index in range(count)]
    images = [(random.integers(0, 256, shape) / 255).astype(np.float32) for shape in shapes]
    return [Tile(image, (f"Panel {index}", GREEK)) for index, image in enumerate(images)]


@pytest.mark.parametrize("weight", ["regular", "bold"])
def test_widths_are_those_that_another_reader_of_fonts_finds(weight):
    face = typeface(weight)
    data = io.BytesIO(resource(f"fonts/{face.name}.ttf").read_bytes())
    font = ImageFont.truetype(data, 2048, layout_engine=ImageFont.Layout.BASIC)
    for each in ("Heeger-Bergen", GREEK, "W"):
        assert face.width(each, 2048) == pytest.approx(font.getlength(each), abs=2)


@pytest.mark.parametrize("weight", ["regular", "bold"])
def test_a_part_of_the_typeface_draws_its_characters_and_no_others(weight):
    face = typeface(weight)
    part = face.subset("Äf(")
    whole = resource(f"fonts/{face.name}.ttf").read_bytes()
    assert len(part) < len(whole) / 3
    small, large = (
        ImageFont.truetype(io.BytesIO(data), 300, layout_engine=ImageFont.Layout.BASIC) for data in (part, whole)
    )
    for each in "Äf(":
        masks = [Image.new("L", (400, 400)) for _ in range(2)]
        for font, mask in zip((small, large), masks, strict=True):
            ImageDraw.Draw(mask).text((20, 20), each, 255, font)
        one, other = (np.asarray(mask, np.float64) for mask in masks)
        # The hinter looks at the other characters too, and moves edges by less than a pixel.
        assert np.abs(one - other).sum() < 0.04 * other.sum()
    assert not any(bytes(small.getmask("Q")))
    assert small.getlength("Q") == large.getlength("Q")


def test_text_is_broken_to_its_width():
    face = typeface()
    lines = face.wrap("a word, a-very-long-hyphenated-word andonewithoutanyhyphenatall", 8, 50)
    assert len(lines) > 3
    assert all(face.width(line, 8) <= 50 for line in lines)
    assert "".join(lines).replace(" ", "") == "aword,a-very-long-hyphenated-wordandonewithoutanyhyphenatall"


def test_everything_lies_on_the_page_and_nothing_on_a_picture():
    page = figure_page(tiles(), Figure(width=8.5), columns=3, title=("A title", "below it"))
    pictures = [each for each in page.items if isinstance(each, Picture)]
    assert len(pictures) == 5
    assert page.width == pytest.approx(8.5 / 2.54 * 72)
    for each in page.items:
        if isinstance(each, Words):
            right = each.x + typeface(each.weight).width(each.text, each.size)
            box = (each.x, each.y - each.size * 0.76, right, each.y)
        else:
            box = (each.x, each.y, each.x + each.width, each.y + each.height)
        assert -1e-9 <= box[0] < box[2] <= page.width + 1e-6
        assert 0 <= box[1] < box[3] <= page.height
        for other in pictures:
            apart = box[2] <= other.x + 1e-9 or box[0] >= other.x + other.width - 1e-9
            apart = apart or box[3] <= other.y + 1e-9 or box[1] >= other.y + other.height - 1e-9
            assert apart or other is each
    scales = {round(each.width / each.pixels.shape[1], 9) for each in pictures}
    assert len(scales) == 1


def test_words_do_not_run_over_each_other():
    page = figure_page(
        tiles(4), Figure(width=6), columns=2, column_heads=("left", "right"), row_heads=("up", "down")
    )
    boxes = [
        (each.x, each.y - 0.7 * each.size, each.x + typeface(each.weight).width(each.text, each.size), each.y)
        for each in page.words
    ]
    for one, other in itertools.combinations(boxes, 2):
        assert one[2] <= other[0] or other[2] <= one[0] or one[3] <= other[1] or other[3] <= one[1]


@pytest.mark.parametrize("channels", [1, 3])
def test_a_pdf_has_its_text_its_fonts_and_its_pictures(channels):
    shown = tiles(3, channels=channels)
    page = figure_page(shown, Figure(), title=("Tïtle",), texts={"texlab-sweep": '{"a": "é"}'})
    data = encode_figure("a.pdf", page)
    assert data == encode_figure("b.PDF", page)
    read = pypdf.PdfReader(io.BytesIO(data), strict=True)
    assert len(read.pages) == 1
    assert read.metadata.title == "Tïtle"
    text = read.pages[0].extract_text()
    for wanted in ("Tïtle", "(a)", "(c)", "Panel 2", "pixels"):
        assert wanted in text
    assert "α 0.15, β ≤ 1 — naïve “Łódź” <&>" in re.sub(r"\s+", " ", text)
    fonts = read.pages[0]["/Resources"]["/Font"]
    assert len(fonts) == 2
    for font in fonts.values():
        part = font.get_object()["/DescendantFonts"][0].get_object()
        program = part["/FontDescriptor"]["/FontFile2"].get_object().get_data()
        ImageFont.truetype(io.BytesIO(program), 12)
    images = [np.asarray(each.image) for each in read.pages[0].images]
    assert len(images) == 3
    for image, tile in zip(images, shown, strict=True):
        wanted = np.rint(tile.image * 255).astype(np.uint8)
        np.testing.assert_array_equal(image.reshape(wanted.shape), wanted)
    assert read.attachments == {"texlab-sweep.json": ['{"a": "é"}'.encode()]}
    assert attached_text(data) == '{"a": "é"}'


def test_an_svg_has_its_text_its_fonts_and_its_pictures():
    shown = tiles(3)
    page = figure_page(shown, Figure(), title=("Tïtle <b>",), texts={"texlab-sweep": '{"a": "é<"}'})
    data = encode_figure("a.svg", page)
    root = ElementTree.fromstring(data)
    lines = [each.text for each in root.iter(f"{SVG}text")]
    assert lines == [each.text for each in page.words]
    assert "Tïtle <b>" in lines
    assert "(b)" in lines
    assert root.find(f"{SVG}metadata").text == '{"a": "é<"}' == carried_text(data)
    faces = re.findall(r"base64,([^)]+)\)", root.find(f"{SVG}style").text)
    assert len(faces) == 2
    for face in faces:
        ImageFont.truetype(io.BytesIO(base64.b64decode(face)), 12)
    images = [each.get(HREF) for each in root.iter(f"{SVG}image")]
    for image, tile in zip(images, shown, strict=True):
        found = np.asarray(Image.open(io.BytesIO(base64.b64decode(image.partition(",")[2]))))
        np.testing.assert_array_equal(found, np.rint(tile.image * 255))
    assert root.get("width") == "17cm"


def test_what_the_typeface_lacks_is_marked_in_the_figure():
    page = figure_page([Tile(tiles(1)[0].image, ("草 grass\x07",))], Figure())
    assert any(each.text == "\ufffd grass\ufffd" for each in page.words)
    ElementTree.fromstring(encode_figure("a.svg", page))


def test_fine_pictures_are_reduced_to_the_resolution():
    shown = [Tile(np.full((300, 400, 3), 0.25, np.float32))]
    page = figure_page(shown, Figure(width=2.54, dpi=100, bar=0), columns=1)
    assert next(each for each in page.items if isinstance(each, Picture)).pixels.shape == (75, 100, 3)
    page = figure_page(shown, Figure(width=2.54, dpi=400), columns=1)
    assert next(each for each in page.items if isinstance(each, Picture)).pixels.shape == (300, 400, 3)


def test_the_scale_bar_is_as_long_as_it_says():
    for bar, wanted in ((None, 50), (7, 7), (1, 1)):
        page = figure_page([Tile(np.zeros((20, 240, 1), np.float32))], Figure(width=10, bar=bar), columns=1)
        drawn = next(each for each in page.items if isinstance(each, Box))
        assert drawn.width == pytest.approx(wanted / 240 * page.width)
        assert page.words[-1].text == ("1 pixel" if wanted == 1 else f"{wanted} pixels")
    assert not [each for each in figure_page(tiles(1), Figure(bar=0)).items if isinstance(each, Box)]


def test_a_place_without_a_picture_says_why():
    page = figure_page([*tiles(1), Tile(None, ("failed",), "There is no such thing.")], Figure())
    assert "There is no such thing." in " ".join(each.text for each in page.words)
    only = figure_page([Tile(None, message="No picture at all.")], Figure())
    assert "No picture at all." in [each.text for each in only.words]


def test_letters_and_captions_can_be_left_out():
    bare = figure_page(tiles(2), Figure(letters=False, captions=False, bar=0))
    assert bare.words == ()
    encode_figure("a.pdf", bare)
    ElementTree.fromstring(encode_figure("a.svg", bare))
    assert [each.text for each in figure_page(tiles(2), Figure(captions=False, bar=0)).words] == ["(a)", "(b)"]


def test_panels_and_lengths_are_named():
    assert [letter(index) for index in (0, 25, 26, 27, 51, 52, 701, 702)] == [
        *("(a)", "(z)", "(aa)", "(ab)", "(az)", "(ba)", "(zz)", "(aaa)")
    ]
    steps = sorted(step * 10**power for power in range(5) for step in (1, 2, 5))
    for most in range(1, 3000, 7):
        assert nice_length(most) == max(each for each in steps if each <= most)
    assert nice_length(0.3) == 1


def test_figures_that_cannot_be_are_refused_in_one_sentence():
    for wrong in (
        {"width": 1.9},
        {"width": float("nan")},
        {"dpi": 0},
        {"points": 25},
        {"columns": 0},
        {"bar": -1},
    ):
        with pytest.raises(ParamError, match=next(iter(wrong))):
            Figure(**wrong)
    with pytest.raises(InputError, match="at least one picture"):
        figure_page([], Figure())
    with pytest.raises(InputError, match="40 columns do not fit 5 cm"):
        figure_page(tiles(40, side=4), Figure(width=5, columns=40))
    with pytest.raises(InputError, match="cm high"):
        figure_page(tiles(60), Figure(width=100, columns=1))
    with pytest.raises(ParamError, match="at most 24 pixels"):
        figure_page(tiles(1), Figure(bar=25))
    with pytest.raises(ImageError, match=r"\.pdf or \.svg"):
        encode_figure("a.eps", figure_page(tiles(1), Figure()))


@pytest.mark.parametrize("suffix", [".pdf", ".svg"])
def test_damaged_figures_are_no_sweeps(tmp_path, suffix):
    whole = encode_figure(f"a{suffix}", figure_page(tiles(1), Figure(), texts={"texlab-sweep": '{"a": 1}' * 9}))
    place = whole.index(b'{"a"')
    for number, data in enumerate((whole, whole[: place + 9], b"", b"%PDF-1.7", b"<svg", b"\xff" * 99)):
        path = tmp_path / f"{number}{suffix}"
        path.write_bytes(data)
        with pytest.raises(RecipeError):
            find_sweep(str(path))
