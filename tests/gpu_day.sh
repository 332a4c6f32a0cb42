#!/usr/bin/env bash
# Bundles programs and tests, and runs them on a GPU host that has a GPU driver and no development packages.
#
#   gpu_day.sh bundle DIR [BUILD]          copies BUILD (default: build/release) to DIR, relocatable, below 60 MB
#   gpu_day.sh run DIR OUT [OPTIONS]       checks and measures with the bundle in DIR; results in OUT
#       --device NAME      a device of spherule (default: gpu)
#       --only PART        one of the parts below; may be given several times (default: all, in this order)
#       --quick            short runs and few tests: shows that everything works, but measures nothing
#       --limit SECONDS    ends each command after this time (default: 290)
#
# parts:
#   probe     the device, its limits and nvidia-smi -q
#   launches  time of empty launches, with barriers and timers, of indirect launches without groups, and of copies
#   compile   compile time of each kernel, without the driver's cache and with it
#   same      two runs of a scene give the same bits; the first 50 steps agree with the CPU
#   runs      scenes with and without friction, with meshes, and in the model accurate, by pass
#   ladder    passes at 10,000 to 1,000,000 spheres
#   largest   passes at 10,000,000 spheres
#   threads   a scene with the driver's thread for OpenGL (NVIDIA's __GL_THREADED_OPTIMIZATIONS)
#   codec     encoding of frames of 10,000 and 1,000,000 spheres
#   serve     a server that records, controlled by `spherule ctl`
#   tests     tests of the device
#   physics   tests of physics, which run at the same time; all other commands run one by one
#   methods   broad phases compared
#
# The bundle contains this script; on the host, run `DIR/gpu_day.sh run DIR OUT`. DIR must be writable: the programs are
# packed, and are unpacked there. Each part takes less than 10 minutes on a GPU. OUT receives at most 8 files; several
# runs append to them. If a command fails, the others still run, and the exit code is 1.
set -euo pipefail

here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
all_parts=(probe launches compile same runs ladder largest threads codec serve tests physics methods)

usage() {
    sed -n '2,29s/^# \?//p' "${BASH_SOURCE[0]}"
    exit "$1"
}

# Libraries that must come from the host: its C library, and libraries of its drivers.
host_library='^(ld-linux.*|linux-vdso|lib(c|m|dl|pthread|rt|resolv|util)\.so|lib(EGL|GLX|GL)_.*|libgbm|libdrm.*|libLLVM.*)'

copy_libraries() {
    local into=$1 name path
    shift
    ldd "$@" | awk '$2 == "=>" && $3 ~ /^\// { print $1, $3 }' | sort -u | while read -r name path; do
        [[ $name =~ $host_library ]] && continue
        case $name in
            # Used only if the host has none or an older version, because drivers may need a newer version than ours.
            libstdc++.so.* | libgcc_s.so.*) cp -L "$path" "$into/lib-cxx/$name" ;;
            *) cp -L "$path" "$into/lib/$name" ;;
        esac
    done
}

# EGL's dispatch library is opened at run time, so ldd does not list it.
copy_glvnd() {
    local name path
    for name in libEGL.so.1 libGLdispatch.so.0 libOpenGL.so.0; do
        path=$(/sbin/ldconfig -p | awk -v name="$name" '$1 == name && /x86-64|AArch64/ { print $NF; exit }')
        [[ -n $path ]] && cp -L "$path" "$1/lib-glvnd/$name"
    done
    [[ -f $1/lib-glvnd/libEGL.so.1 && -f $1/lib-glvnd/libGLdispatch.so.0 ]] ||
        { echo "libEGL.so.1 and libGLdispatch.so.0 are not installed here (package libegl1)" >&2; exit 1; }
    printf '%s\n' '{"file_format_version": "1.0.0", "ICD": {"library_path": "libEGL_nvidia.so.0"}}' \
        >"$1/lib-glvnd/nvidia.json"
}

# Prints lines "LABEL PROGRAM" for the tests that use the device named by SPHERULE_TEST_DEVICE.
device_tests() {
    local label
    for label in gpu physics; do
        ctest --test-dir "$1" -L "^$label\$" --show-only=json-v1 |
            python3 -c 'import json, sys
print("\n".join({t["command"][0] for t in json.load(sys.stdin)["tests"] if not t["name"].startswith("perturbed") and
                 ("SPHERULE_TEST_DEVICE" in str(t) or t["name"].startswith("gpu_device."))}))' |
            sed "/./s/^/$label /"
    done | sort
}

bundle() {
    local dir=$1 build=${2:-$here/../build/release} programs=() tests=() program size
    if [[ -d $dir && ! -x $dir/with_libraries && -n $(ls -A "$dir") ]]; then
        echo "$dir is not empty and no bundle; please name another folder" >&2
        exit 1
    fi
    for program in spherule spherule_bench spherule_codec_bench; do
        [[ -x $build/$program ]] || { echo "$build/$program is not built; ./tests/run.sh builds it" >&2; exit 1; }
        programs+=("$build/$program")
    done
    mkdir -p "$dir"
    device_tests "$build" >"$dir/tests.list"
    mapfile -t tests < <(cut -d' ' -f2 "$dir/tests.list")
    [[ ${#tests[@]} -gt 0 ]] || { echo "$build has no tests for a device; ./tests/run.sh builds them" >&2; exit 1; }
    rm -rf "${dir:?}"/{bin,lib,lib-cxx,lib-glvnd}
    mkdir -p "$dir"/{bin,lib,lib-cxx,lib-glvnd}
    install -s "${programs[@]}" "${tests[@]}" "$dir/bin/"
    sed -i 's| .*/| |' "$dir/tests.list"
    copy_libraries "$dir" "${programs[@]}" "${tests[@]}"
    copy_glvnd "$dir"
    cp "$here/gpu_day/with_libraries" "$here/gpu_day/parts.sh" "${BASH_SOURCE[0]}" "$dir/"
    tar --create --gzip --file "$dir/programs.tar.gz" --remove-files -C "$dir" bin
    size=$(du -sm --apparent-size "$dir" | cut -f1)
    echo "$dir: $size MB, $((${#programs[@]} + ${#tests[@]})) programs"
    [[ $size -lt 60 ]] || { echo "larger than the 60 MB that a bundle may have" >&2; exit 1; }
}

# run DIR OUT OPTIONS...
run() {
    local dir out device=gpu quick='' limit=290 parts=() failed=0 launch part
    [[ -x $1/with_libraries ]] || { echo "$1 is no bundle; $0 bundle $1 makes one" >&2; exit 2; }
    dir=$(cd "$1" && pwd)
    launch=$dir/with_libraries
    mkdir -p "$2"
    out=$(cd "$2" && pwd)
    shift 2
    while [[ $# -gt 0 ]]; do
        case $1 in
            --quick) quick=1; shift; continue ;;
            --device | --limit | --only) [[ $# -gt 1 ]] || { echo "$1 needs a value" >&2; exit 2; } ;;
            *) echo "unknown option $1" >&2; usage 2 >&2 ;;
        esac
        case $1 in
            --device) device=$2 ;;
            --limit)
                [[ $2 =~ ^[1-9][0-9]*$ ]] || { echo "--limit $2: is no number of seconds" >&2; exit 2; }
                limit=$2
                ;;
            --only)
                [[ " ${all_parts[*]} " == *" $2 "* ]] ||
                    { echo "--only $2: is no part; the parts are ${all_parts[*]}" >&2; exit 2; }
                parts+=("$2")
                ;;
        esac
        shift 2
    done
    [[ ${#parts[@]} -gt 0 ]] || parts=("${all_parts[@]}")
    [[ -d $dir/bin ]] || tar --extract --gzip --file "$dir/programs.tar.gz" -C "$dir"
    # shellcheck source=tests/gpu_day/parts.sh
    source "$dir/parts.sh"
    begin_report
    for part in "${parts[@]}"; do "run_$part"; done
    exit "$failed"
}

[[ ${1-} != --help && ${1-} != -h ]] || usage 0
[[ $# -ge 2 ]] || usage 2 >&2
case $1 in
    bundle) bundle "${@:2}" ;;
    run)
        [[ $# -ge 3 ]] || usage 2 >&2
        run "${@:2}"
        ;;
    *) usage 2 >&2 ;;
esac
