# `make` alone lists the targets. Each sets up .venv first; PYTHON=python3.12 chooses the interpreter.
SHELL := bash
.SHELLFLAGS := -euo pipefail -c
.DEFAULT_GOAL := help
export PYTHON

bin := .venv/bin
workers ?= 2
# Compiled once here, before the workers would each compile the same kernels.
case = --amplitude 2 --period 1 --restitution 0.925
compile = $(bin)/rocking simulate $(case) --cycles 1 >/dev/null; \
	$(bin)/rocking classify $(case) >/dev/null & \
	$(bin)/rocking map --amplitude 1:2:2 --period 1:2:2 --restitution 1 --max-cycles 1 >/dev/null 2>&1; wait
# What the page is looked at with; its tests are left out where there is none and none can be installed.
chromium = [ -x /usr/bin/chromium ] || scripts/debian.sh chromium || echo 'without it the tests of the page are left out'

# What the PDF twin of the report is made with; without it there is the page alone.
print = scripts/debian.sh libpango-1.0-0 libpangoft2-1.0-0 libharfbuzz-subset0 || true

.PHONY: help setup reproduce explore test test-long test-exhaustive bench bench-against lint format docs site constraints

help:
	@sed -n 's/^\([a-z-]*\):.*## /\1\t/p' Makefile | while IFS=$$'\t' read -r name what; do printf 'make %-15s %s\n' "$$name" "$$what"; done

setup: ## make .venv with pinned versions, or bring it up to date
	@scripts/setup.sh

reproduce: setup ## the whole of Yim & Lin (1991), judged on one page: results/yim-lin-1991/index.html
	@$(print)
	@$(bin)/rocking paper

explore: setup ## a page that shows a system from all sides; port=N chooses where
	@$(bin)/rocking explore $(if $(port),--port $(port))

test: lint ## lint, then the tests, the examples in docstrings and the README
	@$(print)
	@$(compile)
	@$(chromium)
	@$(bin)/python -m pytest -q -n $(workers)

test-long: setup ## the tests that take minutes: millions of crossings, systems and cycles, the report
	@$(compile)
	@$(chromium)
	@$(bin)/python -m pytest -q -n $(workers) -m long --timeout 3600

test-exhaustive: setup ## the tests that look at a part of something, such as 300 points of a map, at the whole: hours
	@$(print)
	@$(compile)
	@$(bin)/python -m pytest -q -n $(workers) -m 'long or not long' --exhaustive --timeout 0 -rP tests

bench: setup ## what it costs, as ratios against peers measured in the same run
	@$(chromium)
	@$(bin)/python -m benchmarks

bench-against: setup ## its speed against that at a commit, such as REF=main, in some ten minutes; seed=N repeats an order of runs
	@$(bin)/python -m benchmarks.against "$(REF)" $(if $(seed),--seed $(seed))

lint: setup ## ruff, mypy, import-linter
	@$(bin)/ruff check --quiet
	@$(bin)/ruff format --check --quiet || { echo 'not formatted: run `make format`'; exit 1; }
	@$(bin)/mypy --no-error-summary
	@$(bin)/lint-imports --no-logo

format: setup ## rewrite the sources in the one style
	@$(bin)/ruff check --quiet --fix-only
	@$(bin)/ruff format

docs: ## the pages, every block of them run: build/docs/index.html
	@scripts/setup.sh docs
	@$(chromium)
	@$(compile)
	@$(bin)/python -m sphinx --quiet --fail-on-warning --keep-going -d build/docs-pages docs build/docs
	@echo wrote build/docs/index.html

site: reproduce docs ## the report of Yim & Lin (1991), then the pages with it: minutes longer than docs

constraints: ## pin the newest versions anew; PYTHONS names an interpreter of each minor version
	@scripts/constraints.sh $(or $(PYTHONS),python3.11 python3.12 python3.13)
