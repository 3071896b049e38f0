#!/usr/bin/env bash
# SPDX-License-Identifier: AGPL-3.0-or-later
# Tests that build.sh ends with 77 and a command to copy where apt has no source package, or where
# packages to build it are missing.
set -euo pipefail

here=$(cd "$(dirname "$(readlink -f "$0")")" && pwd)
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
mkdir "$folder/bin"
export PATH=$folder/bin:$PATH

# pretend NAME: makes a program of this name, whose script it reads from standard input.
pretend() {
    { echo '#!/bin/sh'; cat; } > "$folder/bin/$1"
    chmod +x "$folder/bin/$1"
}

# expect TEXT: runs build.sh, whose last line must contain the text.
expect() {
    local said code=0
    said=$("$here/build.sh" "$folder/out" 2>&1) || code=$?
    said=$(tail -n 1 <<< "$said")
    [[ $code -eq 77 && $said == *"$1"* ]] && return
    echo "build.sh ended with $code and said: $said"
    echo "expected 77 and: $1"
    exit 1
}

pretend compiler <<'END'
for word; do case $word in *.cpp) name=${word##*/}; : > "${name%.cpp}.o" ;; esac; done
END
export CXX=compiler
pretend dpkg-source <<< 'mkdir -p povray-3.7.0.10/debian'
pretend dpkg-checkbuilddeps <<'END'
missing="libone-dev (>= 2) libtwo | libthree"
echo "dpkg-checkbuilddeps: error: Unmet build dependencies: $missing" >&2
exit 1
END

pretend apt-get <<< 'exit 100'
expect "deb-src"
expect "as root, run: sed "
expect " && apt-get update"

pretend apt-get <<< 'for word; do [ "$word" = source ] && exit 0; done; exit 100'
expect "libone-dev (>= 2)"
expect "as root, run: apt-get build-dep $(cd "$folder" && pwd -P)/out/povray-source/povray-3.7.0.10"
