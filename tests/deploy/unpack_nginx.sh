#!/usr/bin/env bash
# unpack_nginx.sh FOLDER: Debian's nginx, for those who have it not. Unpacked rather than installed: the package would
# start a web server on port 80.
set -euo pipefail

[[ -x /usr/sbin/nginx ]] && exit 0
exec "$(dirname "${BASH_SOURCE[0]}")/../unpack_packages.sh" "$1" nginx
