#!/usr/bin/env bash
# Installs the Debian packages that Catoptra builds with, once: a stamp says that this list was installed.
set -euo pipefail

packages=(
  build-essential cmake ninja-build ccache pkg-config git
  libglm-dev libocct-data-exchange-dev libocct-modeling-algorithms-dev libocct-ocaf-dev libocct-visualization-dev
  libassimp-dev libopenmesh-dev libembree-dev libtbb-dev libopenimageio-dev
  libepoxy-dev libegl-dev libgl1-mesa-dri libegl1
  nlohmann-json3-dev libcli11-dev libtomlplusplus-dev libspdlog-dev libfreetype-dev fonts-dejavu-core
  libgtest-dev
)

missing=()
for package in "${packages[@]}"; do
  dpkg-query -W -f='${Status}' "$package" 2>/dev/null | grep -q 'install ok installed' || missing+=("$package")
done
if [ ${#missing[@]} -eq 0 ]; then exit 0; fi

sudo=""
if [ "$(id -u)" -ne 0 ]; then
  command -v sudo >/dev/null || { echo "setup: needs root or sudo to install: ${missing[*]}" >&2; exit 1; }
  sudo=sudo
fi
echo "setup: installing ${missing[*]}" >&2
$sudo apt-get update -qq
DEBIAN_FRONTEND=noninteractive $sudo -E apt-get install -y -qq --no-install-recommends "${missing[@]}" >/dev/null
