#!/usr/bin/env bash
# unpack_packages.sh FOLDER PACKAGE...: unpacks Debian packages in the folder, without installing them.
set -euo pipefail

folder=$1
shift

[[ -e $folder/complete ]] && exit 0
mkdir -p "$folder/packages"
cd "$folder/packages"
download() { apt-get download -qq "$@" 2>/dev/null; }
if ! download "$@"; then
    # The package lists may be missing or old.
    apt-get update -qq || true
    download "$@" || { echo "cannot be downloaded: apt-get download $*" >&2; exit 1; }
fi
for package in *.deb; do dpkg -x "$package" ..; done
cd ..
rm -r packages
touch complete
