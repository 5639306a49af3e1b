# make run opens the explorer, make test checks everything; both install what is missing first.

PYTHON ?= python3
BIN := .venv/bin
PY := $(BIN)/python

.PHONY: run test lint fmt bench soak large bar numbers tuned report kill calibrate wheel sdist docs lock bits icons program screenshot screens clean distclean
.DEFAULT_GOAL := run

run: .venv/.ready-run
	@$(PY) .ci/run_explorer.py

# The last stage is pytest's, so that its summary is the last line.
test: .venv/.ready-test
	@$(PY) .ci/check.py test

lint: .venv/.ready-test
	@$(PY) .ci/check.py lint

# Every package of the two, and what it imports.
rooms: .venv/.ready-test
	@$(PY) .ci/rooms.py

fmt: .venv/.ready-test
	@$(PY) -m ruff check --fix .
	@$(PY) -m ruff format .

bench: .venv/.ready-bench
	@$(PY) -m pytest tests/benchmarks -q -s --no-xvfb -m benchmark -o python_files='bench_*.py'

# Ten thousand random events in the window: what grows, what is left, what goes wrong; EVENTS=, SEED=.
soak: .venv/.ready-test
	@$(PY) -m tests.soak --events $(or $(EVENTS),10000) --seed $(or $(SEED),1)

# Whether the window falls back to its memory once a result of 4096 x 4096 was closed; SIZE=.
large: .venv/.ready-test
	@$(PY) -m tests.soak.large --size $(or $(SIZE),4096)

# De Bonet's defaults against what they have to reach; writes the table of the help page.
bar: .venv/.ready-run
	@$(PY) -m texlab_core.figures.defaults --write resources/help/de-bonet.md

# The numbers in the words and tables of the other help pages, measured anew.
numbers: .venv/.ready-run
	@$(PY) -m texlab_core.figures --numbers resources/help

# Whether what the tuner finds has a larger V at no larger D than the defaults, into the help; takes most of an hour.
tuned: .venv/.ready-run
	@$(PY) -m texlab_core.figures._tuned --write resources/help/de-bonet.md

# The report that the help opens: forty of De Bonet's 800 textures in one page.
report: .venv/.ready-run
	@$(PY) -m texlab_core.figures._report resources/help/reports/de-bonet-800.html

# A batch of 400 jobs killed at 20 random moments, and on a cluster that loses workers: the same files?
kill: .venv/.ready-test
	@$(PY) -W ignore .ci/kill_batch.py

# The tables of the help pages on measures and findings, from results that were looked at and labelled.
calibrate: .venv/.ready-run
	@$(PY) -m texlab_core.measures.calibrate $(or $(LABELS),../shared/labels)
	@$(PY) -m texlab_core.findings.calibrate $(or $(LABELS),../shared/labels)

wheel: .venv/.ready-run
	@$(PY) -m pip wheel . --no-deps --quiet --wheel-dir dist
	@ls dist/*.whl

sdist: .venv/.ready-test
	@$(PY) -m hatchling build --target sdist

# The site in build/docs: the Python package from its docstrings, and the tutorials.
docs: .venv/.ready-test
	@$(PY) .ci/build_docs.py

# Versions and hashes of everything, for every system and Python that is supported; needs uv.
lock:
	@uv pip compile pyproject.toml --extra test --extra cluster --universal --python-version 3.11 \
		--generate-hashes --no-emit-index-url --no-header --no-annotate --quiet --output-file .ci/lock.txt

# Which methods give other bits here than with the versions of the lock file; BITS=FILE compares with a file.
bits: .venv/.ready-test
	@$(PY) .ci/bits.py $(if $(BITS),--against $(BITS))

# The PNG icons, from the SVG.
icons: .venv/.ready-test
	@$(PY) .ci/icons.py

# A folder with the whole program, for machines without Python.
program: .venv/.ready-run
	@$(PY) .ci/program.py

# The picture in the README.
screenshot: .venv/.ready-run
	@$(BIN)/texlab screenshot --out resources/help/window.png --gallery structured-pebbles

# Every layout in both themes at the sizes of usual screens, to be looked at: build/screens.
screens: .venv/.ready-run
	@$(PY) .ci/screens.py

.venv/.ready-%: pyproject.toml .ci/setup_env.py
	@$(PYTHON) .ci/setup_env.py $*

clean:
	rm -rf build dist .coverage .mypy_cache .ruff_cache .pytest_cache .hypothesis .import_linter_cache
	find texlab texlab_core tests .ci -name __pycache__ -type d -prune -exec rm -rf {} +

distclean: clean
	rm -rf .venv
