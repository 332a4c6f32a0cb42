#!/usr/bin/env bash
# unpack_ase.sh FOLDER: ASE, which reads extended XYZ in the tests, from Debian's packages, for those who have it not.
# It is unpacked rather than installed: SciPy wants Pythran, that Boost 1.74's headers, and these do not go with the 1.81
# that we build with. 20 MB to download, 84 MB in the folder.
set -euo pipefail

/usr/bin/python3 -c 'import ase.io' 2>/dev/null && exit 0
exec "$(dirname "${BASH_SOURCE[0]}")/unpack_packages.sh" "$1" \
    python3-ase python3-scipy python3-decorator libblas3 liblapack3 libgfortran5 libquadmath0 liblbfgsb0
