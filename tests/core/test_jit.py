"""Where compiled kernels are kept."""

from __future__ import annotations

import os
import tempfile
from pathlib import Path

import numba
import platformdirs

from texlab_core.kernels import jit


def test_a_folder_that_can_be_written_needs_no_other(monkeypatch):
    monkeypatch.delenv("NUMBA_CACHE_DIR", raising=False)
    monkeypatch.setattr(jit, "_writable", lambda folder: True)
    jit._choose_cache_directory()
    assert "NUMBA_CACHE_DIR" not in os.environ


def test_a_read_only_installation_uses_the_users_folder(monkeypatch, tmp_path):
    monkeypatch.setenv("NUMBA_CACHE_DIR", "to be put back at the end")
    monkeypatch.delenv("NUMBA_CACHE_DIR")
    monkeypatch.setattr(platformdirs, "user_cache_dir", lambda *names, **more: str(tmp_path))
    really = jit._writable
    monkeypatch.setattr(jit, "_writable", lambda folder: folder != Path(jit.__file__).parent and really(folder))
    jit._choose_cache_directory()
    chosen = Path(os.environ["NUMBA_CACHE_DIR"])
    assert chosen.is_relative_to(tmp_path / "numba")
    assert chosen.is_dir()


def test_nowhere_to_write_is_no_error(monkeypatch):
    monkeypatch.delenv("NUMBA_CACHE_DIR", raising=False)
    monkeypatch.setattr(jit, "_writable", lambda folder: False)
    jit._choose_cache_directory()
    assert "NUMBA_CACHE_DIR" not in os.environ
    compile_anew = numba.njit

    def without_cache(*functions, **options):
        if options.get("cache") and options.get("nogil"):
            raise RuntimeError("no locator available")
        return compile_anew(*functions, **options)

    monkeypatch.setattr(numba, "njit", without_cache)

    def add(first: int, second: int) -> int:
        return first + second

    assert jit.njit(add)(2, 3) == 5


def test_a_folder_that_refuses_files_is_not_writable(monkeypatch, tmp_path):
    def refuse(*args, **options):
        raise PermissionError("read-only")

    assert jit._writable(tmp_path / "made" / "here")
    monkeypatch.setattr(tempfile, "TemporaryFile", refuse)
    assert not jit._writable(tmp_path)
