# Sourced with the name of a program of OMPL: builds benches/peers/NAME.cpp and chta for release, or says what is absent and ends.
mkdir -p target/peers
cargo build --release --quiet --bin chta
ompl=$(ls -d /usr/include/ompl-* /usr/include/ompl 2> /dev/null | tail -n 1 || true)
if [ -z "$ompl" ] || ! command -v g++ > /dev/null; then
    echo "OMPL is absent: apt-get install g++ libompl-dev" >&2
    exit 2
fi
g++ -O3 -march=native -std=c++17 -I/usr/include/eigen3 -I"$ompl" -o "target/peers/$program" "benches/peers/$program.cpp" -lompl
