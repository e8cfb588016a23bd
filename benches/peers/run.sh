#!/bin/sh
# Alternatives to chta on the same chains; README.md beside this file explains what is run and counted.
#
#   benches/peers/run.sh [SEGMENTS...]
set -eu
cd "$(dirname "$0")/../.."
work=target/peers
mkdir -p "$work"
[ -x "$work/venv/bin/python" ] || python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check --requirement benches/peers/requirements.txt
cargo build --release --quiet --bin chta --example long_chain --example peers_solve
ompl=$(ls -d /usr/include/ompl-* /usr/include/ompl 2> /dev/null | tail -n 1 || true)
if [ -n "$ompl" ] && command -v g++ > /dev/null; then
    g++ -O3 -march=native -std=c++17 -I/usr/include/eigen3 -I"$ompl" -I"$(dirname "$ompl")" -o "$work/ompl_prm" benches/peers/ompl_prm.cpp -lompl
else
    echo "OMPL is left out: apt-get install g++ libompl-dev" >&2
    rm -f "$work/ompl_prm"
fi
exec "$work/venv/bin/python" benches/peers/run.py "$@"
