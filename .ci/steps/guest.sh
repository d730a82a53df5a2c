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
tests=$(sed -n 's/.*Executable tests.*(\(.*\)).*/\1/p' "$out/built.txt")
unless_none SocketCAN "no guest starts here" -- "$tests" link::can_vm --nocapture || exit 0
in_guest --with "$handscope" -- sh -c "$handscope sim --can vcan0 & sleep 1
  $handscope watch --hand can:vcan0 --for 2 --json | tail -n 1
  $handscope doctor --hand can:vcan0 --for 2
  $handscope read ANGLE_ACT HAND_ID --hand can:vcan0"
in_guest -- "$tests" session::wires --nocapture
# What moves a hand against what else happens, over CAN: the other wires have their turn in the tests.
# A kernel as a process is as fast as this machine, and these depend on time; a release tries them all ("seams::").
# It does not start on processors whose registers are wider than it knows; the other guest is too slow.
unless_none "seams over CAN" "no kernel as a process starts on this processor" \
  --vm uml --env "HANDSCOPE_SEAMS=/ can" --env HANDSCOPE_SEAMS_AT_A_TIME=2 --with "$handscope" -- "$tests" \
  seams::the_program seams::feedback_freezes --nocapture || true
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
