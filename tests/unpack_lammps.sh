#!/usr/bin/env bash
# unpack_lammps.sh FOLDER: unpacks LAMMPS from Debian's packages if it is not installed. Tests read files that it writes.
# VTK, which the tests need, depends on the other libraries. The download has 5 MB, the folder 18 MB.
set -euo pipefail

command -v lmp >/dev/null && exit 0
exec "$(dirname "${BASH_SOURCE[0]}")/unpack_packages.sh" "$1" lammps liblammps0 libkim-api2 libvoro++1 libfftw3-double3
