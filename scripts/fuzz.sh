#!/usr/bin/env bash
# Fuzzes one target of test/fuzz/ with clang's libFuzzer under the address and undefined behaviour sanitizers.
#
# Usage: scripts/fuzz.sh TARGET [SECONDS]
#   TARGET    such as weights or mesh: the name of a file test/fuzz/TARGET_fuzz.cpp
#   SECONDS   how long; default: until something is found or you press Ctrl-C
#
# What is found lies in build-address-undefined/fuzz/TARGET/ as crash-*, timeout-* or oom-*. Inputs that reach new code
# are kept in its corpus/ and used by the next run. To try one file again, run the program with the file's name:
#   build-address-undefined/test/fuzz/fuzz_TARGET FILE
set -euo pipefail
usage() { sed -n '2,11s/^# \{0,1\}//p' "$0"; }
cd "$(dirname "${BASH_SOURCE[0]}")/.."
known=$(cd test/fuzz && ls -- *_fuzz.cpp | sed 's/_fuzz.cpp$//' | paste -sd ' ')
case "${1:-}" in
  "" | -h | --help)
    usage
    echo "Targets: $known"
    [ $# -gt 0 ] || exit 2
    exit 0
    ;;
esac
target=$1
seconds=${2:-0}
[ -f "test/fuzz/${target}_fuzz.cpp" ] || { echo "fuzz.sh: unknown target '$target'; known are $known" >&2; exit 2; }
[[ "$seconds" =~ ^[0-9]+$ ]] || { echo "fuzz.sh: SECONDS is '$seconds'; it must be a whole number" >&2; exit 2; }

export SANITIZE=address,undefined
. scripts/build_folder.sh
scripts/setup.sh --target "fuzz_$target"
folder="$build/fuzz/$target"
mkdir -p "$folder/corpus"
# An input of 10 s, or one that takes 2 GB, is a finding.
exec "$build/test/fuzz/fuzz_$target" -max_total_time="$seconds" -timeout=10 -rss_limit_mb=2048 \
  -artifact_prefix="$folder/" -print_final_stats=1 "$folder/corpus" "$build/test/fuzz_corpus/$target"
