#!/usr/bin/env bash
# SPDX-License-Identifier: AGPL-3.0-or-later
# Builds povray-overcast: Debian's source package of POV-Ray 3.7 with povray.patch and the
# overcast_*.cpp beside this script.
# usage: build.sh FOLDER        FOLDER/povray-overcast; the sources and objects go to
#                               FOLDER/povray-source
# JOBS: how many compilers run at once (nproc). CXX: such as "ccache g++". The first build takes
# some 12 minutes of one core.
# Exit 77: the source package, or a package that it is built with, is not to be had here; the last
# line says what is missing.
set -euo pipefail

version=3.7.0.10
here=$(cd "$(dirname "$(readlink -f "$0")")" && pwd)
root=$(cd "$here/../../.." && pwd)

usage() {
    sed -n '3,10s/^# \{0,1\}//p' "$0"
}

cannot() {
    echo "build.sh: $1" >&2
    exit 77
}

# Downloads Debian's source package from wherever apt is told to take source packages.
fetch_source() {
    local apt=(apt-get -qq)
    command -v apt-get >/dev/null && command -v dpkg-source >/dev/null ||
        cannot "apt-get and dpkg-source are needed; as root, run: apt-get install dpkg-dev"
    # As root, apt downloads as its own user, who may not write here.
    [[ $(id -u) -ne 0 ]] || apt+=(-o APT::Sandbox::User=root)
    "${apt[@]}" source --download-only --only-source "povray=1:$version-2" &&
        touch fetched && return
    local missing="apt has no source package of povray 1:$version-2 (deb-src); as root, run:"
    local sources=/etc/apt/sources.list.d/debian.sources
    if [[ -f $sources ]]; then
        cannot "$missing sed -i 's/^Types: deb\$/Types: deb deb-src/' $sources && apt-get update"
    fi
    cannot "$missing sed -n 's/^deb /deb-src /p' /etc/apt/sources.list\
 > /etc/apt/sources.list.d/deb-src.list && apt-get update"
}

# Configures as debian/rules does, without documents and packaging.
configure() {
    mv libraries libraries.donotuse # Debian's own libraries are used instead.
    local macro
    for macro in unix/config/*.m4; do
        if [[ ! -h $macro && -f /usr/share/aclocal/${macro##*/} ]]; then
            ln -sf "/usr/share/aclocal/${macro##*/}" "$macro"
        fi
    done
    (cd unix && ./prebuild.sh)
    ./configure --prefix=/usr --sysconfdir=/etc --disable-dependency-tracking --disable-optimiz \
        --disable-strip --with-boost-thread=boost_thread \
        COMPILED_BY="the Overcast project, with povray.patch" \
        CPPFLAGS="-I$root" CXXFLAGS=-O3 LIBS="$PWD/../libovercast_mesh.a -ldl"
}

# Makes a library of our own files beside POV-Ray's sources, anew each time, because that is quick.
compile_ours() {
    local source
    rm -f libovercast_mesh.a
    for source in "$here"/overcast_{device,mesh,settings}.cpp; do
        ${CXX:-g++} -std=c++17 -O2 -I"$root" -c "$source"
    done
    ar rcs libovercast_mesh.a overcast_{device,mesh,settings}.o
}

if [[ $# -ne 1 || $1 == -* ]]; then
    usage
    [[ ${1:-} == -h || ${1:-} == --help ]] || exit 1
    exit 0
fi
mkdir -p "$1"
out=$(cd "$1" && pwd)
mkdir -p "$out/povray-source"
cd "$out/povray-source"
compile_ours

# When the patch has changed, POV-Ray is unpacked and configured again.
stamp=$(sha256sum < "$here/povray.patch")
if [[ ! -f patched || $(cat patched) != "$stamp" ]]; then
    rm -rf "povray-$version" patched
    [[ -f fetched ]] || fetch_source
    # apt has checked what it downloaded; the keys of Debian's developers are rarely here.
    dpkg-source --no-check -x "povray_$version-2.dsc" >/dev/null
    missing=$(dpkg-checkbuilddeps "povray-$version/debian/control" 2>&1) ||
        cannot "${missing#*error: }; as root, run: apt-get build-dep \
$(printf %q "$PWD/povray-$version")"
    patch -d "povray-$version" -p1 --fuzz=0 < "$here/povray.patch"
    (cd "povray-$version" && configure) > configure.log 2>&1 || {
        tail -n 5 configure.log >&2
        echo "build.sh: configuring POV-Ray failed; all it said is in $PWD/configure.log" >&2
        exit 1
    }
    echo "$stamp" > patched
fi
rm -f "povray-$version/unix/povray" # because make does not see that our library is new
make -C "povray-$version" -j "${JOBS:-$(nproc)}" > make.log 2>&1 || {
    grep -m5 -E 'error|Error' make.log >&2 || tail -n 5 make.log >&2
    echo "build.sh: compiling POV-Ray failed; all it said is in $PWD/make.log" >&2
    exit 1
}
cp "povray-$version/unix/povray" "$out/povray-overcast.new"
mv "$out/povray-overcast.new" "$out/povray-overcast"
echo "$out/povray-overcast"
