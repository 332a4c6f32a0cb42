#!/usr/bin/env bash
# run.sh [ARGUMENTS]: installs missing packages on Debian 12, builds the program, and starts `spherule serve ARGUMENTS`.
# Without arguments, the page is at http://127.0.0.1:8080/.
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)

"$root/deploy/install_packages.sh" build run egl software
(
    cd "$root"
    cmake --preset release --log-level=WARNING -D SPHERULE_TESTS=OFF
    cmake --build --preset release -j "$(nproc)"
)
exec "$root/build/release/spherule" serve "$@"
