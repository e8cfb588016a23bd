#!/bin/sh
# The time to read 6000 x 6000 float32 compared with GDAL, and the memory for a slice of such a file.
#
#   benches/read_against_gdal.sh [SIDE]
#
# Ours is examples/read_dem: a whole process that reads the file into memory and scans it for its extremes. GDAL's is
# `gdal_translate -of MEM`: a whole process that decodes every block into memory. Both run on the same files in turn, five times each,
# and the least time of each counts: on the wall, and of the processors (user and system), which a busy machine disturbs less. GDAL runs as it comes (one thread for decoding) and with GDAL_NUM_THREADS=ALL_CPUS.
# Needs gdal-bin and GNU time.
set -eu
cd "$(dirname "$0")/.."
side=${1:-6000}
command -v gdal_translate > /dev/null || { echo "skipped: gdal-bin is not installed"; exit 0; }
cargo build --release --quiet --bin chta --example read_dem
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
target/release/chta synth --rows "$side" --cols "$side" --south-west-m 100000,200000 -o "$folder/made.tif"
gdal_translate -q -co TILED=YES -co COMPRESS=DEFLATE -co PREDICTOR=3 "$folder/made.tif" "$folder/tiled_deflate_p3.tif"
gdal_translate -q -co COMPRESS=LZW -co PREDICTOR=3 "$folder/made.tif" "$folder/strips_lzw_p3.tif"
gdal_translate -q -co COMPRESS=LZW "$folder/made.tif" "$folder/strips_lzw.tif"
gdal_translate -q "$folder/made.tif" "$folder/strips_plain.tif"
rm "$folder/made.tif"

# Least wall time and least processor time of five runs, s.
least() {
    for _ in 1 2 3 4 5; do
        /usr/bin/time -f '%e %U %S' -o "$folder/time" "$@" > /dev/null 2>&1
        tail -n 1 "$folder/time"
    done | awk 'NR == 1 || $1 < wall { wall = $1 } NR == 1 || $2 + $3 < cpu { cpu = $2 + $3 } END { print wall, cpu }'
}

last=$((side - 10))
printf '%-20s %14s %14s %14s %18s %15s\n' file ours_wall_cpu_s gdal_wall_cpu_s ratio_wall_cpu gdal_threads_s slice_peak_MiB
for file in "$folder"/*.tif; do
    cat "$file" > /dev/null
    ours=$(least target/release/examples/read_dem "$file")
    gdal=$(least gdal_translate -q -of MEM "$file" none)
    threads=$(GDAL_NUM_THREADS=ALL_CPUS least gdal_translate -q -of MEM "$file" none)
    /usr/bin/time -f %M -o "$folder/memory" target/release/chta slice "$file" --from 100010.3,200020.7 --to "$((100000 + last)),$((200000 + last - 7))" -o "$folder/chain.csv"
    peak=$(($(tail -n 1 "$folder/memory") / 1024))
    ratio=$(echo "$ours $gdal" | awk '{ printf "%.2f %.2f", $1 / $3, $2 / $4 }')
    printf '%-20s %14s %14s %14s %18s %15s\n' "$(basename "$file" .tif)" "$ours" "$gdal" "$ratio" "$threads" "$peak"
done
