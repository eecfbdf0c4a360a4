# `make` alone lists the targets. Each target sets up .venv first; PYTHON=python3.12 selects the interpreter.
SHELL := bash
.SHELLFLAGS := -euo pipefail -c
.DEFAULT_GOAL := help
export PYTHON

bin := .venv/bin
workers ?= 2
# Chromium for the tests of the page, which are skipped if it cannot be installed.
chromium = [ -x /usr/bin/chromium ] || scripts/debian.sh chromium || echo 'without it the tests of the page are skipped'

# Libraries for the PDF version of the report; without them only the HTML page is written.
print = scripts/debian.sh libpango-1.0-0 libpangoft2-1.0-0 libharfbuzz-subset0 || true

.PHONY: help setup reproduce explore test test-long test-exhaustive mutations bench bench-against lint format docs site wheel constraints

help:
	@sed -n 's/^\([a-z-]*\):.*## /\1\t/p' Makefile | while IFS=$$'\t' read -r name what; do printf 'make %-15s %s\n' "$$name" "$$what"; done

setup: ## make .venv with the pinned versions and compile the kernels, or bring both up to date
	@scripts/setup.sh
	@$(bin)/python -m rocking.kernels

reproduce: setup ## reports on Yim & Lin (1991), and on pulses and earthquakes: results/*/index.html
	@$(print)
	@$(bin)/rocking paper
	@$(bin)/rocking paper pulses-and-earthquakes

explore: setup ## interactive explorer in the browser; port=N selects the port
	@$(bin)/rocking explore $(if $(port),--port $(port))

test: lint ## lint, then the fast tests, the examples in docstrings and the pages
	@$(print)
	@$(chromium)
	@$(bin)/python -m pytest -q -n $(workers)

test-long: setup ## tests that take minutes: millions of crossings, systems and cycles, the report
	@$(chromium)
	@$(bin)/python -m pytest -q -n $(workers) -m long --timeout 3600 $(options)

test-exhaustive: setup ## tests of a sample, such as 300 points of a map, on all points: hours
	@$(print)
	@$(bin)/python -m pytest -q -n $(workers) -m 'long or not long' --exhaustive --timeout 0 -rP tests

mutations: setup ## break the code on purpose and expect tests to fail; files="plot/ melnikov" selects, workers=N at a time
	@$(bin)/python tests/mutations.py --workers $(workers) $(options) $(files)

bench: setup ## benchmarks, as ratios to peers measured in the same run
	@$(chromium)
	@$(bin)/python -m benchmarks

bench-against: setup ## compare the speed with a commit, such as REF=main: ten minutes; seed=N repeats an order of runs
	@$(bin)/python -m benchmarks.against "$(REF)" $(if $(seed),--seed $(seed))

lint: setup ## ruff, mypy, import-linter
	@$(bin)/ruff check --quiet
	@$(bin)/ruff format --check --quiet || { echo 'not formatted: run `make format`'; exit 1; }
	@$(bin)/mypy --no-error-summary
	@$(bin)/lint-imports --no-logo

format: setup ## format the sources
	@$(bin)/ruff check --quiet --fix-only
	@$(bin)/ruff format

docs: setup ## the pages, with all code blocks executed: build/docs/index.html
	@scripts/setup.sh docs
	@$(chromium)
	@$(bin)/python -m sphinx --quiet --fail-on-warning --keep-going -d build/docs-pages docs build/docs
	@echo wrote build/docs/index.html

site: reproduce docs ## the reports, then the pages with them: minutes longer than docs

wheel: setup ## wheel with the compiled kernels: dist/
	@$(bin)/python scripts/wheel.py

constraints: ## pin the newest versions again; PYTHONS names an interpreter of each minor version
	@scripts/constraints.sh $(or $(PYTHONS),python3.11 python3.12 python3.13)
