#!/usr/bin/env bash
# Times of the benches sweep_against_plain, graph, map and fly: the working tree against a commit, in one run.
#
#   benches/against_commit.sh REV [--assert]
#
# Both trees run their own bench sources, in turn (commit, tree, commit, ...), so that a change of load affects both equally; a bench is
# known by its name. For each, the ratio tree / commit of the fastest times of all rounds and of the medians, and the least and greatest
# ratio of one round. With --assert the exit status is 1 where the ratio of the fastest times is above 1.05; such benches first get up to
# twice as many rounds again, since other load on the machine can only add time. A bench that only one tree has is listed without a limit.
#
# If valgrind and gungraun-runner are installed, the instruction counts of benches/instructions.rs follow, with the same limit. They
# do not depend on load. GUNGRAUN_RUNNER may hold the runner's path.
#
# ROUNDS=5, SAMPLES=20 (of divan, per round) and BENCHES="sweep_against_plain graph map fly" can be set.
set -euo pipefail
cd "$(dirname "$0")/.."
revision=${1:?usage: benches/against_commit.sh REV [--assert]}
assert=${2:-}
[ -z "$assert" ] || [ "$assert" = --assert ] || { echo "usage: benches/against_commit.sh REV [--assert]" >&2; exit 2; }
rounds=${ROUNDS:-5}
benches=${BENCHES:-sweep_against_plain graph map fly}
limit=1.05
export DIVAN_SAMPLE_COUNT=${SAMPLES:-20} CARGO_TERM_COLOR=never
declare -A source=([commit]=$(.ci/commit_source "$revision") [tree]=$PWD)
declare -A target=([commit]=${source[commit]%/source}/target [tree]=$PWD/target)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# Builds one bench of one tree and prints where its executable is.
executable() {
    (cd "${source[$1]}" && CARGO_TARGET_DIR=${target[$1]} cargo bench --quiet --locked --no-run --bench "$2" --message-format json) |
        sed -n 's/.*"kind":\["bench"\].*"executable":"\([^"]*\)".*/\1/p'
}

# The output of a bench -> lines of `name <tab> fastest <tab> median`, in ns.
times() {
    sed 's/│/|/g; s/├─/+-/g; s/╰─/+-/g; s/µs/us/g' | awk -v bench="$1" '
        function ns(text, part) { split(text, part, " "); return part[1] * unit[part[2]] }
        function emit(name, fastest, median) { printf "%s %s\t%.6g\t%.6g\n", bench, name, fastest, median }
        BEGIN { unit["ps"] = 1e-3; unit["ns"] = 1; unit["us"] = 1e3; unit["ms"] = 1e6; unit["s"] = 1e9 }
        # The table of sweep_against_plain: ground, window, plain ns, sweep ns, ...
        bench == "sweep_against_plain" && match($0, /^[a-z].* +[0-9]+ +[0-9.]+ +[0-9.]+ /) {
            ground = substr($0, 1, 15); sub(/ +$/, "", ground)
            split(substr($0, 16), column, " ")
            if (column[1] ~ /^[0-9]+$/) emit(ground ", window " column[1], column[3], column[3])
        }
        # A line of map: posts: label time s, label time s, ...; the plain version is not of the crate.
        bench == "map" && / posts.*: / {
            posts = $0; sub(/:.*/, "", posts)
            rest = substr($0, length(posts) + 2)
            while (match(rest, /[a-z]+ [0-9.]+ s[^a-z]/)) {
                split(substr(rest, RSTART, RLENGTH), word, " ")
                if (word[1] != "plain") emit(posts ", " word[1], word[2] * 1e9, word[2] * 1e9)
                rest = substr(rest, RSTART + RLENGTH)
            }
        }
        # The tree that divan draws: a name may stand on a line before its times, when the bench prints something itself.
        match($0, /^[| ]*\+- /) {
            depth = (RLENGTH - 3) / 3
            line = substr($0, RLENGTH + 1)
            name[depth] = line; sub(/  .*/, "", name[depth])
            sub(/^[^ ]+/, "", line)
            full = name[0]
            for (i = 1; i <= depth; i++) full = full "/" name[i]
            timed = 0
        }
        full != "" && !timed && split($0, column, "|") >= 6 {
            # The last six columns: fastest, slowest, median, mean, samples, iterations.
            n = split($0, column, "|")
            if (match(column[n - 5], /[0-9.]+ [pnum]?s *$/)) {
                emit(full, ns(substr(column[n - 5], RSTART)), ns(column[n - 3]))
                timed = 1
            }
        }'
}

# Instructions that gungraun prints -> lines of `name <tab> count <tab> count`.
instructions() {
    awk '
        /^[a-z_]+::/ { name = $1 " " $2; sub(/:.*/, "", $2); name = $1 " " $2 }
        /^ *Instructions: / { split($2, count, "|"); gsub(/,/, "", count[1]); printf "instructions %s\t%s\t%s\n", name, count[1], count[1] }'
}

# One round of one bench in one tree, appended to the measurements.
measure() {
    local repeats=1
    # It times everything once, in a second or two.
    [ "$2" = map ] && repeats=3
    for _ in $(seq "$repeats"); do
        (cd "${source[$1]}" && "${program[$1 $2]}" --bench) > "$work/printed" 2> "$work/errors" ||
            { cat "$work/printed" "$work/errors" >&2; echo "$2 fails in the $1" >&2; exit 2; }
        times "$2" < "$work/printed" | sed "s/^/$1\t$3\t/" >> "$work/$2"
    done
}

# The measurements of one bench (or of instructions) -> a table; the status is 1 where a ratio of the fastest is above the limit.
table() {
    awk -F '\t' -v limit="$limit" '
        function least(store, key, value) { if (!(key in store) || value < store[key]) store[key] = value }
        function middle(list, n, sorted, i, j, held) {
            split(list, sorted, " ")
            for (i = 2; i <= n; i++) {
                held = sorted[i] + 0
                for (j = i - 1; j > 0 && sorted[j] + 0 > held; j--) sorted[j + 1] = sorted[j]
                sorted[j + 1] = held
            }
            return n % 2 ? sorted[(n + 1) / 2] : (sorted[n / 2] + sorted[n / 2 + 1]) / 2
        }
        {
            if (!($3 in known)) { known[$3] = 1; order[++count] = $3 }
            least(fastest, $1 FS $3, $4 + 0)
            least(round, $1 FS $3 FS $2, $4 + 0)
            medians[$1 FS $3] = medians[$1 FS $3] " " $5; measured[$1 FS $3]++
            if ($2 > rounds) rounds = $2
        }
        END {
            for (i = 1; i <= count; i++) {
                name = order[i]; old = "commit" FS name; new = "tree" FS name
                if (!(old in fastest) || !(new in fastest)) {
                    printf "%-64s only in the %s\n", name, (old in fastest) ? "commit" : "tree"
                    continue
                }
                ratio = fastest[new] / fastest[old]
                low = 1e9; high = 0
                for (r = 1; r <= rounds; r++) if ((old FS r) in round && (new FS r) in round) {
                    each = round[new FS r] / round[old FS r]
                    if (each < low) low = each
                    if (each > high) high = each
                }
                by_median = middle(medians[new], measured[new]) / middle(medians[old], measured[old])
                above = ratio > limit
                missed += above
                printf "%-64s %12.6g %12.6g %7.3f %7.3f   %.3f to %.3f%s\n",
                    name, fastest[old], fastest[new], ratio, by_median, low, high, above ? "  ABOVE" : ""
            }
            if (count == 0) { print "nothing measured: what the bench prints is not understood" > "/dev/stderr"; exit 2 }
            exit missed > 0
        }' "$1"
}

declare -A program
for bench in $benches; do
    for side in commit tree; do
        program[$side $bench]=$(executable "$side" "$bench")
        [ -x "${program[$side $bench]}" ] || { echo "$bench does not build in the $side" >&2; exit 2; }
    done
done

missed=0
printf '%-64s %12s %12s %7s %7s   %s\n' "bench (times in ns)" commit tree fastest median "fastest, by round"
for bench in $benches; do
    round=0
    until_round=$rounds
    while true; do
        while [ "$round" -lt "$until_round" ]; do
            round=$((round + 1))
            measure commit "$bench" "$round"
            measure tree "$bench" "$round"
        done
        status=0
        table "$work/$bench" > "$work/table" || status=$?
        if [ "$status" = 2 ]; then exit 2; fi
        if [ "$status" = 0 ] || [ -z "$assert" ] || [ "$round" -ge $((3 * rounds)) ]; then break; fi
        until_round=$((until_round + rounds))
    done
    cat "$work/table"
    missed=$((missed + status))
done

if command -v valgrind > /dev/null && command -v "${GUNGRAUN_RUNNER:-gungraun-runner}" > /dev/null; then
    for side in commit tree; do
        (cd "${source[$side]}" && CARGO_TARGET_DIR=${target[$side]} cargo bench --quiet --locked --bench instructions 2> "$work/errors") > "$work/printed" ||
            { cat "$work/errors" >&2; exit 2; }
        sed 's/\x1b\[[0-9;]*m//g' "$work/printed" | instructions | sed "s/^/$side\t1\t/" >> "$work/instructions"
    done
    table "$work/instructions" || missed=$((missed + 1))
else
    echo "instructions not counted: valgrind or gungraun-runner is absent (benches/instructions.rs says how to install them)"
fi

if [ "$missed" -gt 0 ]; then
    echo "some ratios are above $limit"
    [ -z "$assert" ] || exit 1
fi
