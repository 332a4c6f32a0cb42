# The parts of gpu_day.sh, which sources this file. It sets dir, out, launch, device, quick, limit and failed.

begin_report() {
    [[ ! -f $out/report.md ]] || return 0
    {
        echo "# Device \`$device\`, $(date -u +%Y-%m-%d)"
        echo
        sed -n 's/^model name\s*: /Processor: /p' /proc/cpuinfo | head -n 1
        echo
        echo "| what | outcome | time | where |"
        echo "|---|---|---|---|"
    } >"$out/report.md"
}

# step TITLE LOG COMMAND...: runs the command; appends its output to OUT/LOG and its outcome to the report.
step() {
    local title=$1 log=$2 start=$SECONDS code=0 outcome
    shift 2
    printf '\n$ %s\n' "${*#"$dir"/}" >>"$out/$log"
    limited "$@" >>"$out/$log" 2>&1 || code=$?
    case $code in
        0) outcome="done" ;;
        124) outcome="STOPPED after $limit s" ;;
        *) outcome="FAILED with exit code $code" ;;
    esac
    echo "| $title | $outcome | $((SECONDS - start)) s | \`$log\` |" | tee -a "$out/report.md"
    [[ $code -eq 0 ]] || failed=1
}

# Functions of this file begin with check_ and limit their commands themselves.
limited() {
    if [[ $1 == check_* ]]; then "$@"; else timeout --kill-after=5 "$limit" "$@"; fi
}

spherule() {
    timeout --kill-after=5 "$limit" "$launch" spherule "$@"
}

run_probe() {
    local PATH=$PATH:/usr/local/nvidia/bin  # where some container runtimes mount nvidia-smi
    step "probe" probe.txt "$launch" spherule probe --device "$device"
    if command -v nvidia-smi >/dev/null; then step "nvidia-smi" probe.txt nvidia-smi -q; fi
}

run_launches() {
    step "launches and copies" launches.txt "$launch" spherule_bench --device "$device" --sizes 0 --ladder 0 --costs \
        ${quick:+--quick}
}

# Prints the kernels of a scene with their compile times, the longest first.
check_compile() {
    local log
    log=$(spherule -v run "$@" --device "$device" --for 0.001s 2>&1) || { echo "$log"; return 1; }
    echo "$log" | sed -n 's/.* debug \([a-z_]*\.comp\): compiled in \([0-9.]*\) s.*/\2 s  \1/p' | sort -rn |
        awk '{ print; sum += $1; count += 1 } END { printf "%.2f s  all %d kernels\n", sum, count; exit count == 0 }'
}

run_compile() {
    local cache scenes=("box-4k" "box-4k --quality fast" "box-4k --quality accurate" drum mixer) scene words
    [[ -z $quick ]] || scenes=(box-4k)
    cache=$(mktemp -d "$dir/cache.XXXXXX")
    export __GL_SHADER_DISK_CACHE_PATH=$cache MESA_SHADER_CACHE_DIR=$cache
    for scene in "${scenes[@]}"; do
        read -ra words <<<"$scene"
        step "compiling $scene, no cache" launches.txt check_compile "${words[@]}"
        step "compiling $scene, cached" launches.txt check_compile "${words[@]}"
    done
    unset __GL_SHADER_DISK_CACHE_PATH MESA_SHADER_CACHE_DIR
    rm -rf "$cache"
}

# Succeeds if two runs of the scene end in the same state, bit for bit.
check_same() {
    local hash first='' round
    for round in 1 2; do
        hash=$(spherule run "$@" --device "$device" --json |
            sed -n 's/.*"stateHash":"\([0-9a-f]*\)".*/\1/p') || return 1
        echo "run $round: ${hash:-no hash}"
        [[ -n $hash && ${first:-$hash} == "$hash" ]] || return 1
        first=$hash
    done
}

# Succeeds if the energy and the overlap after 50 steps differ from those of the CPU by at most 1 %.
check_against_cpu() {
    local on report key values=()
    for on in cpu "$device"; do
        report=$(spherule run "$1" --for 0.834s --device "$on" --json) || return 1
        for key in kineticEnergy potentialEnergy overlapMean; do
            values+=("$(sed -n "s/.*\"$key\":\([-+.e0-9]*\).*/\1/p" <<<"$report")")
        done
    done
    echo "kinetic and potential energy and mean overlap, cpu: ${values[*]:0:3}; $device: ${values[*]:3:3}"
    awk -v all="${values[*]}" 'BEGIN {
        if (split(all, v, " ") != 6) exit 1
        for (k = 1; k <= 3; ++k) { d = v[k] - v[k + 3]; if (d < 0) d = -d; if (d > 0.01 * (v[1] + v[2]) && k < 3) exit 1
                                   if (k == 3 && d > 0.05 * v[3]) exit 1 } }'
}

run_same() {
    local scenes=("box-4k --for 1s" "box-50k --for 1s" "stress-1m --for 0.5s") scene words
    [[ -z $quick ]] || scenes=("box-4k --for 0.05s")
    for scene in "${scenes[@]}"; do
        read -ra words <<<"$scene"
        step "same bits: $scene" runs.txt check_same "${words[@]}"
    done
    step "as on the CPU: box-4k" runs.txt check_against_cpu box-4k
}

run_runs() {
    local scenes=("box-4k --for 1s" "box-50k --for 1s" "box-50k --for 1s --no-sleep" "rapids-50k --for 1s"
        "stress-1m --for 0.5s" "drum --for 0.5s" "mixer --for 0.5s" "avalanche --for 0.5s"
        "box-50k --for 0.1s --quality fast" "box-50k --for 0.02s --quality accurate"
        "drum --for 0.02s --quality accurate") scene words
    [[ -z $quick ]] || scenes=("box-4k --for 0.05s" "bounce --for 0.02s --quality accurate")
    for scene in "${scenes[@]}"; do
        read -ra words <<<"$scene"
        step "$scene" runs.txt "$launch" spherule run "${words[@]}" --json --device "$device"
    done
}

# passes TITLE SIZES OPTIONS...
passes() {
    step "$1" ladder.txt "$launch" spherule_bench --device "$device" --sizes 0 --ladder "$2" "${@:3}" ${quick:+--quick}
}

run_ladder() {
    passes "passes at 10,000 to 1,000,000 spheres" 10000,100000,1000000
    passes "the same with friction" 10000,100000,1000000 --friction
}

run_largest() {
    passes "passes at 10,000,000 spheres" 10000000
    [[ -n $quick ]] || passes "the same with friction" 10000000 --friction
}

run_threads() {
    local value duration=1s
    [[ -z $quick ]] || duration=0.05s
    for value in 0 1; do
        step "box-4k for $duration, driver's thread: $value" runs.txt env __GL_THREADED_OPTIMIZATIONS="$value" \
            "$launch" spherule run box-4k --for "$duration" --json --device "$device"
    done
}

run_codec() {
    local sizes=(10000 1000000) size
    [[ -z $quick ]] || sizes=(2000)
    for size in "${sizes[@]}"; do
        step "encoding $size spheres" codec.txt "$launch" spherule_codec_bench --device "$device" --spheres 0 \
            --speed "$size"
    done
}

# metric ADDRESS NAME: the sum of the values of a metric.
metric() {
    exec 3<>"/dev/tcp/${1%:*}/${1##*:}" || return 1
    printf 'GET /metrics HTTP/1.1\r\nHost: %s\r\nConnection: close\r\n\r\n' "$1" >&3
    tr -d '\r' <&3 | awk -v name="$2" 'index($1, name) == 1 { sum += $2; found = 1 } END { print sum + 0; exit !found }'
    exec 3>&-
}

# Serves the scene, records for some seconds, and prints the device's time for each frame.
check_serve() {
    local scene=$1 seconds=$2 folder server url code=0
    folder=$(mktemp -d "$dir/serve.XXXXXX")
    # A second signal would end the server at once; in the background, timeout sends two.
    timeout --foreground --kill-after=5 "$limit" "$launch" spherule serve "$scene" --device "$device" \
        --listen 127.0.0.1:0 --recordings "$folder" >"$folder/log" 2>&1 &
    server=$!
    for ((k = 0; k < 10 * limit; ++k)); do
        url=$(sed -n 's|.*open http://\([0-9.:]*\)/.*|\1|p' "$folder/log")
        [[ -z $url ]] && kill -0 "$server" 2>/dev/null || break
        sleep 0.1
    done
    if [[ -n $url ]]; then record_for "$url" "$seconds" || code=$?; else code=1; fi
    kill "$server" 2>/dev/null || true
    wait "$server" || code=$?
    cat "$folder/log"
    rm -rf "$folder"
    return "$code"
}

# record_for ADDRESS SECONDS
record_for() {
    local url=$1 name steps=() pack=() all=() k
    spherule ctl "ws://$url/ws" record || return 1
    # The server measures passes from the first request for metrics on, and reports once a second.
    metric "$url" spherule_real_time_factor >/dev/null || return 1
    sleep 2
    for k in 1 2; do
        steps+=("$(spherule ctl "ws://$url/ws" query | sed -n 's/.*"step": "\([0-9]*\)".*/\1/p')") || return 1
        pack+=("$(metric "$url" 'spherule_pass_seconds_total{pass="pack"}')") || return 1
        all+=("$(metric "$url" 'spherule_pass_seconds_total{')") || return 1
        [[ $k -eq 2 ]] || sleep "$2"
    done
    echo "real time: $(metric "$url" spherule_real_time_factor) of the wanted speed" || return 1
    spherule ctl "ws://$url/ws" record stop || return 1
    awk -v steps="${steps[*]}" -v pack="${pack[*]}" -v all="${all[*]}" -v seconds="$2" 'BEGIN {
        split(steps, s, " "); split(pack, p, " "); split(all, a, " ")
        n = s[2] - s[1]
        printf "%d steps in %s s; device time: %.3f ms a step, of it %.3f ms for each of %d frames\n", n, seconds,
            n ? 1000 * (a[2] - a[1]) / n : 0, n ? 2000 * (p[2] - p[1]) / n : 0, n / 2
        exit n < 2 || p[2] <= p[1] }'
}

run_serve() {
    local scenes=(box-50k stress-1m) scene seconds=10
    [[ -z $quick ]] || { scenes=(box-4k); seconds=1; }
    for scene in "${scenes[@]}"; do step "serving $scene" serve.txt check_serve "$scene" "$seconds"; done
}

# One part of the tests of a program and its log; join_logs joins them. A log names each test that passed, so that it
# says something after the limit, too.
run_test() {
    local program=$1 part=$2 parts=$3 log without='*' title=$1
    [[ $parts -eq 1 ]] || title="$program, part $((part + 1)) of $parts"
    log=tests-$program-$part.txt
    # Tests that open Mesa's renderer, which a GPU host may lack.
    [[ $device == software ]] || without='-*Software*:*OnAllDevices*'
    GTEST_TOTAL_SHARDS=$parts GTEST_SHARD_INDEX=$part SPHERULE_TEST_DEVICE=$device \
        step "$title" "$log" "$launch" "$program" --gtest_filter="$without"
    return "$failed"
}

join_logs() {
    local log passed
    for log in "$out"/tests-*.txt; do
        passed=$(grep -c '^\[       OK' "$log" || true)
        sed -i "s/| \`${log##*/}\` |/| \`tests.txt\`, $passed passed |/" "$out/report.md"
        cat "$log" >>"$out/tests.txt"
        rm "$log"
    done
}

run_tests() {
    local label test
    while read -r label test; do
        [[ $label != gpu ]] || run_test "$test" 0 1 || failed=1
    done <"$dir/tests.list"
    join_logs
}

run_physics() {
    local label test jobs=() job part parts
    parts=$(($(nproc) / $(grep -vc '^gpu ' "$dir/tests.list") + 1))
    while read -r label test; do
        [[ $label != gpu && -z $quick ]] || continue
        for ((part = 0; part < parts; ++part)); do
            run_test "$test" "$part" "$parts" &
            jobs+=($!)
        done
    done <"$dir/tests.list"
    if [[ -n $quick ]]; then
        run_test physics_tests 0 40 &
        jobs=($!)
    fi
    for job in "${jobs[@]}"; do wait "$job" || failed=1; done
    join_logs
}

run_methods() {
    step "methods compared" ladder.txt "$launch" spherule_bench --device "$device" --ladder 0 ${quick:+--quick}
}
