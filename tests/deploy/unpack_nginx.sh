#!/usr/bin/env bash
# unpack_nginx.sh FOLDER: unpacks Debian's nginx if nginx is not installed. It does not install the package, because
# that would start a web server on port 80.
set -euo pipefail

[[ -x /usr/sbin/nginx ]] && exit 0
exec "$(dirname "${BASH_SOURCE[0]}")/../unpack_packages.sh" "$1" nginx
