# Haptic Glance. `make help` lists what can be made; everything runs in a virtual environment made here.
VENV ?= .venv
PYTHON ?= $(shell command -v python3.11 || command -v python3)
BIN := $(CURDIR)/$(VENV)/bin
SMOKE := build/smoke
psb ?= ../shared/data/psb.zip
newest = $(if $(meshoptimizer),--meshoptimizer $(meshoptimizer))
export PATH := $(BIN):$(PATH)
unexport PYTHONDONTWRITEBYTECODE # or each of some hundred processes compiles the stages anew
test quick fuzz smoke: export OMP_NUM_THREADS = 1 # each core has a process; more threads would spin while they wait
repro: export OPENBLAS_NUM_THREADS = 1 # a second thread saves no time on small matrices
.DEFAULT_GOAL := help
.PHONY: help repro studio test quick fuzz smoke lint docs bench clean lock

help: ## this list
	@grep -hE '^[a-z]+:.*## ' $(MAKEFILE_LIST) | sed -E 's/:.*## /\t/' | expand -t 10

repro: $(VENV)/ready ## run the pipeline: every table, figure and the page, on what params.yaml says
	dvc repro --keep-going || { dvc repro --single-item report; exit 1; } # the report names what is missing

studio: $(VENV)/ready ## look at a mesh, simplify it, touch and mark it, on a local page (mesh=FILE_OR_FOLDER)
	haptic-glance studio $(or $(mesh),samples/dromedary.glb)

test: $(VENV)/ready ## unit and property tests, and beside them the whole pipeline at profile=smoke with its gate
	@mkdir -p build
	@$(MAKE) smoke > build/smoke.log 2>&1 & smoke=$$!; rc=0; \
	pytest -n logical --dist worksteal || rc=$$?; \
	wait $$smoke || { tail -n 40 build/smoke.log; echo "the pipeline at profile=smoke failed: build/smoke.log"; exit 1; }; \
	tail -n 1 build/smoke.log; exit $$rc

quick: $(VENV)/ready ## the tests that are not marked slow, in a minute
	pytest -n auto --dist worksteal -m "not slow"

fuzz: $(VENV)/ready ## damaged files, and 443 mesh files of other people: each is read, or refused in one line (20 minutes)
	FUZZ_SECONDS=600 pytest tests/fuzz

smoke: $(VENV)/ready ## the whole pipeline on a dozen objects, in a scratch copy, held against its baseline
	rm -rf $(SMOKE) && mkdir -p $(SMOKE)
	git ls-files -z -co --exclude-standard | xargs -0 sh -c 'for f; do [ -e "$$f" ] && printf "%s\0" "$$f"; done' sh \
	  | tar --null -T - -cf - | tar -xf - -C $(SMOKE)
	cd $(SMOKE) && git init -q && rm -f dvc.lock && python -m stages.compose profile=smoke && dvc repro && python -m stages.gate

lint: $(VENV)/ready ## ruff: rules and formatting; import-linter: imports run one way; pyright: types
	ruff check .
	ruff format --check .
	lint-imports
	pyright --threads

docs: $(VENV)/ready ## the documentation, to build/docs/index.html; a warning is an error (three minutes, then less)
	python -m sphinx -E -W --keep-going --quiet docs build/docs # -E: numbers come from reports/, which may have changed
	@echo "Open build/docs/index.html."

# Each is one process on one core, but the pipeline.
bench: $(VENV)/ready ## every benchmark, to reports/bench: kernels, simplification, tactile, ...
	OMP_NUM_THREADS=1 python -m benchmarks.kernels
	OMP_NUM_THREADS=1 python -m benchmarks.simplification $(psb) $(newest)
	OMP_NUM_THREADS=1 python -m benchmarks.tactile $(psb)
	OMP_NUM_THREADS=1 python -m benchmarks.up_axis
	OMP_NUM_THREADS=1 python -m benchmarks.deep_gaze
	OMP_NUM_THREADS=1 python -m benchmarks.flip $(psb)
	python -m benchmarks.pipeline

lock: ## pin in constraints.txt all that pyproject.toml asks for
	mkdir -p build
	$(PYTHON) -m pip install --quiet --dry-run --ignore-installed --report build/lock.json --constraint constraints.txt '.[all,dev,docs]'
	$(PYTHON) -c 'import json; [print(each["name"], each["version"].partition("+")[0], sep="==") for each in (item["metadata"] \
	  for item in json.load(open("build/lock.json"))["install"]) if each["name"] != "haptic-glance"]' | LC_ALL=C sort -f > constraints.txt

clean: ## remove what was built and computed; fetched files stay in the user's cache
	rm -rf $(VENV) build .pytest_cache .ruff_cache .dvc/tmp .dvc/cache *.egg-info
	find data -mindepth 1 -maxdepth 1 ! -name reference ! -name annotations -exec rm -rf {} +

$(VENV)/ready: pyproject.toml constraints.txt
	$(PYTHON) -c 'import sys; v = sys.version_info[:2]; sys.exit(v not in ((3, 11), (3, 12)) and "Python 3.11 or 3.12 is needed, this is %d.%d" % v)'
	$(PYTHON) -m venv $(VENV)
	$(BIN)/python -m pip install --quiet --no-compile --constraint constraints.txt --editable '.[all,dev,docs]' # most modules are never imported
	touch $@
