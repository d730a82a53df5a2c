rm -f "$out/tried_in_guest"
if [ -e /sys/class/net/vcan0 ]; then
  echo "this machine has vcan0: the tests try it"
  if command -v candump >/dev/null; then
    sh tests/interop/can_utils.sh "$handscope"
  else
    skipped can-utils "not installed"
  fi
  exit
fi
if [ ! -x "$guest" ]; then
  skipped SocketCAN "neither vcan0 nor $guest here"
  exit
fi

tests=$(tests)
unless_none SocketCAN "no guest starts here" -- "$tests" link::can_vm --nocapture || exit 0
in_guest --with "$handscope" -- sh -c "$handscope sim --can vcan0 & sleep 1
  $handscope watch --hand can:vcan0 --for 2 --json | tail -n 1
  $handscope doctor --hand can:vcan0 --for 2
  $handscope read ANGLE_ACT HAND_ID --hand can:vcan0"
in_guest -- "$tests" session::wires --nocapture
echo SocketCAN >"$out/tried_in_guest"
# Its kernel has virtual gamepads, too: the modules are in the package of the same version.
release=$("$guest" -- uname -r)
rm -rf "$out/modules"
mkdir "$out/modules"
if (cd "$out" && apt-get download "linux-image-$release" >"$out/apt.txt" 2>&1) &&
  dpkg-deb --fsys-tarfile "$out/linux-image-$release"_*.deb |
  tar x -C "$out/modules" --transform 's|.*/||' --wildcards '*/evdev.ko' '*/uinput.ko'; then
  in_guest --with "$out/modules" --with "$tests" -- sh -c "insmod $out/modules/evdev.ko
    insmod $out/modules/uinput.ko
    $tests pad::uinput --nocapture"
  echo "(SocketCAN|virtual gamepad)" >"$out/tried_in_guest"
fi
script=$PWD/tests/interop/can_utils.sh
unless_none can-utils "none to be had for the guest" --can-utils --with "$handscope" --with "$script" -- sh "$script" "$handscope" || true
