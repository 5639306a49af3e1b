"""The tests themselves: what waits really waits, and nobody counts on a thread that has only told of its end."""

from __future__ import annotations

import ast
from pathlib import Path

import pytest

TESTS = Path(__file__).resolve().parents[1]
# Each of these returns what waits at the end of its "with" block, and alone does nothing.
BLOCKS = {"waitSignal", "waitSignals", "waitExposed", "waitActive", "waitCallback", "assertNotEmitted"}
OF_THREADS = {"busy", "is_alive", "occupied", "active_count"}


def names(tree: ast.AST) -> set[str]:
    found = list(ast.walk(tree))
    called = {each.attr for each in found if isinstance(each, ast.Attribute)}
    return called | {each.id for each in found if isinstance(each, ast.Name)}


def idle_waits(tree: ast.AST) -> list[int]:
    """Return the lines of statements that only make something that waits."""
    made = [
        each.value.func
        for each in ast.walk(tree)
        if isinstance(each, ast.Expr) and isinstance(each.value, ast.Call)
    ]
    return [each.lineno for each in made if isinstance(each, ast.Attribute) and each.attr in BLOCKS]


def hasty_looks(tree: ast.AST) -> list[int]:
    """Return the lines that look once at a thread after waiting for something else that it does."""
    found = []
    for function in ast.walk(tree):
        if not isinstance(function, ast.FunctionDef):
            continue
        waited: set[str] = OF_THREADS
        for statement in function.body:
            used = names(statement)
            if isinstance(statement, ast.Assert):
                denied = [each for each in ast.walk(statement) if isinstance(each, ast.UnaryOp)]
                if OF_THREADS & set().union(*map(names, denied)) - waited:
                    found.append(statement.lineno)
            elif any("wait" in name for name in used):
                waited = used
            # Whoever has waited for the thread itself may look at all of it.
            if used & {"join", "close", "await_threads"}:
                waited = OF_THREADS
    return found


@pytest.mark.parametrize(
    ("code", "look", "lines"),
    [
        ("qtbot.waitExposed(window)", idle_waits, [1]),
        ("with qtbot.waitExposed(window):\n    window.show()", idle_waits, []),
        ("def test():\n    qtbot.waitUntil(lambda: told)\n    assert not worker.busy", hasty_looks, [3]),
        ("def test():\n    qtbot.waitUntil(lambda: not worker.busy)\n    assert not worker.busy", hasty_looks, []),
        ("def test():\n    assert not editor.busy", hasty_looks, []),
    ],
)
def test_what_is_looked_for_is_found(code: str, look: object, lines: list[int]) -> None:
    assert look(ast.parse(code)) == lines  # type: ignore[operator]


def test_every_test_waits_for_what_it_looks_at() -> None:
    texts = {path.relative_to(TESTS).as_posix(): path.read_text("utf-8") for path in sorted(TESTS.rglob("*.py"))}
    assert len(texts) > 200
    for look, words in ((idle_waits, BLOCKS), (hasty_looks, OF_THREADS)):
        trees = {path: ast.parse(text) for path, text in texts.items() if any(word in text for word in words)}
        found = [f"{path}:{line}" for path, tree in trees.items() for line in look(tree)]
        assert found == [], look.__doc__
