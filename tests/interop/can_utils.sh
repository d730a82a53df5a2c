#!/bin/sh
# can-utils and the simulated hand on vcan0 understand each other: can_utils.sh HANDSCOPE. Runs where vcan0 is.
set -eu
handscope=$1
work=$(mktemp -d)
cleanup() {
  kill $sim $dump $noise 2>/dev/null || :
  rm -rf "$work"
}
sim='' dump='' noise=''
trap cleanup EXIT

fail() {
  echo "$1; the bus:"
  cat "$work/bus"
  exit 1
}
# Waits until the bus has carried this frame, in candump's form: identifier, length, bytes.
seen() {
  for _ in $(seq 100); do
    tr -s ' ' <"$work/bus" | grep -q "vcan0 $1\$" && return
    sleep 0.1
  done
  fail "not seen: $1"
}

"$handscope" sim --can vcan0 --id 1 >"$work/ready" &
sim=$!
candump vcan0 >"$work/bus" 2>/dev/null &
dump=$!
for _ in $(seq 100); do [ -s "$work/ready" ] && break; sleep 0.1; done
sleep 0.5

# The manual's examples (2.3): ANGLE_ACT(3) of hand 1 is read, ANGLE_SET(3) is written and read back.
cansend vcan0 01840001#02
seen "01840001 \[1\] 02"
seen "01840001 \[2\] E8 03"
cansend vcan0 05750001#5802
seen "05750001 \[1\] 01"
cansend vcan0 01750001#02
seen "01750001 \[2\] 58 02"
echo "cansend reads and writes the simulated hand"

# Our own frames have the documented form: angles in pieces of eight and four bytes, the length in the request.
"$handscope" read ANGLE_SET --hand can:vcan0
seen "01738001 \[1\] 08"
seen "01758001 \[1\] 04"
seen "01738001 \[8\] .*"
echo "candump sees our frames as the manual has them"

kill $dump
# Other traffic beside: any identifier, any length, one a millisecond.
cangen vcan0 -e -g 1 -I r -L r -D r &
noise=$!
"$handscope" watch --hand can:vcan0 --for 2 --json | tail -n 1 >"$work/stats"
grep -q '"reconnects":0,' "$work/stats" || { cat "$work/stats"; exit 1; }
reads=$(sed 's/.*"state_reads":\([0-9]*\).*/\1/' "$work/stats")
[ "$reads" -ge 5 ] || { cat "$work/stats"; exit 1; }
echo "cangen's noise does not upset the link: $reads states in 2 s"
