# What the steps share. A step is run by `bash -euo pipefail`, at the top of the checkout, with $out as the folder of this run.
# A backtrace would hide what a test says as it fails.
export CARGO_TERM_COLOR=never CARGO_INCREMENTAL=0 RUST_BACKTRACE=0
export HANDSCOPE=$PWD/target/debug/handscope
handscope=$HANDSCOPE
# What a step that fails leaves running would keep it from ending.
trap 'kill $(jobs -p) 2>"$out/killed.txt" || true' EXIT
guest=../shared/can-vm/can-vm.sh
session=$out/session

# Packages of others, by who wants them.
window="xvfb xdotool libxcursor1 libxi6 libxkbcommon-x11-0 libgl1 libgl1-mesa-dri"
checkers="lintian desktop-file-utils appstream udev man-db"
modbus="mbpoll libmodbus5"
can_python="python-can pyserial"
modbus_python="pymodbus pyserial"
more_modbus_python="pyModbusTCP uModbus modbus_tk easymodbus pylibmodbus modbus-cli"
models="mujoco yourdfpy"
# websockets is for the tests, which show a hand to a viewer.
readers="mcap mcap-ros2-support rosbags websockets pyarrow pandas polars zstandard lz4"
tools="maturin uv mypy pandas pandas-stubs pyarrow matplotlib nbclient nbformat ipykernel"

skipped() { printf 'skipped: %s: %s\n' "$1" "$2" | tee -a "$out/skipped.txt"; }
required() { printf '%s\n' "$@" | tee -a "$out/required.txt"; }
# shellcheck disable=SC2086
apt_install() { apt-get install -y --no-install-recommends $1 >"$out/apt.txt" 2>&1; }
# shellcheck disable=SC2086
pip_install() { [ -x "$out/python/bin/pip" ] && "$out/python/bin/pip" install -q $1 >"$out/pip.txt" 2>&1; }
python() { "$out/python/bin/python" "$@"; }

# Microseconds in which some program waited for a processor, since the computer started.
waited() { awk '/^some/ {sub(/.*total=/, ""); print}' /proc/pressure/cpu 2>/dev/null || echo 0; }
# Runs a command that talks to a hand in real time; up to three times more while it fails and programs waited for a processor for 30 %
# of the time, as in tests/it/setup/busy.rs: unless_busy COMMAND ...
unless_busy() {
  local began before percent
  for _ in 1 2 3; do
    began=$(date +%s%6N) before=$(waited)
    if "$@"; then return; fi
    percent=$((($(waited) - before) * 100 / ($(date +%s%6N) - began)))
    [ "$percent" -ge 30 ] || return 1
    echo "this computer was busy (programs waited $percent % of the time): tried again" >&2
  done
  "$@"
}

# Starts a simulated hand and waits until it has named its ports: sim_start LINES ARGUMENTS
sim_start() {
  local lines=$1
  shift
  "$handscope" sim "$@" >"$out/ready.txt" &
  sim=$!
  for _ in $(seq 50); do [ "$(wc -l <"$out/ready.txt")" -ge "$lines" ] && return; sleep 0.1; done
  echo "the simulated hand did not start: sim $*"
  return 1
}
sim_end() {
  kill "$sim"
  wait "$sim" || true
}

# The integration tests, as built.
tests() { sed -n 's/.*Executable tests.*(\(.*\)).*/\1/p' "$out/built.txt"; }
# Runs in the guest, where nothing may be skipped. 125: no guest can be had.
in_guest() {
  "$guest" "$@" 2>&1 | tee "$out/guest.txt" || return
  ! grep skipped: "$out/guest.txt"
}
# The same, but what no guest can be had for is skipped: unless_none WHAT WHY ARGUMENTS
unless_none() {
  local what=$1 why=$2 status=0
  shift 2
  in_guest "$@" || status=$?
  [ "$status" -ne 125 ] || skipped "$what" "$why"
  [ "$status" -eq 0 ] || [ "$status" -eq 125 ] || exit "$status"
  return "$status"
}
