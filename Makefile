# Haptic Glance. `make help` lists what can be made; everything runs in a virtual environment made here.
VENV ?= .venv
PYTHON ?= $(shell command -v python3.11 || command -v python3)
BIN := $(CURDIR)/$(VENV)/bin
SMOKE := build/smoke
GAZE := build/gaze
NETWORKS := vgg16-frozen,resnet50-frozen,mobilenet_v2-frozen,mobilenet_v2-finetuned,vgg16-random,resnet50-random,mobilenet_v2-random
gaze ?= ../shared/data/gaze.zip
psb ?= ../shared/data/psb.zip
pressure ?= ../shared/data/pressure_images.zip
grasps ?= ../shared/data/biotac_grasps.zip
export PATH := $(BIN):$(PATH)
.DEFAULT_GOAL := help
.PHONY: help repro test smoke lint bench gaze fixation detectors touch transfer clean

help: ## this list
	@grep -hE '^[a-z]+:.*## ' $(MAKEFILE_LIST) | sed -E 's/:.*## /\t/' | expand -t 10

repro: $(VENV)/ready ## run the pipeline: every table, figure and the page, on what params.yaml says
	dvc repro
	@echo "Open reports/index.html; the tables are in reports/tables."

test: $(VENV)/ready ## unit and property tests, then the whole pipeline at profile=smoke, then the gate
	pytest
	$(MAKE) smoke

# A scratch copy of the working tree with nothing computed yet, in the folder $(1).
fresh = rm -rf $(1) && mkdir -p $(1) \
	&& git ls-files -z -co --exclude-standard | xargs -0 sh -c 'for f; do [ -e "$$f" ] && printf "%s\0" "$$f"; done' sh \
	  | tar --null -T - -cf - | tar -xf - -C $(1) \
	&& cd $(1) && git init -q && rm -f dvc.lock && rm -rf reports/metrics reports/measurements

smoke: $(VENV)/ready ## the whole pipeline on four objects, in a scratch copy, held against its baseline
	$(call fresh,$(SMOKE)) && python -m stages.compose profile=smoke && dvc repro && python -m stages.gate

lint: $(VENV)/ready ## ruff: rules and formatting
	ruff check .
	ruff format --check .

# Each is one process on one core, but the pipeline; errors and scenes read what `make repro` made. The last fetches its
# meshes by `apt-get download`.
bench: $(VENV)/ready ## every benchmark, to reports/bench: errors, backends, scenes, imprints (tacto=PYTHON), ... (an hour)
	OMP_NUM_THREADS=1 python -m benchmarks.errors
	OMP_NUM_THREADS=1 python -m benchmarks.simplification $(psb)
	python -m benchmarks.scenes
	OMP_NUM_THREADS=1 python -m benchmarks.imprints $(psb) $(if $(tacto),--tacto $(tacto))
	python -m benchmarks.networks
	python -m benchmarks.pipeline
	OMP_NUM_THREADS=1 python -m benchmarks.broken_meshes

gaze: $(VENV)/ready ## judge every saliency by human gaze (gaze=PATH of gaze.zip), to reports/attention (15 min.)
	$(call fresh,$(GAZE)) && python -m stages.compose data=gaze channels=judged "meshes.folder=$(abspath $(gaze))" \
	  && dvc repro salient_points
	cp $(GAZE)/reports/measurements/salient_points.csv reports/attention/gaze.csv
	cp $(GAZE)/reports/measurements/weights.csv reports/attention/svm.csv
	cp $(GAZE)/reports/measurements/conspicuity.csv $(GAZE)/reports/measurements/views.csv reports/attention/
	cp $(GAZE)/data/weights/weights.csv reports/attention/weights.csv
	python -m benchmarks.annotations $(GAZE)
	python -m benchmarks.attention $(GAZE)

# Resumable: what a killed start has finished stays in build/fixation, as long as neither the code nor the settings change.
fixation: $(VENV)/ready ## attention of networks at the thesis's size by human gaze (gaze=PATH of gaze.zip), to reports/fixation (an hour and a half)
	[ -d build/fixation ] || { $(call fresh,build/fixation); }
	rm -rf build/fixation/stages build/fixation/conf
	git ls-files -z -co --exclude-standard stages conf dvc.yaml pyproject.toml | tar --null -T - -cf - | tar -xf - -C build/fixation
	cd build/fixation && python -m stages.compose data=gaze "meshes.folder=$(abspath $(gaze))" fixation.parallels=9 \
	  fixation.azimuths=24 "fixation.methods=[$(NETWORKS)]" && dvc repro fixation
	python -m benchmarks.fixation build/fixation

# The lod stage on data set $(1), found at $(2), in a scratch copy; its errors to reports/simplification/$(1).csv.
detectors = $(call fresh,build/detectors_$(1)) && python -m stages.compose data=$(1) experiment=detectors_$(1) \
	  "meshes.folder=$(abspath $(2))" && dvc repro lod && cd $(CURDIR) && python -m benchmarks.detectors build/detectors_$(1) $(1)

detectors: $(VENV)/ready ## errors of every detector on psb and gaze (psb=, gaze=PATH of the zips), to reports/simplification (half an hour)
	$(call detectors,princeton,$(psb))
	$(call detectors,gaze,$(gaze))

# Resumable: what a killed start has finished stays in build/touch, the code there is that of now, and a stage whose code
# has changed begins anew. The lock and the measurements there are its own, since they are of another data set.
touch: $(VENV)/ready ## recorded touches (pressure=, grasps=) and classes of psb (psb=) at the thesis's size, to reports/touch (hours)
	OMP_NUM_THREADS=1 python -m benchmarks.real_touches $(pressure) $(grasps)
	[ -d build/touch ] || { $(call fresh,build/touch); }
	rm -rf build/touch/stages build/touch/conf
	git ls-files -z -co --exclude-standard stages conf dvc.yaml pyproject.toml | tar --null -T - -cf - | tar -xf - -C build/touch
	cd build/touch && python -m stages.compose experiment=table_4_9 "classes.folder=$(abspath $(psb))" \
	  && dvc repro sensor_size sequences
	cp build/touch/reports/measurements/sensor_size.csv reports/touch/sensor_size_princeton.csv
	cp build/touch/reports/measurements/sequences.csv reports/touch/sequences_princeton.csv
	cp build/touch/reports/measurements/contours.csv reports/touch/contours_princeton.csv

# Resumable: what a killed start has finished stays in build/transfer and build/table_5_4.
transfer: $(VENV)/ready ## networks for photographs on recorded touches (pressure=, grasps=; networks=, device=) and on the thesis's classes (psb=), to reports/transfer (hours)
	python -m benchmarks.transfer $(pressure) $(grasps) $(if $(networks),--networks $(networks)) $(if $(device),--device $(device))
	python -m benchmarks.coarse_imprints
	[ -d build/table_5_4 ] || { $(call fresh,build/table_5_4); }
	rm -rf build/table_5_4/stages build/table_5_4/conf
	git ls-files -z -co --exclude-standard stages conf dvc.yaml pyproject.toml | tar --null -T - -cf - | tar -xf - -C build/table_5_4
	cd build/table_5_4 && python -m stages.compose experiment=table_5_4 "classes.folder=$(abspath $(psb))" && dvc repro transfer
	cp build/table_5_4/reports/measurements/transfer.csv reports/transfer/princeton.csv
	cd build/table_5_4 && python -m stages.compose experiment=table_5_4_networks "classes.folder=$(abspath $(psb))" && dvc repro transfer
	cp build/table_5_4/reports/measurements/transfer.csv reports/transfer/princeton_networks.csv

clean: ## remove what was built and computed; fetched files stay in the user's cache
	rm -rf $(VENV) build .pytest_cache .ruff_cache .dvc/tmp .dvc/cache *.egg-info
	find data -mindepth 1 -maxdepth 1 ! -name reference ! -name annotations -exec rm -rf {} +

$(VENV)/ready: pyproject.toml constraints.txt
	$(PYTHON) -c 'import sys; v = sys.version_info[:2]; sys.exit(v not in ((3, 11), (3, 12)) and "Python 3.11 or 3.12 is needed, this is %d.%d" % v)'
	$(PYTHON) -m venv $(VENV)
	$(BIN)/python -m pip install --quiet --constraint constraints.txt --editable '.[dev]'
	touch $@
