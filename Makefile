# make demo   makes .venv, installs, and runs the main job
# make test   the same set-up, then every check and test

PYTHON ?= python3
BIN := .venv/bin

.PHONY: demo test lint figures golden clean

demo: .venv/installed
	$(BIN)/python examples/demo.py

test: lint
	$(BIN)/pytest -n 2 --dist worksteal

lint: .venv/installed
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy

figures: .venv/installed
	$(BIN)/python benchmarks/figures.py
	$(BIN)/python benchmarks/viewing.py
	$(BIN)/python benchmarks/forms.py
	$(BIN)/python benchmarks/library.py
	$(BIN)/python benchmarks/stability.py
	$(BIN)/python benchmarks/scenes.py
	$(BIN)/python benchmarks/engine.py
	$(BIN)/python benchmarks/scaling.py -o docs/engine.svg
	$(BIN)/python benchmarks/images.py
	$(BIN)/python benchmarks/profiles.py
	$(BIN)/python benchmarks/pixels.py
	$(BIN)/python benchmarks/fitting.py intervals

golden: .venv/installed
	$(BIN)/pytest --update-golden tests

.venv/installed: pyproject.toml
	$(PYTHON) -m venv .venv
	$(BIN)/pip install --quiet --disable-pip-version-check --editable '.[test]'
	touch $@

clean:
	rm -rf .venv demo paper cylinder spectral
