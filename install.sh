#!/usr/bin/env bash
# Installs the Debian packages that packages.txt lists, with sudo when not root; re-runnable.
# demo.sh and test.sh source it. ./install.sh tests/packages.txt installs those of tests too.
# install_packages [LIST...]: installs the packages of further lists as well.
set -euo pipefail

install_packages() {
    local here missing=() package sudo=""
    here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
    while read -r package; do
        [[ -z $package || $package == \#* ]] && continue
        dpkg-query -W -f='${Status}' "$package" 2>/dev/null | grep -q 'install ok installed' ||
            missing+=("$package")
    done < <(cat "$here/packages.txt" "$@")
    if [[ ${#missing[@]} -eq 0 ]]; then
        echo "== packages: all installed"
        return
    fi
    command -v apt-get >/dev/null || {
        echo "install.sh: apt-get not found; on a system other than Debian install" \
            "the equivalents of: ${missing[*]}" >&2
        exit 1
    }
    if [[ $(id -u) -ne 0 ]]; then
        command -v sudo >/dev/null || {
            echo "install.sh: not root and sudo not found; as root, run:" \
                "apt-get install ${missing[*]}" >&2
            exit 1
        }
        sudo=sudo
    fi
    echo "== packages: installing ${missing[*]}"
    $sudo apt-get update -qq
    DEBIAN_FRONTEND=noninteractive $sudo apt-get install -y -qq --no-install-recommends \
        "${missing[@]}" >/dev/null
}

if [[ ${BASH_SOURCE[0]} == "$0" ]]; then
    install_packages "$@"
fi
