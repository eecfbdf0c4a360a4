# `make` alone lists the targets. Each target sets up what it needs in .venv first; PYTHON=python3.12 selects the interpreter.
SHELL := bash
.SHELLFLAGS := -euo pipefail -c
.DEFAULT_GOAL := help
export PYTHON

bin := .venv/bin
workers ?= 2
pytest = $(bin)/python -m pytest -q -n $(workers)
user = distributed explorer film netcdf proof report store
# Set up .venv with these extras, and compile the kernels, unless both are up to date.
ready = @scripts/setup.sh $(1) && $(bin)/python -m rocking.kernels
# Chromium for the tests of the page, which are skipped if it cannot be installed.
chromium = [ -x /usr/bin/chromium ] || scripts/debian.sh chromium || echo 'without it the tests of the page are skipped'
# Libraries for the PDF version of the report; without them only the HTML page is written.
print = scripts/debian.sh libpango-1.0-0 libpangoft2-1.0-0 libharfbuzz-subset0 || true

.PHONY: help setup reproduce explore test test-long test-exhaustive test-project mutations bench bench-against lint format check docs \
    site wheel constraints

help:
	@echo 'usage: make TARGET, with one of these targets:'
	@sed -n 's/^\([a-z-]*\):.*## /\1\t/p' Makefile | while IFS=$$'\t' read -r name what; do printf 'make %-15s %s\n' "$$name" "$$what"; done

setup: ## make .venv with the pinned versions of all that users need and compile the kernels, or bring both up to date
	$(call ready,$(user))

reproduce: ## reports on Yim & Lin (1991), and on pulses and earthquakes: results/*/index.html
	$(call ready,report)
	@$(print)
	@$(bin)/rocking paper
	@$(bin)/rocking paper pulses-and-earthquakes

explore: ## interactive explorer in the browser; port=N selects the port
	$(call ready,explorer)
	@$(bin)/rocking explore $(if $(port),--port $(port))

test: ## the fast tests, and the examples in docstrings
	$(call ready,test)
	@$(print)
	@$(chromium)
	@$(pytest)

check: lint test ## lint, then the tests

test-long: ## tests that take minutes: millions of crossings, systems and cycles, the report
	$(call ready,test)
	@$(chromium)
	@$(pytest) -m long --timeout 3600 tests $(options)

test-exhaustive: ## tests of a sample, such as 300 points of a map, on all points: hours
	$(call ready,test)
	@$(print)
	@$(pytest) -m 'long or not long' --exhaustive --timeout 0 -rP tests

test-project: ## tests of the project's files, pages and tools: pins, wheel, benchmarks, mutations
	$(call ready,test)
	@$(pytest) tests/project

mutations: ## break the code on purpose and expect tests to fail; files="plot/ melnikov" selects, workers=N at a time
	$(call ready,test)
	@$(bin)/python tests/mutations.py --workers $(workers) $(options) $(files)

bench: ## benchmarks, as ratios to peers measured in the same run
	$(call ready,test)
	@$(chromium)
	@$(bin)/python -m benchmarks

bench-against: ## compare the speed with a commit, such as REF=main: ten minutes; seed=N repeats an order of runs
	$(call ready,test)
	@$(bin)/python -m benchmarks.against "$(REF)" $(if $(seed),--seed $(seed))

# mypy reads the types of all optional packages.
lint: ## ruff, mypy, import-linter
	$(call ready,lint $(user))
	@$(bin)/ruff check --quiet
	@$(bin)/ruff format --check --quiet || { echo 'not formatted: run `make format`'; exit 1; }
	@scripts/watched.sh mypy $(bin)/mypy --no-error-summary
	@scripts/watched.sh import-linter $(bin)/lint-imports --no-logo

format: ## format the sources
	$(call ready,lint)
	@$(bin)/ruff check --quiet --fix-only
	@$(bin)/ruff format

docs: ## the pages, with all code blocks and those of the README executed: build/docs/index.html
	$(call ready,docs $(user))
	@$(chromium)
	@scripts/watched.sh README.md $(bin)/python docs/extensions/run_page.py README.md
	@$(bin)/python -m sphinx --fail-on-warning --keep-going -d build/docs-pages docs build/docs
	@echo wrote build/docs/index.html

site: reproduce docs ## the reports, then the pages with them: minutes longer than docs

wheel: ## wheel with the compiled kernels: dist/
	$(call ready)
	@$(bin)/python scripts/wheel.py

constraints: ## pin the newest versions again; PYTHONS names an interpreter of each minor version
	@scripts/constraints.sh $(or $(PYTHONS),python3.11 python3.12 python3.13)
