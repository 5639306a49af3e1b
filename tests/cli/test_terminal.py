"""Standard error that is closed or full, names that would move the cursor, and Ctrl-C."""

from __future__ import annotations

import importlib
import json
import logging
import os
import signal
import subprocess
import sys
import time
from typing import TYPE_CHECKING

import pytest

from texlab.cli import main as cli
from texlab.cli import terminal
from texlab.cli.terminal import complain, interrupted, logged_quietly, orderly_interrupts

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from pathlib import Path
    from types import FrameType

    from tests.cli.conftest import Texlab

PATIENCE_S = 240
posix = pytest.mark.skipif(os.name == "nt", reason="signals and devices of Unix")


def test_a_complaint_is_one_line_that_changes_no_colours(capsys: pytest.CaptureFixture[str]) -> None:
    complain("no\n\x1b[2J\u202e\udcff: Wände")
    assert capsys.readouterr().err == "texlab: no\\n\\x1b[2J\\u202e\\udcff: Wände\n"


def test_without_standard_error_nothing_is_said(monkeypatch: pytest.MonkeyPatch, texlab: Texlab) -> None:
    monkeypatch.setattr(sys, "stderr", None)
    assert cli.main(["synth", "missing.png", "--method", "tiling", "--out", "a.png"]) == 2
    assert cli.main(["synth"]) == 2


@posix
@pytest.mark.parametrize(
    "arguments",
    [["gallery"], ["gallery", "--json"], ["--help"], ["--version"], ["methods", "--json"]],
    ids=" ".join,
)
def test_a_full_standard_output_is_one_sentence(arguments: list[str]) -> None:
    without = {name: value for name, value in os.environ.items() if name != "PYTHONUNBUFFERED"}
    with open("/dev/full", "wb") as full:
        done = subprocess.run(
            [sys.executable, "-m", "texlab", *arguments],
            stdout=full,
            stderr=subprocess.PIPE,
            env=without,
            check=False,
        )
    assert done.returncode == 2
    assert done.stderr == b"texlab: Standard output cannot be written: No space left on device.\n"


@posix
@pytest.mark.parametrize("arguments", [["synth"], ["redo", "missing.png", "--out", "a.png"]], ids=" ".join)
def test_a_full_or_closed_standard_error_changes_no_exit_code(arguments: list[str]) -> None:
    command = [sys.executable, "-m", "texlab", *arguments]
    with open("/dev/full", "wb") as full:
        done = subprocess.run(command, stdout=subprocess.PIPE, stderr=full, check=False)
    assert (done.returncode, done.stdout) == (2, b"")
    closed = subprocess.run([*["sh", "-c", 'exec "$@" 2>&-', "sh"], *command], stdout=subprocess.PIPE, check=False)
    assert (closed.returncode, closed.stdout) == (2, b"")


@pytest.fixture
def press() -> Iterator[Callable[[], None]]:
    """Return what presses Ctrl-C in this process, which may have been started with the signal ignored."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield lambda: os.kill(os.getpid(), signal.SIGINT)
    signal.signal(signal.SIGINT, before)


@pytest.fixture
def patience_ends(monkeypatch: pytest.MonkeyPatch) -> Callable[[], None]:
    """Return what ends the time in which work may ask; it does not end by itself."""
    monkeypatch.setattr(terminal, "_PATIENCE_S", 1000)
    return lambda: os.kill(os.getpid(), signal.SIGALRM)


def within(work: Callable[[], None]) -> None:
    with orderly_interrupts():
        work()


def wait() -> None:
    """Wait until a signal's handler raises."""
    while True:
        signal.pause()


@posix
def test_whoever_asks_learns_of_an_interruption(
    press: Callable[[], None], patience_ends: Callable[[], None]
) -> None:
    seen = []

    def work() -> None:
        seen.append(interrupted())
        press()
        while not interrupted():
            pass
        # Nothing is raised on the way out of work that has heard of it.
        patience_ends()
        seen.append(interrupted())

    with pytest.raises(KeyboardInterrupt):
        within(work)
    assert seen == [False, True]
    assert not interrupted()


@posix
def test_no_press_is_lost_wherever_it_comes(press: Callable[[], None], monkeypatch: pytest.MonkeyPatch) -> None:
    """Press before every single instruction of the code that takes, tells and raises it."""
    monkeypatch.setattr(terminal, "_PATIENCE_S", 1000)
    handlers = {number: signal.getsignal(number) for number in (signal.SIGINT, signal.SIGALRM)}
    hook, tracer = sys.unraisablehook, sys.gettrace()
    lost, unheard, passed = [], [], 0

    def within_at(place: int) -> tuple[bool, list[bool]]:
        nonlocal passed
        passed, asked = 0, []

        def look(frame: FrameType, event: str, _: object) -> object:
            nonlocal passed
            if frame.f_code.co_filename != terminal.__file__:
                return None
            frame.f_trace_opcodes = True
            if event == "opcode":
                passed += 1
                if passed == place:
                    press()
            return look

        sys.settrace(look)  # type: ignore[arg-type]  # what mypy knows of it is not all that it takes
        try:
            within(lambda: asked.extend(interrupted() for _ in range(3)))
        except KeyboardInterrupt:
            return True, asked
        finally:
            sys.settrace(tracer)
            sys.unraisablehook = hook
            signal.setitimer(signal.ITIMER_REAL, 0)
            for number, handler in handlers.items():
                signal.signal(number, handler)
        return False, asked

    within_at(0)
    instructions = passed
    assert instructions > 100
    for place in range(1, instructions + 1):
        raised, asked = within_at(place)
        if not raised:
            lost.append(place)
        # Once it has been told, it is told for good, and whoever was told counts as having heard.
        if asked != sorted(asked) or any(asked) != terminal._interruption.heard:
            unheard.append((place, asked))
    assert not lost
    assert not unheard


@posix
def test_work_that_does_not_ask_is_interrupted(
    press: Callable[[], None], patience_ends: Callable[[], None]
) -> None:
    reached = []

    def work() -> None:
        press()
        reached.append("pressed")
        patience_ends()
        reached.append("never")

    with pytest.raises(KeyboardInterrupt):
        within(work)
    assert reached == ["pressed"]


@posix
def test_patience_ends_by_itself(press: Callable[[], None], monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(terminal, "_PATIENCE_S", 0.001)

    def work() -> None:
        press()
        wait()

    with pytest.raises(KeyboardInterrupt):
        within(work)


@posix
def test_an_alarm_that_comes_before_the_handler_is_done_is_no_loss(
    press: Callable[[], None], monkeypatch: pytest.MonkeyPatch
) -> None:
    # As on a machine so busy that the time is over before the handler's next line.
    def at_once(_: object, seconds: float, *rest: object) -> None:
        if seconds:
            os.kill(os.getpid(), signal.SIGALRM)

    monkeypatch.setattr(terminal.signal, "setitimer", at_once)
    reached = []

    def work() -> None:
        press()
        reached.append(interrupted())

    with pytest.raises(KeyboardInterrupt):
        within(work)
    assert reached == []
    assert signal.getsignal(signal.SIGINT) is signal.SIG_DFL


@posix
def test_imports_are_not_interrupted(
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    press: Callable[[], None],
    patience_ends: Callable[[], None],
) -> None:
    (tmp_path / "slow_to_import.py").write_text(
        "import os, signal\nfor each in ('SIGINT', 'SIGALRM'):\n    os.kill(os.getpid(), getattr(signal, each))\n"
        "DONE = True\n"
    )
    monkeypatch.syspath_prepend(tmp_path)
    found = []

    def work() -> None:
        found.append(importlib.import_module("slow_to_import").DONE)
        wait()

    with pytest.raises(KeyboardInterrupt):
        within(work)
    assert found == [True]


@posix
def test_what_a_destructor_swallows_is_raised_again(
    press: Callable[[], None], patience_ends: Callable[[], None]
) -> None:
    class Swallows:
        def __del__(self) -> None:
            press()
            patience_ends()

    reached = []

    def work() -> None:
        Swallows()
        reached.append("after")
        wait()

    with pytest.raises(KeyboardInterrupt):
        within(work)
    assert reached == ["after"]


@posix
def test_other_errors_in_destructors_are_reported_as_ever(monkeypatch: pytest.MonkeyPatch) -> None:
    told: list[object] = []
    monkeypatch.setattr(sys, "unraisablehook", lambda caught: told.append(caught.exc_type))

    class Fails:
        def __del__(self) -> None:
            raise ZeroDivisionError

    def work() -> None:
        Fails()

    within(work)
    assert told == [ZeroDivisionError]


@posix
@pytest.mark.parametrize("at", range(3))
def test_a_press_at_the_very_end_is_not_lost(
    press: Callable[[], None], monkeypatch: pytest.MonkeyPatch, at: int
) -> None:
    set_handler, ends = signal.signal, []

    def pressed_before(number: int, handler: object) -> object:
        if ends and len(ends) == at + 1:
            ends.append("pressed")
            press()
        ends.extend(["set"] if ends else [])
        return set_handler(number, handler)  # type: ignore[arg-type]

    monkeypatch.setattr(terminal.signal, "signal", pressed_before)
    with pytest.raises(KeyboardInterrupt):
        within(lambda: ends.append("end") if at < 2 else (ends.append("end"), press()))  # type: ignore[arg-type]
    assert "pressed" in ends or at == 2


@posix
def test_a_second_press_ends_at_once(press: Callable[[], None], monkeypatch: pytest.MonkeyPatch) -> None:
    class Ended(BaseException):
        pass

    def end(code: int) -> None:
        assert code == terminal.INTERRUPTED
        raise Ended

    monkeypatch.setattr(os, "_exit", end)
    monkeypatch.setattr(terminal, "_PATIENCE_S", 1000)

    def work() -> None:
        press()
        press()

    with pytest.raises(KeyboardInterrupt) as caught:
        within(work)
    assert isinstance(caught.value.__context__, Ended)


@posix
def test_a_signal_that_was_ignored_from_the_start_stays_so(press: Callable[[], None]) -> None:
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    reached = []

    def work() -> None:
        press()
        reached.append(interrupted())

    within(work)
    assert reached == [False]


def test_uninterrupted_blocks_leave_no_trace() -> None:
    numbers = [signal.SIGINT, *([signal.SIGALRM] if hasattr(signal, "SIGALRM") else [])]
    before = [signal.getsignal(number) for number in numbers], sys.unraisablehook
    with orderly_interrupts():
        assert not interrupted()
    assert ([signal.getsignal(number) for number in numbers], sys.unraisablehook) == before


# The command line, which says when a run is on its way: its first step is there.
TOLD = """
import signal, sys
signal.signal(signal.SIGINT, signal.default_int_handler)
from texlab.cli.main import main
from texlab_core.engine import run as engine

drive = engine._drive

def told(steps, *rest):
    def watched():
        while True:
            try:
                step = next(steps)
            except StopIteration as end:
                return end.value
            print("a step", flush=True)
            yield step
    return drive(watched(), *rest)

engine._drive = told
sys.exit(main(sys.argv[1:]))
"""


@posix
@pytest.mark.slow
@pytest.mark.parametrize("presses", [1, 3])
@pytest.mark.parametrize(
    "arguments",
    [
        ["synth", "--method", "heeger-bergen", "--size", "2048x2048", "--set", "iterations=50"],
        ["sweep", "--method", "heeger-bergen", "--vary", "seed=0:99:100"],
        ["compare", "--size", "2048x2048", "--methods", "heeger-bergen,de-bonet"],
    ],
    ids=lambda arguments: arguments[0],
)
def test_ctrl_c_ends_with_130_and_without_half_a_file(tmp_path: Path, arguments: list[str], presses: int) -> None:
    command = [arguments[0], "gallery:structured-pebbles", *arguments[1:], "--out", str(tmp_path / "a.png")]
    # Whoever runs the tests may have the signal ignored.
    with subprocess.Popen(
        [sys.executable, "-c", TOLD, *command], stdout=subprocess.PIPE, stderr=subprocess.PIPE
    ) as process:
        assert process.stdout is not None
        assert process.stdout.readline() == b"a step\n"
        for _ in range(presses):
            process.send_signal(signal.SIGINT)
            time.sleep(0.02)
        _, errors = process.communicate(timeout=PATIENCE_S)
    # A second one may find Python shutting down, and ends it as a shell expects.
    assert process.returncode in ((130,) if presses == 1 else (130, -signal.SIGINT))
    assert errors == b""
    assert os.listdir(tmp_path) == []


def test_what_the_core_logs_goes_to_the_log_file(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv("TEXLAB_HOME", str(tmp_path))
    with logged_quietly():
        try:
            raise RuntimeError("told in the log")
        except RuntimeError:
            logging.getLogger("texlab_core.sheets.sweep").exception("A cell failed")
    assert capsys.readouterr().err == ""
    assert "told in the log" in (tmp_path / "log" / "texlab.log").read_text()


def test_help_and_version_do_not_even_import_numpy() -> None:
    code = (
        "import sys\nfrom texlab.cli.main import main\nfor each in ['--help', '--version']: main([each])\n"
        "print(json.dumps('numpy' in sys.modules), file=sys.stderr)"
    )
    done = subprocess.run([sys.executable, "-c", f"import json\n{code}"], capture_output=True, check=True)
    assert json.loads(done.stderr) is False
