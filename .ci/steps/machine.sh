rm -f "$out/required.txt" "$out/skipped.txt"
: >"$out/required.txt"
if command -v apt-get >/dev/null && apt-get update -qq -o APT::Update::Error-Mode=any 2>"$out/apt.txt"; then
  required "the real window" lintian
fi
if [ -e /sys/class/net/vcan0 ]; then
  required SocketCAN
elif [ -x "$guest" ]; then
  required SocketCAN can-utils
fi
if command -v python3 >/dev/null && python3 -m venv "$out/python" >"$out/venv.txt" 2>&1 &&
  "$out/python/bin/pip" download -q --no-deps -d "$out/probe" pyserial >"$out/pip.txt" 2>&1; then
  required python-can pymodbus pandas polars mcap foxglove mujoco maturin
fi
# CycloneDDS 0.10.2, which Unitree pins, has wheels for Python up to 3.10.
for python in python3.10 "$HOME"/.pyenv/versions/3.10.*/bin/python; do
  if "$python" -m venv "$out/dds" >"$out/venv.txt" 2>&1 &&
    "$out/dds/bin/pip" download -q --no-deps -d "$out/probe" cyclonedds==0.10.2 >"$out/pip.txt" 2>&1; then
    required cyclonedds
    break
  fi
done
