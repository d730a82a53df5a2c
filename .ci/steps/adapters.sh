if ! pip_install "$can_python"; then
  skipped python-can "not here and not to be had"
  exit
fi
for kind in slcan usbcan; do
  sim_start 1 "--$kind" "$out/adapter" --id 7
  interface=$kind
  [ "$kind" = slcan ] || interface=robotell
  unless_busy python tests/interop/python_can.py "$interface" "$out/adapter"
  unless_busy "$handscope" watch --hand "$kind:$out/adapter?id=7" --for 2 --json >"$out/watched.txt"
  tail -n 1 "$out/watched.txt"
  sim_end
done
