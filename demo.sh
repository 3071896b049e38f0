#!/usr/bin/env bash
# Renders a lake shore of 7 million triangles with a quarter of the GPU memory that its level 2
# would fill. Installs packages, builds, renders; re-runnable.
set -euo pipefail
cd "$(dirname "$(readlink -f "$0")")"
source ./install.sh

if [[ ${1:-} == --help || ${1:-} == -h ]]; then
    sed -n '2,3s/^# //p' "$0"
    exit 0
fi
install_packages
echo "== configure and build (Release) into build/"
cmake --preset release >/dev/null
cmake --build build
echo "== render: 'plants', 343 MiB of level 2, in 86 MiB of GPU memory"
mkdir -p out
build/bin/overcast render plants --size 1280x720 --gpu-memory 86M \
    -o out/demo.png -o out/demo.exr --stats out/demo.json
echo "== done: look at out/demo.png; out/demo.exr is linear," \
    "out/demo.json has the statistics (docs/reference/stats.md)"
