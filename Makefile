# Front door: set-up, build, demo, tests. See README.md.
BUILD ?= build

.PHONY: setup build demo test

setup:
	@scripts/setup.sh

build: setup
	@cmake --preset release
	@cmake --build --preset release

test: build
	@ctest --preset release
