# Everything a newcomer needs: `make demo`, then `make test`. Rust, Python 3.11 and a package registry are enough.

PYTHON ?= python3
UV_VERSION := 0.13.8
# uv from the machine where it is there, else a pinned one in a folder of the project.
UV := $(shell command -v uv 2>/dev/null || echo .uv/bin/uv)
RUN := $(UV) run --locked --quiet
DEMO ?= obstacle_course
# One Python for all that cargo builds: for another, pyo3 and what uses it are compiled again.
export PYO3_PYTHON ?= $(shell command -v $(PYTHON))
# The tests start hundreds of Pythons: each module is compiled once, whatever the shell says.
unexport PYTHONDONTWRITEBYTECODE
# What the built package is made of: `make setup` builds anew when it changes.
SOURCES := $(shell find rust models scenarios -type f)

.PHONY: setup wheel demo test test-core test-package test-long fast docs docs-test fuzz check lint lint-package clippy deny advisories format bench clean

setup: .venv/.ready ## the environment in .venv, with the command .venv/bin/treadwell

.venv/.ready: $(UV) pyproject.toml uv.lock Cargo.toml Cargo.lock $(SOURCES)
	$(UV) sync --locked
	@touch $@

.uv/bin/uv:
	$(PYTHON) -m venv .uv
	.uv/bin/pip install --quiet --disable-pip-version-check uv==$(UV_VERSION)

wheel: setup ## a wheel in dist/, for other environments: pip install dist/treadwell-*.whl
	$(RUN) maturin build --release --out dist

demo: setup ## one episode: the result, and where its pictures are
	$(RUN) treadwell run $(DEMO)

# The same cases in every run: what passes for one passes for all. `make fuzz` draws new ones.
test: export PROPTEST_RNG_SEED ?= 2004
test: ## every check, and every test but the long ones: the core's and the package's side by side, since much of each waits for one processor
	$(CARGO_TEST) --release --no-run # with every processor; the package and clippy then find most of it done
	$(MAKE) --jobs=2 --output-sync=line test-core test-package

test-core: clippy deny
	cargo fmt --check
	$(CARGO_TEST) --release
	MAKEFLAGS= cargo test --release $(CORE) --doc --quiet # it looks for make's jobs, and warns

test-package: lint-package
	$(PYTEST) --hypothesis-profile ci -m "not long and not docs"

test-long: export PROPTEST_RNG_SEED ?= 2004
test-long: setup ## what `make test` leaves out: further seeds, walks and builds of minutes, every bench
	$(CARGO_LONG)
	$(PYTEST) --hypothesis-profile ci -m long

fast: export PROPTEST_RNG_SEED ?= 2004
fast: setup ## the quick tests: two and a half minutes on two cores
	$(CARGO_FAST)
	$(PYTEST) --hypothesis-profile ci -m "not scenario and not slow and not long and not docs"

# The site's builder lives in an environment of its own: neither `make setup` nor a user needs it.
DOCS := $(UV) run --locked --quiet --isolated --only-group docs python tools/docs/site_of_pages.py
docs: $(UV) ## the documentation as a site, build/site/index.html; RUST=1: with the pages of the crates, which take minutes
	$(if $(RUST),cargo doc --no-deps --workspace --quiet)
	$(DOCS) $(if $(RUST),--rust $(or $(CARGO_TARGET_DIR),target)/doc)

docs-test: setup docs ## the site's links, and every command of the tutorial, the long ones too
	$(PYTEST) --hypothesis-profile ci -m docs

# In `make test` crates are built once, as the package is: tests of the core run on what walks.
NEXTEST := $(shell cargo nextest --version 2>/dev/null)
# The bindings have no Rust tests, and their library is the package's alone to build: a build by another would take it away under maturin.
CORE := --workspace --exclude bindings
CARGO_TEST := $(if $(NEXTEST),cargo nextest run $(CORE),cargo test $(CORE) --lib --bins --tests)
CARGO_LONG := $(if $(NEXTEST),cargo nextest run $(CORE) --release --run-ignored only,cargo test $(CORE) --release --lib --bins --tests -- --ignored)
# Tests in a module `slow` take seconds each, as those that pytest marks so.
CARGO_FAST := $(CARGO_TEST) $(if $(NEXTEST),-E 'not test(slow::)',-- --skip slow::)

PYTEST := $(RUN) pytest -q -n auto --dist worksteal

FUZZ_ROUNDS ?= 10
fuzz: setup ## the property tests with new random cases, FUZZ_ROUNDS times
	for round in $$(seq $(FUZZ_ROUNDS)); do \
		$(CARGO_TEST) && $(PYTEST) -m hypothesis || exit 1; \
	done

lint:
	cargo fmt --check
	$(MAKE) --jobs=2 lint-package clippy # the package's build leaves a processor free

lint-package: setup
	$(RUN) ruff check
	$(RUN) ruff format --check
	$(RUN) mypy
	$(RUN) python -m mypy.stubtest --mypy-config-file pyproject.toml treadwell._core

clippy:
	cargo clippy --release --workspace --all-targets --quiet -- -D warnings

deny: ## licences and sources of the crates; cargo-deny is asked where it is there
	@if cargo deny --version >/dev/null 2>&1; then cargo deny check licenses bans sources; \
	else echo "cargo-deny is not installed: tests/test_dependencies.py alone looks at licences and sources"; fi

advisories: setup ## known faults of what we build on; needs the network, cargo-deny and pip-audit
	cargo deny check advisories
	$(UV) export --locked --quiet --no-emit-project --format requirements-txt --output-file .uv-export.txt
	$(RUN) --with pip-audit pip-audit --strict --requirement .uv-export.txt --disable-pip; status=$$?; rm .uv-export.txt; exit $$status

format: setup
	cargo fmt
	$(RUN) ruff check --fix
	$(RUN) ruff format

check: test

clean:
	rm -rf target .venv .uv dist build
