#!/usr/bin/env bash
# make_base.sh TAR: makes a minimal Debian 12 as a tar file, with debootstrap. It uses the mirror of this machine's apt.
# It copies this machine's settings of apt, npm and certificates, so that later packages come from the same place.
set -euo pipefail

tar=$1
work=$(mktemp -d -p "$(dirname "$tar")")
trap 'rm -rf --one-file-system "$work"' EXIT
root=$work/root

mirror=$(apt-get indextargets --format '$(SITE)' 'Codename: bookworm' 'Created-By: Packages' | head -n 1)
if ! debootstrap --variant=minbase bookworm "$root" ${mirror:+"$mirror"} >"$work/log" 2>&1; then
    tail -n 20 "$work/log" >&2
    exit 1
fi

# Same as in Debian's slim image: no documentation except licences, and no wait for the disk after each file.
cat >"$root/etc/dpkg/dpkg.cfg.d/image" <<'END'
force-unsafe-io
path-exclude /usr/share/doc/*
path-include /usr/share/doc/*/copyright
path-exclude /usr/share/info/*
path-exclude /usr/share/locale/*
path-exclude /usr/share/man/*
END

# Replaces the list of sources of debootstrap.
rm "$root/etc/apt/sources.list"
for settings in /etc/apt/sources.list /etc/apt/sources.list.d /etc/apt/apt.conf.d /etc/apt/auth.conf.d /etc/npmrc \
    /root/.npmrc /usr/local/share/ca-certificates; do
    [[ -e $settings ]] || continue
    cp -r --parents "$settings" "$root"
done
# Debian's image does not contain these files either.
rm -rf "$root"/var/cache/apt/archives/*.deb "$root"/var/cache/apt/*.bin "$root"/var/lib/apt/lists/* "$root"/var/log/*
tar -C "$root" -cf "$tar.new" .
mv "$tar.new" "$tar"
