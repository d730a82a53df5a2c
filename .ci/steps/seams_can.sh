# What moves a hand against what else happens, over CAN: the other wires have their turn in the tests.
# A kernel as a process is as fast as this machine, and these depend on time: nothing runs beside them. A release tries them all
# ("seams::").
if [ -e /sys/class/net/vcan0 ] || [ ! -x "$guest" ]; then
  echo "no guest is needed, or there is none"
  exit
fi
tests=$(tests)
# It does not start on processors whose registers are wider than it knows; the other guest is too slow.
unless_none "seams over CAN" "no kernel as a process starts on this processor" \
  --time 900 --vm uml --env "HANDSCOPE_SEAMS=/ can" --env HANDSCOPE_SEAMS_AT_A_TIME=2 --with "$handscope" -- "$tests" \
  seams::the_program seams::feedback_freezes --nocapture || true
