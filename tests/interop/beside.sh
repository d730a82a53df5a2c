#!/bin/sh
# Compares the program for another system with this system's of the same version: pictures, hands, recordings.
# Usage: beside.sh HANDSCOPE COMMAND, where COMMAND runs the other one: qemu-aarch64 /whole/path, or wine /whole/path.exe
# For aarch64, the root file system that .ci/package --all leaves in target/unstable has what this needs:
# chroot target/unstable sh /root/source/tests/interop/beside.sh HANDSCOPE qemu-aarch64 /whole/path
set -eu
here=$(realpath "$1")
shift
work=$(mktemp -d)
cd "$work"
served=
trap 'kill $served 2>/dev/null || true; rm -rf "$work"' EXIT
fail() { echo "$*" >&2; exit 1; }
# Starts a command that serves a hand; $hand is where.
serve() {
  "$@" >ready.txt 2>serve.txt &
  served=$!
  for _ in $(seq 300); do
    hand=$(sed -n 's/\r$//; s/^ready tcp //p' ready.txt)
    [ -z "$hand" ] || return 0
    sleep 0.1
  done
  cat ready.txt serve.txt
  fail "it serves nothing: $*"
}

[ "$("$@" --version | tr -d '\r')" = "$("$here" --version)" ] || fail "another version"
"$here" snapshot --view all --out here >here.txt
"$@" snapshot --view all --out there >there.txt
diff -r here there || fail "other pictures"
echo "pictures of the same bytes: $(find there -name '*.png' | wc -l)"

"$@" watch --hand sim: --for 3 | grep ' states (' || fail "it reads no built-in hand"

serve "$@" share --hand sim: --tcp 127.0.0.1:0
"$here" watch --hand "tcp:$hand" --for 3 | grep ' states (' || fail "it shares no hand"
kill $served

"$@" record --hand sim: --for 3 --out grasp.mcap
"$here" info grasp.mcap | grep '^states' || fail "it records what cannot be read here"
serve "$@" replay grasp.mcap --loop --tcp 127.0.0.1:0
"$here" read ANGLE_ACT FORCE_ACT --hand "tcp:$hand" || fail "it replays nothing"
kill $served
"$here" record --hand sim: --for 3 --out own.mcap
"$@" info own.mcap | grep '^states' || fail "it reads no recording from here"
