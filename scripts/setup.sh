#!/usr/bin/env bash
# Installs the Debian 12 packages that Catoptra is built with (--tests: and tested with), as root or through sudo. Does nothing where
# all are there.
set -euo pipefail

packages=(
  build-essential cmake ninja-build ccache pkg-config git
  libglm-dev libocct-data-exchange-dev libocct-modeling-algorithms-dev libocct-ocaf-dev libocct-visualization-dev libfontconfig-dev
  libassimp-dev libzip-dev libpugixml-dev libopenmesh-dev libembree-dev libtbb-dev libyaml-cpp-dev libopenimageio-dev openimageio-tools
  libepoxy-dev libegl-dev libgl1-mesa-dri libegl1
  nlohmann-json3-dev libcli11-dev libtomlplusplus-dev libspdlog-dev libssl-dev libsqlite3-dev libfreetype-dev fonts-dejavu-core
  python3-dev pybind11-dev python3-numpy
  libgtest-dev
)

# A browser for the HTML reports; a cluster scheduler and the tools of the Python tests.
if [ "${1:-}" = --tests ]; then packages+=(chromium python3-pytest python3-distributed mypy); fi
# Some machines have npm from elsewhere than Debian.
command -v npm >/dev/null || packages+=(npm)

missing=()
for package in "${packages[@]}"; do
  status=$(dpkg-query -W -f='${Status}' "$package" 2>/dev/null || true)
  [[ $status == *"install ok installed"* ]] || missing+=("$package")
done
if [ ${#missing[@]} -eq 0 ]; then exit 0; fi

as_root=()
if [ "$(id -u)" -ne 0 ]; then
  command -v sudo >/dev/null || { echo "setup: root or sudo is needed to install: ${missing[*]}" >&2; exit 1; }
  as_root=(sudo)
fi
echo "setup: installing ${missing[*]}" >&2
log=$(mktemp)
trap 'rm -f "$log"' EXIT
install() {
  "${as_root[@]}" apt-get update -qq &&
    "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "${missing[@]}"
}
if ! install >"$log" 2>&1; then
  tail -n 20 "$log" >&2
  echo "setup: apt-get could not install the packages above; Debian 12 (bookworm) has all of them" >&2
  exit 1
fi
