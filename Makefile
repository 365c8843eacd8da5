# Two commands do everything on a fresh Debian with Python 3.11 or newer (with pip and venv) and make:
#   make demo    install into .venv, plan and verify a sample, say where the results are
#   make test    install the tools of a developer as well, run the tests

PYTHON ?= python3
VENV ?= .venv
BIN := $(VENV)/bin
DEMO := bracket

.PHONY: demo test lint types wheel clean
.DELETE_ON_ERROR:

demo: $(VENV)/.user
	$(BIN)/deltacam plan samples/$(DEMO).dxf -o out
	$(BIN)/deltacam verify out/$(DEMO).program.csv --drawing samples/$(DEMO).dxf
	@echo
	@echo "The program is out/$(DEMO).program.csv; open out/$(DEMO).report.html in a browser to see it."
	@echo "Next: $(BIN)/deltacam plan --help"

test: $(VENV)/.developer
	$(BIN)/python -m pytest --numprocesses logical --dist loadscope

lint: $(VENV)/.developer
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .

types: $(VENV)/.developer
	$(BIN)/mypy

wheel: $(VENV)/.developer
	rm -rf dist
	$(BIN)/python -m pip wheel --quiet --no-deps --wheel-dir dist .

clean:
	rm -rf $(VENV) out dist .pytest_cache .mypy_cache .ruff_cache .hypothesis

$(VENV)/.made:
	$(PYTHON) -c 'import sys; sys.exit("deltacam needs Python 3.11 or newer, this is " + sys.version.split()[0] if sys.version_info < (3, 11) else 0)'
	$(PYTHON) -m venv $(VENV)
	touch $@

$(VENV)/.user: $(VENV)/.made pyproject.toml
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --editable .
	touch $@

$(VENV)/.developer: $(VENV)/.user pyproject.toml
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --editable ".[dev]"
	touch $@
