#!/usr/bin/env bash
# unpack_ase.sh FOLDER: ASE, which reads extended XYZ in the tests, from Debian's packages, for those who have it not.
# It is unpacked rather than installed: SciPy wants Pythran, that Boost 1.74's headers, and these do not go with the 1.81
# that we build with. 20 MB to download, 84 MB in the folder.
set -euo pipefail

folder=$1
packages=(python3-ase python3-scipy python3-decorator libblas3 liblapack3 libgfortran5 libquadmath0 liblbfgsb0)

/usr/bin/python3 -c 'import ase.io' 2>/dev/null && exit 0
[[ -e $folder/complete ]] && exit 0
mkdir -p "$folder/packages"
cd "$folder/packages"
download() { apt-get download -qq "${packages[@]}" 2>/dev/null; }
if ! download; then
    # Without lists of packages, or with old ones.
    apt-get update -qq || true
    download || { echo "ASE cannot be downloaded: apt-get download ${packages[*]}" >&2; exit 1; }
fi
for package in *.deb; do dpkg -x "$package" ..; done
cd ..
rm -r packages
touch complete
