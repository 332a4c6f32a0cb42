#!/usr/bin/env bash
# Installs missing packages, builds everything, checks the formatting and runs the tests.
#
#   ./tests/run.sh                  the tests that need no privileges; they run as any user, in any container
#   ./tests/run.sh --long           also the long tests (label "long")
#   ./tests/run.sh --all            also long tests, tests that need root (label "all"), and deploy/verify_image.sh
#   ./tests/run.sh --label unit     only the tests with this label; may be given several times
#   ./tests/run.sh --tidy           clang-tidy for server/ instead of the tests
#   ./tests/run.sh --sanitize       only tests without OpenGL, with ASan and UBSan, then with TSan
#   ./tests/run.sh --fuzz SECONDS   each fuzz target for SECONDS, from its seeds, instead of the tests
#
# After the tests it prints the time of each label; the last line is a summary. The exit code is 1 if anything failed.
set -euo pipefail

cd "$(dirname "${BASH_SOURCE[0]}")/.."
build=build/release
jobs=$(nproc)

all=
long=
labels=()
tidy=
sanitize=
fuzz=
while [[ $# -gt 0 ]]; do
    case $1 in
        --all) all=1; long=1; shift ;;
        --long) long=1; shift ;;
        --label) labels+=("${2:?--label needs a name}"); shift 2 ;;
        --tidy) tidy=1; shift ;;
        --sanitize) sanitize=1; shift ;;
        --fuzz) fuzz=${2:?--fuzz needs seconds}; shift 2 ;;
        -h | --help) sed -n '2,13s/^# \?//p' "$0"; exit 0 ;;
        *) echo "unknown option $1; see $0 --help" >&2; exit 2 ;;
    esac
done
if [[ -n $tidy$sanitize$fuzz && ${#labels[@]} -gt 0 ]]; then
    echo "--label chooses among the tests; --tidy, --sanitize and --fuzz run others" >&2
    exit 2
fi
if [[ -n $all$long && -n $tidy$sanitize$fuzz${labels[*]-} ]]; then
    echo "--all and --long run all other tests, too; --label, --tidy, --sanitize and --fuzz choose" >&2
    exit 2
fi

durations=()
failed=()

# phase NAME COMMAND...: runs the command; records its time, and its name if it failed.
phase() {
    local name=$1 start=$SECONDS
    shift
    echo "== $name"
    "$@" || failed+=("$name")
    durations+=("$name $((SECONDS - start)) s")
}

summary() {
    local verdict="all passed"
    [[ ${#failed[@]} -eq 0 ]] || verdict="FAILED: $(printf '%s, ' "${failed[@]}" | sed 's/, $//')"
    echo "== spherule: $verdict ($(printf '%s, ' "${durations[@]}" | sed 's/, $//'))"
    [[ ${#failed[@]} -eq 0 ]]
}

# needed NAME COMMAND...: same as phase, but ends the script if the command failed.
needed() {
    phase "$@"
    if [[ ${#failed[@]} -gt 0 ]]; then
        summary || exit 1
    fi
}

check_format() {
    find server tests \( \( -name node_modules -o -path tests/bench/kernels \) -prune \) -o \( -name '*.cpp' -o -name '*.h' \) -print0 |
        xargs -0 clang-format --dry-run -Werror
}

# Tests connect only to this machine, so no proxy is used. Those that install packages get it as PACKAGE_PROXY.
run_tests() {
    local chosen=() left_out=() log=$build/tests.log code=0
    [[ -n $long ]] || left_out+=(long)
    [[ -n $all ]] || left_out+=(all)
    if [[ ${#labels[@]} -gt 0 ]]; then
        chosen=(-L "^($(IFS='|'; echo "${labels[*]}"))\$")
    elif [[ ${#left_out[@]} -gt 0 ]]; then
        chosen=(-LE "^($(IFS='|'; echo "${left_out[*]}"))\$")
    fi
    env -u http_proxy -u https_proxy -u all_proxy -u HTTP_PROXY -u HTTPS_PROXY -u ALL_PROXY \
        PACKAGE_PROXY="${http_proxy:-${HTTP_PROXY:-}}" \
        ctest --test-dir "$build" -j "$jobs" --output-on-failure --no-tests=error "${chosen[@]}" | tee "$log" || code=1
    shares "$log"
    return $code
}

# shares LOG: prints the share of each label in the time of all tests, from ctest's lines such as
# "unit = 12.34 sec*proc (5 tests)".
shares() {
    echo "== labels: seconds of their tests together ($jobs run at a time), share, number of tests"
    awk '/ sec\*proc \([0-9]+ tests?\)$/ { seconds[$1] = $3; tests[$1] = substr($5, 2); sum += $3 }
         END { for (label in seconds)
                   printf "%9.1f s %3.0f %%  %s, %d\n", seconds[label], sum ? 100 * seconds[label] / sum : 0, label, tests[label] }' \
        "$1" | sort -rn
}

# clang-tidy cannot read the headers that GCC precompiled.
run_tidy() {
    mkdir -p build/tidy
    sed -E 's/-Winvalid-pch -include [^ ]+cmake_pch\.hxx//' "$build/compile_commands.json" > build/tidy/compile_commands.json
    run-clang-tidy -p build/tidy -quiet -j "$jobs" "^$PWD/server/.*\.cpp\$" | grep -vE '^(clang-tidy|[0-9]+ warnings)'
    return "${PIPESTATUS[0]}"
}

# These tests compute on the CPU device, because sanitizers report faults of Mesa's renderer.
sanitized_programs=(
    unit_{scene,codec,encode,recording,host,cli,kernels,compute,net,client,support} physics_tests net_tests
)
sanitized_tests='^(unit_(scene|codec|recording|cli|kernels|net|client|support)|physics_tests_cpu|net_tests)\.'
sanitized_tests+='|^unit_encode\.(Spheres/)?Codec(Counts)?\.|^unit_host\.(PlayerTest|PlaybackProducer)\.'
sanitized_tests+='|^unit_compute\.(CpuMemory|Pool)\.'
sanitized() {
    cmake --preset "$1" --log-level=WARNING -D SPHERULE_TESTS=ON &&
        cmake --build --preset "$1" -j "$jobs" --target "${sanitized_programs[@]}" &&
        ctest --test-dir "build/$1" -j "$jobs" --output-on-failure --no-tests=error \
            -R "$sanitized_tests"
}

# Inputs that fail are written to build/fuzz/finds-TARGET.
fuzzed() {
    local target=$1 seconds=$2
    mkdir -p "build/fuzz/corpus-$target" "build/fuzz/finds-$target"
    "build/fuzz/tests/fuzz/fuzz_$target" -max_total_time="$seconds" -print_final_stats=1 -verbosity=0 \
        -artifact_prefix="build/fuzz/finds-$target/" "build/fuzz/corpus-$target" "tests/fuzz/seeds/$target"
}

if [[ -n $fuzz ]]; then
    needed packages ./deploy/install_packages.sh build run egl software test clang
    needed configure cmake --preset fuzz --log-level=WARNING -D SPHERULE_TESTS=ON
    targets=(scene csv xyz lammps mesh height_field table text message connection codec recording checkpoint)
    needed build cmake --build --preset fuzz -j "$jobs" --target "${targets[@]/#/fuzz_}"
    for target in "${targets[@]}"; do phase "fuzz $target" fuzzed "$target" "$fuzz"; done
    summary
    exit
fi
if [[ -n $sanitize ]]; then
    needed packages ./deploy/install_packages.sh build run egl software test clang
    phase asan sanitized asan
    phase tsan sanitized tsan
    summary
    exit
fi
needed packages ./deploy/install_packages.sh build run egl software test ${tidy:+tidy} ${all:+image}
needed ase ./tests/unpack_ase.sh build/ase
needed lammps ./tests/unpack_lammps.sh build/lammps
needed nginx ./tests/deploy/unpack_nginx.sh build/nginx
needed configure cmake --preset release --log-level=WARNING -D SPHERULE_TESTS=ON
needed build cmake --build --preset release -j "$jobs"
phase format check_format
if [[ -n $tidy ]]; then
    phase tidy run_tidy
else
    phase tests run_tests
fi
[[ -z $all ]] || phase image ./deploy/verify_image.sh --software
summary
