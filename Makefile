# make run opens the explorer, make test checks everything; both install what is missing first.

PYTHON ?= python3
BIN := .venv/bin
PY := $(BIN)/python

.PHONY: run test lint fmt bench wheel screenshot clean distclean
.DEFAULT_GOAL := run

run: .venv/.ready-run
	@$(PY) .ci/run_explorer.py

# The last stage is pytest's, so that its summary is the last line.
test: .venv/.ready-test
	@$(PY) .ci/check.py test

lint: .venv/.ready-test
	@$(PY) .ci/check.py lint

fmt: .venv/.ready-test
	@$(PY) -m ruff check --fix .
	@$(PY) -m ruff format .

bench: .venv/.ready-bench
	@$(PY) -m pytest tests/benchmarks -q -s --no-xvfb -m benchmark -o python_files='bench_*.py'

wheel: .venv/.ready-run
	@$(PY) -m pip wheel . --no-deps --quiet --wheel-dir dist
	@ls dist/*.whl

# The picture in the README.
screenshot: .venv/.ready-run
	@$(BIN)/texlab screenshot --out resources/help/window.png --gallery structured-pebbles

.venv/.ready-%: pyproject.toml .ci/setup_env.py
	@$(PYTHON) .ci/setup_env.py $*

clean:
	rm -rf build dist .coverage .mypy_cache .ruff_cache .pytest_cache .hypothesis .import_linter_cache
	find texlab texlab_core tests .ci -name __pycache__ -type d -prune -exec rm -rf {} +

distclean: clean
	rm -rf .venv
