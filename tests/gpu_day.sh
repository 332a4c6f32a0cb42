#!/usr/bin/env bash
# Bundles programs and tests, and runs them on a GPU host that has a GPU driver and no development packages.
#
#   gpu_day.sh bundle DIR [BUILD]          copies BUILD (default: build/release) to DIR, relocatable, below 60 MB
#   gpu_day.sh run DIR OUT [OPTIONS]       probe, GPU tests and benchmarks of the bundle in DIR; results in OUT
#       --device NAME      a device of spherule (default: gpu)
#       --quick            only GPU tests and short benchmarks: shows that everything works, but measures nothing
#       --only PART        probe, tests or bench; may be given several times (default: all)
#       --limit SECONDS    ends each command after this time (default: 590)
#
# The bundle contains this script; on the host, run `DIR/gpu_day.sh run DIR OUT`. DIR must be writable: the programs are
# packed, and are unpacked there. OUT receives at most 8 files; several runs append to them. Tests of physics run at
# the same time, all other commands one by one. If a command fails, the others still run, and the exit code is 1.
set -euo pipefail

here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)

usage() {
    sed -n '2,13s/^# \?//p' "${BASH_SOURCE[0]}"
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
}

write_launcher() {
    cat >"$1/with_libraries" <<'LAUNCHER'
#!/bin/sh
# with_libraries PROGRAM [ARGUMENTS]: runs a program of this folder with the libraries beside it.
here=$(cd "$(dirname "$0")" && pwd)
path=$here/lib

# The path of a library of the host: in a folder of LD_LIBRARY_PATH, or where the loader finds it.
host() {
    found=$(echo "${LD_LIBRARY_PATH-}" | tr : '\n' | while read -r folder; do
        [ -z "$folder" ] || [ ! -e "$folder/$1" ] || { echo "$folder/$1"; break; }
    done)
    [ -n "$found" ] || found=$(/sbin/ldconfig -p 2>/dev/null | awk -v name="$1" '$1 == name { print $NF; exit }')
    echo "$found"
}
newest() { grep -ao 'GLIBCXX_3\.4\.[0-9]*' "$1" | cut -d. -f3 | sort -n | tail -n 1; }

theirs=$(host libstdc++.so.6)
if [ -z "$theirs" ] || [ "$(newest "$theirs")" -lt "$(newest "$here/lib-cxx/libstdc++.so.6")" ]; then
    path=$path:$here/lib-cxx
fi
[ -n "$(host libEGL.so.1)" ] || path=$path:$here/lib-glvnd

# In some containers, the driver is installed without its vendor file.
if [ -z "${__EGL_VENDOR_LIBRARY_FILENAMES-}" ] && [ -n "$(host libEGL_nvidia.so.0)" ] &&
    [ -z "$(find /etc/glvnd/egl_vendor.d /usr/share/glvnd/egl_vendor.d -name '*nvidia*' 2>/dev/null)" ]; then
    export __EGL_VENDOR_LIBRARY_FILENAMES="$here/lib-glvnd/nvidia.json"
    for mesa in /usr/share/glvnd/egl_vendor.d/*mesa*; do
        [ -f "$mesa" ] && __EGL_VENDOR_LIBRARY_FILENAMES=$__EGL_VENDOR_LIBRARY_FILENAMES:$mesa
    done
fi

export LD_LIBRARY_PATH="$path${LD_LIBRARY_PATH:+:$LD_LIBRARY_PATH}"
program=$1
shift
exec "$here/bin/$program" "$@"
LAUNCHER
    chmod +x "$1/with_libraries"
    printf '%s\n' '{"file_format_version": "1.0.0", "ICD": {"library_path": "libEGL_nvidia.so.0"}}' \
        >"$1/lib-glvnd/nvidia.json"
}

# Prints lines "LABEL PROGRAM" for the tests that use the device named by SPHERULE_TEST_DEVICE.
device_tests() {
    local label
    for label in gpu physics; do
        ctest --test-dir "$1" -L "^$label\$" --show-only=json-v1 |
            python3 -c 'import json, sys; print("\n".join({t["command"][0] for t in json.load(sys.stdin)["tests"]}))' |
            grep -v '/bits_test$' | sed "/./s/^/$label /"
    done | sort
}

bundle() {
    local dir=$1 build=${2:-$here/../build/release} programs=() tests=() program size
    if [[ -d $dir && ! -x $dir/with_libraries && -n $(ls -A "$dir") ]]; then
        echo "$dir is not empty and no bundle; please name another folder" >&2
        exit 1
    fi
    for program in spherule spherule_bench; do
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
    write_launcher "$dir"
    cp "${BASH_SOURCE[0]}" "$dir/gpu_day.sh"
    tar --create --gzip --file "$dir/programs.tar.gz" --remove-files -C "$dir" bin
    size=$(du -sm --apparent-size "$dir" | cut -f1)
    echo "$dir: $size MB, $((${#programs[@]} + ${#tests[@]})) programs"
    [[ $size -lt 60 ]] || { echo "larger than the 60 MB that a bundle may have" >&2; exit 1; }
}

# step TITLE LOG COMMAND...: runs the command; appends its output to OUT/LOG and its outcome to the report.
step() {
    local title=$1 log=$2 start=$SECONDS code=0 outcome
    shift 2
    printf '\n$ %s\n' "$(basename "$1") ${*:2}" >>"$out/$log"
    timeout --kill-after=5 "$limit" "$@" >>"$out/$log" 2>&1 || code=$?
    case $code in
        0) outcome="done" ;;
        124) outcome="STOPPED after $limit s" ;;
        *) outcome="FAILED with exit code $code" ;;
    esac
    echo "| $title | $outcome | $((SECONDS - start)) s | \`$log\` |" | tee -a "$out/report.md"
    [[ $code -eq 0 ]] || failed=1
}

run_probe() {
    step "probe" probe.txt "$launch" spherule probe --device "$device"
}

# One part of the tests of a program and its log; run_tests joins the logs. A log names each test that passed, so that it
# says something after the limit, too.
run_test() {
    local program=$1 part=$2 parts=$3 log without='*' title=$1
    [[ $parts -eq 1 ]] || title="$program, part $((part + 1)) of $parts"
    log=tests-$program-$part.txt
    # Tests that open Mesa's renderer, which a GPU host may lack. bundle() leaves out bits_test.
    [[ $device == software ]] || without='-*Software*:*AllDevices*'
    GTEST_TOTAL_SHARDS=$parts GTEST_SHARD_INDEX=$part SPHERULE_TEST_DEVICE=$device \
        step "$title" "$log" "$launch" "$program" --gtest_filter="$without"
    return "$failed"
}

run_tests() {
    local label test jobs=() job part parts log passed
    rm -f "$out"/tests-*.txt
    parts=$(($(nproc) / $(grep -vc '^gpu ' "$dir/tests.list") + 1))
    while read -r label test; do
        [[ $label != gpu ]] || run_test "$test" 0 1 || failed=1  # alone: it compares times
    done <"$dir/tests.list"
    while read -r label test; do
        [[ -z $quick && $label != gpu ]] || continue
        for ((part = 0; part < parts; ++part)); do
            run_test "$test" "$part" "$parts" &
            jobs+=($!)
        done
    done <"$dir/tests.list"
    for job in "${jobs[@]}"; do wait "$job" || failed=1; done
    for log in "$out"/tests-*.txt; do
        passed=$(grep -c '^\[       OK' "$log" || true)
        sed -i "s/| \`${log##*/}\` |/| \`tests.txt\`, $passed passed |/" "$out/report.md"
        cat "$log" >>"$out/tests.txt"
        rm "$log"
    done
}

# Succeeds when the last two runs of a scene in the log ended in the same state, bit for bit.
same_state() {
    local hashes
    hashes=$(sed -n "s/^{\"scene\":\"$2\".*\"stateHash\":\"\([0-9a-f]*\)\".*/\1/p" "$1" | tail -n 2)
    echo "$hashes"
    [[ $(wc -l <<<"$hashes") -eq 2 && $(sort -u <<<"$hashes" | wc -l) -eq 1 ]]
}

run_bench() {
    local pace=() duration=1s scene scenes=(box-4k box-50k stress-1m rapids mixer)
    [[ -z $quick ]] || { pace=(--quick); duration=0.1s; scenes=(box-4k); }
    for scene in "${scenes[@]}"; do
        step "$scene for $duration" bench.txt "$launch" spherule run "$scene" --for "$duration" --json --device "$device"
        [[ $scene == box-* ]] || continue
        step "$scene again" bench.txt "$launch" spherule run "$scene" --for "$duration" --json --device "$device"
        step "same bits from both" bench.txt "$dir/gpu_day.sh" same_state "$out/bench.txt" "$scene"
    done
    step "passes over sizes" bench.txt "$launch" spherule_bench --device "$device" --sizes 0 "${pace[@]}" \
        --csv "$out/ladder.csv" --markdown "$out/ladder.md"
    step "methods compared" bench.txt "$launch" spherule_bench --device "$device" --ladder 0 "${pace[@]}" \
        --csv "$out/compare.csv" --markdown "$out/compare.md"
}

run() {
    [[ -x $dir/with_libraries ]] || { echo "$dir is no bundle; $0 bundle $dir makes one" >&2; exit 2; }
    tar --extract --gzip --file "$dir/programs.tar.gz" -C "$dir"
    if [[ ! -f $out/report.md ]]; then
        {
            echo "# Device \`$device\`, $(date -u +%Y-%m-%d)"
            echo
            sed -n 's/^model name\s*: /Processor: /p' /proc/cpuinfo | head -n 1
            echo
            echo "| what | outcome | time | where |"
            echo "|---|---|---|---|"
        } >"$out/report.md"
    fi
    local part
    for part in "${parts[@]}"; do "run_$part"; done
}

[[ $# -ge 2 ]] || usage 2
case $1 in
    bundle) bundle "${@:2}" ;;
    same_state) same_state "$2" "${3:?}" ;;
    run)
        [[ $# -ge 3 ]] || usage 2
        mkdir -p "$3"
        dir=$(cd "$2" && pwd) out=$(cd "$3" && pwd)
        launch=$dir/with_libraries device=gpu quick='' limit=590 parts=() failed=0
        shift 3
        while [[ $# -gt 0 ]]; do
            case $1 in
                --device) device=${2:?--device needs a name}; shift 2 ;;
                --quick) quick=1; shift ;;
                --limit) limit=${2:?--limit needs seconds}; shift 2 ;;
                --only)
                    [[ ${2-} =~ ^(probe|tests|bench)$ ]] || usage 2
                    parts+=("$2")
                    shift 2
                    ;;
                *) usage 2 ;;
            esac
        done
        [[ ${#parts[@]} -gt 0 ]] || parts=(probe tests bench)
        run
        exit "$failed"
        ;;
    *) usage 2 ;;
esac
