# Every target sets up what it needs; a second run of a set-up is instant.
# Python 3.11 goes into .venv (with Blender 4.5 as a module), Python 3.13 into .venv-3.13 (5.2).

SHELL := /bin/bash
.SHELLFLAGS := -eu -o pipefail -c
.DEFAULT_GOAL := help
MOCAP := .venv/bin/silhouette-mocap
KERNEL := $(wildcard core/native/build.py core/native/*.c core/native/*.h)
CORE_TESTS := tests/core tests/test_layers.py

.PHONY: help env demo demo-real test lint test-core test-command test-addon bench bench-tracking speed fuzz fuzz-kernel sanitize-kernel long-take blender clean

help: ## This list
	@grep -E '^[a-z-]+:.*## ' $(MAKEFILE_LIST) | sed -E 's/^([a-z-]+):.*## /make \1\t/' | expand -t 18

env: .venv/.ready .venv-3.13/.installed ## Both Python environments, with Blender as a module

.venv/.installed: pyproject.toml $(wildcard setup.py)
	@.ci/environment 3.11 .venv

.venv-3.13/.installed: pyproject.toml $(wildcard setup.py)
	@.ci/environment 3.13 .venv-3.13

# the kernel lies in the checkout, so both environments see the one built here
.venv/.ready: .venv/.installed $(KERNEL)
	@.venv/bin/python core/native/build.py >/dev/null
	@touch $@

demo: .venv/.ready ## Fit the sample walk, from masks and from silhouette videos, into out/
	@$(MOCAP) fit sample_scenes/walk/take.toml --out out/walk
	@$(MOCAP) fit sample_scenes/walk/take_videos.toml --out out/walk_videos
	@.venv/bin/python .ci/results.py out/walk out/walk_videos

demo-real: .venv/.ready ## Fetch the real four-camera recording and fit it into out/balance
	@.venv/bin/python sample_scenes/balance/fetch.py
	@$(MOCAP) plate sample_scenes/balance/take_footage.toml --recipes sample_scenes/balance/plates.toml
	@$(MOCAP) masks sample_scenes/balance/take_footage.toml --out sample_scenes/balance/data/masks
	@$(MOCAP) fit sample_scenes/balance/take.toml --out out/balance
	@.venv/bin/python .ci/results.py out/balance

test: env lint test-core test-command test-addon ## Linters and all tests, on Python 3.11 and 3.13 and both Blenders

lint: .venv/.installed
	.venv/bin/ruff check .
	.venv/bin/ruff format --check .
	.venv/bin/pyright

test-core: env
	.venv/bin/python -m pytest -q -n 2 --dist worksteal $(CORE_TESTS)
	.venv-3.13/bin/python -m pytest -q -n 2 --dist worksteal $(CORE_TESTS)

test-command: env
	.venv/bin/python -m pytest -q -n 2 --dist worksteal tests/command
	.venv-3.13/bin/python -m pytest -q -n 2 --dist worksteal tests/command

test-addon: env
	.venv/bin/python -m pytest -q -n 2 tests/addon
	.venv-3.13/bin/python -m pytest -q -n 2 tests/addon

prototypes ?= $(wildcard ../shared/prototypes)
bench: .venv/.ready ## Tables 1 and 2 of the 2003 paper on this machine, into out/bench
	@$(if $(prototypes),,echo "no frozen baselines in ../shared/prototypes: their rows are left out")
	@$(MOCAP) bench energy --json out/bench/energy.json --out out/bench $(addprefix --prototypes ,$(prototypes))

takes ?=
bench-tracking: .venv/.ready ## Errors and speed of the trackers, into out/bench; takes="a/take.toml b/take.toml" for others
	@$(MOCAP) bench tracking $(takes) --json out/bench/tracking.json --out out/bench

speed: ## Put what make bench and make bench-tracking measured into the README
	@.venv/bin/python .ci/speed.py out/bench

fuzz: .venv/.ready ## 10,000 damaged takes, calibrations and masks through a real command
	@cd tests && ../.venv/bin/python -m benchmarks.fuzz --cases 10000

seconds ?= 60
fuzz-kernel: .venv/.ready ## The kernel under sanitizers on scenes made of bytes; seconds=3600 for an hour (gcc)
	@cd tests && ../.venv/bin/python -m benchmarks.fuzz_kernel --seconds $(seconds)

sanitize-kernel: .venv/.ready ## The kernel's tests under AddressSanitizer, UBSan and valgrind (gcc, valgrind)
	@cd tests && ../.venv/bin/python -m benchmarks.sanitize_kernel

long-take: .venv/.ready ## Memory and disk over a fit of 10,000 frames
	@mkdir -p out && cd tests && ../.venv/bin/python -m benchmarks.long_take --every 1000 --svg ../out/long_take.svg

blender: .venv/.ready .venv-3.13/.installed ## A real Blender 5.2, cached outside the tree (needs root and a Debian-like machine)
	@.ci/blender

clean: ## Forget results and caches; the environments stay
	rm -rf out build dist .pytest_cache .ruff_cache
