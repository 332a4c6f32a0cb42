#!/usr/bin/env bash
# Builds deploy/Dockerfile without a container engine, on a minimal Debian that it makes. Checks the content of the
# image, and runs it without privileges and with a read-only root. Needs root on Debian 12; installs missing packages.
#
#   deploy/verify_image.sh              the image for NVIDIA GPUs and for processors
#   deploy/verify_image.sh --software   also the image with Mesa's renderers
#
# Its files are in build/image: the Debian, the images, and a compiler cache that shortens later builds. CCACHE_DIR sets
# another folder for the cache.
set -euo pipefail

cd "$(dirname "${BASH_SOURCE[0]}")/.."
work=$PWD/build/image
cache=${CCACHE_DIR:-$work/ccache}
base=docker.io/library/debian:bookworm-slim

variants=(plain)
case ${1-} in
    '') ;;
    --software) variants+=(software) ;;
    -h | --help) sed -n '2,10s/^# \?//p' "$0"; exit 0 ;;
    *) echo "unknown option $1; see $0 --help" >&2; exit 2 ;;
esac
if [[ $(id -u) -ne 0 ]]; then
    echo "Only root can make the file systems that this needs: sudo $0 $*" >&2
    exit 2
fi

deploy/install_packages.sh image
if [[ ! -x build/release/spherule_load ]]; then
    # The checks need the load client.
    deploy/install_packages.sh build run egl software test
    cmake --preset release --log-level=WARNING -D SPHERULE_TESTS=ON
    cmake --build --preset release -j "$(nproc)" --target spherule spherule_load
fi

# buildah with its own storage, which is separate from the machine's images. It uses overlays if the file system does.
images() {
    buildah --root "$work/storage" --runroot "$work/storage-run" "$@"
}

make_base() {
    [[ -s $work/base.tar ]] || tests/image/make_base.sh "$work/base.tar"
    local container
    container=$(images from scratch)
    images add --quiet "$container" "$work/base.tar" /
    images commit --quiet --rm "$container" "$base"
}

# build VARIANT: builds the image as Docker does, but with this machine's network and a compiler cache.
build() {
    local arguments=()
    [[ $1 != software ]] || arguments=(--build-arg SOFTWARE_GL=1)
    images bud --isolation chroot --pull-never --format docker --layers --network host \
        --volume "$cache:/root/.cache/ccache" "${arguments[@]}" \
        --file deploy/Dockerfile --tag "localhost/spherule:$1" .
}

# check VARIANT: runs the tests of the image.
check() {
    local facts=$work/$1 container root failed=0
    rm -rf "$facts"
    mkdir -p "$facts"
    images inspect --type image "localhost/spherule:$1" >"$facts/image.json"
    images push --quiet "localhost/spherule:$1" "oci:$facts/layers"
    container=$(images from --pull-never "localhost/spherule:$1")
    root=$(images mount "$container")
    python3 tests/image/contents_test.py "$facts" "$root" || failed=1
    # A network namespace: all ports are free, and no port is open to others.
    unshare --mount --net python3 tests/image/running_test.py "$facts" "$root" || failed=1
    images rm "$container" >/dev/null
    rm -rf "$facts/layers"
    return "$failed"
}

mkdir -p "$work" "$cache"
images inspect --type image "$base" >/dev/null 2>&1 || make_base
failed=()
for variant in "${variants[@]}"; do
    echo "== image $variant: build"
    build "$variant"
    echo "== image $variant: check"
    check "$variant" || failed+=("$variant")
done
if [[ ${#failed[@]} -gt 0 ]]; then
    echo "== image: FAILED: ${failed[*]}"
    exit 1
fi
echo "== image: all passed"
