#!/usr/bin/env bash
# unpack_ase.sh FOLDER: unpacks ASE from Debian's packages if it is not installed. Tests read extended XYZ with it. It
# cannot be installed: SciPy depends on Pythran, and that on Boost 1.74, which conflicts with Boost 1.81 of the build.
# The download has 20 MB, the folder 84 MB.
set -euo pipefail

/usr/bin/python3 -c 'import ase.io' 2>/dev/null && exit 0
exec "$(dirname "${BASH_SOURCE[0]}")/unpack_packages.sh" "$1" \
    python3-ase python3-scipy python3-decorator libblas3 liblapack3 libgfortran5 libquadmath0 liblbfgsb0
