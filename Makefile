# Everything from a fresh clone: `make run` serves, `make test` tests. A stamp file marks each
# finished step in .stamps/, so that a second call starts at once.

PORT ?= 8000
PYTHON ?= python3
BIN := .venv/bin
STAMPS := .stamps
PYTHON_SOURCES := $(shell find engine service -path service/viewer -prune -o -name '*.py' -print)
VIEWER_SOURCES := $(shell find static -path static/node_modules -prune -o -type f -print)

.PHONY: run test check bench levels sheet portraits measure lock clean chromium

run: $(STAMPS)/python $(STAMPS)/bytecode $(STAMPS)/viewer
	$(BIN)/risorius serve --port $(PORT)

test: $(STAMPS)/python-dev $(STAMPS)/bytecode $(STAMPS)/viewer chromium
	npm --prefix static test
	$(BIN)/pytest --numprocesses auto --maxprocesses 4 --dist loadfile --no-loadscope-reorder

check: $(STAMPS)/python-dev $(STAMPS)/node
	$(BIN)/ruff format --check .
	$(BIN)/ruff check .
	$(BIN)/mypy
	$(BIN)/lint-imports
	npm --prefix static run check

# Beside Taichi and Warp where they are: .venv/bin/pip install -e '.[bench]'
bench: $(STAMPS)/python
	$(BIN)/risorius bench --docs docs

levels: $(STAMPS)/python
	$(BIN)/risorius levels

measure: $(STAMPS)/python
	$(BIN)/risorius measure

BROW_MUSCLES := "frontalis_medial": 0.9, "frontalis_lateral": 0.9, "corrugator_supercilii": 0.9, \
	"procerus": 0.9, "depressor_supercilii": 0.9

sheet: $(STAMPS)/python-dev $(STAMPS)/viewer chromium
	$(BIN)/risorius sheet -o docs/expressions.jpg --view front --size 192 --columns 8
	$(BIN)/risorius sheet -o docs/emotions.jpg --view front --size 360 --columns 4 --set emotions
	$(BIN)/risorius sheet -o docs/intensities.jpg --view front --size 240 --columns 7 --set intensities
	$(BIN)/risorius sheet -o docs/combinations.jpg --view front --size 280 --columns 5 --set combinations
	$(BIN)/risorius sheet -o docs/recipes.jpg --view front --size 200 --columns 9 --set recipes
	$(BIN)/risorius sheet -o docs/people.jpg --people --only rest --whole \
		--view front,three-quarter,profile --size 240 --columns 6
	$(BIN)/risorius sheet -o docs/closeups.jpg --rig standard,mei,ruth,kwame --only rest \
		--view eye,mouth,ear,profile --size 300 --columns 4
	$(BIN)/risorius sheet -o docs/palsy.jpg --only rest,6E+12E,1E+2E,43E --view front --size 280 --columns 4 \
		--edit '{"palsy": {"side": "left", "grade": "III"}}' \
		--edit '{"palsy": {"side": "left", "grade": "VI"}}'
	$(BIN)/risorius sheet -o docs/botulinum.jpg --only rest,1E+2E,4E --view front --size 280 --columns 3 \
		--edit '{"name": "relaxed", "relaxed": {$(BROW_MUSCLES)}}'
	$(BIN)/risorius sheet -o docs/tissue-age.jpg --only rest,6E+12E,4E --view front --size 240 --columns 3 \
		--edit '{"tissue_age": 22}' --edit '{"tissue_age": 50}' --edit '{"tissue_age": 78}' \
		--edit '{"recipe": {"age": 78}}'
	$(BIN)/risorius sheet -o docs/tissue-regions.jpg --only 12E,18E,27E --view front --size 280 --columns 3 \
		--edit '{"name": "stiff left", "tissue": {"region_stiffness": {"cheek.L": 10, "nasolabial.L": 10, "lip.L": 10}}}' \
		--edit '{"name": "lax left", "tissue": {"region_laxity": {"cheek.L": 1, "nasolabial.L": 1, "lip.L": 1}}}'
	$(BIN)/risorius screens -o docs --jpeg --only inside-dermis,inside-editor,viewer-phone

# The people's pictures in the viewer.
portraits: $(STAMPS)/python-dev $(STAMPS)/viewer chromium
	@mkdir -p static/public/people
	$(BIN)/risorius sheet -o static/public/people --people --only rest --whole --view front --size 144 --cut-out
	$(BIN)/risorius sheet -o static/public/people --rig standard,paper --only rest --whole --view front --size 144 --cut-out

# Chromium for the browser test: the system's, else Debian's, else Playwright's own.
chromium: $(STAMPS)/python-dev
	@command -v chromium >/dev/null || command -v chromium-browser >/dev/null \
	|| { [ "$$(id -u)" = 0 ] && apt-get update -qq && apt-get install -y -qq chromium >/dev/null; } \
	|| $(BIN)/playwright install chromium \
	|| echo "Chromium is missing and could not be installed: the browser tests will be skipped."

lock: $(STAMPS)/python-dev
	$(BIN)/pip install --quiet pip-tools
	$(BIN)/pip-compile --quiet --generate-hashes --allow-unsafe --strip-extras --all-build-deps \
		--no-emit-index-url --no-emit-trusted-host --no-emit-find-links -o requirements.lock pyproject.toml
	$(BIN)/pip-compile --quiet --generate-hashes --allow-unsafe --strip-extras --all-build-deps \
		--extra dev --no-emit-index-url --no-emit-trusted-host --no-emit-find-links \
		-c requirements.lock -o requirements-dev.lock pyproject.toml

clean:
	rm -rf .venv $(STAMPS) static/node_modules service/viewer

$(STAMPS)/venv:
	$(PYTHON) -m venv .venv
	@mkdir -p $(STAMPS) && touch $@

$(STAMPS)/python: requirements.lock pyproject.toml | $(STAMPS)/venv
	$(BIN)/pip install --quiet --require-hashes -r requirements.lock
	RISORIUS_SKIP_VIEWER=1 $(BIN)/pip install --quiet --no-deps --no-build-isolation -e .
	@touch $@

# As installing a wheel does: each process that starts would compile 350 files for half a second,
# where Python may not write what it compiles.
$(STAMPS)/bytecode: $(PYTHON_SOURCES) | $(STAMPS)/python
	$(BIN)/python -m compileall -q engine service
	@touch $@

$(STAMPS)/python-dev: requirements-dev.lock $(STAMPS)/python
	$(BIN)/pip install --quiet --require-hashes -r requirements-dev.lock
	@touch $@

$(STAMPS)/node: static/package-lock.json | $(STAMPS)/venv
	npm --prefix static ci --no-audit --no-fund
	@touch $@

$(STAMPS)/viewer: $(STAMPS)/node $(VIEWER_SOURCES)
	npm --prefix static run build
	@touch $@
