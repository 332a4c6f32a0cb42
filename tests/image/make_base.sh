#!/usr/bin/env bash
# make_base.sh TAR: a minimal Debian 12 as a tar file, by debootstrap, from where this machine's apt gets Debian and with
# this machine's settings for apt, npm and certificates, so that what is installed on top comes from the same place.
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

# As in Debian's own slim image: no documentation but licences, and no wait for the disk at each file.
cat >"$root/etc/dpkg/dpkg.cfg.d/image" <<'END'
force-unsafe-io
path-exclude /usr/share/doc/*
path-include /usr/share/doc/*/copyright
path-exclude /usr/share/info/*
path-exclude /usr/share/locale/*
path-exclude /usr/share/man/*
END

# In place of debootstrap's own list of where Debian is.
rm "$root/etc/apt/sources.list"
for settings in /etc/apt/sources.list /etc/apt/sources.list.d /etc/apt/apt.conf.d /etc/apt/auth.conf.d /etc/npmrc \
    /root/.npmrc /usr/local/share/ca-certificates; do
    [[ -e $settings ]] || continue
    cp -r --parents "$settings" "$root"
done
# What a Debian image leaves out too.
rm -rf "$root"/var/cache/apt/archives/*.deb "$root"/var/cache/apt/*.bin "$root"/var/lib/apt/lists/* "$root"/var/log/*
tar -C "$root" -cf "$tar.new" .
mv "$tar.new" "$tar"
