# Every target sets the project up first; nothing but Python 3.11 (or newer), its venv package and make is needed.
PYTHON ?=
VENV := .venv
BIN := $(VENV)/bin
READY := $(VENV)/.ready
# What the main job needs; and beside it what tests, lint and documentation need.
TESTED := $(VENV)/.ready-for-tests
# Processes keep the code that they compile, whatever the environment says: a command takes half the time with it.
unexport PYTHONDONTWRITEBYTECODE
LOCK := $(BIN)/uv pip compile --quiet --universal --python-version 3.11 --generate-hashes --no-emit-index-url \
  --no-emit-find-links --no-annotate --no-header pyproject.toml
RUN := OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1 $(BIN)

.PHONY: compare test check bench lint full docs schema lock clean

compare: $(READY)  ## run the main job: three methods on suite "small", judged, with a report
	$(RUN)/drystone compare --suite small --study imperfections:60s

# Tests of the report in a browser need Debian's chromium; without it they are left out, and said to be.
BROWSER := $(shell command -v chromium 2>/dev/null)

test: $(TESTED)  ## pass the tests
	$(if $(BROWSER),,@echo "chromium is not installed: the browser tests are left out")
	$(RUN)/python -m pytest -n 2 --dist worksteal -o faulthandler_timeout=600 -o faulthandler_exit_on_timeout=true -m "not slow$(if $(BROWSER),, and not browser)"

full: $(TESTED)  ## every test and every reference, the slow ones too
	$(RUN)/python -m pytest
	$(RUN)/drystone check --tier full

check: $(TESTED)  ## the reference regression, quick tier
	$(RUN)/drystone check

bench: $(TESTED)  ## measured values and CPU seconds of every method, beside the figures to beat
	$(RUN)/python -m benchmarks overhead --full
	$(RUN)/python -m benchmarks limit_analysis
	$(RUN)/python -m benchmarks finite_elements
	$(RUN)/python -m benchmarks distinct_elements small de
	$(RUN)/python -m benchmarks distinct_elements small de-soft

lint: $(TESTED)  ## style, types and the layer contract
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy
	$(BIN)/lint-imports --no-cache

docs: $(TESTED)  ## build the documentation into out/docs; a warning is an error
	$(RUN)/python -m sphinx -W --keep-going -q -b html docs out/docs
	@! grep -rlE '(src|href)="https://[^"]*\.(js|css)"' out/docs --include='*.html' || { echo "these pages need a network"; exit 1; }

schema: $(READY)  ## write the JSON Schemas of the formats again
	for format in wall result describe; do $(BIN)/drystone schema $$format > docs/$$format-1.schema.json; done

lock: $(TESTED)  ## resolve the dependencies anew (versions and hashes only)
	$(LOCK) --extra checkout --upgrade -o requirements.lock
	$(LOCK) --extra dev --constraint requirements.lock --upgrade -o requirements-tests.lock

$(READY): requirements.lock pyproject.toml .ci/set-up
	@.ci/set-up "$(VENV)" requirements.lock $(PYTHON)
	$(RUN)/python -m drystone.kernels
	touch $(READY)

$(TESTED): $(READY) requirements-tests.lock
	@.ci/set-up "$(VENV)" requirements-tests.lock $(PYTHON)
	touch $(TESTED)

clean:
	rm -rf $(VENV) out
