#!/usr/bin/env bash
# unpack_packages.sh FOLDER PACKAGE...: Debian packages unpacked in the folder, where they can be used but change nothing
# of the machine.
set -euo pipefail

folder=$1
shift

[[ -e $folder/complete ]] && exit 0
mkdir -p "$folder/packages"
cd "$folder/packages"
download() { apt-get download -qq "$@" 2>/dev/null; }
if ! download "$@"; then
    # Without lists of packages, or with old ones.
    apt-get update -qq || true
    download "$@" || { echo "cannot be downloaded: apt-get download $*" >&2; exit 1; }
fi
for package in *.deb; do dpkg -x "$package" ..; done
cd ..
rm -r packages
touch complete
