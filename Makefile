# Front door. README.md says what each target leaves where.
.PHONY: help setup build demo test

help:
	@echo "make demo   install what is missing, build, render the main example into out/"
	@echo "make build  install what is missing, build a release into build/"
	@echo "make test   the same, then every test (CATOPTRA_CORPUS=folder adds the tests on real CAD files)"

setup:
	@scripts/setup.sh

build: setup
	@cmake --preset release
	@cmake --build --preset release

# Builds what the demonstration needs and no tests.
demo: setup
	@cmake --preset release
	@cmake --build --preset release --target catoptra examples
	@scripts/demo.sh

test:
	@scripts/setup.sh --tests
	@$(MAKE) --no-print-directory build
	@scripts/test.sh
