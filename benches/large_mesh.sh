#!/usr/bin/env bash
# Time and memory of a plan over a mesh of three million facets, loaded from an OBJ: a whole process of the release build. The mesh is the
# triangulation of a synthetic DEM of 1 226 x 1 226 posts.
#
#   benches/large_mesh.sh
#
# CONTACTS=1000 and ROUNDS=3 can be set. Needs GNU time and awk.
set -euo pipefail
cd "$(dirname "$0")/.."
[ -x /usr/bin/time ] || { echo "no /usr/bin/time here: install the package time" >&2; exit 2; }
cargo build --quiet --locked --release
program=${CARGO_TARGET_DIR:-$PWD/target}/release/chta
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
"$program" synth --rows 1226 --cols 1226 --spacing-m 1 --seed 1 -o "$work/dem.asc"
# The header of an ESRI ASCII grid is a name and a number a line; rows follow from the north.
awk '
    NF == 2 && NR <= 6 { header[tolower($1)] = $2; next }
    { for (i = 1; i <= NF; i++) printf "v %g %g %s\n", i - 1, header["nrows"] - 1 - row, $i; row++ }
    END {
        cols = header["ncols"]
        for (j = 0; j < row - 1; j++)
            for (i = 1; i < cols; i++) {
                a = j * cols + i; b = a + 1; c = a + cols; d = c + 1
                printf "f %d %d %d\nf %d %d %d\n", a, c, b, b, c, d
            }
    }' "$work/dem.asc" > "$work/dem.obj"
rm "$work/dem.asc"
cat > "$work/plan.toml" <<TOML
[body]
name = "moon"
[hopper]
takeoff_speed_max_m_s = 14.0
landing_speed_max_m_s = 14.0
[surface]
friction_coefficient = 0.8
[terrain]
mesh = "dem.obj"
route = "free"
start_m = [100.0, 100.0, 0.0]
goal_m = [1100.0, 1100.0, 0.0]
[search]
contacts_max = ${CONTACTS:-1000}
TOML
for ((round = 1; round <= ${ROUNDS:-3}; round++)); do
    /usr/bin/time -f '%e s elapsed, %U s of processor time, %M KiB' -o "$work/time" \
        "$program" plan "$work/plan.toml" --quiet > "$work/answer" 2> "$work/warnings" || { [ $? = 1 ] || { cat "$work/warnings" >&2; exit 2; }; }
    [ "$round" -gt 1 ] || grep -E 'hops|roadmap:' "$work/answer" | head -n 4
    cat "$work/time"
done
