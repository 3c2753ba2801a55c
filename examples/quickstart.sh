#!/bin/bash
# Installs what pscn needs (Debian 12, as root), builds the release and renders the teapot into teapot.png.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
. examples/packages.sh
export LC_ALL=C

install_packages "${BUILD_PACKAGES[@]}"
cmake -S . -B build -DCMAKE_BUILD_TYPE=Release -DPSCN_WERROR=OFF
cmake --build build
build/src/command/pscn render scenes/teapot.pscn -o teapot.png
echo "The picture is $PWD/teapot.png"
