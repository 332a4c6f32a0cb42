#!/usr/bin/env bash
# install_packages.sh SECTION...: installs the missing packages of these sections of packages.txt. If none is missing,
# it changes nothing, and needs neither root nor the network.
set -euo pipefail

list=$(dirname "${BASH_SOURCE[0]}")/packages.txt

installed() {
    [[ $(dpkg-query -W -f '${Status}' "$1" 2>/dev/null) == 'install ok installed' ]]
}

missing=()
section=
while read -r package program; do
    case $package in
        '') ;;
        '#') [[ $program =~ ^==\ ([a-z]+)\ ==$ ]] && section=${BASH_REMATCH[1]} ;;
        *)
            [[ " $* " == *" $section "* ]] || continue
            [[ -n $program ]] && command -v "$program" >/dev/null && continue
            installed "$package" || missing+=("$package")
            ;;
    esac
done <"$list"

[[ ${#missing[@]} -gt 0 ]] || exit 0

if ! command -v apt-get >/dev/null; then
    echo "This is no Debian; please install what corresponds to: ${missing[*]}" >&2
    exit 1
fi
as_root=()
if [[ $(id -u) -ne 0 ]]; then
    if ! command -v sudo >/dev/null; then
        echo "Packages are missing and neither root nor sudo is at hand. As root, please run:" >&2
        echo "  apt-get install --no-install-recommends ${missing[*]}" >&2
        exit 1
    fi
    as_root=(sudo)
fi
echo "Installing ${#missing[@]} Debian packages: ${missing[*]}"
"${as_root[@]}" apt-get update -qq
"${as_root[@]}" env DEBIAN_FRONTEND=noninteractive \
    apt-get install -y -qq --no-install-recommends -o Dpkg::Use-Pty=0 "${missing[@]}"
