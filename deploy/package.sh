#!/usr/bin/env bash
# package.sh: installs missing packages on Debian 12, builds the program, and writes the Debian package with its service
# to build/packages/spherule_VERSION-1_ARCHITECTURE.deb. docs/operations.md#as-a-service-on-debian describes the package.
set -euo pipefail

cd "$(dirname "${BASH_SOURCE[0]}")/.."
deploy/install_packages.sh build run
cmake --preset release --log-level=WARNING -D SPHERULE_TESTS=OFF
cmake --build --preset release -j "$(nproc)"

# All times in the package are that of the source, so the same source gives the same package.
SOURCE_DATE_EPOCH=$(git log -1 --format=%ct 2>/dev/null || stat -c %Y CHANGELOG.md)
export SOURCE_DATE_EPOCH
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
(umask 022 && cpack -G DEB --config build/release/CPackConfig.cmake -B "$work" >"$work/log") || {
    cat "$work/log" >&2
    exit 1
}
mkdir -p build/packages
for package in "$work"/*.deb; do
    mv "$package" build/packages/
    echo "build/packages/$(basename "$package")"
done
