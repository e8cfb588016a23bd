#!/bin/sh
# How `chta check` and `chta plan` grow with the chain: whole processes on long_chain's ground (Mars, 10 m/s, friction 0.6, 5 cm of
# clearance), on two threads, each case the fastest of several runs.
#
#   benches/scale.sh                    prints the table
#   RUNS=5 benches/scale.sh             more runs of each case
#   BUILD=no benches/scale.sh           with the program as it was built last
#   benches/scale.sh --assert           and fails where a target of docs/performance.md is missed, by wall clock
#   benches/scale.sh --assert user      the same by processor time over two, for a machine with other work on it
#
# Needs GNU time (/usr/bin/time) and awk. Printed: wall and processor time in s, peak memory in MiB, hops, and the log-log slope of time
# over vertices from 10 000 to 100 000.
set -eu
cd "$(dirname "$0")/.."
by=none
if [ "${1:-}" = --assert ]; then by=${2:-wall}; fi
runs=${RUNS:-3}
if [ "${BUILD:-yes}" = yes ]; then cargo build --quiet --release --bin chta --example long_chain; fi
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cat > "$work/mars.toml" <<'TOML'
[body]
name = "mars"
[hopper]
takeoff_speed_max_m_s = 10
landing_speed_max_m_s = 10
clearance_m = 0.05
[surface]
friction_coefficient = 0.6
TOML

# The fastest run of one case, by the criterion asked for: command, segments, points inside each, wall s, user and system s, KiB, hops.
measure() {
    run=0
    while [ "$run" -lt "$runs" ]; do
        /usr/bin/time -v target/release/chta "$1" "$work/$2.csv" --scenario "$work/mars.toml" --start 0 --goal "$2" \
            --points-per-segment "$3" --threads 2 --quiet > "$work/answer" 2> "$work/time"
        hops=$(sed -n 's/^traversable, \([0-9]*\) hops.*/\1/p' "$work/answer")
        awk -v OFS=' ' -v case="$1 $2 $3" -v hops="$hops" '
            /Elapsed \(wall clock\)/ { n = split($NF, part, ":"); wall = 0; for (i = 1; i <= n; i++) wall = wall * 60 + part[i] }
            /User time|System time/ { used += $NF }
            /Maximum resident/ { memory = $NF }
            END { print case, wall, used, memory, hops }' "$work/time"
        run=$((run + 1))
    done | sort -k "$([ "$by" = user ] && echo 5 || echo 4)" -n | head -n 1
}

for segments in 10000 30000 100000; do
    target/release/examples/long_chain --segments "$segments" --seed 1 > "$work/$segments.csv"
done
for command in check plan; do
    for points in 0 4; do
        for segments in 10000 30000 100000; do
            measure "$command" "$segments" "$points"
        done
    done
done > "$work/table"

awk -v by="$by" '
    BEGIN { print "command segments    k   wall s  used s  MiB   hops" }
    {
        printf "%-7s %8d %4d %8.2f %7.2f %5.0f %6d\n", $1, $2, $3, $4, $5, $6 / 1024, $7
        time = by == "wall" ? $4 : $5
        if ($2 == 10000) small = time
        if ($2 == 100000) {
            slope = log(time / small) / log(10)
            printf "        slope of %s time from 10 000 to 100 000 vertices: %.2f\n", by == "wall" ? "wall" : "processor", slope
            if ($1 == "check") {
                if (slope >= 1.1) missed = missed "; slope " slope " at k = " $3
                seconds = by == "user" ? $5 / 2 : $4
                if (seconds > ($3 == 0 ? 0.5 : 5)) missed = missed "; " seconds " s at k = " $3
            }
            if ($6 >= 256 * 1024) missed = missed "; " $6 / 1024 " MiB in " $1 " at k = " $3
            if ($7 <= 3700) missed = missed "; only " $7 " hops"
        }
    }
    END {
        if (by != "none" && missed != "") { print "missed" missed; exit 1 }
    }' "$work/table"
