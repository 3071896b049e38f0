#!/usr/bin/env bash
# Builds and runs the tests; installs packages first; re-runnable.
# usage: ./test.sh [--asan] [ctest options]
#   ./test.sh                  all tests
#   ./test.sh -L importers     one folder's tests: core importers kdtree gpu plugin host testscenes
#                              tests
#   ./test.sh -L accelerator   kdtree, gpu and plugin
#   ./test.sh -R EmbreeParity  tests by name
#   ./test.sh --asan …         the same with AddressSanitizer and UndefinedBehaviorSanitizer, in
#                              build-asan/
set -euo pipefail
cd "$(dirname "$(readlink -f "$0")")"
source ./install.sh

if [[ " $* " == *" --help "* || " $* " == *" -h "* ]]; then
    sed -n '2,11s/^# \{0,1\}//p' "$0"
    exit 0
fi
preset=release
build=build
werror=${CI:+ON}
if [[ ${1:-} == --asan ]]; then
    shift
    preset=asan
    build=build-asan
    werror=OFF # With sanitizers GCC 12 warns of uninitialised parts of its own <regex>.
    export UBSAN_OPTIONS=${UBSAN_OPTIONS:-print_stacktrace=1:halt_on_error=1}
fi
install_packages tests/packages.txt
echo "== configure and build ($preset) into $build/"
cmake --preset "$preset" -DOVC_TESTS=ON -DOVC_WERROR="${werror:-OFF}" >/dev/null
cmake --build "$build"
echo "== test"
ctest --test-dir "$build" --output-on-failure --parallel "$(nproc)" "$@"
