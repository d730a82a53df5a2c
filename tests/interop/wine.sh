#!/bin/sh
# Tries the Windows program under wine 10: what beside.sh compares, a serial port, what Windows cannot do, the folder of
# recordings, the window, and that a hand stops however the program ends. HANDSCOPE is the Linux program of the same version.
# Usage: wine.sh FILE.zip HANDSCOPE
# It needs wine, gcc-mingw-w64-x86-64-win32, imagemagick, unzip and xvfb, installed in target/unstable, which .ci/package --all
# leaves, with /proc and /dev mounted there: chroot target/unstable sh /root/source/tests/interop/wine.sh FILE.zip HANDSCOPE
set -eu
zip=$(realpath "$1")
linux=$(realpath "$2")
tests=$(dirname "$(realpath "$0")")
work=$(mktemp -d)
cd "$work"
export HOME="$work" WINEPREFIX="$work/wine" WINEDEBUG=-all DISPLAY=:87 LC_ALL=C.UTF-8
started=
trap 'kill $started 2>/dev/null || true; rm -rf "$work"' EXIT
fail() { echo "$*" >&2; exit 1; }
there() { timeout 60 wine "$work/handscope/handscope.exe" "$@"; }
# Served by the Linux program, so that what the hand received is not told by the program under trial.
port=6087
angle() { "$linux" read ANGLE_ACT --hand tcp:127.0.0.1:$port --json; }
wait_for() { for _ in $(seq 200); do [ ! -s "$1" ] || return 0; sleep 0.05; done; fail "$1 did not come"; }

unzip -q "$zip"
x86_64-w64-mingw32-gcc-win32 -O1 -o console.exe "$tests/console.c"
Xvfb $DISPLAY -noreset -screen 0 1600x1000x24 >xvfb.txt 2>&1 &
started=$!
wineboot -i >wineboot.txt 2>&1
# Keeps wine's server running: where it ends, it writes to the standard error of the program that started it.
wine ping -n 600 127.0.0.1 >ping.txt 2>&1 &
started="$started $!"

sh "$tests/beside.sh" "$linux" wine "$work/handscope/handscope.exe"

there help gamepad >there.txt
"$linux" help gamepad >here.txt
cmp here.txt there.txt || fail "other bytes of text"

"$linux" sim --rs485 "$work/hand" --tcp 127.0.0.1:$port --scenario free >sim.txt 2>&1 &
started="$started $!"
wait_for sim.txt
ln -s "$(readlink hand)" wine/dosdevices/com3
there read TEMP --hand rs485:COM3
there scan --serial COM3 --ids 1
there doctor --hand rs485:COM3 | head -n 3
there scan

refuses() {
  if there "$@" >out.txt 2>why.txt; then fail "done, though Windows cannot: $*"; fi
  cat why.txt
  [ "$(grep -c Linux why.txt)" = 1 ] || fail "no word of Linux: $*"
  [ "$(wc -l <why.txt)" = 1 ] || fail "not one line: $*"
}
refuses watch --hand can:can0
refuses sim --can can0
refuses sim --rs485 COM9
refuses inputs
refuses follow --hand sim: --gamepad

there record --hand sim: --for 1
find -L wine/drive_c/users -maxdepth 7 -path '*/Documents/Handscope/*.mcap' | grep . || fail "no recording in the documents"

# However the program ends, the hand stands still 300 ms later. Where a console's window is closed, wine kills the program, and
# what stops the hand is its holder process.
ends() {
  rm -f told.txt
  timeout 60 wineconsole console.exe "$1" 3 told.txt handscope/handscope.exe trial --hand tcp:127.0.0.1:$port \
    --joint index --speed 10 --arm >trial.txt 2>&1 &
  console=$!
  sleep 2
  before=$(angle)
  wait_for told.txt
  sleep 0.3
  then=$(angle)
  sleep 1
  now=$(angle)
  wait $console || true
  sed -n p told.txt
  grep -q ': told' told.txt || fail "$1: it was not ended"
  [ "$before" != "$then" ] || fail "$1: the hand had not moved: $before"
  [ "$then" = "$now" ] || fail "$1: the hand moves on: $then, then $now"
}
for how in key close logoff shutdown kill window; do ends $how; done

wine handscope/handscope.exe >window.txt 2>&1 &
window=$!
started="$started $window"
sleep 30
import -window root /tmp/handscope-window.png
kill -0 $window || { cat window.txt; fail "the window is gone"; }
[ "$(identify -format %k /tmp/handscope-window.png)" -gt 1000 ] || fail "the window shows nothing"
echo "the window stands; look at /tmp/handscope-window.png"
