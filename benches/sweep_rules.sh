#!/usr/bin/env bash
# Instructions of a sweep per pair under either rule of the clearance, by valgrind: three rounds less one, without the set-up.
set -euo pipefail
cd "$(dirname "$0")/.."
command -v valgrind >/dev/null || { echo "skipped: no valgrind to count instructions with; install valgrind"; exit 0; }
bench=$(cargo bench --no-run --bench sweep_rules 2>&1 | sed -n 's/.*(\(.*sweep_rules-[0-9a-f]*\)).*/\1/p')
counted() { valgrind --tool=callgrind --callgrind-out-file=/dev/null "$bench" "$@" 2>&1 | sed -n 's/.*Collected : \([0-9]*\).*/\1/p'; }
printf '%-8s %-9s %-10s %10s %10s %7s\n' window friction clearance vertex tapered ratio
while read -r window friction clearance; do
    for rule in vertex tapered; do
        one=$(counted "$window" "$friction" "$clearance" $rule 1)
        three=$(counted "$window" "$friction" "$clearance" $rule 3)
        declare "$rule=$(awk "BEGIN { print ($three - $one) / (2 * 200 * $window) }")"
    done
    # shellcheck disable=SC2154
    awk "BEGIN { printf \"%-8s %-9s %-10s %10.1f %10.1f %7.3f\n\", \"$window\", \"$friction\", \"$clearance\", $vertex, $tapered, $tapered / $vertex }"
done <<'SCENES'
30 0.6 0.05
200 0.6 0.05
200 5 5
200 0.6 0
SCENES
