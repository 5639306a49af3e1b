"""JSON from outside: what is read equals the standard parser, what is refused says why in one sentence."""

from __future__ import annotations

import itertools
import json

import pytest
from hypothesis import given
from hypothesis import strategies as st

from texlab_core.errors import InputError, RecipeError
from texlab_core.files import strict_json

TEXT = st.text(st.characters(exclude_categories=["Cs"]), max_size=20)
DATA = st.recursive(
    st.none()
    | st.booleans()
    | st.integers(-(10**30), 10**30)
    | st.floats(allow_nan=False, allow_infinity=False)
    | TEXT,
    lambda inner: st.lists(inner, max_size=4) | st.dictionaries(TEXT, inner, max_size=4),
    max_leaves=12,
)


@given(DATA)
def test_reads_what_the_standard_parser_reads(data):
    text = json.dumps(data)
    assert strict_json.loads(text) == data
    assert strict_json.loads(text.encode()) == data
    assert strict_json.loads(strict_json.dumps(data)) == data


def test_a_byte_order_mark_is_no_content():
    assert strict_json.loads(b"\xef\xbb\xbf[1]") == [1]
    assert strict_json.loads("\ufeff[1]") == [1]


def test_brackets_inside_strings_are_no_nesting():
    text = json.dumps({"a": "[" * 500, 'b\\"': '\\"[[' * 50})
    assert strict_json.loads(text, max_depth=1) == json.loads(text)


@pytest.mark.parametrize("depth", [1, 5, 32])
def test_depth_is_counted_exactly(depth):
    text = "[" * depth + "]" * depth
    assert strict_json.loads(text, max_depth=depth) == json.loads(text)
    with pytest.raises(InputError, match=r"^The text is nested more than"):
        strict_json.loads("[" + text + "]", max_depth=depth)


@pytest.mark.parametrize(
    ("source", "says"),
    [
        ("", "is not valid JSON"),
        ("{", "is not valid JSON"),
        ('{"a": 1} x', "is not valid JSON"),
        ('["unclosed', "is not valid JSON"),
        ("[" * 100_000, "is nested more than 32 levels deep"),
        ("[NaN]", "holds NaN"),
        ("[-Infinity]", "holds -Infinity"),
        ("[1e999]", "too large"),
        ("1" * 5000, "too large or too long"),
        ("0." + "1" * 5000, "too large or too long"),
        ('{"a": 1, "b": {"c": 1, "c": 2}}', "has the key 'c' twice"),
        ('["\\ud800"]', "half of a surrogate pair"),
        ('["' + '\\"' * 500_000 + "\\", "is not valid JSON"),
        (b"\xff\xfe[1]", "is not UTF-8 text"),
        (b'["\xc3"]', "is not UTF-8 text"),
        ("[" + "1," * 600_000 + "1]", "is 1.14 MB long, and at most 1 MB is read"),
    ],
)
def test_what_is_refused_says_why(source, says):
    with pytest.raises(RecipeError) as caught:
        strict_json.loads(source, what="the recipe", error=RecipeError)
    message = str(caught.value)
    assert message.startswith("The recipe ")
    assert says in message
    assert message.endswith(".")
    assert len(message) < 160


def test_a_key_repeated_among_very_many_is_found_at_once():
    # Counting each key among all the others would take hours.
    source = "{" + ",".join(f'"{key}":0' for key in range(400_000)) + ',"399999":1}'
    with pytest.raises(RecipeError, match="has the key '399999' twice"):
        strict_json.loads(source, max_bytes=2**25, error=RecipeError)


def test_size_counts_bytes_not_characters():
    text = json.dumps("ä" * 100, ensure_ascii=False)
    assert strict_json.loads(text, max_bytes=202) == "ä" * 100
    with pytest.raises(InputError, match="202 bytes long"):
        strict_json.loads(text, max_bytes=201)


def test_files(tmp_path):
    path = tmp_path / "a.json"
    path.write_text('{"a": [1, 2.5]}')
    assert strict_json.load(path) == {"a": [1, 2.5]}
    path.write_text("[1," * 3)
    with pytest.raises(InputError, match=r"a\.json is not valid JSON"):
        strict_json.load(path)
    path.write_text(" " * 2000)
    with pytest.raises(InputError, match="is longer than 1000 bytes"):
        strict_json.load(path, max_bytes=1000)
    with pytest.raises(RecipeError, match=r"cannot be read \(No such file or directory\)\.$"):
        strict_json.load(tmp_path / "missing.json", error=RecipeError)
    with pytest.raises(InputError, match=r"cannot be read"):
        strict_json.load("a\0b")


def test_writing_refuses_what_reading_refuses():
    with pytest.raises(ValueError, match="not JSON compliant"):
        strict_json.dumps([float("nan")])


@pytest.mark.parametrize("text", ["1" * 900_000, "-" + "9" * 900_000, "0." + "3" * 900_000, "1e" + "9" * 900_000])
def test_long_numbers_are_refused_before_they_are_converted(text, monkeypatch):
    # The time of a conversion grows with the square of the digits.
    converted = []
    for kind in (int, float):
        monkeypatch.setattr(
            strict_json,
            kind.__name__,
            lambda digits, kind=kind: (converted.append(digits), kind(digits))[1],
            raising=False,
        )
    with pytest.raises(InputError, match="too large or too long"):
        strict_json.loads(f"[12, 3.5, {text}]")
    assert converted == ["12", "3.5"]


@pytest.mark.parametrize("opening", ["[", '{"a":', '[{"":['])
def test_deep_texts_never_reach_the_parser(opening, monkeypatch):
    # It recurses, and its errors depend on the version of Python.
    def never(*_, **__):
        raise AssertionError

    monkeypatch.setattr(json, "loads", never)
    with pytest.raises(InputError, match="is nested more than 32 levels deep"):
        strict_json.loads(opening * 100_000)


def test_quotes_and_backslashes_are_walked_over_once(monkeypatch):
    # However it is closed or escaped, no character is looked at by two tokens.
    tokens = strict_json._TOKENS
    for text in ('"' * 100_001, '"\\' * 100_000, '"\\"' * 100_000, '["' + "\\" * 200_001, "]" * 100_000):
        found = [token.span() for token in tokens.finditer(text)]
        assert all(before[1] <= after[0] for before, after in itertools.pairwise(found))
        assert len(found) <= len(text)
        with pytest.raises(InputError, match="is not valid JSON"):
            strict_json.loads(text)
