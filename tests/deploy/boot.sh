#!/bin/sh
# boot.sh ROOT: starts systemd in the root, as the first process of new namespaces, with a network of its own.
set -eu

root=$1
mount --bind "$root" "$root"
mount -t proc proc "$root/proc"
mount -t sysfs -o ro sysfs "$root/sys"
if [ -e /sys/fs/cgroup/cgroup.controllers ]; then
    mount -t cgroup2 cgroup2 "$root/sys/fs/cgroup"
else
    mount -t tmpfs tmpfs "$root/sys/fs/cgroup"
    mkdir "$root/sys/fs/cgroup/systemd"
    mount -t cgroup -o none,name=systemd cgroup "$root/sys/fs/cgroup/systemd"
fi
mount -t tmpfs tmpfs "$root/dev"
for device in null zero full random urandom tty; do
    touch "$root/dev/$device"
    mount --bind "/dev/$device" "$root/dev/$device"
done
ln -s /proc/self/fd "$root/dev/fd"
mkdir "$root/dev/shm" "$root/dev/pts"
mount -t devpts -o newinstance,ptmxmode=0666 devpts "$root/dev/pts"
for folder in dev/shm run tmp; do mount -t tmpfs tmpfs "$root/$folder"; done
ip link set lo up
# The variable is that of container managers.
exec chroot "$root" /usr/bin/env -i container=spherule PATH=/usr/sbin:/usr/bin /lib/systemd/systemd
