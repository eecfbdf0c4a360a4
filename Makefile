# `make` alone lists the targets. Each sets up .venv first; PYTHON=python3.12 chooses the interpreter.
SHELL := bash
.SHELLFLAGS := -euo pipefail -c
.DEFAULT_GOAL := help
export PYTHON

bin := .venv/bin
workers ?= 2
# Compiled once here, before the workers would each compile the same kernels.
compile = $(bin)/rocking simulate --amplitude 2 --period 1 --restitution 0.925 --cycles 1 >/dev/null

.PHONY: help setup reproduce test test-long bench lint format constraints

help:
	@sed -n 's/^\([a-z-]*\):.*## /\1\t/p' Makefile | while IFS=$$'\t' read -r name what; do printf 'make %-12s %s\n' "$$name" "$$what"; done

setup: ## make .venv with pinned versions, or bring it up to date
	@scripts/setup.sh

reproduce: setup ## the figures of Yim & Lin (1991), into results/yim-lin-1991/
	@$(bin)/rocking paper

test: lint ## lint, then the tests, the examples in docstrings and the README
	@$(compile)
	@$(bin)/python -m pytest -q -n $(workers)

test-long: setup ## the tests that take minutes: millions of crossings, systems and cycles
	@$(compile)
	@$(bin)/python -m pytest -q -n $(workers) -m long --timeout 3600

bench: setup ## what it costs, as ratios against peers measured in the same run
	@$(bin)/python -m benchmarks

lint: setup ## ruff, mypy, import-linter
	@$(bin)/ruff check --quiet
	@$(bin)/ruff format --check --quiet || { echo 'not formatted: run `make format`'; exit 1; }
	@$(bin)/mypy --no-error-summary
	@$(bin)/lint-imports --no-logo

format: setup ## rewrite the sources in the one style
	@$(bin)/ruff check --quiet --fix-only
	@$(bin)/ruff format

constraints: ## pin the newest versions anew; PYTHONS names an interpreter of each minor version
	@scripts/constraints.sh $(or $(PYTHONS),python3.11 python3.12 python3.13)
